"""Keeps the keyboard where the user is when a list is made anew: never on a button that merely comes next."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import shiboken6
from PySide6.QtCore import QObject, Qt, QTimer
from PySide6.QtWidgets import QApplication, QWidget

_SHOWN_MS = 20
"""After so long what was made anew is shown, and what was taken away is gone."""


@dataclass(frozen=True, slots=True)
class _Lost:
    """A widget that had the focus and was hidden.

    Attributes:
        place: what is still seen round it. kind, parent: its class and its parent's. at: its number among its like
            there. name: for a screen reader, or "".
    """

    place: QWidget
    kind: type[QWidget]
    parent: type[object]
    at: int
    name: str

    @staticmethod
    def of(widget: QWidget) -> _Lost | None:
        """Return what is known of a widget that was just hidden; None where its whole window was."""
        place = next((each for each in _ancestors(widget) if each.isVisible()), None)
        if place is None:
            return None
        kind, parent = type(widget), type(widget.parent())
        return _Lost(place, kind, parent, _alike(place, kind, parent).index(widget), widget.accessibleName())

    @property
    def successor(self) -> QWidget | None:
        """What took its place: of the same name, else at the same number; None where there is none of its kind."""
        if not shiboken6.isValid(self.place):
            return None
        focusable = [
            each
            for each in _alike(self.place, self.kind, self.parent)
            if each.isVisible() and each.isEnabled() and each.focusPolicy() != Qt.FocusPolicy.NoFocus
        ]
        named = [each for each in focusable if self.name and each.accessibleName() == self.name]
        return next(iter([*named, *focusable[self.at : self.at + 1], *focusable[-1:]]), None)


class FocusKeeper(QObject):
    """Watches the focus of a window.

    Where a widget that has it is hidden, Qt passes it on along the chain of Tab, which comes to the first button of a
    bar; Space would then press that. Here it goes to what took the widget's place, else to the view.
    """

    def __init__(self, window: QWidget, to_view: Callable[[], None]) -> None:
        """Watch a window; `to_view` has the keys go to what is at the front."""
        super().__init__(window)
        self._window, self._to_view = window, to_view
        self._lost: _Lost | None = None
        self._passed_to: QWidget | None = None
        self._shown = QTimer(self, singleShot=True, interval=_SHOWN_MS)
        self._shown.timeout.connect(self._give_back)
        application = QApplication.instance()
        assert isinstance(application, QApplication)
        application.focusChanged.connect(self._follow)

    @property
    def waiting(self) -> bool:
        """Whether the focus is about to be given back."""
        return self._shown.isActive()

    def _follow(self, old: QWidget | None, new: QWidget | None) -> None:
        if old is None or new is None or not shiboken6.isValid(old) or old.isVisible():
            return
        if old.window() is not self._window or new.window() is not self._window or not self._window.isVisible():
            return
        if not self._shown.isActive() or self._passed_to is not old:
            self._lost = _Lost.of(old)
        if self._lost is not None:
            self._passed_to = new
            self._shown.start()

    def _give_back(self) -> None:
        """Give the focus back unless somebody else has set it meanwhile."""
        lost, passed_to, self._lost, self._passed_to = self._lost, self._passed_to, None, None
        if lost is None or self._window.focusWidget() is not passed_to:
            return
        successor = lost.successor
        if successor is not None:
            successor.setFocus(Qt.FocusReason.OtherFocusReason)
        else:
            self._to_view()


def _ancestors(widget: QWidget) -> Iterator[QWidget]:
    above = widget.parentWidget()
    while above is not None:
        yield above
        above = above.parentWidget()


def _alike(place: QWidget, kind: type[QWidget], parent: type[object]) -> list[QWidget]:
    """Return the widgets of a class whose parents are of another, in the order in which they were made."""
    return [each for each in place.findChildren(kind) if type(each) is kind and type(each.parent()) is parent]
