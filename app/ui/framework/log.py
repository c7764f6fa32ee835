"""The log that is shown: every line of the drawing language, and between them what was opened, computed and
exported.
"""

from __future__ import annotations

from ...drafting.document import Document, DocumentChange, LogLine
from .log_view import LogView


class Log:
    """Follows a document's log; notes stand where they happened, also after another document was opened."""

    def __init__(self, document: Document, view: LogView) -> None:
        self._document, self._view = document, view
        self.lines: list[LogLine] = []
        self._taken = 0
        document.subscribe(self._on_change)

    def note(self, what: str, reply: str, error: bool = False) -> None:
        """Add something that is no line of the drawing language."""
        self.lines.append(LogLine(what, reply, error))
        self._view.show_lines(self.lines)

    def _on_change(self, change: DocumentChange) -> None:
        if change & DocumentChange.LOG:
            log = self._document.log
            self._taken = min(self._taken, len(log))
            self.lines += log[self._taken :]
            self._taken = len(log)
            self._view.show_lines(self.lines)
