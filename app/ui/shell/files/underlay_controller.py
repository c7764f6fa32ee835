"""A picture under the drawing, to be traced: placed, scaled by two points, moved, turned, hidden, taken away."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog

from ....core.errors import HitofudeError, InputError
from ....core.tolerances import WELD
from ....drafting.document import DocumentChange
from ....drafting.expressions.numbers import length
from ....model.curves import Point
from ....model.underlay import Underlay
from ...framework.commands import Commands, on_trigger
from ...framework.workspace import Workspace
from ...views.canvas.canvas import Canvas
from ...views.canvas.marker_mode import MarkerMode
from ...views.canvas.painting.underlay_layer import SUFFIXES, UnderlayLayer, read_picture

_SCALE = "Scale the picture: click two points of it, then type their distance; Esc ends"
_DISTANCE = "Scale the picture: type the distance of the two points, such as 50 or 2in, or click the second again"
_MOVE = "Move the picture: click a point of it, then where that belongs; Esc ends"
_TURN = "Turn the picture: click two points of it that lie straight across or up; Esc ends"


class UnderlayController(QObject):
    """Lets the user lay a picture under the drawing; that is no change of the drawing and is not undone.

    Signals:
        changed(): another picture, or another place of it. refused(sentence): what was typed is no distance.
    """

    changed = Signal()
    refused = Signal(str)

    def __init__(self, canvas: Canvas, workspace: Workspace, commands: Commands) -> None:
        super().__init__(canvas)
        self._canvas, self._workspace, self._commands = canvas, workspace, commands
        self._points: list[Point] = []
        self._shown: UnderlayLayer | None = None
        self._missing: Underlay | None = None
        acts: dict[str, Callable[[], None]] = {
            "underlay": self._choose,
            "underlay_scale": lambda: self._mark(_SCALE, self._scale_click),
            "underlay_move": lambda: self._mark(_MOVE, self._move_click),
            "underlay_turn": lambda: self._mark(_TURN, self._turn_click),
            "underlay_remove": lambda: self.lay(None),
        }
        for name, act in acts.items():
            on_trigger(commands, name, act)
        commands["underlay_shown"].toggled.connect(self._show)
        workspace.document.subscribe(lambda change: self.lay(None) if DocumentChange.LOADED in change else None)
        self.lay(None)

    @property
    def underlay(self) -> Underlay | None:
        """Where the picture lies, if there is one; also of one whose file cannot be read."""
        return self._shown.place if self._shown is not None else self._missing

    def place(self, path: Path) -> None:
        """Lay a picture over the display's frame; what is wrong with it is said."""
        try:
            image = read_picture(path)
        except InputError as error:
            self._workspace.notice.ask(str(error), error=True)
            return
        x0, y0, x1, y1 = self._canvas.frame.extent
        pitch = min((x1 - x0) / image.width(), (y1 - y0) / image.height())
        self.lay(UnderlayLayer(image, Underlay(str(path.absolute()), (x0, y0), pitch)))
        self._workspace.notice.ask(
            f"{path.name} lies under the drawing. Two points whose distance you know give it its size.",
            [
                ("Scale by two points", lambda: self._mark(_SCALE, self._scale_click)),
                ("Remove it", lambda: self.lay(None)),
            ],
        )

    def bring(self, place: Underlay | None) -> str:
        """Lay the picture that a file tells of; return what is wrong with it, or "". Its place is kept all the same."""
        if place is None:
            self.lay(None)
            return ""
        try:
            self.lay(UnderlayLayer(read_picture(Path(place.path)), place))
        except InputError as error:
            self.lay(None)
            self._missing = place
            self._commands["underlay_remove"].setEnabled(True)
            return f"{error} It was the picture to trace, {place.path}; place it again, or remove it."
        return ""

    def lay(self, picture: UnderlayLayer | None) -> None:
        """Show another picture, or none."""
        self._shown, self._missing = picture, None
        for name in ("underlay_scale", "underlay_move", "underlay_turn", "underlay_shown", "underlay_remove"):
            self._commands[name].setEnabled(picture is not None)
        self._commands["underlay_shown"].setChecked(picture is not None)
        self._canvas.set_underlay(picture)
        self.changed.emit()

    def _choose(self) -> None:
        name, _ = QFileDialog.getOpenFileName(
            self._canvas,
            "Place a picture to trace",
            self._workspace.preferences.settings.last_folder,
            f"Pictures ({' '.join('*' + suffix for suffix in SUFFIXES)})",
        )
        if name:
            self.place(Path(name))

    def _show(self, on: bool) -> None:
        self._canvas.set_underlay(self._shown if on else None)

    def _mark(self, prompt: str, click: Callable[[Point], None], points: list[Point] | None = None) -> None:
        self._commands["underlay_shown"].setChecked(True)
        self._points = points or []
        self._workspace.notice.dismiss()
        self._canvas.mark(MarkerMode(prompt, lambda: tuple(self._points), lambda at, reach: click(at), self._typed))
        self._canvas.setFocus()

    def _put(self, place: Underlay) -> None:
        if self._shown is not None:
            self._shown.place = place
            self.changed.emit()
            self._canvas.repaint_scene()
        self._points = []
        self._canvas.mark(None)

    def _scale_click(self, at: Point) -> None:
        self._points = [*self._points[:1], at]
        if len(self._points) == 2:
            self._mark(_DISTANCE, self._scale_click, self._points)

    def _typed(self, text: str) -> bool:
        """Take the distance of the two points; return False when the text is nothing for the picture."""
        if len(self._points) < 2 or self.underlay is None:
            return False
        a, b = self._points
        try:
            wanted = length(text)
            if wanted < WELD or math.dist(a, b) < WELD:
                raise InputError("Two points have a distance greater than 0 mm; click them again.")
            self._put(self.underlay.scaled(a, wanted / math.dist(a, b)))
        except HitofudeError as error:
            self.refused.emit(str(error))
        return True

    def _move_click(self, at: Point) -> None:
        self._points.append(at)
        if len(self._points) == 2 and self.underlay is not None:
            a, b = self._points
            self._put(self.underlay.moved(b[0] - a[0], b[1] - a[1]))

    def _turn_click(self, at: Point) -> None:
        self._points.append(at)
        if len(self._points) == 2 and self.underlay is not None:
            a, b = self._points
            angle = math.atan2(b[1] - a[1], b[0] - a[0])
            self._put(self.underlay.turned(a, round(angle / (math.pi / 2)) * math.pi / 2 - angle))
