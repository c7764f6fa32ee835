"""The Surfaces view: a scene in space, from above, or plane by plane."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QComboBox, QMenu, QSlider, QWidget

from ....model.finding import Finding
from ....usecases.scene.lines import BoundaryPoint
from ...framework.boxes import v_box
from ...framework.dropping import drop
from ...framework.fields import ChoiceField
from ...framework.figures import counted
from ...framework.icons import IconButton
from ...framework.labels import Elided, muted
from ...framework.verdict import VerdictLevel, VerdictSummary
from ..cut.camera import StandardView
from ..nc.heads import bar
from .scene_canvas import PickedPart, SceneCanvas
from .scene_computation import SceneState
from .scene_raster import SceneColourBy, SceneLayer
from .shown_scene import ShownScene


class ViewDirection(Enum):
    """How a scene is looked at; the value is the direction."""

    SPACE = StandardView.ISOMETRIC
    PLAN = StandardView.TOP
    SECTION = StandardView.FRONT


_LAYERS = (
    (SceneLayer.SURFACES, "Surfaces"),
    (SceneLayer.PATHS, "Paths"),
    (SceneLayer.LINKS, "Links"),
    (SceneLayer.RAPIDS, "Rapids and plunges"),
    (SceneLayer.POINTS, "Boundary points"),
    (SceneLayer.NAMES, "Names of boundary points"),
)
_COLOURS = (
    (SceneColourBy.SURFACE, "By surface"),
    (SceneColourBy.TOOL, "By tool"),
    (SceneColourBy.LINE, "By line type"),
)
_NAMES = ((ViewDirection.SPACE, "3D"), (ViewDirection.PLAN, "Plan"), (ViewDirection.SECTION, "Section"))


class SurfacesView(QWidget):
    """Shows a computed scene.

    Signals:
        point_picked(number), surface_picked(number): the mouse chose a boundary point, or a surface.
        hovered(sentence): what the mouse is over, "" = nothing. cursor_moved(x, y, axes): where that is, mm.

    Attributes:
        shown: the scene, or None. points: its boundary points. look: how it is looked at. plane: slider over all
            passes' planes.
        state: where the scene stands. verdict, findings: on its program. may_retry: what failed may do better another
            time. at_once: changes are computed at once.
    """

    point_picked = Signal(int)
    surface_picked = Signal(int)
    hovered = Signal(str)
    cursor_moved = Signal(float, float, str)

    def __init__(self) -> None:
        super().__init__()
        self.shown: ShownScene | None = None
        self.points: tuple[BoundaryPoint, ...] = ()
        self.look, self.state, self.at_once, self.may_retry = ViewDirection.SPACE, SceneState.NONE, True, False
        self.verdict, self.findings = VerdictSummary(VerdictLevel.NONE, "Not computed"), tuple[Finding, ...]()
        self.canvas, self.looks = SceneCanvas(), ChoiceField("", _NAMES)
        self.looks.show_value(self.look)
        self.name, self.plane, self.at = Elided(role="muted"), QSlider(Qt.Orientation.Horizontal), muted()
        self.plane.setToolTip("Cutting plane whose section is shown")
        self.plane.setAccessibleName("Cutting plane")
        self.fit, self.eye = IconButton("fit", "Fit (F)"), IconButton("eye", "What is shown")
        self.colours, self.menu = QComboBox(), QMenu(self)
        self.colours.setAccessibleName("Colours of paths")
        self.colours.setToolTip("What tells paths apart")
        for by, name in _COLOURS:
            self.colours.addItem(name, by)
        self.switches = {layer: self.menu.addAction(name) for layer, name in _LAYERS}
        for switch in self.switches.values():
            switch.setCheckable(True)
            switch.setChecked(True)
            switch.toggled.connect(lambda _: self.canvas.set_layers(self._layers))
        head = QWidget()
        row = bar(head)
        for widget, stretch in (
            (self.looks, 0),
            (self.name, 1),
            (self.plane, 1),
            (self.at, 0),
            (self.colours, 0),
            (self.eye, 0),
            (self.fit, 0),
        ):
            row.addWidget(widget, stretch)
        column = v_box(self, spacing=0)
        column.addWidget(head)
        column.addWidget(self.canvas, 1)
        self.setFocusProxy(self.canvas)
        self.looks.chosen.connect(self.set_look)
        self.plane.valueChanged.connect(lambda _: self._show())
        self.fit.clicked.connect(self.canvas.fit)
        self.eye.clicked.connect(lambda: drop(self.menu, self.eye))
        self.colours.activated.connect(lambda _: self.canvas.set_colour_by(self.colours.currentData()))
        self.canvas.pointed.connect(self._on_pointed)
        self.canvas.picked.connect(self._on_picked)
        self.set_look(self.look)

    @property
    def summary(self) -> str:
        """What there is to say about the scene, or ""."""
        if self.shown is None:
            return ""
        computed = self.shown.computed
        planes = counted(len(self.shown.planes), "plane")
        return (
            f"{counted(len(computed.scene.surfaces), 'surface')} · {planes} · "
            f"{counted(len(computed.moves.moves), 'move')}"
        )

    def show_scene(self, shown: ShownScene, points: tuple[BoundaryPoint, ...] = (), again: bool = False) -> None:
        """Show a scene: all of it, or, when it is the one that was shown in another state, from where it is looked
        at.
        """
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

    def show_nothing(self) -> None:
        """Show no scene until there is one."""
        self.shown, self.points = None, ()
        self.name.setText("")
        self.canvas.show_picture(None)

    def show_standing(
        self, state: SceneState, verdict: VerdictSummary, findings: tuple[Finding, ...], may_retry: bool = False
    ) -> None:
        """Know where the scene stands, what is to be said of its program, and whether a failure may pass."""
        self.state, self.verdict, self.findings, self.may_retry = state, verdict, findings, may_retry

    def show_point(self, number: int) -> None:
        """Have a boundary point stand out: on its plane, or where it is in space."""
        point = self.points[number]
        if self.look is ViewDirection.SECTION:
            self.plane.setValue(point.plane)
        self.canvas.mark_point(self._marks.index(number) if number in self._marks else -1)

    def set_look(self, look: ViewDirection) -> None:
        """Look in another way."""
        self.look = look
        self.looks.show_value(look)
        self.plane.setVisible(look is ViewDirection.SECTION)
        self.at.setVisible(look is ViewDirection.SECTION)
        self._show()
        self.canvas.look(look.value)

    @property
    def _layers(self) -> SceneLayer:
        on = SceneLayer(0)
        for layer, switch in self.switches.items():
            on |= layer if switch.isChecked() else SceneLayer(0)
        return on

    @property
    def _marks(self) -> list[int]:
        """The number of the boundary point that each mark of the canvas is of; the other height of a jump is that of
        its point.
        """
        if self.look is ViewDirection.SECTION:
            return [number for number, point in enumerate(self.points) if point.plane == self.plane.value()]
        return [number for number, point in enumerate(self.points) for _ in range(1 + (point.kind == "jump"))]

    def _on_pointed(self, over: PickedPart | None) -> None:
        if over is None or self.shown is None:
            self.hovered.emit("")
            return
        x, y, z = over.place
        section = self.look is ViewDirection.SECTION
        self.cursor_moved.emit(x, z if section else y, "XZ" if section else "XY")
        place = f"{x:.3f}, {z:.3f}" if section else f"{x:.3f}, {y:.3f}, {z:.3f}"
        if over.mark >= 0:
            point = self.points[self._marks[over.mark]]
            x, y, z = point.place.tolist()
            self.hovered.emit(f"{point.name}, {point.kind}, at {x:.3f}, {y:.3f}, {z:.3f}")
        elif over.surface >= 0:
            self.hovered.emit(f"{self.shown.computed.names[over.surface]} at {place}")
        else:
            self.hovered.emit("")

    def _on_picked(self, over: PickedPart) -> None:
        if over.mark >= 0:
            self.canvas.mark_point(over.mark)
            self.point_picked.emit(self._marks[over.mark])
        elif over.surface >= 0:
            self.surface_picked.emit(over.surface)

    def _show(self) -> None:
        shown = self.shown
        if shown is None:
            self.canvas.show_picture(None)
            return
        picture = shown.space
        if self.look is ViewDirection.SECTION and shown.planes:
            at = self.plane.value()
            picture = shown.section(*shown.planes[at])
            self.at.setText(f"{at + 1} / {len(shown.planes)}")
        names = shown.computed.names
        floor = any(each.surface == len(names) - 1 for each in shown.space.strands)
        tools = {family.tool.number: f"T{family.tool.number} {family.tool.label}" for family in shown.computed.families}
        self.canvas.show_picture(picture, shown.colours, names if floor else names[:-1], shown.lines, tools)
