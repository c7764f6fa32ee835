"""Figure 11 in the window: how long each way to compute heights takes here, on the die or on one's own program."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QPushButton, QWidget

from ...framework.boxes import v_box
from ...framework.fields import ChoiceField
from ...framework.labels import muted, show_words
from ...framework.section import hairline, heading

if TYPE_CHECKING:
    from ....exhibits.figure_eleven import FigureEleven

_CELLS = 512


class FigureElevenForm(QWidget):
    """How finely to measure, the button that does, and the table.

    Signals:
        requested(): measure, or leave it while that is done.
    """

    requested = Signal()

    def __init__(self) -> None:
        super().__init__()
        self.cells = ChoiceField("Cells", [(cells, str(cells)) for cells in (256, 512, 1024)])
        self.cells.setToolTip("Along the longer side of the stock")
        self.cells.show_value(_CELLS)
        self.measure = QPushButton("Measure figure 11")
        self.measure.setFixedHeight(32)
        self.measure.setToolTip("Every way to compute heights on this machine, one after the other")
        self.table, self.why = QLabel(), muted()
        self.table.setTextFormat(Qt.TextFormat.RichText)
        for label in (self.table, self.why):
            label.setWordWrap(True)
            label.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        column = v_box(self, (0, 6, 0, 0), 4)
        parts: tuple[QWidget, ...] = (hairline(), heading("Figure 11"), self.cells, self.measure, self.table, self.why)
        for part in parts:
            column.addWidget(part)
        self.show_figure(None)
        self.measure.clicked.connect(self.requested)

    def show_busy(self, busy: bool) -> None:
        """Offer to leave what is being measured."""
        self.measure.setText("Cancel" if busy else "Measure figure 11")

    def show_figure(self, figure: FigureEleven | None) -> None:
        """Show what was measured, or nothing."""
        self.table.setVisible(figure is not None)
        self.why.setVisible(figure is not None)
        if figure is None:
            return
        from ....exhibits.figure_eleven import why_slower

        self.table.setText(table_of(figure))
        self.why.setText("\n".join((*why_slower(figure), *((figure.fault,) if figure.fault else ()))))

    def show_fault(self, sentence: str) -> None:
        """Say why nothing was measured."""
        show_words(self.why, sentence)


def table_of(figure: FigureEleven) -> str:
    """Return the seconds of each way, and how far its heights are from those of record, as rich text."""
    from ....exhibits.figure_eleven import HeightMethod

    rows = []
    for row in figure.rows:
        rows.append(f"<tr><td colspan='3'><b>{escape(row.name)}</b>, {row.program.moves:,} moves</td></tr>")
        for way in HeightMethod:
            took, apart = row.seconds.get(way), row.apart.get(way)
            seconds = "-" if took is None else f"{took:.3f} s"
            off = "" if apart is None else f"{apart.largest:.2g} mm"
            rows.append(f"<tr><td>{way.value}&nbsp;</td><td align='right'>{seconds}&nbsp;</td><td>{off}</td></tr>")
    return f"<table cellspacing='0' cellpadding='1'>{''.join(rows)}</table>"
