"""The sheet beside the cut: what its colours mean, which paths lie over it, and where it is cut open."""

from __future__ import annotations

from enum import Enum

from PySide6.QtCore import QRectF, Qt, Signal
from PySide6.QtGui import QColor, QImage, QPainter, QPaintEvent
from PySide6.QtWidgets import QSlider, QWidget

from ...framework.catalogue import tr
from ...framework.fields import ChoiceField, ListField
from ...framework.legend import LegendRow, LegendSheet
from ...framework.samples import PathLineKind
from ...framework.section import heading
from ...framework.theme import text_font
from ...framework.themed import Themed
from .cell_colours import STEPS, ColourKey, CutColourBy

WIDTH = 228
_BAR_PX, _SCALE_PX, _ROW_PX, _PAD_PX = 10, 148, 22, 8
_SLIDES, _CHOICE_PX = 1000, 102
_CUTTING = "Cutting moves"
"""A program's feed is a pocket's, a hole's or a pass over a surface; which one, a text does not tell."""


class SectionAxis(Enum):
    """Across which axis the stock is cut open."""

    WHOLE = "Whole"
    X = "X"
    Y = "Y"


class ColourScale(Themed, QWidget):
    """The scale of the colours, or their names."""

    def __init__(self) -> None:
        super().__init__()
        self._key: ColourKey | None = None

    def show_key(self, key: ColourKey) -> None:
        """Explain other colours."""
        self._key = key
        self.setFixedHeight(_SCALE_PX + 2 * _PAD_PX if key.ticks else _ROW_PX * len(key.names))
        self.setAccessibleDescription(", ".join([tick.text for tick in key.ticks] + [name for _, name in key.names]))
        self.update()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the colours and what they mean."""
        if self._key is None:
            return
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        painter.setFont(text_font())
        if self._key.ticks:
            self._paint_scale(painter, self._key)
        else:
            self._paint_names(painter, self._key)

    def _paint_scale(self, painter: QPainter, key: ColourKey) -> None:
        steps = key.palette[:STEPS][::-1, None].copy()
        bar = QRectF(0, _PAD_PX, _BAR_PX, _SCALE_PX)
        painter.drawImage(bar, QImage(steps.tobytes(), 1, STEPS, 4, QImage.Format.Format_RGBA8888))
        for tick in key.ticks:
            y = bar.bottom() - tick.at * bar.height()
            painter.setPen(self._theme.muted)
            painter.drawLine(_BAR_PX + 3, round(y), _BAR_PX + 8, round(y))
            text = QRectF(_BAR_PX + 14, y - 9, 80, 18)
            painter.drawText(text.translated(76, 0), Qt.AlignmentFlag.AlignVCenter, tr(tick.remark))
            painter.setPen(self._theme.ink)
            painter.drawText(text, Qt.AlignmentFlag.AlignVCenter, tr(tick.text))

    def _paint_names(self, painter: QPainter, key: ColourKey) -> None:
        for k, (colour, name) in enumerate(key.names):
            middle = (k + 0.5) * _ROW_PX
            painter.setPen(Qt.PenStyle.NoPen)
            painter.setBrush(QColor(*colour))
            painter.drawRoundedRect(QRectF(0, middle - 6, 12, 12), 2, 2)
            painter.setPen(self._theme.ink)
            painter.drawText(QRectF(22, middle - 9, self.width(), 18), Qt.AlignmentFlag.AlignVCenter, tr(name))


class CutLegend(LegendSheet):
    """A quiet sheet in the upper right corner.

    Signals:
        colour_chosen(CutColourBy). layer_switched(PathLineKind, on). wedges_switched(on). section_chosen(Side, share in
        [0, 1] of the stock).
    """

    colour_chosen = Signal(CutColourBy)
    layer_switched = Signal(PathLineKind, bool)
    wedges_switched = Signal(bool)
    section_chosen = Signal(SectionAxis, float)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, heading(CutColourBy.METAL.value), WIDTH)
        self.key = ColourScale()
        self.colour = ListField("Colour by", [(colour, colour.value) for colour in CutColourBy])
        self.colour.box.setFixedWidth(_CHOICE_PX)
        self.side = ChoiceField("Section", [(side, side.value) for side in SectionAxis], 60)
        self.side.show_value(SectionAxis.WHOLE)
        self.slider = self._slider()
        self.rows = {
            sample: LegendRow(sample, _CUTTING if sample is PathLineKind.POCKET else "")
            for sample in (PathLineKind.POCKET, PathLineKind.CONTOUR, PathLineKind.PLUNGE, PathLineKind.RAPID)
        }
        self.wedges = LegendRow(PathLineKind.WEDGES)
        self.wedges.setChecked(False)
        self.wedges.hide()
        self.add(self.key)
        self.add_gap(6)
        self.add(self.colour)
        self.add_line()
        self.add(*self.rows.values(), self.wedges)
        self.add_line()
        self.add(self.side, self.slider)
        self._connect()

    def _slider(self) -> QSlider:
        slider = QSlider(Qt.Orientation.Horizontal)
        slider.setRange(0, _SLIDES)
        slider.setAccessibleName("Place of the section")
        slider.setValue(_SLIDES // 2)
        slider.hide()
        return slider

    def _connect(self) -> None:
        self.colour.chosen.connect(self.colour_chosen)
        self.side.chosen.connect(self._choose_side)
        self.slider.valueChanged.connect(lambda _: self._tell_section())
        for sample, row in self.rows.items():
            row.toggled.connect(lambda on, s=sample: self.layer_switched.emit(s, on))
        self.wedges.toggled.connect(self.wedges_switched)

    @property
    def chosen_side(self) -> SectionAxis:
        """Across which axis the stock is cut open."""
        return next(
            side for side, button in self.side.buttons.items() if button.isChecked() and isinstance(side, SectionAxis)
        )

    def show_colours(self, colour: CutColourBy, key: ColourKey, choices: tuple[CutColourBy, ...]) -> None:
        """Explain the colours, and offer those that there can be."""
        self.title.setText(colour.value)
        self.key.show_key(key)
        self.colour.set_choices([(choice, choice.value) for choice in choices])
        self.colour.show_value(colour)
        self.fit_contents()

    def show_layers(self, present: set[PathLineKind]) -> None:
        """Have rows only for paths that there are."""
        for sample, row in self.rows.items():
            row.setVisible(sample in present)
        self.fit_contents()

    def show_wedges(self, possible: bool) -> None:
        """Have the row for the facets of a sweep, or not."""
        self.wedges.setVisible(possible)
        self.fit_contents()

    def tell_facet(self, facet: float) -> None:
        """Tell how large these facets are, mm."""
        self.wedges.label.setText(f"{PathLineKind.WEDGES.value}  d = {facet:.2g} mm")
        self.wedges.setToolTip(
            f"Show or hide what the last moves sweep: cylinders and wedges, in facets of d = {facet:.2g} mm"
        )

    def _choose_side(self, side: SectionAxis) -> None:
        self.slider.setVisible(side is not SectionAxis.WHOLE)
        self.fit_contents()
        self._tell_section()

    def _tell_section(self) -> None:
        self.section_chosen.emit(self.chosen_side, self.slider.value() / _SLIDES)
