"""Cuts the job's program in the background as soon as it is computed, and shows what is left."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from PySide6.QtCore import QObject, Signal

from app.progress import Progress
from app.ui.computation import State
from app.ui.cut.picture import CutMoves, CutPaths, CutPicture
from app.ui.main_window import MainWindow
from app.ui.worker import Answer, Worker

if TYPE_CHECKING:
    from app.workflow.cut import CutProgram
    from app.workflow.make import Made

_STEP_RAD = 0.1
"""Turn of a straight piece of an arc's path."""


def cut_picture(made: Made, progress: Progress) -> CutPicture:
    """Cut a made program and prepare the picture; runs on a worker's thread.

    Raises:
        HitofudeError: it cannot be cut.
        Cancelled: the job was asked to stop.
    """
    from app.workflow.cut import cut_made  # imports the engine: never on the window's thread

    result = cut_made(made, progress=progress.part(0.0, 0.9))
    progress.step(0.9, "Preparing the cut")
    lines, tools = result.lines(), result.tools()
    grid = result.cut.before.grid
    picture = CutPicture(
        result.cut.heights.copy(), grid.x0, grid.y0, grid.pitch, result.floor, result.top, result.cut.owner,
        CutMoves(lines, tools, np.zeros(0, np.int32)), paths=_paths(made, result),
    )  # fmt: skip
    _ = picture.relief  # made here, so that the window does not wait for it
    return picture


def _paths(made: Made, result: CutProgram) -> CutPaths:
    """Return the tool's way as straight pieces."""
    from app.model.motion_path import arc_paths
    from app.nc.read.notes_operation import contour_motions
    from app.ui.nc.motion_shapes import shape_motions

    starts, ends, looks = [], [], []
    for file, program in zip(made.files, result.programs, strict=True):
        shapes = shape_motions(program, contour_motions(file.nc.text.encode("ascii"), program))
        motions, arcs = program.motions, arc_paths(program.motions)
        elsewhere = shapes.home.any(axis=1) | shapes.away.any(axis=1)
        straight = np.flatnonzero(~(elsewhere | np.isin(np.arange(len(motions)), arcs.rows)))
        order, begin, end = [straight], [motions.start[straight]], [motions.end[straight]]
        pieces = np.maximum(1, np.ceil(np.abs(arcs.sweep) / _STEP_RAD)).astype(int)
        for count in np.unique(pieces).tolist():
            same = np.flatnonzero(pieces == count)
            points = arcs.points(np.linspace(0.0, 1.0, count + 1))[same]
            order.append(np.repeat(arcs.rows[same], count))
            begin.append(points[:, :-1].reshape(-1, 3))
            end.append(points[:, 1:].reshape(-1, 3))
        rows = np.concatenate(order)
        sorting = np.argsort(rows, kind="stable")
        starts.append(np.concatenate(begin)[sorting])
        ends.append(np.concatenate(end)[sorting])
        looks.append(np.asarray(shapes.look)[rows[sorting]])
    return CutPaths(np.concatenate(starts), np.concatenate(ends), np.concatenate(looks).astype(np.uint8))


class Cutting(QObject):
    """Follows the computation; its own worker, so that cutting never holds up computing.

    Signals:
        shown(): the view shows another cut, or none. failed(sentence).
    """

    shown = Signal()
    failed = Signal(str)

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._view, self._computation = window.views.cut, window.computation
        self._made: object = None
        self._job_id: int | None = None
        self.worker = Worker(self)
        self.worker.done.connect(self._on_done)
        self.worker.failed.connect(self._on_failed)
        window.status.cancelled.connect(self.worker.cancel)
        window.closed.connect(self.worker.finish)
        self._computation.changed.connect(self._follow)

    def _follow(self) -> None:
        made = self._computation.made
        if made is self._made or self._computation.state is State.RUNNING:
            return
        self._made = made
        if made is None or not made.files:
            self._view.show_cut(None)
            self.shown.emit()
            return
        self._job_id = self.worker.start(lambda progress: cut_picture(made, progress), 0)

    def _on_done(self, answer: Answer) -> None:
        if answer.job_id == self._job_id and isinstance(answer.value, CutPicture):
            self._view.show_cut(answer.value)
            self.shown.emit()

    def _on_failed(self, answer: Answer) -> None:
        if answer.job_id == self._job_id:
            self.failed.emit(answer.error or "")
