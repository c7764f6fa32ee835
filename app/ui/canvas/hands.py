"""Mouse and keys of the canvas: aiming, drawing, selecting, panning. What is shown is the canvas' own business."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from PySide6.QtCore import QEvent, QPointF, Qt, Signal
from PySide6.QtGui import QFocusEvent, QKeyEvent, QMouseEvent
from PySide6.QtWidgets import QWidget

from app.edit.document import Document
from app.edit.words import ids_text, point_text
from app.errors import InputError
from app.model.curves import Point
from app.ui.canvas.aim import Aim, AimRules, aim, rounded
from app.ui.canvas.grid import grid_steps
from app.ui.canvas.modes import CanvasTool
from app.ui.canvas.part_picture import PartPicture
from app.ui.canvas.running import ToolRunner
from app.ui.canvas.viewport import Viewport

PICK_PX = 6.0
_DRAG_PX = 4.0
_ADDING = Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.ShiftModifier


@dataclass(frozen=True)
class Marking:
    """Places that are put by clicks, one each; a click on one takes it away.

    Attributes:
        prompt: what is expected.
        places: those that are there, mm.
        click: takes a place, mm, and how near counts as on it, mm.
    """

    prompt: str
    places: Callable[[], Sequence[Point]]
    click: Callable[[Point, float], None]


class Hands(Viewport):
    """A viewport that draws and selects in a document.

    Signals:
        cursor_moved: x, y under the mouse, mm. prompt_changed: what is expected next. tool_changed: CanvasTool.
        hovered: what lies under the mouse, or "". message: the sentence of an error.
        key_typed: a character meant for the command line.
    """

    cursor_moved = Signal(float, float)
    prompt_changed = Signal(str)
    tool_changed = Signal(object)
    hovered = Signal(str)
    message = Signal(str)
    key_typed = Signal(str)

    def __init__(self, document: Document, parent: QWidget | None = None) -> None:
        """Begin with SELECT, snapping to points."""
        super().__init__(parent)
        self.document, self.picture = document, PartPicture()
        self.runner = ToolRunner(document, self.message.emit)
        self.mouse: QPointF | None = None
        self.aim: Aim | None = None
        self.band_from: QPointF | None = None
        self.marking: Marking | None = None
        self._snap, self._grid_snap, self._ortho = True, False, False
        self._space = self._shift = False
        self._told = (self.runner.prompt, CanvasTool.SELECT)
        self.setMouseTracking(True)
        self.setFocusPolicy(Qt.FocusPolicy.StrongFocus)

    def look_at(self, point: Point | None) -> None:
        """Light up what lies under the mouse, mm; None for nothing."""
        raise NotImplementedError

    def fit(self) -> None:
        """Show everything."""
        raise NotImplementedError

    @property
    def tool(self) -> CanvasTool:
        """The running tool."""
        return self.runner.kind

    @property
    def prompt(self) -> str:
        """What is expected next."""
        return self.marking.prompt if self.marking is not None else self.runner.prompt

    @property
    def snap(self) -> bool:
        """Whether the mouse snaps to points of the drawing."""
        return self._snap

    @property
    def grid_snap(self) -> bool:
        """Whether the mouse snaps to the raster."""
        return self._grid_snap

    @property
    def ortho(self) -> bool:
        """Whether lines go only across and up; Shift is the opposite for as long as it is held."""
        return self._ortho

    @property
    def grid_step(self) -> float:
        """Distance of the fine raster's lines, mm."""
        return grid_steps(self.view)[0]

    @property
    def banding(self) -> bool:
        """True while a selection window is dragged."""
        if self.band_from is None or self.mouse is None:
            return False
        return (self.mouse - self.band_from).manhattanLength() > _DRAG_PX

    def mark(self, marking: Marking | None) -> None:
        """Let clicks mark places, until Esc or another tool; None ends that."""
        if marking is not None:
            self.runner.start(CanvasTool.SELECT)
        self.marking = marking
        self._tell()

    def set_tool(self, tool: CanvasTool) -> None:
        """Begin a tool."""
        self.marking = None
        self.runner.start(tool)
        self.look_at(None)
        self._tell()

    def set_snap(self, on: bool) -> None:
        """Snap to points of the drawing, or not."""
        self._snap = on
        self._aim_again()

    def set_grid_snap(self, on: bool) -> None:
        """Snap to the raster, or not."""
        self._grid_snap = on
        self._aim_again()

    def set_ortho(self, on: bool) -> None:
        """Draw only across and up, or freely."""
        self._ortho = on
        self._aim_again()

    def cancel(self) -> None:
        """Give up what is going on: the selection window, the shape, the tool, the selection."""
        if self.marking is not None:
            self.mark(None)
        elif self.band_from is not None:
            self.band_from = None
        elif not self.runner.cancel() and self.document.selection:
            self._run("select none")
        self._tell()

    def accept(self) -> None:
        """End the shape; without one end the tool; without a tool begin the last one again."""
        if self.marking is not None:
            self.mark(None)
            return
        self.runner.accept()
        self._tell()

    def back(self) -> None:
        """Take the last point of the shape back."""
        self.runner.back()
        self._tell()

    def type_text(self, text: str) -> bool:
        """Give typed text to the running tool; return False when it is nothing for it."""
        used = self.runner.type_text(text)
        self._tell()
        return used

    def delete_selection(self) -> None:
        """Delete what is selected."""
        if self.document.selection:
            self._run(f"delete {ids_text(self.document.selection)}")

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Give a point, begin a selection, or hold the drawing."""
        button = event.button()
        if button is Qt.MouseButton.MiddleButton or (button is Qt.MouseButton.LeftButton and self._space):
            self.begin_pan(event.position())
        elif button is Qt.MouseButton.RightButton and (self.runner.tool is not None or self.marking is not None):
            self.accept()
        elif button is Qt.MouseButton.LeftButton and self.area.contains(event.position()):
            self._move_to(event)
            if self.marking is not None:
                self.marking.click(self.view.to_world(event.position()), PICK_PX / self.view.scale)
                self.update()
            elif self.aim is None:
                self.band_from = event.position()
            else:
                self.runner.click(self.aim.point)
                self._tell()

    def mouseDoubleClickEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Count the second click as a click."""
        self.mousePressEvent(event)

    def mouseMoveEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Aim, drag the window, or drag the drawing."""
        self.pan_to(event)
        self._move_to(event)

    def mouseReleaseEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Select, or let the drawing go."""
        if self.end_pan():
            self._show_cursor()
        elif event.button() is Qt.MouseButton.LeftButton and self.band_from is not None:
            self.mouse = event.position()
            line = self._band_line(event) if self.banding else self._click_line(event)
            self.band_from = None
            if line:
                self._run(line)
            self.update()

    def leaveEvent(self, event: QEvent) -> None:  # noqa: N802 (Qt's name)
        """Forget the mouse."""
        self.mouse = self.aim = None
        self.look_at(None)
        self.update()

    def keyPressEvent(self, event: QKeyEvent) -> None:  # noqa: N802 (Qt's name)
        """Esc cancels, Enter ends, Backspace takes a point back, Del deletes, F and Home fit, Space pans; the rest is text."""
        action = self._keys().get(Qt.Key(event.key()))
        commanding = bool(event.modifiers() & (Qt.KeyboardModifier.ControlModifier | Qt.KeyboardModifier.AltModifier))
        if commanding:
            super().keyPressEvent(event)
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
            Qt.Key.Key_Escape: self.cancel, Qt.Key.Key_Return: self.accept, Qt.Key.Key_Enter: self.accept,
            Qt.Key.Key_Delete: self.delete_selection, Qt.Key.Key_Backspace: self.back, Qt.Key.Key_Home: self.fit, Qt.Key.Key_F: self.fit,
            Qt.Key.Key_Space: lambda: self._hold_space(True), Qt.Key.Key_Shift: lambda: self._hold_shift(True),
        }

    def _hold_space(self, held: bool) -> None:
        self._space = held
        self._show_cursor()

    def _hold_shift(self, held: bool) -> None:
        self._shift = held
        self._aim_again()

    def _show_cursor(self) -> None:
        drawing = Qt.CursorShape.CrossCursor if self.runner.tool or self.marking else Qt.CursorShape.ArrowCursor
        self.setCursor(Qt.CursorShape.OpenHandCursor if self._space else drawing)

    def _move_to(self, event: QMouseEvent) -> None:
        self.mouse = event.position()
        self._shift = bool(event.modifiers() & Qt.KeyboardModifier.ShiftModifier)
        self._aim_again()
        point = self.aim.point if self.aim else rounded(self.view.to_world(self.mouse), self.view.scale)
        self.cursor_moved.emit(*point)
        if self.runner.tool is None and self.band_from is None:
            self.look_at(self.view.to_world(self.mouse))

    def _aim_again(self) -> None:
        tool = self.runner.tool
        self.aim = None
        if tool is not None and self.mouse is not None:
            rules = AimRules(self._snap, self._grid_snap, self._ortho != self._shift, self.grid_step, self.view.scale)
            self.aim = aim(self.view.to_world(self.mouse), tool, self.picture.lookup.snaps, rules)
            self.runner.aim_at(self.aim.point)
        self.update()

    def _click_line(self, event: QMouseEvent) -> str:
        """Return the line that selects what was clicked, or ""."""
        entity = self.picture.nearest(self.view.to_world(event.position()), PICK_PX / self.view.scale)
        adding = bool(event.modifiers() & _ADDING)
        if entity is None:
            return "select none" if self.document.selection and not adding else ""
        how = ("remove " if entity.id in self.document.selection else "add ") if adding else ""
        return f"select {how}{entity.id}"

    def _band_line(self, event: QMouseEvent) -> str:
        """Return the line that selects by the window dragged: to the right what is inside, to the left also what it crosses."""
        assert self.band_from is not None
        kind = "window" if event.position().x() >= self.band_from.x() else "crossing"
        corners = [point_text(rounded(self.view.to_world(p), self.view.scale)) for p in (self.band_from, event.position())]
        how = "add " if event.modifiers() & _ADDING else ""
        return f"select {how}{kind} {' '.join(corners)}"

    def _run(self, line: str) -> None:
        try:
            self.document.run(line)
        except InputError as error:
            self.message.emit(str(error))

    def _tell(self) -> None:
        """Say what has changed of tool and prompt."""
        before, self._told = self._told, (self.prompt, self.runner.kind)
        if before[1] is not self.runner.kind:
            self.tool_changed.emit(self.runner.kind)
        if before[0] != self.prompt:
            self.prompt_changed.emit(self.prompt)
        self._show_cursor()
        self._aim_again()
