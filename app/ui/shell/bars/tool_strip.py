"""The strip of tools at the left of the canvas: groups of buttons, several kinds of one tool behind one of them."""

from __future__ import annotations

from PySide6.QtCore import QPoint, QPointF, QSize, Qt, QTimer
from PySide6.QtGui import QColor, QKeyEvent, QMouseEvent, QPainter, QPaintEvent, QPolygonF, QResizeEvent
from PySide6.QtWidgets import QFrame, QToolButton, QWidget

from ...framework.boxes import give_ground, h_box
from ...framework.themed import Themed
from .actions import Actions

SIDE = 32
_GAP, _MARGIN = 9, 5
_HOLD_MS = 350
_CORNER = 9

GROUPS: tuple[tuple[tuple[str, ...], ...], ...] = (
    (("tool_select",), ("tool_measure",)),
    (
        ("tool_line",),
        ("tool_polyline",),
        ("tool_arc_three", "tool_arc_centre", "tool_arc_radius", "tool_arc_on"),
        ("tool_circle", "tool_circle_two", "tool_circle_three"),
        ("tool_rectangle", "tool_rectangle_round"),
        ("tool_polygon",),
        ("tool_slot",),
        ("tool_ellipse",),
        ("tool_spline",),
        ("tool_text",),
    ),
    (
        ("tool_move",),
        ("tool_copy",),
        ("tool_rotate",),
        ("tool_scale",),
        ("tool_mirror",),
        ("tool_array", "tool_array_polar"),
        ("tool_offset",),
        ("tool_join", "tool_explode", "tool_reverse"),
        ("tool_trim",),
        ("tool_extend",),
        ("tool_fillet",),
        ("tool_chamfer",),
        ("tool_break",),
        ("delete",),
    ),
    (("tool_point",), ("tool_guide",), ("tool_dimension",), ("fit",)),
)
"""Groups of buttons, each with the actions behind it."""


def _dressed(button: QToolButton, actions: Actions, name: str) -> None:
    button.setDefaultAction(actions[name])
    button.setToolButtonStyle(Qt.ToolButtonStyle.ToolButtonIconOnly)
    button.setIconSize(QSize(20, 20))
    button.setFixedSize(SIDE, SIDE)
    button.setAutoRaise(True)
    button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
    button.setAccessibleName(actions[name].toolTip())


class Variants(QFrame):
    """A row of buttons, the kinds of one tool, that goes when one is taken or a click falls elsewhere."""

    def __init__(self, actions: Actions, names: tuple[str, ...], parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("variants")
        self.buttons: dict[str, QToolButton] = {}
        row = h_box(self, (3, 3, 3, 3), 2)
        for name in names:
            self.buttons[name] = QToolButton()
            _dressed(self.buttons[name], actions, name)
            self.buttons[name].clicked.connect(self.hide)
            row.addWidget(self.buttons[name])


class ToolButton(Themed, QToolButton):
    """One tool, or the kind of it used last; a held or right click, a click on its corner, or Right opens the row of
    kinds.

    Attributes:
        names: of the kinds. row: the kinds to choose from, or None where there is one.
    """

    def __init__(self, actions: Actions, names: tuple[str, ...]) -> None:
        super().__init__()
        _dressed(self, actions, names[0])
        self.names = names
        self._hold = QTimer(self, singleShot=True, interval=_HOLD_MS)
        self._hold.timeout.connect(self.open)
        self.row = Variants(actions, names, self) if len(names) > 1 else None
        if self.row is not None:
            for name in names:
                actions[name].toggled.connect(lambda on, name=name: self._show(actions, name) if on else None)
                actions[name].triggered.connect(lambda *_, name=name: self._show(actions, name))

    def _show(self, actions: Actions, name: str) -> None:
        self.setDefaultAction(actions[name])
        for other in self.actions():  # with a second one Qt takes the button for a menu, and paints its arrow
            if other is not actions[name]:
                self.removeAction(other)
        self.setAccessibleName(actions[name].toolTip())

    def open(self) -> None:
        """Open the row of kinds."""
        if self.row is not None:
            self.setDown(False)
            self.row.move(self.mapToGlobal(QPoint(self.width() + 2, -3)))
            self.row.show()
            self.row.buttons[next(iter(self.row.buttons))].setFocus()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Open the row at a right click or on the corner; else begin to wait."""
        at = event.position()
        corner = at.x() >= self.width() - _CORNER and at.y() >= self.height() - _CORNER
        if self.row is not None and (event.button() is Qt.MouseButton.RightButton or corner):
            self.open()
            return
        self._hold.start()
        super().mousePressEvent(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Click, unless the row has been opened meanwhile."""
        self._hold.stop()
        super().mouseReleaseEvent(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Open the row at Right."""
        if event.key() == Qt.Key.Key_Right and self.row is not None:
            self.open()
        else:
            super().keyPressEvent(event)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the button, and a small corner where there are kinds."""
        super().paintEvent(event)
        if self.row is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setPen(Qt.PenStyle.NoPen)
        painter.setBrush(QColor(self._theme.muted))
        x, y = self.width() - 3.5, self.height() - 3.5
        painter.drawPolygon(QPolygonF([QPointF(x, y - 5), QPointF(x, y), QPointF(x - 5, y)]))


class ToolStrip(QWidget):
    """All tools in groups, in two columns; in a low window in as many as it takes.

    Attributes:
        buttons: by the name of the first action behind each.
    """

    def __init__(self, actions: Actions) -> None:
        super().__init__()
        give_ground(self, "toolStrip")
        offered = [[tuple(name for name in names if actions[name].isVisible()) for names in group] for group in GROUPS]
        self._groups = [[ToolButton(actions, names) for names in group if names] for group in offered]
        self.buttons = {button.names[0]: button for group in self._groups for button in group}
        for button in self.buttons.values():
            button.setParent(self)
        self._lines = [QFrame(self) for _ in GROUPS[1:]]
        for line in self._lines:
            line.setObjectName("hairline")
        self._lay_out(2)

    def minimumSizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """Return the height below which tools would be cut off, at four columns."""
        return QSize(self.width(), self._height(4))

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Take as many columns as the height asks for."""
        super().resizeEvent(event)
        self._lay_out(next((columns for columns in (2, 3, 4) if self._height(columns) <= self.height()), 4))

    def _lay_out(self, columns: int) -> None:
        self.setFixedWidth(columns * SIDE + 2 * _MARGIN + 1)
        y = _MARGIN
        for number, group in enumerate(self._groups):
            if number:
                self._lines[number - 1].setGeometry(_MARGIN + 4, y + _GAP // 2, columns * SIDE - 8, 1)
                y += _GAP
            for k, button in enumerate(group):
                button.move(_MARGIN + k % columns * SIDE, y + k // columns * SIDE)
            y += -(-len(group) // columns) * SIDE

    def _height(self, columns: int) -> int:
        rows = sum(-(-len(group) // columns) for group in self._groups)
        return rows * SIDE + (len(GROUPS) - 1) * _GAP + 2 * _MARGIN
