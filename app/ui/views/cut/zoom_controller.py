"""Step S101: what is seen of the stock is cut again with as many cells as the whole, whenever the view rests."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....core.progress import Progress
from ...framework.worker import JobOutcome, Worker
from .cell_colours import CutColourBy, prepare
from .cut_picture import CutPicture
from .model import CutModel
from .render_scheduler import RenderScheduler
from .shown_cut import picture_of
from .visible_region import RegionQuery, region_to_refine, serves

if TYPE_CHECKING:
    from ....usecases.cutting.cut import CutProgram

MOST_LOOKS = 5
"""A finer look shows better what is seen, and so may ask for another one; so often at most."""


@dataclass(frozen=True, eq=False)
class ZoomResult:
    """What a finer look found.

    Attributes:
        sight: what was looked at. detail: its part in finer cells; None = the whole will do.
    """

    sight: RegionQuery
    detail: CutPicture | None


def zoomed_cut(followed: ZoomTarget, sight: RegionQuery, colour: CutColourBy, progress: Progress) -> ZoomResult:
    """Cut the part of the stock that is seen with as many cells as the whole; runs on the worker's thread.

    Args:
        followed: the whole, cut. sight: what is looked at. colour: what its colours tell.

    Raises:
        HitofudeError: it cannot be cut.
        Cancelled: the view has moved on.
    """
    from ....usecases.cutting.cut import CutOptions, cut

    program, cells = followed.program, followed.program.options.cells
    window = region_to_refine(sight, cells)
    progress.step(0.3, "Looking closer")
    if window is None:
        return ZoomResult(sight, None)
    if serves(window, sight.detail):
        return ZoomResult(sight, sight.detail)
    moves = sight.picture.moves
    assert moves is not None
    part = cut(program.setup, CutOptions(cells, window, judge=False, stop=followed.stop), progress.part(0.3, 0.9))
    detail = picture_of(part, moves)
    prepare(detail, colour, sight.picture.span)
    return ZoomResult(sight, detail)


@dataclass(frozen=True, slots=True)
class ZoomTarget:
    """A program, and how many of its motions are done; None = all."""

    program: CutProgram
    stop: int | None = None


class ZoomController(QObject):
    """Follows a view; its own worker, so that a look never holds up anything else.

    Signals:
        found(CutPicture | None): the finer cells to be shown, or none. looked(): they are those that should be.
        failed(sentence).
    """

    found = Signal(object)
    looked = Signal()
    failed = Signal(str)

    def __init__(self, model: CutModel, painting: RenderScheduler, parent: QObject) -> None:
        super().__init__(parent)
        self._model, self._painting = model, painting
        self._followed: ZoomTarget | None = None
        self._job_id: int | None = None
        self._looks = 0
        self.worker = Worker(self, head_start_s=0.0)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(self._on_failed)
        painting.stirred.connect(self._on_stirred)
        painting.rested.connect(self._look)

    def follow(self, followed: ZoomTarget | None) -> None:
        """Look closer at another program, or another moment of it, from now on; None: at nothing."""
        if followed != self._followed:
            self.worker.cancel()
            self._followed, self._looks = followed, 0
            self.found.emit(None)
            if self._painting.resting:
                self._look()

    def _on_stirred(self) -> None:
        self._looks = 0
        if self.worker.busy:
            self.worker.cancel()

    def _look(self) -> None:
        model, followed = self._model, self._followed
        if followed is None or model.picture is None or not self._painting.visible or self._looks >= MOST_LOOKS:
            return
        sight, colour = model.sighted(model.picture, self._painting.size), model.colour_shown
        self._looks += 1
        self._job_id = self.worker.start(lambda progress: zoomed_cut(followed, sight, colour, progress), 0)

    def _on_done(self, answer: JobOutcome) -> None:
        """Show what was found; with it, more of what is seen may be known, so look again until nothing changes."""
        look, model = answer.value, self._model
        if answer.job_id != self._job_id or not isinstance(look, ZoomResult) or look.sight.picture is not model.picture:
            return
        if look.detail is model.detail:
            self.looked.emit()
            return
        self.found.emit(look.detail)
        if look.detail is not None and self._painting.resting:
            self._look()
        else:
            self.looked.emit()

    def _on_failed(self, answer: JobOutcome) -> None:
        if answer.job_id == self._job_id:
            self.failed.emit(answer.error or "")
