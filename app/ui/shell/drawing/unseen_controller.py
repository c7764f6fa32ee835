"""Says when what a typed line has drawn lies outside of the picture, where a slip of a digit would not be noticed."""

from __future__ import annotations

from PySide6.QtCore import QObject

from ....drafting.document import DocumentChange
from ....geometry.sample import Box, bounds, union
from ...framework.workspace import Workspace
from ...views.canvas.canvas import Canvas
from ...views.language.command_runner import CommandRunner


class UnseenController(QObject):
    """Looks at the curves that each line adds."""

    def __init__(self, canvas: Canvas, lines: CommandRunner, workspace: Workspace) -> None:
        super().__init__(canvas)
        self._canvas, self._document, self._notice = canvas, workspace.document, workspace.notice
        self._next_id = 1
        self._document.subscribe(self._on_change)
        lines.ran.connect(lambda _, well: self._look() if well else None)

    def _on_change(self, change: DocumentChange) -> None:
        if change & DocumentChange.LOADED:
            self._next_id = self._document.part.next_id()

    def _look(self) -> None:
        """Offer to show what is new, if nothing of it is seen beside what was there before."""
        part, fresh = self._document.part, self._next_id
        self._next_id = part.next_id()
        if self._next_id <= fresh or not part.entities or part.entities[0].id >= fresh or not self._canvas.isVisible():
            return
        box = union([bounds(entity.curve) for entity in part.entities if entity.id >= fresh])
        if box is not None and not _overlap(box, self._canvas.view.world_box(self._canvas.area)):
            self._notice.ask(
                "What was drawn lies outside of the picture.",
                [("Show all", self._canvas.fit), ("Undo", self._document.undo)],
                of_job=True,
            )


def _overlap(a: Box, b: Box) -> bool:
    return a[0] <= b[2] and b[0] <= a[2] and a[1] <= b[3] and b[1] <= a[3]
