"""The legend over the canvas: what each line means, a click switches it off; colour by tool or by region."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QPainter, QPaintEvent
from PySide6.QtWidgets import QWidget

from ....model.job import Job
from ....model.operation import Operation
from ...framework.fields import ChoiceField
from ...framework.labels import muted
from ...framework.legend import LegendRow, LegendSheet
from ...framework.samples import PathLineKind, sample_of
from ...framework.section import heading
from ...framework.themed import Themed
from ...panels.changes import kind_name
from .modes import PathColourBy
from .painting.engagement_colours import STEPS, colours

WIDTH, _MOST_WIDTH = 180, 228
"""As usual, and where names of several tools want more, px."""


class EngagementScale(Themed, QWidget):
    """The colours of engagement, and the shares of the diameter between them."""

    def __init__(self) -> None:
        super().__init__()
        self.setFixedHeight(30)
        self.setToolTip("Share of the diameter that is engaged: from little to a full slot")

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint a band of colours with figures under their borders."""
        painter = QPainter(self)
        shown = colours(self._theme)
        wide = self.width() / len(shown)
        for k, colour in enumerate(shown):
            painter.fillRect(QRectF(k * wide, 6, wide, 6), colour)
        painter.setPen(self._theme.muted)
        for k, share in enumerate(STEPS, 1):
            unit = " %" if k == len(STEPS) else ""
            aside = painter.fontMetrics().horizontalAdvance(unit) / 2
            painter.drawText(
                QRectF(k * wide - 20 + aside, 14, 40, 14), Qt.AlignmentFlag.AlignCenter, f"{100 * share:.0f}{unit}"
            )


class Legend(LegendSheet):
    """A quiet sheet in the canvas' upper right corner.

    Signals:
        layer_switched(sample, on). colour_chosen(PathColourBy).
    """

    layer_switched = Signal(PathLineKind, bool)
    colour_chosen = Signal(PathColourBy)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, heading("Legend"), WIDTH)
        self.rows: dict[PathLineKind, LegendRow] = {}
        for sample in (sample for sample in PathLineKind if sample is not PathLineKind.WEDGES):
            row = LegendRow(sample)
            row.toggled.connect(lambda on, s=sample: self.layer_switched.emit(s, on))
            self.rows[sample] = row
            self.add(row)
        self.colour = ChoiceField(
            "", [(PathColourBy.TOOL, "Tool"), (PathColourBy.REGION, "Region"), (PathColourBy.ENGAGEMENT, "Load")]
        )
        self.colour.buttons[PathColourBy.ENGAGEMENT].setToolTip("How much of the diameter is engaged along the path")
        self.colour.show_value(PathColourBy.TOOL)
        self.colour.chosen.connect(self._choose_colour)
        self.scale = EngagementScale()
        self.scale.hide()
        self.add_line()
        self.add(muted("Colour by"), self.colour, self.scale)

    def _choose_colour(self, by: PathColourBy) -> None:
        for row in self.rows.values():
            row.line.set_any_colour(by is not PathColourBy.TOOL)
        self.scale.setVisible(by is PathColourBy.ENGAGEMENT)
        self.fit_contents()
        self.colour_chosen.emit(by)

    def show_remainders(self, present: dict[PathLineKind, bool]) -> None:
        """Have entries for what a program leaves standing, tabs among it, only when there is some."""
        for sample, there in present.items():
            self.rows[sample].setVisible(there)
        self.fit_contents()

    def show_job(self, job: Job) -> None:
        """Name the tools of the paths, and have entries for pockets, rest machining, contours and keep-out areas only
        when there are any.
        """
        paths = (PathLineKind.POCKET, PathLineKind.REST, PathLineKind.CONTOUR)
        tools = {sample: _tools(job.operations, sample) for sample in (*paths, PathLineKind.PLUNGE)}
        kinds = {sample: _kind(job.operations, sample) for sample in paths}
        kinds[PathLineKind.PLUNGE] = "Hole" if tools[PathLineKind.PLUNGE] else PathLineKind.PLUNGE.value
        wanted = max(self.rows[sample].width_for(kinds[sample], numbers) for sample, numbers in tools.items())
        width = min(max(wanted, WIDTH), _MOST_WIDTH)
        self.setFixedWidth(width)
        for sample, numbers in tools.items():
            self.rows[sample].show_names(kinds[sample], numbers, width)
        for sample in paths:
            self.rows[sample].setVisible(bool(tools[sample]))
        self.rows[PathLineKind.CLAMP].setVisible(bool(job.keep_out_layers))
        self.fit_contents()


def _kind(operations: tuple[Operation, ...], sample: PathLineKind) -> str:
    """Return what a line's operations are called: all by one name, or by the line's."""
    names = {kind_name(type(op)) for op in operations if sample_of(op) is sample and op.cut.enabled}
    return names.pop() if len(names) == 1 else sample.value


def _tools(operations: tuple[Operation, ...], sample: PathLineKind) -> tuple[str, ...]:
    numbers = dict.fromkeys(op.cut.tool for op in operations if sample_of(op) is sample and op.cut.enabled)
    return tuple(f"T{number}" for number in numbers)
