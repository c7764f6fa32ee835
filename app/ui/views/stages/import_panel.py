"""Beside a picture that is to become a part: what is ink, how large a pixel is, and what its lines leave open."""

from __future__ import annotations

from dataclasses import replace
from enum import Enum

from PySide6.QtCore import QSignalBlocker, Qt, Signal
from PySide6.QtWidgets import QHBoxLayout, QLabel, QListWidget, QPushButton, QScrollArea, QSlider, QWidget

from ....core.errors import HitofudeError
from ....raster.ambiguities import AmbiguityKind
from ....raster.picture_file import MM_PER_INCH
from ....raster.picture_options import InkMeaning, PictureOptions
from ...framework.boxes import give_ground, v_box
from ...framework.fields import ChoiceField, NumberField, NumberSpec, field_name
from ...framework.figures import TIMES, counted, grouped
from ...framework.labels import Elided, muted, show_words
from ...framework.samples import Switch
from ...framework.section import EDGE, hairline, heading
from ...framework.side_scroll import WIDTH
from .picture_preview import ASSUMED_DPI, PicturePreview, PictureSettings, PixelSize

_LIST_PX = 96
_DOUBTS = {
    AmbiguityKind.GAP: "Gap",
    AmbiguityKind.OPEN: "Open line",
    AmbiguityKind.JUNCTION: "Lines meet",
    AmbiguityKind.MERGED: "Thick line",
    AmbiguityKind.NARROW: "Narrow",
}
_KINDS = {
    InkMeaning.LINES: "Read as lines: what they enclose is machined.",
    InkMeaning.AREAS: "Read as areas: the ink itself is machined.",
}


class PictureAspect(Enum):
    """What is shown of the picture."""

    READING = "Reading"
    PICTURE = "Picture"


class SizeGivenBy(Enum):
    """What tells how large a pixel is."""

    DPI = "Resolution"
    POINTS = "Two points"


