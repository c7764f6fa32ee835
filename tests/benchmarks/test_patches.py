"""Showing cells that changed, as a multiple of the time that showing the whole cut anew takes."""

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from app.ui.views.cut.cell_colours import CutColourBy, cell_colours
from app.ui.views.cut.cell_patch import patch_of
from app.ui.views.cut.cut_picture import CutPicture
from app.ui.views.cut.rendering.cut_scene import CutScene
from tests.benchmarks.conftest import OURS, record
from tests.ui.cut.pictures import INKS, without_a_screen

pytestmark = pytest.mark.benchmark
CELLS, SIDE = 1024, 256


def heights() -> np.ndarray:
    x = np.arange(CELLS) / 30.0
    return (-4.0 + np.sin(x) * np.cos(x)[:, None]).astype(np.float32)


@pytest.fixture
def scene():
    with without_a_screen() as context:
        made, picture = CutScene(context), CutPicture(heights(), 0.0, 0.0, 0.1, -10.0, 0.0)
        made.show_picture(picture)
        made.show_colours(cell_colours(picture, CutColourBy.METAL, INKS))
        yield made
        made.release()


def test_a_patch(benchmark: BenchmarkFixture, scene: CutScene) -> None:
    """Relief of 256 x 256 changed cells and those round them that they shade, and all of it on the graphics side."""
    cells, values, place = (
        heights(),
        np.zeros((CELLS, CELLS), np.uint8),
        (slice(300, 300 + SIDE), slice(400, 400 + SIDE)),
    )

    def show() -> None:
        scene.patch(patch_of(cells, values, 0.1, place))
        scene.ctx.finish()

    benchmark.pedantic(show, rounds=20, warmup_rounds=2)
    record(benchmark, f"{SIDE} x {SIDE} of {CELLS} x {CELLS} cells shown anew", OURS, least=True)


def test_the_whole(benchmark: BenchmarkFixture, scene: CutScene) -> None:
    """The same by relief of the whole, and the whole on the graphics side."""
    cells = heights()

    def show() -> None:
        scene.show_picture(CutPicture(cells, 0.0, 0.0, 0.1, -10.0, 0.0))
        scene.ctx.finish()

    benchmark.pedantic(show, rounds=20, warmup_rounds=2)
    record(benchmark, f"{SIDE} x {SIDE} of {CELLS} x {CELLS} cells shown anew", "all of it", least=True)
