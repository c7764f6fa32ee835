"""The NC view: text at the left, its path at the right; a click on either shows the other. A second program fits beside
it.
"""

from __future__ import annotations

import numpy as np
from PySide6.QtCore import QEvent, QPoint, Qt, Signal
from PySide6.QtGui import QKeyEvent
from PySide6.QtWidgets import QSplitter, QWidget

from ...framework.boxes import v_box
from ...framework.figures import clock, counted, grouped
from .heads import PathHead
from .line_marks import Ints
from .motion_shapes import ViewSide
from .painting.motion_layer import MotionColourBy
from .path_view import PathView
from .places import ComparedProgram, difference_places, differing_rows, rows_of
from .places_panel import PlacesPanel
from .program_panel import ProgramPanel
from .program_reader import ShownProgram
from .program_text import ProgramText
from .state_strip import StateStrip
from .state_words import state_items
from .text_pane import TextPane

_NONE = np.zeros(0, np.int64)
_SHARES, _SHARES_OF_TWO = (440, 0, 560), (320, 320, 400)


class NcView(QWidget):
    """Shows one program, or two that are compared; whoever owns it decides which.

    Signals:
        side_requested(ViewSide): the picture of this side is missing. menu_requested(point): of the text, on the
            screen.
        comparison_closed(): the user has seen enough of the second program.

    Attributes:
        pane: the program's text. other: the second one's. side: from where the path is seen.
        compared: what the second program is; None = there is none.
        beside: tells of a program that is not the job's. foreign: whether the shown one is such.
    """

    side_requested = Signal(ViewSide)
    menu_requested = Signal(QPoint)
    comparison_closed = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.side = ViewSide.XY
        self.compared: ComparedProgram | None = None
        self.pane, self.other, self.state = TextPane(), TextPane(closable=True), StateStrip()
        self.path_head, self.path = PathHead(), PathView()
        self.differences = PlacesPanel("difference", "F7")
        self.beside, self.foreign = ProgramPanel(), False
        right = QWidget()
        column = v_box(right, spacing=0)
        column.addWidget(self.path_head)
        column.addWidget(self.path, 1)
        self.splitter = QSplitter(Qt.Orientation.Horizontal)
        self.splitter.setHandleWidth(1)
        self.splitter.setChildrenCollapsible(False)
        for at, widget in enumerate((self.pane, self.other, right)):
            self.splitter.addWidget(widget)
            self.splitter.setStretchFactor(at, 2 if widget is right else 1)
        self.splitter.setSizes(list(_SHARES))
        self.other.hide()
        column = v_box(self, spacing=0)
        column.addWidget(self.splitter, 1)
        column.addWidget(self.differences)
        column.addWidget(self.state)
        self.setFocusProxy(self.pane)
        self._connect()

    def _connect(self) -> None:
        self.pane.rows_picked.connect(lambda first, last: self._on_rows(self.pane, first, last))
        self.other.rows_picked.connect(lambda first, last: self._on_rows(self.other, first, last))
        self.pane.menu_requested.connect(self.menu_requested)
        self.other.head.closed.connect(self.comparison_closed)
        self.differences.picked.connect(self._go_to_difference)
        self.path.motion_picked.connect(self.pick_motion)
        self.path.other_picked.connect(self._pick_other)
        self.path_head.fit_requested.connect(self.path.fit)
        self.path_head.side_chosen.connect(self.set_side)
        self.path_head.colour_chosen.connect(self.set_colour)

    @property
    def shown(self) -> ShownProgram | None:
        """The program with everything that was read of it; None while only its text is known."""
        return self.pane.shown

    @property
    def active(self) -> TextPane:
        """The text that the keys are for: the second one only while it has the focus."""
        focus = self.focusWidget()
        return (
            self.other if focus is not None and self.other.isVisible() and self.other.isAncestorOf(focus) else self.pane
        )

    @property
    def summary(self) -> str:
        """What there is to say about the program as a whole, or ""."""
        if self.shown is None:
            return ""
        length, seconds = float(self.shown.shapes.length.sum()), self.shown.times.total
        return f"{counted(len(self.shown.shapes), 'motion')} · {grouped(length, 0)} mm · {clock(seconds)}"

    def show_text(self, name: str, text: ProgramText) -> None:
        """Show a text whose motions are not known yet."""
        self.show_comparison(None)
        self.pane.show_text(name, text)
        self.path.show_pictures(None)
        self.state.show_items([])

    def show_program(self, shown: ShownProgram) -> None:
        """Show a program that was read; of the same text, the picked line stays."""
        self.show_comparison(None)
        self.pane.show_program(shown)
        self.set_side(self.side)
        if shown.program.error is not None:
            self.pane.go_to_problem(shown.program.error)
        elif self.pane.text.current >= 0:
            self._on_rows(self.pane, *self.pane.text.selection)
        else:
            self.state.show_items([])

    def show_comparison(self, compared: ComparedProgram | None) -> None:
        """Show a second program beside the first and what differs, or take it away."""
        if compared is None and self.compared is None:
            return
        self.compared = compared
        self.other.setVisible(compared is not None)
        self.splitter.setSizes(list(_SHARES if compared is None else _SHARES_OF_TWO))
        items = compared.differences.items if compared is not None else ()
        if compared is None:
            self.differences.show_places("", ())
        else:
            self.other.show_program(compared.other)
            self.other.mark_differing(differing_rows([item.b for item in items]))
            self.differences.show_places(*difference_places(compared.differences))
        self.pane.mark_differing(differing_rows([item.a for item in items]))
        self.set_side(self.side)

    def set_side(self, side: ViewSide) -> None:
        """Look at the path from above or from a side."""
        self.side = side
        self.path_head.side.show_value(side)
        if self.shown is None:
            return
        if side in self.shown.pictures and (self.compared is None or side in self.compared.pictures):
            self._show_side()
            self.path.fit_now()
        else:
            self.side_requested.emit(side)

    def set_colour(self, colour: MotionColourBy) -> None:
        """Let colours tell the tool or the kind of motion."""
        self.path_head.colour.show_value(colour)
        self.path.set_colour(colour)
        self.pane.text.set_colour(colour)
        self.other.text.set_colour(colour)

    def pick_motion(self, motion: int) -> None:
        """Mark the line of a motion, light the motion up and say what is in force."""
        if self.shown is None:
            return
        row = int(self.shown.program.motions.line[motion]) - 1
        self.pane.text.pick(row, tell=False)
        self.path.light(np.array([motion]))
        self.state.show_items(state_items(self.shown.shapes, row, motion, self.shown.times))

    def _pick_other(self, motion: int) -> None:
        """Mark the line of a motion of the second program."""
        if self.compared is not None:
            self.other.text.pick(int(self.compared.other.program.motions.line[motion]) - 1)

    def event(self, event: QEvent) -> bool:
        """Keep F3 from the drawing: here it finds the next place."""
        if (
            event.type() == QEvent.Type.ShortcutOverride
            and isinstance(event, QKeyEvent)
            and event.key() == Qt.Key.Key_F3
        ):
            event.accept()
            return True
        return super().event(event)

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """F3 finds, F fits the path, Escape closes the find bar."""
        if event.key() == Qt.Key.Key_F3:
            self.active.find_next(back=bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier))
        elif event.key() == Qt.Key.Key_F and not event.modifiers():
            self.path.fit()
        elif event.key() == Qt.Key.Key_Escape and self.active.finder.isVisible():
            self.active.finder.close_bar()
        else:
            super().keyPressEvent(event)

    def _show_side(self) -> None:
        picture = self.shown.pictures.get(self.side) if self.shown is not None else None
        self.path.show_pictures(picture, self.compared.pictures.get(self.side) if self.compared is not None else None)
        if self.shown is not None and self.pane.text.current >= 0:
            self.path.light(self.shown.shapes.of_rows(*self.pane.text.selection))

    def _on_rows(self, pane: TextPane, first: int, last: int) -> None:
        """Light up what picked lines move, and say what is in force at the last of them."""
        if pane.shown is None:
            return
        motions = pane.shown.shapes.of_rows(first, last)
        self._light(pane, motions)
        self.path.bring_into_sight()
        self.state.show_items(state_items(pane.shown.shapes, pane.text.current, None, pane.shown.times))

    def _light(self, pane: TextPane, motions: Ints) -> None:
        if pane is self.pane:
            self.path.light(motions)
        else:
            self.path.light(_NONE, motions)

    def _go_to_difference(self, index: int) -> None:
        """Show a difference in both texts and on both paths."""
        if self.compared is None or not self.compared.differences.items:
            return
        item = self.compared.differences.items[index]
        self.pane.go_to_rows(*rows_of(item.a), tell=False)
        self.other.go_to_rows(*rows_of(item.b), tell=False)
        self.path.light(np.arange(item.a.first, item.a.stop), np.arange(item.b.first, item.b.stop))
        self.path.bring_into_sight()
        if self.shown is not None:
            self.state.show_items(state_items(self.shown.shapes, self.pane.text.current, None, self.shown.times))
