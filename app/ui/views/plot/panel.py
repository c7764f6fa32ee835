"""Beside the page preview: on what paper, how large, and what of the drawing."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QPushButton, QWidget

from ....core.errors import HitofudeError
from ....drafting.expressions.numbers import length
from ....formats.plot.layout import PlotOptions, scale_words
from ....formats.plot.page import Paper
from ...framework.boxes import give_ground, h_box, v_box
from ...framework.fields import ChoiceField, ListField, NumberField, NumberSpec
from ...framework.figures import TIMES, counted, grouped
from ...framework.form import SwitchField
from ...framework.labels import muted, show_words
from ...framework.section import EDGE, hairline, heading
from ...framework.side_scroll import WIDTH

_SCALES = (10.0, 5.0, 2.0, 1.0, 1 / 2, 1 / 5, 1 / 10, 1 / 20, 1 / 50, 1 / 100)
_PAPERS = {paper: paper.name if paper.name[0] == "A" else paper.name.capitalize() for paper in Paper}
_LEAST, _MOST = 1e-3, 1e3


def read_scale(text: str) -> float:
    """Return a scale from `1:2`, `2:1`, `50%` or `0.5`.

    Raises:
        HitofudeError: it is none, or is out of 1 : 1000 to 1000 : 1.
    """
    first, colon, second = text.partition(":")
    percent = text.strip().endswith("%")
    try:
        value = length(first) / length(second) if colon else length(text.strip().rstrip("%")) / (100 if percent else 1)
    except ZeroDivisionError:
        value = 0.0
    if not _LEAST <= value <= _MOST:
        raise HitofudeError("The scale is out of range; use 1:1000 to 1000:1.")
    return value


@dataclass(frozen=True, slots=True)
class PlotRequest:
    """What the user wants on paper.

    Attributes:
        layout: paper and scale. paths: with tool paths. notes: with points and dimensions. black: in one ink.
    """

    layout: PlotOptions = field(default_factory=PlotOptions)
    paths: bool = False
    notes: bool = True
    black: bool = False


class PlotPanel(QWidget):
    """The fields; a change asks for another preview.

    Signals:
        changed(PlotRequest). save_requested(). print_requested(). left().
    """

    changed = Signal(PlotRequest)
    save_requested = Signal()
    print_requested = Signal()
    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "sidePanel")
        self.setFixedWidth(WIDTH)
        self.request = PlotRequest()
        self.paper = ListField("Paper", list(_PAPERS.items()))
        self.lies = ChoiceField("Lies", [(True, "Landscape"), (False, "Portrait")])
        self.scale = ListField("Scale", [(None, "Fit one sheet"), *((each, scale_words(each)) for each in _SCALES)])
        self.factor = NumberField(
            NumberSpec("Factor", "", decimals=4, is_length=False, tip="Any other scale: 1:3, 0.25 or 75%."), read_scale
        )
        self.framed, self.paths = (
            SwitchField("Frame, title"),
            SwitchField("Tool paths", "Contours dashed, pockets solid, a colour a tool."),
        )
        self.notes, self.black = (
            SwitchField("Dimensions", "With points and dimensions."),
            SwitchField("Black only", "All in one ink."),
        )
        self.told, self.wrong = muted(), QLabel()
        self.save, self.print, self.leave = QPushButton("Save…"), QPushButton("Print…"), QPushButton("Close")
        self._lay_out()
        self._connect()
        self._show()

    def _lay_out(self) -> None:
        for label in (self.told, self.wrong):
            label.setWordWrap(True)
        self.wrong.setProperty("role", "error")
        self.wrong.hide()
        self.save.setProperty("role", "primary")
        column = v_box(self, (EDGE + 1, 12, EDGE, 12), 6)
        groups = (
            (heading("Plot"), self.paper, self.lies, self.scale, self.factor, self.told, self.wrong),
            (self.framed, self.paths, self.notes, self.black),
        )
        for group in groups:
            for widget in group:
                column.addWidget(widget)
            column.addSpacing(4)
            column.addWidget(hairline())
            column.addSpacing(4)
        buttons = h_box(spacing=8)
        for button in (self.save, self.print, self.leave):
            button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
            buttons.addWidget(button)
        buttons.addStretch(1)
        column.addLayout(buttons)
        column.addStretch(1)

    def _connect(self) -> None:
        self.paper.chosen.connect(lambda paper: self._lay(replace(self.request.layout, paper=paper)))
        self.lies.chosen.connect(lambda across: self._lay(replace(self.request.layout, landscape=across)))
        self.scale.chosen.connect(lambda scale: self._lay(replace(self.request.layout, scale=scale)))
        self.factor.committed.connect(lambda scale: self._lay(replace(self.request.layout, scale=scale)))
        self.framed.chosen.connect(lambda on: self._lay(replace(self.request.layout, framed=on)))
        self.paths.chosen.connect(lambda on: self._take(replace(self.request, paths=on)))
        self.notes.chosen.connect(lambda on: self._take(replace(self.request, notes=on)))
        self.black.chosen.connect(lambda on: self._take(replace(self.request, black=on)))
        self.save.clicked.connect(self.save_requested)
        self.print.clicked.connect(self.print_requested)
        self.leave.clicked.connect(self.left)

    def _lay(self, layout: PlotOptions) -> None:
        self._take(replace(self.request, layout=layout))

    def _take(self, request: PlotRequest) -> None:
        self.request = request
        self._show()
        self.changed.emit(request)

    def _show(self) -> None:
        layout = self.request.layout
        self.paper.show_value(layout.paper)
        self.lies.show_value(layout.landscape)
        self.scale.show_value(layout.scale)
        self.framed.show_value(layout.framed)
        for switch, on in (
            (self.paths, self.request.paths),
            (self.notes, self.request.notes),
            (self.black, self.request.black),
        ):
            switch.show_value(on)

    def show_paths_there(self, there: bool) -> None:
        """Offer tool paths only where some were computed."""
        self.paths.switch.setEnabled(there)

    def show_result(self, scale: float, sheets: int, size: tuple[float, float]) -> None:
        """Tell the scale, how many sheets it takes, and how large the part (mm) is on them."""
        self._say("")
        self.factor.show_value(scale)
        across, up = (grouped(each * scale, 2) for each in size)
        self.told.setText(f"{scale_words(scale)} on {counted(sheets, 'sheet')}: {across} {TIMES} {up} mm on paper")

    def refuse(self, why: str) -> None:
        """Say why there is nothing to plot."""
        self.told.setText("")
        self._say(why)

    def _say(self, why: str) -> None:
        show_words(self.wrong, why)
        self.save.setEnabled(not why)
        self.print.setEnabled(not why)
