"""The Curves view: both paths over one another, and below them how far they are apart."""

from __future__ import annotations

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QWidget

from ...framework.boxes import h_box, v_box
from ...framework.fields import ChoiceField
from ...framework.figures import counted
from ...framework.icons import IconButton
from ...framework.labels import Elided, muted
from ...framework.samples import Switch
from ..nc.heads import bar
from ..nc.motion_shapes import ViewSide
from ..nc.painting.motion_layer import MotionLayer
from ..nc.program_reader import ShownProgram
from .deviation_plot import DeviationPlot, deviation_text
from .deviation_track import DeviationSample
from .model import CurvesModel
from .path_view import CurvesPathView


class CurvesView(QWidget):
    """Shows a program, or what smoothing made of it.

    Signals:
        side_requested(ViewSide): the picture of this side is missing. spotted(sentence): a place was picked.

    Attributes:
        curves: what is shown; None = a program that is not smoothed, or nothing.
    """

    side_requested = Signal(ViewSide)
    spotted = Signal(str)

    def __init__(self) -> None:
        super().__init__()
        self.side = ViewSide.XY
        self.curves: CurvesModel | None = None
        self._program: ShownProgram | None = None
        self.path, self.deviation = CurvesPathView(), DeviationPlot()
        self.sides = ChoiceField("", [(side, side.name) for side in ViewSide])
        self.sides.show_value(ViewSide.XY)
        for button in self.sides.buttons.values():
            button.setToolTip(f"Seen from {button.text()}")
            button.setAccessibleName(f"Seen from {button.text()}")
        self.name, self.comb, self.fit = Elided(role="muted"), Switch("Curvature comb"), IconButton("fit", "Fit (F)")
        self.comb.setToolTip("Show how much the curves bend: taller is tighter")
        column = v_box(self, spacing=0)
        column.addWidget(self._head())
        column.addWidget(self.path, 1)
        column.addWidget(self.deviation)
        self.setFocusProxy(self.path)
        self.sides.chosen.connect(self.set_side)
        self.comb.toggled.connect(self.path.show_comb)
        self.fit.clicked.connect(self.path.fit)
        self.deviation.picked.connect(self.go_to)

    def _head(self) -> QWidget:
        head = QWidget()
        row = bar(head)
        row.addWidget(self.sides)
        row.addWidget(self.name, 1)
        beside = h_box(spacing=6)
        beside.addWidget(muted("Curvature comb"))
        beside.addWidget(self.comb)
        row.addLayout(beside)
        row.addWidget(self.fit)
        return head

    @property
    def summary(self) -> str:
        """What there is to say about the whole, or ""."""
        if self.curves is None:
            return ""
        shown = self.curves
        return f"{counted(len(shown.before), 'motion')} before · {counted(len(shown.now.shapes), 'motion')} after"

    def show_program(self, shown: ShownProgram | None) -> None:
        """Show a program that is not smoothed, or nothing."""
        self.curves, self._program = None, shown
        self.name.setText(shown.source.name if shown is not None else "")
        self.deviation.show_track(None, 0.0)
        self.comb.setEnabled(False)
        self.set_side(self.side)

    def show_curves(self, curves: CurvesModel) -> None:
        """Show a smoothed program; what is looked at stays where it is of the same program."""
        stays = self._program is curves.was and self.path.moved
        view = self.path.view
        self.curves, self._program = curves, curves.was
        self.name.setText(curves.was.source.name)
        self.deviation.show_track(curves.track, curves.done.options.tolerance)
        self.comb.setEnabled(len(curves.changed) > 0)
        self.set_side(self.side)
        if stays:
            self.path.set_view(view)

    def set_side(self, side: ViewSide) -> None:
        """Look from above or from a side."""
        self.side = side
        self.sides.show_value(side)
        program, curves = self._program, self.curves
        if program is None:
            self.path.show_program(None)
        elif curves is not None and side in curves.layers:
            self.path.show_curves(curves, side)
            self.path.fit_now()
        elif curves is None and side in program.pictures:
            self.path.show_program(program.pictures[side])
            self.path.fit_now()
        else:
            self.side_requested.emit(side)

    def go_to(self, spot: DeviationSample) -> None:
        """Show a place on the path and in the plot."""
        self.path.mark(spot)
        self.deviation.show_spot(spot)
        self.spotted.emit(deviation_text(spot))


def picture_of(shown: ShownProgram, side: ViewSide) -> MotionLayer:
    """Return the picture of a program that is not smoothed."""
    return MotionLayer(shown.shapes, side)
