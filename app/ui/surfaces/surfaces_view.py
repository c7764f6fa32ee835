"""The Surfaces view: a scene in space, from above, or plane by plane."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QSlider, QVBoxLayout, QWidget

from app.model.finding import Finding
from app.ui.cut.camera import StandardView
from app.ui.figures import counted
from app.ui.icons import IconButton
from app.ui.labels import Elided, muted
from app.ui.nc.heads import bar
from app.ui.panels.fields import ChoiceField
from app.ui.surfaces.points_page import Row
from app.ui.surfaces.scene_canvas import SceneCanvas
from app.ui.surfaces.shown_scene import ShownScene
from app.ui.verdict import Level, Verdict


class Look(Enum):
    """How a scene is looked at; the value is the direction."""

    SPACE = StandardView.ISOMETRIC
    PLAN = StandardView.TOP
    SECTION = StandardView.FRONT


_NAMES = ((Look.SPACE, "3D"), (Look.PLAN, "Plan"), (Look.SECTION, "Section"))


class SurfacesView(QWidget):
    """Shows a computed scene.

    Signals:
        point_picked(number): the mouse chose a boundary point.

    Attributes:
        shown: the scene, or None. points: its boundary points. look: how it is looked at. plane: slider over all passes' planes.
        computing: a scene is on its way. verdict, findings: on its program.
    """

    point_picked = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.shown: ShownScene | None = None
        self.points: tuple[Row, ...] = ()
        self.look, self.computing = Look.SPACE, False
        self.verdict, self.findings = Verdict(Level.NONE, "Not computed"), tuple[Finding, ...]()
        self.canvas, self.looks = SceneCanvas(), ChoiceField("", _NAMES)
        self.looks.show_value(self.look)
        self.name, self.plane, self.at = Elided(role="muted"), QSlider(Qt.Orientation.Horizontal), muted()
        self.plane.setToolTip("Cutting plane whose section is shown")
        self.plane.setAccessibleName("Cutting plane")
        self.fit = IconButton("fit", "Fit (F)")
        head = QWidget()
        row = bar(head)
        for widget, stretch in ((self.looks, 0), (self.name, 1), (self.plane, 1), (self.at, 0), (self.fit, 0)):
            row.addWidget(widget, stretch)
        column = QVBoxLayout(self)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        column.addWidget(head)
        column.addWidget(self.canvas, 1)
        self.setFocusProxy(self.canvas)
        self.looks.chosen.connect(self.set_look)
        self.plane.valueChanged.connect(lambda _: self._show())
        self.fit.clicked.connect(self.canvas.fit)
        self.set_look(self.look)

    @property
    def summary(self) -> str:
        """What there is to say about the scene, or ""."""
        if self.shown is None:
            return ""
        computed = self.shown.computed
        planes = counted(len(self.shown.planes), "plane")
        return f"{counted(len(computed.scene.surfaces), 'surface')} · {planes} · {counted(len(computed.moves.moves), 'move')}"

    def show_scene(self, shown: ShownScene, points: tuple[Row, ...] = (), again: bool = False) -> None:
        """Show a scene: all of it, or, when it is the one that was shown in another state, from where it is looked at."""
        self.shown, self.points = shown, points
        self.name.setText(shown.computed.scene.name)
        last = max(len(shown.planes) - 1, 0)
        at = min(self.plane.value(), last) if again else len(shown.planes) // 2
        self.plane.blockSignals(True)
        self.plane.setRange(0, last)
        self.plane.setValue(at)
        self.plane.blockSignals(False)
        if again:
            self._show()
        else:
            self.set_look(self.look)

    def show_standing(self, verdict: Verdict, findings: tuple[Finding, ...], computing: bool) -> None:
        """Know what is to be said of the scene's program, and whether it is on its way."""
        self.verdict, self.findings, self.computing = verdict, findings, computing

    def show_point(self, number: int) -> None:
        """Show a boundary point: on its plane, or where it is in space."""
        point = self.points[number]
        if self.look is Look.SECTION:
            self.plane.setValue(point.plane)

    def set_look(self, look: Look) -> None:
        """Look in another way."""
        self.look = look
        self.looks.show_value(look)
        self.plane.setVisible(look is Look.SECTION)
        self.at.setVisible(look is Look.SECTION)
        self._show()
        self.canvas.look(look.value)

    def _show(self) -> None:
        shown = self.shown
        if shown is None:
            self.canvas.show_picture(None)
            return
        picture = shown.space
        if self.look is Look.SECTION and shown.planes:
            at = self.plane.value()
            picture = shown.section(*shown.planes[at])
            self.at.setText(f"{at + 1} / {len(shown.planes)}")
        floor = any(line.surface == len(shown.computed.scene.surfaces) for line in shown.space.lines)
        self.canvas.show_picture(picture, shown.colours, shown.computed.names if floor else shown.computed.names[:-1])
