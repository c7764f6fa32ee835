"""A quiet sheet in the upper right corner of a picture: what its lines and colours mean; it can be folded."""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import QSize, Qt
from PySide6.QtGui import QColor, QMouseEvent, QPainter, QPaintEvent
from PySide6.QtWidgets import QFrame, QHBoxLayout, QLabel, QSizePolicy, QToolButton, QWidget

from .boxes import h_box, v_box
from .catalogue import tr
from .icons import IconButton
from .labels import Elided, set_role
from .samples import LineSample, PathLineKind
from .section import hairline
from .themed import Themed

_GAP_PX = 8
_MOST_OF_WIDTH = 0.4
_BESIDE_PX = 76
"""What of a sheet's width is beside the words of a row."""


class LegendRow(QToolButton):
    """One kind of line; a click shows or hides it."""

    def __init__(self, sample: PathLineKind, words: str = "") -> None:
        """Make one; `words` name it where those of the sample do not."""
        super().__init__()
        words = words or sample.value
        self.setCheckable(True)
        self.setChecked(True)
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFixedHeight(24)
        self.setSizePolicy(QSizePolicy.Policy.Expanding, QSizePolicy.Policy.Fixed)
        self.line, self.label = LineSample(sample), Elided(words)
        self.setAccessibleName(f"Show {words.lower()}")
        self.setToolTip(f"Show or hide: {words.lower()}")
        row = h_box(self, (4, 0, 8, 0), 10)
        row.addWidget(self.line)
        row.addWidget(self.label, 1)
        for child in (self.line, self.label):
            child.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.toggled.connect(self._show_state)

    def width_for(self, kind: str, names: Sequence[str]) -> int:
        """Return how wide a sheet is in which its name and all that it is of can be read, px."""
        return self.label.fontMetrics().horizontalAdvance(tr(" ".join((kind, *names)))) + _BESIDE_PX

    def show_names(self, kind: str, names: Sequence[str], width: int) -> None:
        """Name it, and what it is of: as many as there is room for in a sheet so many px wide; the tool tip has all."""
        room, measure = width - _BESIDE_PX, self.label.fontMetrics().horizontalAdvance
        whole = " ".join((kind, *names))
        shorter = (f"{' '.join((kind, *names[:count]))} …" for count in range(len(names) - 1, 0, -1))
        self.label.setText(next((text for text in (whole, *shorter) if measure(tr(text)) <= room), kind))
        self.setToolTip(f"Show or hide: {whole[:1].lower()}{whole[1:]}")

    def _show_state(self, on: bool) -> None:
        self.line.setEnabled(on)
        self.line.update()
        set_role(self.label, "" if on else "muted")
        font = self.label.font()
        font.setStrikeOut(not on)
        self.label.setFont(font)


class LegendSheet(Themed, QFrame):
    """A sheet with a title that folds, and a body below it.

    Attributes:
        title: over it. fold: the button that folds it. body: what is explained.
    """

    def __init__(self, parent: QWidget, title: QLabel, width: int) -> None:
        """Make an empty one, `width` px wide."""
        super().__init__(parent)
        self._folded_for_room = False
        self._fits = True
        self.setFixedWidth(width)
        self.title, self.body = title, QWidget()
        self.fold = IconButton("up", "Fold the legend")
        self.fold.setCheckable(True)
        self.fold.toggled.connect(self._fold)
        head = QHBoxLayout()
        head.addWidget(title)
        head.addStretch(1)
        head.addWidget(self.fold)
        column = v_box(self, (12, 10, 12, 10), 0)
        column.addLayout(head)
        column.addWidget(self.body)
        self._rows = v_box(self.body, (0, 4, 0, 0), 0)

    def add(self, *widgets: QWidget) -> None:
        """Put widgets below what there is."""
        for widget in widgets:
            self._rows.addWidget(widget)

    def add_gap(self, height: int) -> None:
        """Leave some px free."""
        self._rows.addSpacing(height)

    def add_line(self) -> None:
        """Draw a line between what is above and below."""
        self.add_gap(_GAP_PX)
        self.add(hairline())
        self.add_gap(_GAP_PX)

    def fit_contents(self) -> None:
        """Be as high as what is shown."""
        for widget in (self.body, self):
            layout = widget.layout()
            if layout is not None:
                layout.activate()
        self.adjustSize()

    def fit_into(self, room: QSize) -> None:
        """Fold where there is less height than the sheet needs, or so little width that it would hide much of the
        picture; unfold again where there is enough.
        """
        layout = self.layout()
        folded_px = (
            layout.minimumSize().height()
            if layout is not None and self.fold.isChecked()
            else self.height() - self.body.height()
        )
        needed = folded_px + self.body.sizeHint().height()
        fits = needed <= room.height() and self.width() <= _MOST_OF_WIDTH * room.width()
        if not fits and self._fits:
            self._folded_for_room = not self.fold.isChecked()
            self.fold.setChecked(True)
        elif fits and self._folded_for_room:
            self.fold.setChecked(False)
            self._folded_for_room = False
        self._fits = fits

    def _fold(self, folded: bool) -> None:
        self.body.setVisible(not folded)
        self.fold.show_icon("down" if folded else "up", "Unfold the legend" if folded else "Fold the legend")
        self.fit_contents()

    def mousePressEvent(self, event: QMouseEvent) -> None:  # noqa: N802 (Qt's name)
        """Keep clicks beside a row from reaching the picture."""
        event.accept()

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the sheet: the canvas' own colour, nearly covering."""
        ground = QColor(self._theme.canvas)
        ground.setAlphaF(0.92)
        QPainter(self).fillRect(self.rect(), ground)
