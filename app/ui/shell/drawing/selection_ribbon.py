"""The ribbon over what is selected in the drawing: says what the curves are to become, one button a way."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QRect, QRectF, QSize, Qt
from PySide6.QtWidgets import QToolButton, QWidget

from ....drafting.document import Document, DocumentChange
from ....geometry.sample import bounds_of_all
from ...framework.boxes import give_ground, h_box
from ...framework.commands import Commands
from ...views.canvas.canvas import Canvas
from ...views.canvas.modes import CanvasMode
from .selection_ways import SelectionWays

_WAYS = {
    "pocket": ("Pocket", "Clear the area within the selected curves"),
    "outside": ("Outside", "Cut along the selected curves, on their outer side: what is within them stays whole"),
    "inside": ("Inside", "Cut along the selected curves, on their inner side: what is around them stays whole"),
    "on": ("On line", "Cut with the tool's middle on the selected curves"),
    "drill": ("Drill", "Drill the selected circles"),
    "engrave": ("Engrave", "Engrave along the selected curves"),
    "vcarve": ("V-carve", "Carve the area within the selected curves with a V cutter, from wall to wall"),
}
"""The ways that are offered, by the commands' names: in the ribbon's words, short, for it lies over the drawing, and in
those of its tips.
"""

_GAP_PX = 14
"""Between the ribbon and the selection, so that grips can be taken."""

_MOST = 2000
"""Of a larger selection the place is not looked for: the ribbon stands at the top."""


class SelectionRibbon(QWidget):
    """Stands over the selection of a drawing while no tool is in hand, and is gone else; what a selection cannot become
    is grey.

    Attributes:
        buttons: by the way that they stand for.
    """

    def __init__(self, canvas: Canvas, document: Document, commands: Commands, ways: SelectionWays) -> None:
        super().__init__(canvas)
        self._canvas, self._document, self._ways = canvas, document, ways
        self._box: QRectF | None = None
        self._any = False
        give_ground(self, "selectionRibbon")
        self.setCursor(Qt.CursorShape.ArrowCursor)
        row = h_box(self, (4, 4, 4, 4), 2)
        self.buttons = {way: self._button(way, commands) for way in _WAYS}
        for button in self.buttons.values():
            row.addWidget(button)
        self.hide()
        document.subscribe(self._follow)
        ways.changed.connect(self._refuse)
        for signal in (canvas.prompt_changed, canvas.tool_changed, canvas.view_changed, canvas.mode_changed):
            signal.connect(self.place)

    def _button(self, way: str, commands: Commands) -> QToolButton:
        name, tip = _WAYS[way]
        button = QToolButton()
        button.setText(name)
        button.setProperty("role", "ribbon")
        button.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        button.setToolTip(tip)
        button.clicked.connect(lambda: commands[f"machine_{way}"].trigger())
        return button

    def _refuse(self) -> None:
        """Grey what the selection cannot become; the tip says why."""
        for way, button in self.buttons.items():
            why = self._ways.refused.get(way, "")
            button.setEnabled(not why)
            button.setToolTip(why or _WAYS[way][1])

    def _follow(self, change: DocumentChange) -> None:
        """Look where the selection is; it is where it was unless it or the drawing changes."""
        if change & (DocumentChange.SELECTION | DocumentChange.PART):
            chosen = self._document.selection
            curves = [each.curve for each in self._document.part.entities if each.id in chosen] if chosen else []
            box = bounds_of_all(curves) if 0 < len(curves) <= _MOST else None
            self._box = QRectF(box[0], box[1], box[2] - box[0], box[3] - box[1]) if box is not None else None
            self._any = bool(curves)
            self.place()

    def place(self, *_: object) -> None:
        """Stand over the selection, below it where there is no room above; be gone while a tool is in hand."""
        canvas = self._canvas
        shown = self._any and canvas.mode is CanvasMode.DRAW and not canvas.working
        if shown:
            self.adjustSize()
            self.move(place_beside(self._on_screen(), self.size(), canvas.area.toRect()))
        self.setVisible(shown)

    def _on_screen(self) -> QRect:
        view, box = self._canvas.view, self._box
        if box is None:
            return QRect()
        return QRectF(view.to_screen((box.left(), box.bottom())), view.to_screen((box.right(), box.top()))).toRect()


def place_beside(selection: QRect, size: QSize, area: QRect) -> QPoint:
    """Return where a ribbon of a size stands, px: over a selection, else below it, else at the top of the area.

    Args:
        selection: on the screen; a null one has no place. size: of the ribbon. area: that it keeps within.
    """
    room = area.adjusted(_GAP_PX // 2, _GAP_PX // 2, -_GAP_PX // 2, -_GAP_PX // 2)
    middle = selection.center().x() if not selection.isNull() else room.center().x()
    left = min(max(middle - size.width() // 2, room.left()), max(room.right() - size.width(), room.left()))
    above, below = selection.top() - _GAP_PX - size.height(), selection.bottom() + _GAP_PX
    if not selection.isNull() and above >= room.top():
        return QPoint(left, min(above, room.bottom() - size.height()))
    fits = not selection.isNull() and below + size.height() <= room.bottom()
    return QPoint(left, max(below, room.top()) if fits else room.top())
