"""The Surfaces view: a scene in space, from above, or plane by plane."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import Qt
from PySide6.QtWidgets import QSlider, QVBoxLayout, QWidget

from app.ui.cut.camera import StandardView
from app.ui.figures import counted
from app.ui.icons import IconButton
from app.ui.labels import Elided, muted
from app.ui.nc.heads import bar
from app.ui.panels.fields import ChoiceField
from app.ui.surfaces.scene_canvas import SceneCanvas
from app.ui.surfaces.shown_scene import ShownScene


class Look(Enum):
    """How a scene is looked at; the value is the direction."""

    SPACE = StandardView.ISOMETRIC
    PLAN = StandardView.TOP
    SECTION = StandardView.FRONT


_NAMES = ((Look.SPACE, "3D"), (Look.PLAN, "Plan"), (Look.SECTION, "Section"))


class SurfacesView(QWidget):
    """Shows a computed scene.

    Attributes:
        shown: the scene, or None. look: how it is looked at. plane: slider over the cutting planes of all passes.
        computing: a scene is on its way.
    """

    def __init__(self) -> None:
        super().__init__()
        self.shown: ShownScene | None = None
        self.look, self.computing = Look.SPACE, False
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

    def show_scene(self, shown: ShownScene) -> None:
        """Show a scene, all of it."""
        self.shown = shown
        self.name.setText(shown.computed.scene.name)
        self.plane.blockSignals(True)
        self.plane.setRange(0, max(len(shown.planes) - 1, 0))
        self.plane.setValue(len(shown.planes) // 2)
        self.plane.blockSignals(False)
        self.set_look(self.look)

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
