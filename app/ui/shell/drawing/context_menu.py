"""The menu at the mouse over the drawing: the last tool again, and what can be done with what is selected."""

from __future__ import annotations

from contextlib import suppress

from PySide6.QtCore import QObject, QPoint
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QMenu

from ....core.errors import InputError
from ....drafting.document import Document
from ...framework.commands import Commands
from ...views.canvas.canvas import Canvas
from ..bars.actions import MACHINE_THIS, plain
from .proposal_controller import WAYS
from .selection_ways import SelectionWays

_FOR_SELECTION = (
    "tool_move",
    "tool_copy",
    "tool_rotate",
    "tool_scale",
    "tool_mirror",
    "tool_offset",
    "",
    "tool_join",
    "tool_explode",
    "tool_reverse",
    "tool_measure",
    "",
    "delete",
)
_WITHOUT = ("select_all", "fit")


class ContextMenu(QObject):
    """Opens when the canvas asks for it.

    Attributes:
        menu: the one opened last, or None.
    """

    def __init__(self, canvas: Canvas, document: Document, commands: Commands, ways: SelectionWays) -> None:
        super().__init__(canvas)
        self._canvas, self._document, self._commands, self._ways = canvas, document, commands, ways
        self.menu: QMenu | None = None
        canvas.menu_requested.connect(self.open)

    def open(self, at: QPoint) -> None:
        """Open the menu at a point of the screen; what lies under the mouse is selected first, unless it is."""
        canvas, document = self._canvas, self._document
        under = canvas.candidates()
        if under and not any(thing.id in document.selection for thing in under):
            self._run(f"select {under[0].id}")
        if self.menu is not None:
            self.menu.deleteLater()
        self.menu = self.made(under[0].id if under else None)
        self.menu.popup(at)

    def made(self, under: int | None) -> QMenu:
        """Return the menu; `under` is the number of what lies under the mouse."""
        menu = QMenu(self._canvas)
        again = self._commands[f"tool_{self._canvas.runner.last.value}"]
        menu.addAction(self._named(menu, f"Repeat {again.text().split(chr(9))[0].replace('&', '')}", again))
        menu.addSeparator()
        if under is not None:
            chain = menu.addAction("Select chain")
            chain.triggered.connect(lambda *_: self._run(f"select chain {under}"))
            menu.addSeparator()
        if self._document.selection:
            self._add_ways(menu.addMenu(plain(MACHINE_THIS)))
            menu.addSeparator()
        for name in _FOR_SELECTION if self._document.selection else _WITHOUT:
            if name:
                menu.addAction(self._commands[name])
            else:
                menu.addSeparator()
        if self._document.selection:
            menu.addAction(self._commands["properties"])
        return menu

    def _add_ways(self, menu: QMenu) -> None:
        """Offer what the selection is to become; what it cannot become is grey, and its tip says why."""
        menu.setToolTipsVisible(True)
        for way in WAYS:
            action, why = self._commands[f"machine_{way}"], self._ways.refused.get(way, "")
            if why:
                action = self._named(menu, action.text(), action)
                action.setEnabled(False)
                action.setToolTip(why)
            menu.addAction(action)

    def _named(self, menu: QMenu, text: str, action: QAction) -> QAction:
        made = QAction(text, menu)
        made.triggered.connect(lambda *_: action.trigger())
        return made

    def _run(self, line: str) -> None:
        with suppress(InputError):
            self._document.run(line)
