"""A window at the Stages view."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.core.progress import Progress
from app.ui.framework.view import View
from app.ui.views.stages import controller
from app.ui.views.stages.film_set import FilmRequest, FilmSet, film_set_of
from tests.ui.conftest import WAIT_MS


class FilmsOnce:
    """Films that were made before, by what they were made of; nobody changes them."""

    def __init__(self) -> None:
        self._kept: list[FilmSet] = []

    def __call__(self, request: FilmRequest, before: FilmSet | None, progress: Progress) -> FilmSet:
        """Return the film of a job's stages, as the view has it made."""
        for made in self._kept:
            if _alike(request, made.request):
                return replace(made, request=request)
        self._kept.append(film_set_of(request, before, progress))
        return self._kept[-1]


def _alike(one: FilmRequest, other: FilmRequest) -> bool:
    shown = (one.job, one.size, one.published) == (other.job, other.size, other.published)
    return shown and one.pixels is other.pixels


@pytest.fixture(scope="session")
def films_once():
    return FilmsOnce()


@pytest.fixture
def staged(qtbot, wiring, films_once, monkeypatch):
    """A triangle with a hole, its stages computed on a small bitmap, once a run, and shown."""
    wiring.run("line 0,0 30,0 0,24 0,0")
    wiring.run("circle 9,8 3")
    wiring.run("line 40,0 52,0 52,12 40,12 40,0")
    with monkeypatch.context() as meanwhile:
        meanwhile.setattr(controller, "film_set_of", films_once)
        wiring.display_controller.show_view(View.STAGES)
        show_stages(qtbot, wiring)
    return wiring


def show_stages(qtbot, wiring):
    """Wait until the stages are there."""
    qtbot.waitUntil(
        lambda: not wiring.stages_controller.worker.busy and wiring.window_.views.stages.film is not None,
        timeout=WAIT_MS,
    )
