"""Measures how the Cut view feels: `python -m tests.ui.measure_cut`; under `xvfb-run` with QT_QPA_PLATFORM=xcb the real
widget.

Prints how long new heights take to the screen, how many pictures a second turning gives, how long the fine picture
takes and the longest of its pieces, for 1024 x 1024 cells in a view of 1200 x 800 px.
"""

from __future__ import annotations

import os
import statistics
import time
from dataclasses import dataclass, replace

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtWidgets import QApplication

from app.ui.framework.theme import DARK
from app.ui.views.cut.cell_colours import prepare
from app.ui.views.cut.render_scheduler import REST_MS
from app.ui.views.cut.view import CutView
from tests.ui.cut.made_up import made_up
from tests.ui.measure_window import live_until

CELLS, SIZE, TURNS = 1024, (1200, 800), 40


@dataclass(frozen=True)
class Felt:
    """What was measured, ms; medians but for `piece_ms`, the longest.

    Attributes:
        new_ms: from `show_cut` until the heights are on the screen, prepared before, as the worker does.
        prepare_ms: that. turn_ms: one picture while turning, composition included. budget: squares of it.
        fine_ms: from the last movement until the fine picture is shown. piece_ms: the window's longest pause meanwhile.
    """

    surface: str
    new_ms: float
    prepare_ms: float
    turn_ms: float
    budget: int
    fine_ms: float
    piece_ms: float


def shown_view() -> CutView:
    """Return a shown view with a cut in it, at rest."""
    view = CutView()
    view.resize(*SIZE)
    view.set_theme(DARK)
    view.show()
    view.show_cut(made_up(CELLS))
    live_until(lambda: view.render_scheduler.fine)
    return view


def new_heights(view: CutView) -> tuple[float, float]:
    """Return how long other heights take to the screen, and how long preparing them took, ms."""
    picture = replace(view.model.picture, heights=view.model.picture.heights * np.float32(0.9), values={})
    begun = time.perf_counter()
    prepare(picture, view.colour)
    made = time.perf_counter()
    view.show_cut(picture)
    while view.render_scheduler.due:
        QApplication.processEvents()
    return 1000 * (time.perf_counter() - made), 1000 * (made - begun)


def turn(view: CutView) -> float:
    """Return how long one step of turning takes until it is on the screen, ms."""
    begun = time.perf_counter()
    view.look_now(view.model.camera.orbited(0.05, 0.0, np.array([50.0, 50.0, -10.0])))
    while view.render_scheduler.due:
        QApplication.processEvents()
    return 1000 * (time.perf_counter() - begun)


def fine(view: CutView) -> tuple[float, float]:
    """Return how long the fine picture takes after a movement, and the longest pause of the window meanwhile, ms."""
    turn(view)
    begun = last = time.perf_counter()
    longest = 0.0
    while not view.render_scheduler.fine:
        QApplication.processEvents()
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    return 1000 * (time.perf_counter() - begun) - REST_MS, 1000 * longest


def measure() -> Felt:
    """Measure one view."""
    view = shown_view()
    news = [new_heights(view) for _ in range(9)]
    turns = [turn(view) for _ in range(TURNS)]
    fines = [fine(view) for _ in range(3)]
    return Felt(
        type(view.render_scheduler.surface).__name__,
        statistics.median(n for n, _ in news),
        statistics.median(r for _, r in news),
        statistics.median(turns[TURNS // 2 :]),
        view.render_scheduler.budget,
        statistics.median(f for f, _ in fines),
        max(p for _, p in fines),
    )


def main() -> None:
    """Measure and print."""
    application = QApplication.instance() or QApplication([])
    print(measure())
    application.quit()


if __name__ == "__main__":
    main()
