"""The legend over the canvas: what each line means, a click switches it off; colour by tool or by region."""

from __future__ import annotations

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QVBoxLayout, QWidget

from ....model.job import Job
from ....model.operation import Operation
from ...framework.fields import ChoiceField
from ...framework.icons import IconButton
from ...framework.labels import muted
from ...framework.samples import LineSample, PathLineKind, sample_of
from ...framework.section import hairline, heading
from ...framework.theme import LIGHT, Theme
from .modes import PathColourBy
from .painting.engagement_colours import STEPS, colours


class LegendRow(QToolButton):
    """One kind of line; a click shows or hides it."""

    def __init__(self, sample: PathLineKind) -> None:
        super().__init__()
        self.setCheckable(True)
        self.setChecked(True)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFixedHeight(24)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.line, self.label = LineSample(sample), QLabel(sample.value)
        self.setAccessibleName(f"Show {sample.value.lower()}")
        self.setToolTip(f"Show or hide: {sample.value.lower()}")
        row = QHBoxLayout(self)
        row.setContentsMargins(4, 0, 8, 0)
        row.setSpacing(10)
        row.addWidget(self.line)
        row.addWidget(self.label)
        row.addStretch(1)
        for child in (self.line, self.label):
            child.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.toggled.connect(self._show_state)

    def _show_state(self, on: bool) -> None:
        self.line.setEnabled(on)
        self.line.update()
        self.label.setProperty("role", "" if on else "muted")
        self.label.style().unpolish(self.label)
        self.label.style().polish(self.label)
        font = self.label.font()
        font.setStrikeOut(not on)
        self.label.setFont(font)


class EngagementScale(QWidget):
    """The colours of engagement, and the shares of the diameter between them."""

    def __init__(self) -> None:
        super().__init__()
        self._theme = LIGHT
        self.setFixedHeight(30)
        self.setToolTip("Share of the diameter that is engaged: from little to a full slot")

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint a band of colours with figures under their borders."""
        painter = QPainter(self)
        shown = colours(self._theme)
        wide = self.width() / len(shown)
        font = painter.font()
        font.setPixelSize(10)
        painter.setFont(font)
        for k, colour in enumerate(shown):
            painter.fillRect(QRectF(k * wide, 6, wide, 6), colour)
        painter.setPen(self._theme.muted)
        for k, share in enumerate(STEPS, 1):
            unit = " %" if k == len(STEPS) else ""
            aside = painter.fontMetrics().horizontalAdvance(unit) / 2
            painter.drawText(
                QRectF(k * wide - 20 + aside, 14, 40, 14), Qt.AlignmentFlag.AlignCenter, f"{100 * share:.0f}{unit}"
            )


class Legend(QFrame):
    """A quiet sheet in the canvas' upper right corner.

    Signals:
        layer_switched(sample, on). colour_chosen(PathColourBy).
    """

    layer_switched = Signal(PathLineKind, bool)
    colour_chosen = Signal(PathColourBy)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent)
        self._theme, self._folded_for_room = LIGHT, False
        self.setFixedWidth(170)
        column = QVBoxLayout(self)
        column.setContentsMargins(12, 10, 12, 10)
        column.setSpacing(0)
        column.addLayout(self._head())
        column.addSpacing(4)
        self.body = QWidget()
        column.addWidget(self.body)
        column = QVBoxLayout(self.body)
        column.setContentsMargins(0, 0, 0, 0)
        column.setSpacing(0)
        self.rows: dict[PathLineKind, LegendRow] = {}
        for sample in (sample for sample in PathLineKind if sample is not PathLineKind.WEDGES):
            row = LegendRow(sample)
            row.toggled.connect(lambda on, s=sample: self.layer_switched.emit(s, on))
            self.rows[sample] = row
            column.addWidget(row)
        column.addSpacing(8)
        column.addWidget(hairline())
        column.addSpacing(8)
        column.addWidget(muted("Colour by"))
        self.colour = ChoiceField(
            "", [(PathColourBy.TOOL, "Tool"), (PathColourBy.REGION, "Region"), (PathColourBy.ENGAGEMENT, "Load")]
        )
        self.colour.buttons[PathColourBy.ENGAGEMENT].setToolTip("How much of the diameter is engaged along the path")
        self.colour.show_value(PathColourBy.TOOL)
        self.colour.chosen.connect(self._choose_colour)
        column.addWidget(self.colour)
        self.scale = EngagementScale()
        self.scale.hide()
        column.addWidget(self.scale)

    def _head(self) -> QHBoxLayout:
        head = QHBoxLayout()
        self.fold = IconButton("up", "Fold the legend")
        self.fold.setCheckable(True)
        self.fold.toggled.connect(self._fold)
        head.addWidget(heading("Legend"))
        head.addStretch(1)
        head.addWidget(self.fold)
        return head

    def fit_into(self, room: int) -> None:
        """Fold when there are fewer px of height than the sheet needs, and unfold again when there are enough."""
        layout = self.layout()
        folded_px = (
            layout.minimumSize().height()
            if layout is not None and self.fold.isChecked()
            else self.height() - self.body.height()
        )
        needed = folded_px + self.body.sizeHint().height()
        if needed > room and not self.fold.isChecked():
            self._folded_for_room = True
            self.fold.setChecked(True)
        elif needed <= room and self._folded_for_room:
            self.fold.setChecked(False)
            self._folded_for_room = False

    def _fold(self, folded: bool) -> None:
        self.body.setVisible(not folded)
        self.fold.show_icon("down" if folded else "up", "Unfold the legend" if folded else "Fold the legend")
        self.adjustSize()

    def _choose_colour(self, by: PathColourBy) -> None:
        for row in self.rows.values():
            row.line.set_any_colour(by is not PathColourBy.TOOL)
        self.scale.setVisible(by is PathColourBy.ENGAGEMENT)
        self._fit()
        self.colour_chosen.emit(by)

    def set_theme(self, theme: Theme) -> None:
        """Follow the theme."""
        self._theme = theme
        self.update()

    def show_left(self, left: bool, unreachable: bool) -> None:
        """Have entries for what is left on the floor only when there is some."""
        self.rows[PathLineKind.LEFT].setVisible(left)
        self.rows[PathLineKind.UNREACHABLE].setVisible(unreachable)
        self._fit()

    def _fit(self) -> None:
        """Take the height of the rows that are shown."""
        for widget in (self.body, self):
            layout = widget.layout()
            if layout is not None:
                layout.activate()
        self.adjustSize()

    def show_job(self, job: Job) -> None:
        """Name the tools of the paths, and have entries for rest machining and keep-out areas only when there are
        any.
        """
        for sample in (PathLineKind.POCKET, PathLineKind.REST, PathLineKind.CONTOUR):
            self.rows[sample].label.setText(f"{sample.value} {_tools(job.operations, sample)}".strip())
        self.rows[PathLineKind.REST].setVisible(bool(_tools(job.operations, PathLineKind.REST)))
        self.rows[PathLineKind.CLAMP].setVisible(bool(job.keep_out_layers))
        self._fit()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep clicks beside a row from reaching the canvas."""
        event.accept()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the sheet: the canvas' own colour, nearly covering."""
        ground = QColor(self._theme.canvas)
        ground.setAlphaF(0.92)
        QPainter(self).fillRect(self.rect(), ground)


def _tools(operations: tuple[Operation, ...], sample: PathLineKind) -> str:
    numbers = dict.fromkeys(op.cut.tool for op in operations if sample_of(op) is sample and op.cut.enabled)
    return " ".join(f"T{number}" for number in numbers)
