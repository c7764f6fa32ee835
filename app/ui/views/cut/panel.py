"""Beside the cut: the verdict, the NC text in step with it, the places to look at, what mends the one that was picked,
and how far all is from the part.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QColor, QPainter, QPaintEvent, QResizeEvent, QShowEvent
from PySide6.QtWidgets import (
    QBoxLayout,
    QHBoxLayout,
    QLabel,
    QPushButton,
    QScrollArea,
    QSizePolicy,
    QVBoxLayout,
    QWidget,
)

from ...framework.boxes import empty, give_ground, h_box, put_away, v_box
from ...framework.figures import TIMES
from ...framework.labels import Elided, muted, set_role
from ...framework.section import EDGE, ListRow, hairline, heading, theme_children
from ...framework.side_scroll import WIDTH
from ...framework.theme import Theme
from ...framework.themed import Themed
from ...framework.verdict import VerdictLevel, VerdictSummary
from ...framework.width_grip import WidthGrip
from .cell_colours import ColourKey
from .findings import CutFinding, FindingColour, findings_of, level_of, sentences_of, title_of
from .histogram_plot import HistogramPlot
from .mend_row import MendRow, TrialRow
from .nc_beside import NcBeside
from .overlay_text import pitch_words
from .shown_cut import ShownCut

if TYPE_CHECKING:
    from ....usecases.mending import Mend

_ROLES = {VerdictLevel.OK: "ok", VerdictLevel.BAD: "error", VerdictLevel.REMARK: "warning", VerdictLevel.NONE: ""}
_TEXT_PX, _LEAST_LIST_PX, _ROOM_PX, _TIGHT_PX = 64, 56, 760, 640

ROOMY_PX, WIDE_PX = 1600, 420
"""From this width of the window on the panel is so wide."""

_MOST_SHARE = 0.6
"""Of the window's width, for the panel."""

_TITLE_PX = 230
"""So wide a place's title is shown whole; the words of where it lies give way first."""


class Dot(Themed, QWidget):
    """A spot of an entry's colour; a ring for what is out of reach."""

    def __init__(self, colour: FindingColour) -> None:
        super().__init__()
        self._colour = colour
        self.setFixedSize(10, 16)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the spot."""
        painter = QPainter(self)
        painter.setRenderHint(QPainter.RenderHint.Antialiasing)
        ink = colour_of(self._colour, self._theme)
        painter.setPen(ink)
        painter.setBrush(QColor(ink) if self._colour is not FindingColour.UNREACHABLE else Qt.BrushStyle.NoBrush)
        painter.drawEllipse(1, 4, 8, 8)


def colour_of(colour: FindingColour, theme: Theme) -> QColor:
    """Return an entry's colour by day or by night."""
    ink: QColor = getattr(theme, colour.value)
    return ink


