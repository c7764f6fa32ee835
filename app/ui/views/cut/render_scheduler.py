"""When a cut is painted: coarse while it moves, fine when it rests, and the fine picture piece by piece."""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import replace

from PySide6.QtCore import QObject, QTimer, Signal
from PySide6.QtWidgets import QWidget

from .cell_colours import CellColours
from .cell_patch import CellPatch
from .model import CutModel
from .playback_overlay import PlaybackOverlay
from .relief import Bytes
from .rendering.cut_frame import CutFrame
from .rendering.cut_scene import CutScene
from .rendering.render_target import RenderStyle
from .surface import GlSurface, ImageSurface, pixel_size

REST_MS = 50
"""After so long without a movement the fine picture is begun."""

_FAST_MS, _SLOW_MS = 25.0, 60.0
_LEAST_BUDGET, _FIRST_BUDGET, _MOST_BUDGET = 1 << 14, 1 << 16, 1 << 22


class RenderScheduler(QObject):
    """Keeps the scene of a view up to date.

    Signals:
        stirred(): what is seen begins to change. rested(): nothing has moved for a while.

    Attributes:
        budget: lines of sight of a picture of the moving cut; it follows the time that painting takes.
        frame_ms: how long the last coarse picture took, ms.
        fine: whether the fine picture is shown. due: whether the coarse one is still to be painted.
        playback: what lies over the cut while it is played. surface: on which it is painted; None until there is one.
    """

    stirred = Signal()
    rested = Signal()

    def __init__(self, model: CutModel, widget: QWidget) -> None:
        """Make one; `widget` is what the surface covers."""
        super().__init__(widget)
        self._model, self._widget = model, widget
        self.surface: GlSurface | ImageSurface | None = None
        self.budget, self.frame_ms, self.fine = _FIRST_BUDGET, 0.0, False
        self._colours: CellColours | None = None
        self._detail_values: Bytes | None = None
        self._look = RenderStyle((0.0,) * 3, (0.5,) * 3, (0.5,) * 3, ((0.5, 0.5, 0.5, 1.0),) * 4)
        self._picture_due = self._colours_due = self._detail_due = self.due = False
        self._patches: list[CellPatch] = []
        self.playback = PlaybackOverlay(model, self)
        self.playback.stirred.connect(self.stir)
        self._steps: Iterator[bool] | None = None
        self._rest = QTimer(self, singleShot=True, interval=REST_MS)
        self._rest.timeout.connect(self._on_rest)
        self._next = QTimer(self, singleShot=True, interval=0)
        self._next.timeout.connect(self._go_on)

    @property
    def look(self) -> RenderStyle:
        """Colours and light."""
        return self._look

    @property
    def resting(self) -> bool:
        """Whether nothing has moved for a while."""
        return not self._rest.isActive()

    @property
    def size(self) -> tuple[int, int]:
        """Width and height of what is painted, px."""
        return pixel_size(self._widget)

    @property
    def visible(self) -> bool:
        """Whether anybody sees it."""
        return self._widget.isVisible()

    def new_picture(self) -> None:
        """The view shows another cut; it is painted once its colours are known."""
        self._picture_due = True
        self.playback.tool_due = True
        self.stir()

    def patch(self, patch: CellPatch) -> None:
        """Show cells that have changed: only they are handed over, unless so many wait that all are less.

        The picture is changed in place, so its arrays must be nobody else's.
        """
        picture = self._model.picture
        if picture is None:
            return
        patch.write_to(picture, self._model.colour_shown)
        self._patches.append(patch)
        if sum(each.heights.size for each in self._patches) > picture.heights.size:
            self._patches.clear()
            self._picture_due = self._colours_due = True
        self.stir()

    def adopt(self, values: Bytes) -> None:
        """Take the cells' colours from another array from now on, which holds the same ones and is changed in place."""
        if self._colours is not None:
            self._colours = replace(self._colours, values=values)

    def new_colours(self, colours: CellColours, detail: Bytes | None, look: RenderStyle) -> None:
        """The cut has other colours.

        Args:
            colours: of the whole. detail: of the finer look at a part of it, if there is one.
            look: of everything else.
        """
        self._colours, self._detail_values, self._look = colours, detail, look
        self._colours_due = self._detail_due = True
        self.stir()

    def new_detail(self, values: Bytes | None) -> None:
        """The view shows another finer look at a part of the cut, or none: the fine picture is painted anew at once."""
        self._detail_values, self._detail_due = values, True
        if self.resting and not self.due:
            self._begin_fine()
        else:
            self.stir()

    def renew(self) -> None:
        """The scene is a new one."""
        self._picture_due = self._colours_due = self.playback.tool_due = self.playback.wedges_due = True
        self.stir()

    def moved(self) -> None:
        """What is seen changes: paint it coarse at once, and fine when nothing moves any more."""
        self.stir()
        self.stirred.emit()

    def stir(self) -> None:
        """Paint coarse at once, however often it is asked for only one picture at a time, and fine when nothing more is
        asked for.
        """
        self._steps, self.due, self.fine = None, True, False
        self._next.stop()
        self._rest.start()
        if self.surface is not None:
            self.surface.update()

    def paint(self, scene: CutScene) -> None:
        """Paint what is due, with the scene's context current."""
        if scene.picture is None and self._model.picture is not None:
            self._picture_due = self._colours_due = True
        if not self.due:
            return
        begun = time.perf_counter()
        uploaded = self._upload(scene)
        self.due = False
        scene.draw(self._frame(self.budget))
        scene.ctx.finish()
        self.frame_ms = 1000 * (time.perf_counter() - begun)
        if self.resting:  # it was hidden, or painting came late: the fine picture is still to come
            self._rest.start()
        if not uploaded:
            self._learn()

    def _upload(self, scene: CutScene) -> bool:
        """Hand over what is new; return whether something was. Heights wait for their colours."""
        picture, colours = self._model.picture, self._colours
        self.playback.hand_over(scene)
        if picture is None or colours is None or colours.values.shape != picture.heights.shape:
            return False
        if self._colours_due and self._patches:  # these tell what the colours told before
            self._picture_due = True
        new = self._picture_due or self._colours_due or self._detail_due
        if self._picture_due:
            scene.show_picture(picture)
            scene.show_paths(picture.paths)
            self._patches.clear()
        if self._colours_due:
            scene.show_colours(colours)
        if self._detail_due or self._picture_due:
            scene.show_detail(self._model.detail, self._detail_values)
        for patch in self._patches:
            scene.patch(patch)
        self._patches.clear()
        self._picture_due = self._colours_due = self._detail_due = False
        return new

    def _frame(self, budget: int) -> CutFrame:
        seen = self._model
        return CutFrame(seen.camera, self.size, self._look, budget, seen.section, seen.looks)

    def _learn(self) -> None:
        """Paint the next moving picture finer where there is time for it, coarser where there is not."""
        if self.frame_ms < _FAST_MS:
            self.budget = min(2 * self.budget, _MOST_BUDGET)
        elif self.frame_ms > _SLOW_MS:
            self.budget = max(self.budget // 2, _LEAST_BUDGET)

    def _on_rest(self) -> None:
        self._begin_fine()
        self.rested.emit()

    def _begin_fine(self) -> None:
        surface = self.surface
        if surface is None or self.due or not self.visible:
            return
        surface.work(self._upload)
        self.fine = False
        self._steps = surface.work(lambda scene: scene.draw_in_steps(self._frame(0)))
        self._go_on()

    def _go_on(self) -> None:
        """Paint the next piece of the fine picture."""
        surface, steps = self.surface, self._steps
        if surface is None or steps is None:
            return
        shows = surface.work(lambda _: next(steps, None))
        if shows is not None:
            if shows:
                surface.update()
            self._next.start()
            return
        self._steps, self.fine = None, True
        surface.update()