class ImportPanel(QWidget):
    """Fields for one picture; a change asks for another reading, which comes back by `show_preview`.

    Signals:
        requested(PictureSettings): read it like this. see_chosen(PictureAspect). place_picked(index): show this
            doubtful place.
        accepted(): make it the part. left(): leave it.

    Attributes:
        reading: what was asked for last; None = there is no picture. by: what tells the size.
    """

    requested = Signal(PictureSettings)
    see_chosen = Signal(PictureAspect)
    place_picked = Signal(int)
    accepted = Signal()
    left = Signal()

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "sidePanel")
        self.setFixedWidth(WIDTH)
        self.reading: PictureSettings | None = None
        self.by = SizeGivenBy.DPI
        self.name, self.about = Elided(role="muted"), muted()
        self.see = ChoiceField("See", [(see, see.value) for see in PictureAspect])
        self.threshold, self.level, self.otsu = QSlider(Qt.Orientation.Horizontal), muted(), QPushButton("Automatic")
        self.invert = Switch("Ink is light on dark")
        self.despeckle = NumberField(
            NumberSpec("Despeckle", "px", 0, 100_000, 0, False, "Spots of up to so many pixels are taken away.")
        )
        self.ink = ChoiceField("Ink is", [(kind, kind.value.capitalize()) for kind in InkMeaning])
        self.measure = ChoiceField("Size by", [(by, by.value) for by in SizeGivenBy])
        self.dpi = NumberField(NumberSpec("Resolution", "dpi", 1, 99_999, 2, False, "Pixels an inch."))
        self.apart = NumberField(
            NumberSpec("Apart", "mm", 0.001, 99_999, tip="How far the two points are from one another.")
        )
        self.kind, self.summary, self.ambiguities, self.list, self.wrong = (
            muted(),
            muted(),
            heading("Doubtful places"),
            QListWidget(),
            QLabel(),
        )
        self.take, self.leave = QPushButton("Use it as the part"), QPushButton("Leave it")
        self._lay_out()
        self._connect()

    def _lay_out(self) -> None:
        for label in (self.about, self.kind, self.summary, self.wrong):
            label.setWordWrap(True)
        self.wrong.setProperty("role", "error")
        self.otsu.setProperty("role", "link")
        self.otsu.setToolTip("Where it parts dark from light best (Otsu)")
        self.threshold.setRange(1, 255)
        self.threshold.setAccessibleName("Threshold")
        self.take.setProperty("role", "primary")
        self.list.setFixedHeight(_LIST_PX)
        self.list.setAccessibleName("Doubtful places")
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        inner = QWidget()
        column = v_box(inner, (EDGE, 0, EDGE, 8), 6)
        groups = (
            (self.see,),
            (
                heading("Ink"),
                self._threshold_row(),
                self._row("Light on dark", self.invert),
                self.despeckle,
                self.ink,
                self.kind,
            ),
            (heading("Size"), self.measure, self.dpi, self.apart, self.summary),
            (self.ambiguities, self.list),
        )
        for k, group in enumerate(groups):
            if k:
                column.addSpacing(4)
                column.addWidget(hairline())
                column.addSpacing(4)
            for widget in group:
                column.addWidget(widget)
        column.addStretch(1)
        area = QScrollArea()
        area.setWidget(inner)
        area.setWidgetResizable(True)
        area.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self._frame(area)

    def _frame(self, area: QScrollArea) -> None:
        """Put the name above the fields, and the buttons below them."""
        head, buttons = QHBoxLayout(), QHBoxLayout()
        head.setSpacing(12)
        head.addWidget(heading("Picture"))
        head.addWidget(self.name, 1)
        for button in (self.take, self.leave):
            buttons.addWidget(button)
        buttons.addStretch(1)
        column = v_box(self, (1, 12, 0, 12), 6)
        for row in (head, buttons):
            row.setContentsMargins(EDGE, 0, EDGE, 0)
        for label in (self.about, self.wrong):
            label.setContentsMargins(EDGE, 0, EDGE, 0)
        column.addLayout(head)
        column.addWidget(self.about)
        column.addWidget(area, 1)
        column.addWidget(hairline())
        column.addWidget(self.wrong)
        column.addLayout(buttons)

    def _threshold_row(self) -> QWidget:
        row, box = QWidget(), QHBoxLayout()
        row.setLayout(box)
        box.setContentsMargins(0, 0, 0, 0)
        box.setSpacing(8)
        self.level.setFixedWidth(self.level.fontMetrics().horizontalAdvance("255"))
        box.addWidget(field_name("Threshold"))
        for widget in (self.threshold, self.level, self.otsu):
            box.addWidget(widget)
        return row

    def _row(self, text: str, widget: QWidget) -> QWidget:
        row, box = QWidget(), QHBoxLayout()
        row.setLayout(box)
        box.setContentsMargins(0, 2, 0, 2)
        box.setSpacing(8)
        box.addWidget(field_name(text))
        box.addWidget(widget)
        box.addStretch(1)
        return row

    def _connect(self) -> None:
        self.see.chosen.connect(self.see_chosen)
        self.threshold.valueChanged.connect(lambda level: self._change(threshold=level))
        self.otsu.clicked.connect(lambda: self._change(threshold=None))
        self.invert.toggled.connect(lambda on: self._change(invert=on))
        self.despeckle.committed.connect(lambda most: self._change(despeckle=round(most)))
        self.ink.chosen.connect(lambda kind: self._change(shows=kind))
        self.measure.chosen.connect(self._choose_measure)
        self.dpi.committed.connect(lambda dpi: self._measure(PixelSize(dpi)))
        self.apart.committed.connect(self._set_apart)
        self.list.currentRowChanged.connect(self.place_picked)
        self.take.clicked.connect(self.accepted)
        self.leave.clicked.connect(self.left)

    def begin(self, preview: PicturePreview) -> None:
        """Begin with another picture."""
        self.by = SizeGivenBy.DPI
        self.reading = preview.reading
        self.name.setText(preview.reading.path.name)
        self.see.show_value(PictureAspect.READING)
        self.show_preview(preview)

    def show_preview(self, preview: PicturePreview) -> None:
        """Show how the picture was read."""
        reading, options = preview.reading, preview.reading.options
        with QSignalBlocker(self.threshold), QSignalBlocker(self.invert):
            self.threshold.setValue(preview.picture.threshold)
            self.invert.setChecked(options.invert)
        self.level.setText(str(preview.picture.threshold))
        self.otsu.setEnabled(options.threshold is not None)
        self.despeckle.show_value(options.despeckle)
        self.ink.show_value(options.shows)
        self.kind.setText(" ".join((_KINDS[preview.kind], *preview.picture.remarks)))
        with QSignalBlocker(self.list):
            self.list.clear()
            self.list.addItems([f"{_DOUBTS[place.kind]} at {place.where}" for place in preview.places])
            for k, place in enumerate(preview.places):
                self.list.item(k).setToolTip(f"At {place.where}, {place.kind.value}")
            self.list.setCurrentRow(-1)
        self.ambiguities.setText(
            f"{counted(len(preview.places), 'doubtful place')}" if preview.places else "No doubtful place"
        )
        self.list.setVisible(bool(preview.places))
        self.refuse("")
        self._show_measure(reading)

    def refuse(self, reason: str) -> None:
        """Say why the picture cannot become the part; "" = nothing is wrong."""
        show_words(self.wrong, reason)

    def add_point(self, col: float, row: float) -> None:
        """Take a point of the picture, px, as one of the two; a third one begins anew."""
        if self.reading is None or self.by is not SizeGivenBy.POINTS:
            return
        before = self.reading.measure
        points = (*before.points, (col, row)) if len(before.points) < 2 else ((col, row),)
        self._measure(replace(before, points=points))

    def _change(self, **changes: object) -> None:
        """Ask for another reading of the ink."""
        if self.reading is not None:
            options: PictureOptions = replace(self.reading.options, **changes)  # type: ignore[arg-type]
            self.reading = replace(self.reading, options=options)
            self.requested.emit(self.reading)

    def _choose_measure(self, by: SizeGivenBy) -> None:
        self.by = by
        if self.reading is not None:
            pitch = self.reading.measure.pitch
            self._measure(PixelSize(MM_PER_INCH / pitch))

    def _set_apart(self, apart: float) -> None:
        if self.reading is not None:
            self._measure(replace(self.reading.measure, apart=apart))

    def _measure(self, measure: PixelSize) -> None:
        """Take another size, unless it is none: then say why."""
        if self.reading is None:
            return
        try:
            changed = replace(self.reading, measure=measure)
            self._show_measure(changed)
        except HitofudeError as error:
            self.apart.refuse(str(error))
        else:
            self.reading = changed
            self.requested.emit(changed)

    def _show_measure(self, reading: PictureSettings) -> None:
        frame, measure = reading.frame, reading.measure
        self.measure.show_value(self.by)
        self.dpi.setVisible(self.by is SizeGivenBy.DPI)
        self.apart.setVisible(self.by is SizeGivenBy.POINTS)
        self.dpi.show_value(MM_PER_INCH / frame.pitch)
        if measure.apart is not None:
            self.apart.show_value(measure.apart)
        self.about.setText(
            f"{grouped(frame.cols, 0)} {TIMES} {grouped(frame.rows, 0)} px, {grouped(frame.cols * frame.pitch, 1)} "
            f"{TIMES} {grouped(frame.rows * frame.pitch, 1)} mm"
        )
        self.summary.setText(self._words(reading))

    def _words(self, reading: PictureSettings) -> str:
        """Return what is known of the size, or what to do next."""
        if self.by is SizeGivenBy.DPI:
            assumed = not reading.names_size and reading.measure.dpi == ASSUMED_DPI
            guess = (
                f"The file does not say how large it is; {ASSUMED_DPI:g} dpi is a guess. Type it, or measure two "
                "points."
            )
            return guess if assumed else ""
        asked = ("Click the first point in the picture.", "Click the second point.", "Type how far apart they are.")
        return (
            asked[len(reading.measure.points)]
            if reading.measure.apart is None or len(reading.measure.points) < 2
            else ""
        )
