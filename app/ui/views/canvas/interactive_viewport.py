"""Mouse and keys of the canvas: aiming, drawing, selecting, panning. What is shown is the canvas' own business."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPoint, QPointF, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QKeySequence, QMouseEvent
from PySide6.QtWidgets import QLineEdit, QWidget

from ....core.errors import InputError
from ....drafting.document import Document
from ....drafting.expressions.errors import reason_of
from ....drafting.expressions.words import ids_text
from ....model.curves import Point
from ....model.notes import Note
from ....model.part import Entity
from .grips import GRIP_PX, DragTool, Grips, SelectionDragTool, pull_tool
from .marker_mode import MarkerMode, place_near
from .modes import CanvasTool
from .painting.grid import grid_steps
from .painting.part_layer import PartLayer
from .prompt_tool import PromptTool
from .selection import SelectionCycle, band_line, click_line
from .snap import SNAP_NAMES, SNAP_WORDS, best
from .snap_state import SnapState
from .snapped_point import SnappedPoint, rounded
from .tool_runner import ToolRunner
from .tool_target import aimed
from .value_entry import ValueEntry
from .viewport import Viewport, ViewportScene

PICK_PX = 6.0
_DRAG_PX = 4.0
_ADDING = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier


@dataclass(frozen=True, eq=False)
class MouseAnswers:
    """What the picture does for the mouse and the keys.

    Attributes:
        look_at: lights up what lies under a place, mm; None for nothing.
        fit: shows everything.
    """

    look_at: Callable[[Point | None], None]
    fit: Callable[[], None]


@dataclass(frozen=True, slots=True)
class MousePress:
    """Where a button went down; the view may move while it is held.

    Attributes:
        position: on the canvas, px. at: in the drawing, mm. reach: how near counted as on a thing then, mm.
    """

    position: QPointF
    at: Point
    reach: float


class InteractiveViewport(Viewport):
    """A viewport that draws and selects in a document.

    Attributes:
        snap_state: what helps the mouse to aim. grips: of what is selected. turns: which of several things under the
            mouse is meant. entry: what is typed into the boxes at the pointer.

    Signals:
        cursor_moved: x, y under the mouse, mm. prompt_changed: what is expected next. tool_changed: CanvasTool.
        hovered: what lies under the mouse, or "". message: the sentence of an error.
        key_typed: a character meant for the command line. menu_requested: where on the screen the selection's menu is
            asked for. cancelled: something is given up, by Esc.
    """

    cursor_moved = Signal(float, float)
    prompt_changed = Signal(str)
    tool_changed = Signal(object)
    hovered = Signal(str)
    message = Signal(str)
    key_typed = Signal(str)
    menu_requested = Signal(QPoint)
    cancelled = Signal()

    def __init__(
        self, document: Document, scene: ViewportScene, answers: MouseAnswers, parent: QWidget | None = None
    ) -> None:
        """Begin with SELECT, snapping to points."""
        super().__init__(scene, parent)
        self._answers = answers
        self.document, self.picture = document, PartLayer()
        self.runner = ToolRunner(document, self.message.emit)
        edited = QLineEdit(self)
        edited.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        edited.hide()
        self.entry = ValueEntry(self.runner, edited, self._size)
        self.mouse: QPointF | None = None
        self.aim: SnappedPoint | None = None
        self.band_from: MousePress | None = None
        self.marker_mode: MarkerMode | None = None
        self.snap_state, self.grips, self.turns = SnapState(self.picture, self), Grips(), SelectionCycle()
        self.snap_state.changed.connect(self._aim_again)
        self._space = False
        self._held_from: MousePress | None = None
        self._marks_from: MousePress | None = None
        self._carried: Point | None = None
        self._told = (self.runner.prompt, CanvasTool.SELECT, self._switched())
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    @property
    def working(self) -> bool:
        """True while a tool is in hand, or places are being marked."""
        return self.runner.tool is not None or self.marker_mode is not None

    @property
    def tool(self) -> CanvasTool:
        """The running tool."""
        return self.runner.kind

    @property
    def prompt(self) -> str:
        """What is expected next."""
        if self.snap_state.forced is not None:
            return f"Point at a curve: {SNAP_NAMES[self.snap_state.forced].lower()}"
        return self.marker_mode.prompt if self.marker_mode is not None else self.runner.prompt

    @property
    def grid_step(self) -> float:
        """Distance of the fine raster's lines, mm."""
        return grid_steps(self.view, self.unit)[0]

    @property
    def banding(self) -> bool:
        """True while a selection window is dragged."""
        return _apart(self.band_from, self.mouse)

    def mark(self, marking: MarkerMode | None) -> None:
        """Let clicks mark places, until Esc or another tool; None ends that."""
        if marking is not None:
            self.runner.start(CanvasTool.SELECT)
        self.marker_mode, self._marks_from = marking, None
        self._tell()

    @property
    def marked_places(self) -> list[Point]:
        """The places that are being marked, mm, one that is dragged where it is dragged to."""
        mode = self.marker_mode
        if mode is None:
            return []
        places = list(mode.places())
        if mode.move is not None and self._marks_from is not None and _apart(self._marks_from, self.mouse):
            carried = place_near(places, self._marks_from.at, self._marks_from.reach)
            if carried is not None and self.mouse is not None:
                places[places.index(carried)] = self.view.to_world(self.mouse)
        return places

    def _let_mark(self, position: QPointF) -> None:
        """Mark where the button was pressed, or move what was dragged from there."""
        begun, self._marks_from = self._marks_from, None
        mode = self.marker_mode
        if mode is None or begun is None:
            return
        if mode.move is not None and _apart(begun, position):
            mode.move(begun.at, self.view.to_world(position), begun.reach)
        else:
            mode.click(begun.at, begun.reach)
        self.update()

    def set_tool(self, tool: CanvasTool) -> None:
        """Begin a tool."""
        self.marker_mode = None
        self.runner.start(tool)
        self.snap_state.forget()
        self._answers.look_at(None)
        self._tell()

    def set_snap(self, on: bool) -> None:
        """Snap to points of the drawing, or not."""
        self.snap_state.switch(snap=on)

    def set_grid_snap(self, on: bool) -> None:
        """Snap to the raster, or not."""
        self.snap_state.switch(grid=on)

    def set_ortho(self, on: bool) -> None:
        """Draw only across and up, or freely."""
        self.snap_state.switch(ortho=on)

    def cancel(self) -> None:
        """Give up what is going on: what is typed, the selection window, the shape, the tool, the selection."""
        self.cancelled.emit()
        if self.entry.editing or not self.runner.typed.free:
            self.entry.give_up()
            self._tell()
            return
        if self.marker_mode is not None:
            self.mark(None)
        elif self.band_from is not None:
            self.band_from = None
        elif self.snap_state.forced is not None:
            self.snap_state.forget()
        elif not self.runner.cancel() and self.document.selection:
            self._run("select none")
        self.snap_state.forget()
        self._tell()

    def accept(self) -> None:
        """End the shape; without one end the tool; without a tool begin the last one again."""
        if self.marker_mode is not None:
            self.mark(None)
            return
        if self.entry.editing:
            self.entry.take()
        else:
            self.runner.accept()
        self._tell()

    def back(self) -> None:
        """Take the last point of the shape back."""
        self.runner.back()
        self._tell()

    def type_text(self, text: str) -> bool:
        """Give typed text to the running tool; return False when it is nothing for it."""
        used = (self.marker_mode is not None and self.marker_mode.typed(text)) or self.runner.type_text(text)
        kind = SNAP_WORDS.get(text.strip().lower())
        if not used and self.runner.tool is not None and kind is not None:
            self.snap_state.switch(forced=kind)
            used = True
        self._tell()
        return used

    def choose(self, word: str) -> None:
        """Take an option of the running tool."""
        self.runner.choose(word)
        self._tell()

    def see_words(self, text: str) -> None:
        """Show what words that are being typed would become, where they are asked for."""
        self.runner.words = text
        if self.runner.wants_words:
            self.update()

    def take_value(self, text: str) -> bool:
        """Take a text as the value of the first box at the pointer and go on to the next; return False where the tool
        has no two boxes.
        """
        if len(self.entry.rows) < 2:
            return False
        self.entry.begin(text)
        self.entry.step(1)
        self._tell()
        return True

    def delete_selection(self) -> None:
        """Delete what is selected."""
        if self.document.selection:
            self._run(f"delete {ids_text(self.document.selection)}")

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Give a point, begin a selection, or hold the drawing."""
        button = event.button()
        if button is Qt.MouseButton.MiddleButton or (button is Qt.MouseButton.LeftButton and self._space):
            self.begin_pan(event.position())
        elif button is Qt.MouseButton.RightButton and self.working:
            self.accept()
        elif button is Qt.MouseButton.RightButton:
            self.menu_requested.emit(event.globalPosition().toPoint())
        elif button is Qt.MouseButton.LeftButton and self.area.contains(event.position()):
            self._move_to(event)
            if self.marker_mode is not None:
                self._marks_from = self._press(event.position())
            elif self.aim is None:
                self._take_hold(event.position(), self._adds(event))
            else:
                self._give_point(self.aim)

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Select everything that joins what was clicked; for a tool the second click is a click."""
        found = self.candidates() if event.button() is Qt.MouseButton.LeftButton else []
        if not found or self.runner.tool is not None or self.marker_mode is not None:
            self.mousePressEvent(event)
            return
        clicked = next((thing for thing in found if thing.id in self.document.selection), found[0])
        self._run(f"select {'add ' if event.modifiers() & _ADDING else ''}chain {clicked.id}")

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Aim, drag the window, the selection, or the drawing."""
        self.pan_to(event)
        if self._carried is not None and _apart(self.band_from, event.position()):
            self._held_from, self.band_from = self.band_from, None
            self._hold(SelectionDragTool([self._carried]))
        if isinstance(self.runner.tool, SelectionDragTool):
            self.runner.tool.keep = bool(event.modifiers() & Qt.KeyboardModifier.ControlModifier)
        self._move_to(event)
        if self._marks_from is not None:
            self.update()

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Select, or let the drawing go."""
        if self.end_pan():
            self._show_cursor()
        elif event.button() is Qt.MouseButton.LeftButton and self._marks_from is not None:
            self._let_mark(event.position())
        elif event.button() is Qt.MouseButton.LeftButton and self._held_from is not None:
            self._let_go(event.position())
        elif event.button() is Qt.MouseButton.LeftButton and self.band_from is not None:
            self.mouse = event.position()
            line = self._band_line(event) if self.banding else self._click_line(event)
            self.band_from = self._carried = None
            if line:
                self._run(line)
            self.update()

    def focusNextPrevChild(self, forward: bool) -> bool:  # noqa: N802 (Qt's name)
        """Tab goes on to the next box at the pointer, or to the next of several things under the mouse; without either,
        to the next field.
        """
        if self.entry.rows:
            if self.entry.editing:
                self.entry.step(1 if forward else -1)
            else:
                self.entry.begin(last=not forward)
            self._tell()
            return True
        if self.mouse is None or self.runner.tool is not None or len(self.candidates()) < 2:
            return super().focusNextPrevChild(forward)
        self.turns.on(self.mouse)
        self._answers.look_at(self.view.to_world(self.mouse))
        return True

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Forget the mouse."""
        self.mouse = self.aim = self.entry.pointer = None
        self._answers.look_at(None)
        self.update()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Esc cancels, Enter ends, Backspace takes a point back, Del deletes, Home fits, Space pans; figures go into
        the boxes at the pointer, the rest is text.
        """
        action = self._keys().get(Qt.Key(event.key()))
        commanding = bool(event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier))
        if commanding and not (self.entry.editing and event.matches(QKeySequence.StandardKey.Paste)):
            super().keyPressEvent(event)
        elif self.entry.key(event):
            self._tell()
        elif self.entry.begins(event.text()):
            self.entry.begin(event.text())
            self._tell()
        elif action is not None:
            action()
        elif event.text() and event.text().isprintable():
            self.key_typed.emit(event.text())
        else:
            super().keyPressEvent(event)

    def keyReleaseEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """End panning with Space, and what Shift did."""
        if event.key() == Qt.Key.Key_Space and not event.isAutoRepeat():
            self._hold_space(False)
        elif event.key() == Qt.Key.Key_Shift:
            self._hold_shift(False)
        super().keyReleaseEvent(event)

    def focusOutEvent(self, event: QFocusEvent) -> None:  # noqa: N802 (Qt's name)
        """Forget keys that are held."""
        self._hold_space(False)
        super().focusOutEvent(event)

    def _keys(self) -> dict[Qt.Key, Callable[[], None]]:
        return {
            Qt.Key.Key_Escape: self.cancel,
            Qt.Key.Key_Return: self.accept,
            Qt.Key.Key_Enter: self.accept,
            Qt.Key.Key_Delete: self.delete_selection,
            Qt.Key.Key_Backspace: self.back,
            Qt.Key.Key_Home: self._answers.fit,
            Qt.Key.Key_Up: lambda: self._count_on(1),
            Qt.Key.Key_Down: lambda: self._count_on(-1),
            Qt.Key.Key_Space: lambda: self._hold_space(True),
            Qt.Key.Key_Shift: lambda: self._hold_shift(True),
        }

    def _count_on(self, by: int) -> None:
        """Change the count of the running tool."""
        self.runner.count_on(by)
        self._tell()

    def _hold_space(self, held: bool) -> None:
        self._space = held
        self._show_cursor()

    def _hold_shift(self, held: bool) -> None:
        self.snap_state.switch(shift=held)

    def _show_cursor(self) -> None:
        drawing = Qt.CursorShape.CrossCursor if self.runner.tool or self.marker_mode else Qt.CursorShape.ArrowCursor
        self.setCursor(Qt.CursorShape.OpenHandCursor if self._space else drawing)

    def _move_to(self, event: QMouseEvent) -> None:
        self.mouse = event.position()
        self.snap_state.shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        self._aim_again()
        point = self.aim.point if self.aim else rounded(self.view.to_world(self.mouse), self.view.scale)
        self.cursor_moved.emit(*point)
        if self.band_from is None:
            self._answers.look_at(self.view.to_world(self.mouse) if self.runner.looking else None)

    def _aim_again(self) -> None:
        tool = self.runner.tool
        self.aim = None
        if tool is not None and self.mouse is not None:
            at, steps = self.view.to_world(self.mouse), (self.grid_step, self.view.scale)
            self.aim, under = aimed(at, tool, self.snap_state, self.picture, steps)
            if self.aim is not None:
                self.runner.aim_at(self.aim.point, under)
        self.entry.pointer = self.aim.point if self.aim is not None else None
        self.update()

    def _size(self) -> float:
        """How large what is drawn or in view is, mm."""
        x0, y0, x1, y1 = self.view.world_box(self.area)
        drawn = self.picture.box or (x0, y0, x1, y1)
        return max(x1 - x0, y1 - y0, drawn[2] - drawn[0], drawn[3] - drawn[1])

    def _give_point(self, found: SnappedPoint) -> None:
        """Give a tool the point that the mouse aims at, with the values that are held."""
        if self.entry.editing and not self.entry.settle():
            self.update()
            return
        refused = self.snap_state.click(found)
        if refused:
            self.message.emit(refused)
        else:
            self.runner.click(found.point)
        self._tell()

    def _press(self, position: QPointF) -> MousePress:
        """Return what is kept of a button that goes down at a position, px."""
        return MousePress(QPointF(position), self.view.to_world(position), PICK_PX / self.view.scale)

    def _take_hold(self, position: QPointF, adding: bool) -> None:
        """Take what is under the mouse in hand: a grip at once, the selection as soon as the mouse moves, else begin a
        window.
        """
        reach = PICK_PX / self.view.scale
        grip = self.grips.at(self.view.to_world(position), GRIP_PX / self.view.scale)
        if grip is not None and not adding:
            self._held_from = self._press(position)
            self._hold(pull_tool(self.document, grip))
            return
        self.band_from = self._press(position)
        at = self.view.to_world(position)
        if self.runner.tool is None and any(thing.id in self.document.selection for thing in self.candidates()):
            snap = best(self.picture.near_points(at, reach), at, reach)
            self._carried = snap.point if snap is not None else rounded(at, self.view.scale)

    def _hold(self, tool: DragTool) -> None:
        """Take a grip or the selection in hand."""
        self._answers.look_at(None)
        self.runner.hold(tool)
        self._tell()

    def _let_go(self, position: QPointF) -> None:
        """Put what was dragged where the mouse is; a grip that was only clicked stays in hand until the next click."""
        dragged, self._held_from, self._carried = _apart(self._held_from, position), None, None
        if not dragged or not isinstance(self.runner.tool, DragTool) or self.aim is None:
            return
        self._give_point(self.aim)
        if isinstance(self.runner.tool, DragTool) and self.snap_state.forced is None:
            self.runner.cancel()
            self._tell()

    def candidates(self) -> list[Entity | Note]:
        """Return what can be selected under the mouse, nearest first."""
        if self.mouse is None:
            return []
        return self.picture.candidates(self.view.to_world(self.mouse), PICK_PX / self.view.scale)

    def _click_line(self, event: QMouseEvent) -> str:
        """Return the line that selects what was clicked, or ""."""
        adding = self._adds(event)
        turn = self.turns.at(event.position()) if adding else self.turns.click(event.position())
        return click_line(self.candidates(), turn, self.document.selection, adding)

    def _adds(self, event: QMouseEvent) -> bool:
        """Return whether a click adds to the selection rather than makes another one."""
        return self.runner.choosing or bool(event.modifiers() & _ADDING)

    def _band_line(self, event: QMouseEvent) -> str:
        """Return the line that selects by the window dragged."""
        assert self.band_from is not None
        end = self.view.to_world(event.position())
        a, b = (rounded(point, self.view.scale) for point in (self.band_from.at, end))
        return band_line((a, b), self._adds(event))

    def _run(self, line: str) -> None:
        try:
            self.document.run(line)
        except InputError as error:
            self.message.emit(reason_of(error))

    def _switched(self) -> frozenset[str]:
        """Return the options of the running tool that are on; where a selection is asked for no prompt tells them."""
        tool = self.runner.tool
        return frozenset(tool.on) if isinstance(tool, PromptTool) else frozenset()

    def _tell(self) -> None:
        """Say what has changed of tool, prompt and options."""
        if isinstance(self.runner.tool, DragTool) and not self.runner.tool.points:
            self.runner.start(CanvasTool.SELECT)
        before, self._told = self._told, (self.prompt, self.runner.kind, self._switched())
        if before[1] is not self.runner.kind:
            self.tool_changed.emit(self.runner.kind)
        if (before[0], before[2]) != (self.prompt, self._told[2]):
            self.prompt_changed.emit(self.prompt)
        self.entry.refresh()
        self._show_cursor()
        self._aim_again()


def _apart(begun: MousePress | None, position: QPointF | None) -> bool:
    """Return whether the mouse has been dragged from where a button went down to another position."""
    if begun is None or position is None:
        return False
    return (begun.position - position).manhattanLength() > _DRAG_PX
