"""When a cut is painted: coarse while it moves, fine when it rests, and the fine picture piece by piece."""

from __future__ import annotations

import time
from collections.abc import Iterator
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer

from app.ui.cut.colouring import Colouring
from app.ui.cut.scene import CutScene, Frame
from app.ui.cut.stage import CutLook
from app.ui.cut.surface import pixel_size

if TYPE_CHECKING:
    from app.ui.cut.cut_view import CutView

REST_MS = 140
"""After so long without a movement the fine picture is begun."""

_FAST_MS, _SLOW_MS = 25.0, 60.0
_LEAST_BUDGET, _MOST_BUDGET = 1 << 14, 1 << 22


class Painting(QObject):
    """Keeps the scene of a view up to date.

    Attributes:
        budget: squares that a picture of the moving cut is painted with; it follows the time that painting takes.
        frame_ms: how long the last coarse picture took, ms.
        fine: whether the fine picture is shown. due: whether the coarse one is still to be painted.
    """

    def __init__(self, view: CutView) -> None:
        super().__init__(view)
        self._view = view
        self.budget, self.frame_ms, self.fine = 2 * _LEAST_BUDGET, 0.0, False
        self._colours: Colouring | None = None
        self._look = CutLook((0.0,) * 3, (0.5,) * 3, (0.5,) * 3, ((0.5, 0.5, 0.5, 1.0),) * 4)
        self._picture_due = self._colours_due = self.due = False
        self._steps: Iterator[None] | None = None
        self._rest = QTimer(self, singleShot=True, interval=REST_MS)
        self._rest.timeout.connect(self._begin_fine)
        self._next = QTimer(self, singleShot=True, interval=0)
        self._next.timeout.connect(self._go_on)

    def new_picture(self) -> None:
        """The view shows another cut."""
        self._picture_due = True
        self.moved()

    def new_colours(self, colours: Colouring, look: CutLook) -> None:
        """The cut has other colours."""
        self._colours, self._look, self._colours_due = colours, look, True
        self.moved()

    def renew(self) -> None:
        """The scene is a new one."""
        self._picture_due = self._colours_due = True
        self.moved()

    def moved(self) -> None:
        """What is shown is no longer right: paint it coarse at once, and fine when nothing moves any more."""
        self._steps, self.due, self.fine = None, True, False
        self._next.stop()
        self._rest.start()
        if self._view.surface is not None:
            self._view.surface.update()

    def paint(self, scene: CutScene) -> None:
        """Paint what is due, with the scene's context current."""
        if scene.picture is None and self._view.picture is not None:
            self._picture_due = self._colours_due = True
        if not self.due:
            return
        begun = time.perf_counter()
        if self._picture_due and self._view.picture is not None:
            scene.show_picture(self._view.picture)
            scene.show_paths(self._view.picture.paths)
        if self._colours_due and self._colours is not None:
            scene.show_colours(self._colours)
        uploaded = self._picture_due or self._colours_due
        self._picture_due = self._colours_due = self.due = False
        scene.draw(self._frame(self.budget))
        scene.ctx.finish()
        self.frame_ms = 1000 * (time.perf_counter() - begun)
        if not uploaded:
            self._learn()

    def _frame(self, budget: int) -> Frame:
        camera, section, shown = self._view.frame_parts()
        return Frame(camera, pixel_size(self._view), self._look, budget, section, shown)

    def _learn(self) -> None:
        """Paint the next moving picture finer where there is time for it, coarser where there is not."""
        if self.frame_ms < _FAST_MS:
            self.budget = min(2 * self.budget, _MOST_BUDGET)
        elif self.frame_ms > _SLOW_MS:
            self.budget = max(self.budget // 2, _LEAST_BUDGET)

    def _begin_fine(self) -> None:
        surface = self._view.surface
        if surface is None or self.due or not self._view.isVisible():
            return
        self._steps = surface.work(lambda scene: scene.draw_in_steps(self._frame(0)))
        self._go_on()

    def _go_on(self) -> None:
        """Paint the next piece of the fine picture."""
        surface, steps = self._view.surface, self._steps
        if surface is None or steps is None:
            return
        if surface.work(lambda _: next(steps, _DONE)) is None:
            self._next.start()
            return
        self._steps, self.fine = None, True
        surface.update()


_DONE = object()
