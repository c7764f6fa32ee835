"""What stands between a view, its panel and what the program computes."""

from __future__ import annotations

from PySide6.QtCore import QObject, Signal


class Controller(QObject):
    """Acts for a view; knows no window, and tells by its signals what a window has to show.

    Signals:
        failed(sentence): what went wrong. said(sentence): what was done, in a line.
        changed(): the view shows or lacks something else. front_requested(): the view shall come to the front.
    """

    failed = Signal(str)
    said = Signal(str)
    changed = Signal()
    front_requested = Signal()

    def see(self, seen: bool) -> None:
        """Be told that the view came to the front, or no longer is there."""