class _Title(Elided):
    """A place's title; where room is short its middle gives way: the figure at its end is what it is read for."""

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Draw as much as fits."""
        painter = QPainter(self)
        painter.setPen(self.palette().color(self.foregroundRole()))
        text = self.fontMetrics().elidedText(self.text(), Qt.TextElideMode.ElideMiddle, self.width())
        painter.drawText(self.rect(), self.alignment(), text)


class CutPanel(Themed, QWidget):
    """What is known of the cut.

    Signals:
        picked(CutFinding): the user wants to see this place. line_requested(motion): and its line in the NC view.
        form_requested(): tools and stock shall be others. left(): the job's own cut shall be shown.
        mend_requested(Mend): the job shall be changed so. preview_requested(Mend): and this shall be seen before.

    Attributes:
        shown: what it tells of; None = nothing. entries: the places. chosen: the one that was picked last.
        nc: the text beside the cut. mends: the buttons that change the job. looks: those that show
            the cut as it would be then. grip: makes it wider.
    """

    picked = Signal(CutFinding)
    line_requested = Signal(int)
    form_requested = Signal()
    left = Signal()
    mend_requested = Signal(object)
    preview_requested = Signal(object)

    def __init__(self) -> None:
        super().__init__()
        give_ground(self, "sidePanel")
        self.setFixedWidth(WIDTH)
        self.shown: ShownCut | None = None
        self.entries: tuple[CutFinding, ...] = ()
        self.chosen: CutFinding | None = None
        self.rows: list[ListRow] = []
        self._listed: tuple[CutFinding, ...] = ()
        self.title, self.name, self.verdict, self.cells = heading("Cut"), Elided(role="muted"), QLabel(), muted()
        self.counted, self.sentence, self.go = heading("Places"), muted(), QPushButton("Show the line")
        self.nc, self.histogram = NcBeside(), HistogramPlot()
        self.mends: list[QPushButton] = []
        self.looks: list[QPushButton] = []
        self._mending = QVBoxLayout()
        self.inner, self.list, self.details = QWidget(), QScrollArea(), QWidget()
        self._rows = QVBoxLayout(self.inner)
        self.foreign, self.form, self.back = (
            QWidget(),
            QPushButton("Tools and stock…"),
            QPushButton("Close it"),
        )
        self._width = self._window_width = 0
        self.grip = WidthGrip(self)
        self.grip.dragged.connect(self.choose_width)
        self.grip.given_up.connect(partial(self.choose_width, 0))
        self._lay_out()
        self.go.clicked.connect(self._want_line)
        self.form.clicked.connect(self.form_requested)
        self.back.clicked.connect(self.left)

    def _lay_out(self) -> None:
        for label in (self.title, self.verdict, self.sentence):
            label.setWordWrap(True)
        self._rows.setContentsMargins(0, 0, 0, 0)
        self._rows.setSpacing(0)
        self._rows.addStretch(1)
        self.list.setWidget(self.inner)
        self.list.setWidgetResizable(True)
        self.list.setMinimumHeight(_LEAST_LIST_PX)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.nc.text.setMinimumHeight(_TEXT_PX)
        self._mending.setSpacing(4)
        details = v_box(self.details, spacing=6)
        details.addLayout(_indented(self.sentence))
        details.addLayout(_indented(self._mending))
        details.addLayout(_indented(self.go, stretch=True))
        self.details.hide()
        column = v_box(self, (1, 12, 0, 8), 6)
        for widget in (self.title, self.name, self.verdict, self.cells):
            column.addLayout(_indented(widget))
        row = h_box(self.foreign, (EDGE - 4, 0, EDGE, 0))
        for button in (self.form, self.back):
            button.setProperty("role", "link")
            row.addWidget(button)
        row.addStretch(1)
        column.addWidget(self.foreign)
        column.addWidget(hairline())
        column.addWidget(self.nc, 3)
        column.addWidget(hairline())
        column.addLayout(_indented(self.counted))
        column.addWidget(self.list, 1)
        column.addWidget(self.details)
        self.line = hairline()
        column.addWidget(self.line)
        column.addLayout(_indented(self.histogram))

    def show_cut(self, shown: ShownCut | None) -> None:
        """Tell of another cut."""
        self.shown, self.chosen = shown, None
        self.entries = findings_of(shown) if shown is not None else ()
        if self.isVisible() or not self.entries:
            self._fill()
        self.nc.show_cut(shown)
        self.show_mends(())
        self.details.hide()
        if shown is None:
            return
        grid = shown.cut.cut.before.grid
        self.name.setText(", ".join(shown.names))
        self.foreign.setVisible(shown.given is not None)
        self.verdict.setText(sentences_of(shown))
        self.cells.setText(f"{grid.cols} {TIMES} {grid.rows} cells of {pitch_words(grid.pitch)}")
        self.show_told(None)
        self.counted.setText(f"Places ({len(self.entries)})" if self.entries else "No places to look at")
        self.list.setVisible(bool(self.entries))
        self._make_room()

    def show_way_back(self, own: bool) -> None:
        """Say where the way leads that ends the look at another program: to the job's cut, if it has one."""
        self.back.setText("Back to the job's cut" if own else "Close it")

    def fit_beside(self, width: int) -> None:
        """Be wider in a wide window, of so many px, so that whole lines of NC text can be read; or as was chosen."""
        self._window_width = width
        usual = WIDE_PX if width >= ROOMY_PX else WIDTH
        self.setFixedWidth(min(max(self._width or usual, WIDTH), max(WIDTH, round(_MOST_SHARE * width))))

    def choose_width(self, width: int) -> None:
        """Be so wide from now on, px, as far as the cut keeps room; 0 = as it is by itself."""
        self._width = width
        self.fit_beside(self._window_width)

    def show_told(self, told: VerdictSummary | None) -> None:
        """Head the panel with the badge's verdict; None = there is none on this cut."""
        if self.shown is None:
            return
        self.title.setText(title_of(self.shown, told))
        set_role(self.title, _ROLES[level_of(self.shown, told)])

    def show_key(self, key: ColourKey) -> None:
        """Give the histogram the colours of the deviation."""
        if self.shown is not None and self.shown.histogram is not None:
            self.histogram.show_histogram(self.shown.histogram, key)

    def choose(self, entry: CutFinding) -> None:
        """Show what there is to say about a place, and tell that it should be seen."""
        self.chosen = entry
        self._fill()
        for row, each in zip(self.rows, self.entries, strict=True):
            row.set_chosen(each is entry)
        self.sentence.setText(entry.sentence.replace("mm2", "mm²"))
        self.go.setVisible(entry.motion >= 0)
        self.go.setText(f"Show line {entry.line} in the NC view")
        self.show_mends(())
        self.details.show()
        self._make_room()
        self.picked.emit(entry)

    def show_mends(self, mends: Sequence[Mend]) -> None:
        """Offer what mends the chosen place: a button each, and beside it what it changes."""
        self._clear_mends()
        for mend in mends:
            row = MendRow(mend)
            row.button.clicked.connect(partial(self._mend, mend))
            row.look.clicked.connect(partial(self._preview, mend))
            self.mends.append(row.button)
            self.looks.append(row.look)
            self._add_mend(row)

    def show_trial(self, mend: Mend, told: VerdictSummary) -> None:
        """Say that what is shown is what a mend would make, with the verdict on it, and ask whether it is taken."""
        self._clear_mends()
        if self.shown is not None:
            self.title.setText(f"Preview · {title_of(self.shown, told)}")
            set_role(self.title, _ROLES[level_of(self.shown, told)])
        self.name.setText(mend.words)
        row = TrialRow(mend)
        row.take.clicked.connect(partial(self._mend, mend))
        row.back.clicked.connect(self.left)
        self.mends = [row.take, row.back]
        self._add_mend(row)
        self.sentence.setText(f"{mend.words}: {mend.change}. Nothing is changed yet.")
        self.go.hide()
        self.details.show()
        self._make_room()

    def _add_mend(self, row: QWidget) -> None:
        theme_children(row, self._theme)
        self._mending.addWidget(row)

    def _clear_mends(self) -> None:
        empty(self._mending)
        self.mends, self.looks = [], []

    def _preview(self, mend: Mend, *_: object) -> None:
        self.preview_requested.emit(mend)

    def _mend(self, mend: Mend, *_: object) -> None:
        self.mend_requested.emit(mend)

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Show as much as there is room for."""
        self._make_room()

    def _make_room(self) -> None:
        """Where there is little room, what is said of a place takes that of the histogram, then that of what is said of
        the whole.
        """
        room = self.height() > (_ROOM_PX if self.details.isHidden() else _ROOM_PX + 140)
        for label in (self.verdict, self.cells):
            label.setVisible(self.details.isHidden() or self.height() > _TIGHT_PX)
        for widget in (self.histogram, self.line):
            widget.setVisible(room and self.shown is not None and self.shown.histogram is not None)

    def showEvent(self, event: QShowEvent) -> None:  # noqa: N802 (Qt's name)
        """Have a row for each place of a cut that came while the panel was not seen."""
        super().showEvent(event)
        self._fill()

    def _fill(self) -> None:
        """Have a row for each place, made once: many of them hold the window up."""
        if self._listed == self.entries:
            return
        self._listed = self.entries
        for row in self.rows:
            self._rows.removeWidget(row)
            put_away(row)
        self.rows = [self._row(entry) for entry in self.entries]
        for k, row in enumerate(self.rows):
            self._rows.insertWidget(k, row)

    def _row(self, entry: CutFinding) -> ListRow:
        dot = Dot(entry.colour)
        dot.set_theme(self._theme)
        title = _Title(entry.title)
        title.setSizePolicy(QSizePolicy.Policy.Ignored, QSizePolicy.Policy.Preferred)
        title.setMinimumWidth(min(title.sizeHint().width(), _TITLE_PX))
        where = Elided(entry.words, role="muted", shorter=(*entry.where, ""))
        row = ListRow(dot, title, where, stretch_after=-1, wide=1)
        row.setToolTip(f"{entry.sentence}\n{entry.words}".strip())
        row.call(f"{entry.title}, {entry.words}")
        row.clicked.connect(partial(self.choose, entry))
        row.stepped.connect(partial(self._step, entry))
        return row

    def _step(self, entry: CutFinding, way: int) -> None:
        """Go to the neighbour of a row."""
        at = self.entries.index(entry) + way
        if 0 <= at < len(self.rows):
            self.choose(self.entries[at])
            self.rows[at].setFocus()

    def _want_line(self) -> None:
        if self.chosen is not None and self.chosen.motion >= 0:
            self.line_requested.emit(self.chosen.motion)


def _indented(what: QWidget | QBoxLayout, stretch: bool = False) -> QHBoxLayout:
    """Return a row that keeps the panel's margins."""
    line = h_box(margins=(EDGE, 0, EDGE, 0))
    if isinstance(what, QWidget):
        line.addWidget(what)
    else:
        line.addLayout(what, 1)
    if stretch:
        line.addStretch(1)
    return line
