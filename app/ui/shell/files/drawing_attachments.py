"""What lies beside the drawing and is kept with it: the picture that is traced, and the text of the editor."""

from __future__ import annotations

from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....formats.project.extras import ProjectExtras

if TYPE_CHECKING:
    from ...views.language.controller import TextController
    from .underlay_controller import UnderlayController


class DrawingAttachments(QObject):
    """Tells what lies beside the drawing now, and brings back what a file holds.

    Signals:
        changed(): the picture or the text is another.
    """

    changed = Signal()

    def __init__(self, parent: QObject) -> None:
        super().__init__(parent)
        self._saved = ProjectExtras()
        self._underlaying: UnderlayController | None = None
        self._control: TextController | None = None

    def watch(self, underlaying: UnderlayController, control: TextController) -> None:
        """Look after these two from now on."""
        self._underlaying, self._control = underlaying, control
        underlaying.changed.connect(self.changed)
        control.page.edited.connect(self.changed)

    @property
    def now(self) -> ProjectExtras:
        """What lies there now."""
        assert self._underlaying is not None and self._control is not None
        return ProjectExtras(self._underlaying.underlay, self._control.text, self._control.page.replaces)

    @property
    def unsaved(self) -> bool:
        """Whether something is there that lies in no file; a text that is drawn already is not missed."""
        assert self._control is not None
        now = self.now
        written = bool(now.text.strip()) and now.text != self._saved.text and not self._control.is_drawn
        return written or now.underlay != self._saved.underlay

    def mark_saved(self, beside: ProjectExtras) -> None:
        """Remember what the drawing's file holds."""
        self._saved = beside

    def bring(self, beside: ProjectExtras) -> str:
        """Lay and write what a file holds; return what is wrong with it, or "". A file without a text leaves the
        editor's.
        """
        assert self._underlaying is not None and self._control is not None
        if beside.text:
            self._control.text = beside.text
            self._control.page.set_replaces(beside.replaces)
        return self._underlaying.bring(beside.underlay)
