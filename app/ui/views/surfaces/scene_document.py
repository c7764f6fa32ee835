"""The scene that is open in the window: its text. Panel and editor change the same text, and one undo goes through
both.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtGui import QTextCursor, QTextDocument
from PySide6.QtWidgets import QPlainTextDocumentLayout

UNTITLED = "untitled"
"""What a scene without a file is called."""


class SceneDocument(QObject):
    """One text.

    Signals:
        changed(): the text is another. standing_changed(): it came to be saved or unsaved, or what can be undone
        changed.

    Attributes:
        document: what editors show. path: of the file; None = in no file yet. open: there is a scene.
    """

    changed = Signal()
    standing_changed = Signal()

    def __init__(self, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = QTextDocument(self)
        self.document.setDocumentLayout(QPlainTextDocumentLayout(self.document))
        self.path: Path | None = None
        self.open = False
        self._told, self._stem = "", UNTITLED
        self.document.contentsChanged.connect(self._on_contents)
        for signal in (self.document.modificationChanged, self.document.undoAvailable, self.document.redoAvailable):
            signal.connect(lambda _: self.standing_changed.emit())

    @property
    def text(self) -> str:
        """The whole text."""
        return self.document.toPlainText()

    @property
    def name(self) -> str:
        """Of the file, or what stands for it."""
        return self.path.name if self.path is not None else f"{self._stem}.toml"

    @property
    def modified(self) -> bool:
        """Whether something is not saved."""
        return self.open and self.document.isModified()

    def load(self, text: str, path: Path | None, stem: str = UNTITLED) -> None:
        """Take another scene; what was done to the one before cannot be undone any more.

        Args:
            text: of the scene. path: of its file; None = it is in none yet, and would be called `stem`.
        """
        self.path, self.open, self._stem = path, True, stem
        self._told = text
        self.document.setPlainText(text)
        self.document.clearUndoRedoStacks()
        self.document.setModified(False)
        self.changed.emit()
        self.standing_changed.emit()

    def replace(self, text: str) -> None:
        """Change the text; one step for undo, and what stays the same is not touched, so that editors stay where they
        are.
        """
        before = self.text
        if text == before:
            return
        start = _alike(before, text)
        room = min(len(before), len(text)) - start
        end = _alike(before[::-1][:room], text[::-1][:room])
        cursor = QTextCursor(self.document)
        cursor.setPosition(_units(before[:start]))
        cursor.setPosition(_units(before[: len(before) - end]), QTextCursor.MoveMode.KeepAnchor)
        cursor.insertText(text[start : len(text) - end])

    def edit(self, change: Callable[[str], str]) -> None:
        """Change the text by a function of it.

        Raises:
            InputError: what the function raises; the text is as it was.
        """
        self.replace(change(self.text))

    def mark_saved(self, path: Path) -> None:
        """Say that the text as it is now is in a file."""
        self.path = path
        self.document.setModified(False)
        self.standing_changed.emit()

    def _on_contents(self) -> None:
        if self.text != self._told:  # other colours are no other text
            self._told = self.text
            self.changed.emit()


def _alike(one: str, other: str) -> int:
    """Return how many letters two texts begin with alike."""
    return next((n for n, (a, b) in enumerate(zip(one, other, strict=False)) if a != b), min(len(one), len(other)))


def _units(text: str) -> int:
    """Return how many places of a QTextDocument a text takes: letters beyond the basic plane take two."""
    return len(text) + sum(ord(letter) > 0xFFFF for letter in text)
