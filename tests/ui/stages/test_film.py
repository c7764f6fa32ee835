"""Stages as changes: every plane comes back bit for bit, forwards, backwards and by leaps."""

import numpy as np
import pytest

from app.drafting.document import Document
from app.exhibits.stages import Variant, stages
from app.raster.frame import PixelCode
from app.ui.views.stages.film import Projector, chain_at
from app.ui.views.stages.film_set import FilmRequest, film_set_of
from app.usecases.making.bitmap_job import drawn_job
from app.usecases.pixels.options import BitmapSize
from app.usecases.pixels.way import compute_on_bitmap

SIZE = BitmapSize(120)


@pytest.fixture(scope="module")
def job():
    document = Document()
    document.run("line 0,0 30,0 0,24 0,0")
    document.run("line 40,0 52,0 52,12 40,12 40,0")
    return document.job


@pytest.fixture(scope="module")
def planes(job):
    ready = drawn_job(job, SIZE)
    return list(stages(ready.job, ready.part, compute_on_bitmap(ready.job, ready.part).paths, Variant.SETTLED))


@pytest.fixture(scope="module")
def reel(job):
    return film_set_of(FilmRequest(job, SIZE))


def test_every_stage_comes_back_in_any_order(reel, planes):
    projector = Projector(reel.film)
    order = [
        *range(len(planes)),
        *reversed(range(len(planes))),
        *np.random.default_rng(2).permutation(len(planes)).tolist(),
    ]
    for at in order:
        projector.show(at)
        assert np.array_equal(projector.plane, planes[at].plane), at
    assert [still.number for still in reel.film.stills] == [stage.number for stage in planes]


def test_codes_are_those_that_a_step_holds(reel, planes):
    for number in (110, 203, 208):
        held = {int(code) for stage in planes if stage.number == number for code in np.unique(stage.plane)}
        assert reel.film.codes[number] == held
    peel = next(k for k, still in enumerate(reel.film.stills) if still.number == 304)
    assert {PixelCode.TRACED, PixelCode.FRAME, PixelCode.PROCESSED} <= reel.film.codes_near(peel)


def test_steps_and_parts_are_found(reel):
    film = reel.film
    first = film.seek_step(301, -1)
    assert film.stills[first].number == 301 and film.seek_step(301, first) > first
    last = max(k for k, still in enumerate(film.stills) if still.number == 301)
    assert film.seek_step(301, last) == first
    second = film.seek_part(first, 1)
    assert {film.stills[first].region, film.stills[second].region} == {1, 2} and film.stills[
        second - 1
    ].region == film.stills[first].region
    assert film.seek_part(second, -1) == first
    assert film.seek_part(len(film) - 1, 1) == len(film) - 1 and film.seek_part(0, -1) == 0


def test_another_fill_uses_the_paths_again(job, reel):
    published = film_set_of(FilmRequest(job, SIZE, published=True), reel)
    assert published.made is reel.made and published.film is not reel.film
    wrong = [still.number for still in published.film.stills if still.wrong is not None]
    assert wrong[:2] == [208, 130] and set(wrong[2:]) == {304, 307}, wrong
    assert film_set_of(FilmRequest(job, SIZE), published).film is reel.film


def test_chains_are_found_by_their_pixels(reel):
    still = reel.film.stills[reel.film.seek_step(203, -1)]
    assert len(still.chains) == 2
    for k, chain in enumerate(still.chains):
        row, col = chain.pixels()[5]
        assert chain_at(still.chains, int(row), int(col)) == k
    assert chain_at(still.chains, 0, 0) is None
