"""The chain codes that a step has found or read: a list, the code of the chosen one as text, and what its digits
mean.
"""

from __future__ import annotations

from collections.abc import Sequence

from PySide6.QtCore import Qt, Signal
from PySide6.QtGui import QGuiApplication
from PySide6.QtWidgets import QListWidget, QPlainTextEdit, QWidget

from ....raster.trace import PixelChain
from ...framework.boxes import h_box, v_box
from ...framework.figures import counted
from ...framework.icons import IconButton
from ...framework.section import heading
from ...framework.theme import mono_font
from .direction_rose import DirectionRose

_LIST_PX, _TEXT_PX, _MOST_SHOWN, _MOST_DIGITS = 96, 132, 300, 20_000


class ChainsPanel(QWidget):
    """Chains of one stage.

    Signals:
        picked(index): light this chain up; -1 = none.

    Attributes:
        chains: what is listed; of a great many only the first, which the heading says.
    """

    picked = Signal(int)

    def __init__(self) -> None:
        super().__init__()
        self.chains: tuple[PixelChain, ...] = ()
        self.title, self.copy = heading("Chain code"), IconButton("copy", "Copy all chain codes of this step")
        self.list, self.text, self.rose = QListWidget(), QPlainTextEdit(), DirectionRose()
        self._lay_out()
        self._show_text(-1)
        self.list.currentRowChanged.connect(self._choose)
        self.copy.clicked.connect(self.copy_all)

    def _lay_out(self) -> None:
        head = h_box()
        head.addWidget(self.title)
        head.addStretch(1)
        head.addWidget(self.copy)
        self.list.setFixedHeight(_LIST_PX)
        self.list.setHorizontalScrollBarPolicy(Qt.ScrollBarPolicy.ScrollBarAlwaysOff)
        self.list.setAccessibleName("Contour lines of this step")
        self.list.setToolTip("Column and row of the start pixel S, and how long the code is")
        self.text.setReadOnly(True)
        self.text.setFont(mono_font())
        self.text.setFixedHeight(_TEXT_PX)
        self.text.setAccessibleName("Chain code")
        self.text.setObjectName("chainText")
        above = h_box(spacing=8)
        above.addWidget(self.list, 1)
        above.addWidget(self.rose)
        column = v_box(self, spacing=6)
        column.addLayout(head)
        column.addLayout(above)
        column.addWidget(self.text)

    def show_chains(self, chains: Sequence[PixelChain]) -> None:
        """List other chains, none of them chosen."""
        if not chains and not self.chains:
            return
        self.chains = tuple(chains)
        self.list.blockSignals(True)
        self.list.clear()
        self.list.addItems([_title(k, chain) for k, chain in enumerate(self.chains[:_MOST_SHOWN])])
        self.list.setCurrentRow(-1)
        self.list.blockSignals(False)
        self.title.setText(f"Chain code of {counted(len(self.chains), 'line')}" if self.chains else "Chain code")
        self._show_text(-1)

    def choose(self, index: int) -> None:
        """Choose a chain, without telling; -1 = none."""
        self.list.blockSignals(True)
        self.list.setCurrentRow(index if index < self.list.count() else -1)
        self.list.blockSignals(False)
        self._show_text(index)

    def copy_all(self) -> None:
        """Put the codes of all chains, a line each, on the clipboard."""
        QGuiApplication.clipboard().setText("".join(f"{chain.text()}\n" for chain in self.chains))

    def _choose(self, index: int) -> None:
        self._show_text(index)
        self.picked.emit(index)

    def _show_text(self, index: int) -> None:
        if index < 0:
            self.text.setPlainText("")
            self.text.setPlaceholderText(
                "Click a line to see its code: row, column of S, then a digit for each step."
                if self.chains
                else "This step traces no line."
            )
            return
        code = self.chains[index].text()
        self.text.setPlainText(code if len(code) <= _MOST_DIGITS else f"{code[:_MOST_DIGITS]}…")


def _title(index: int, chain: PixelChain) -> str:
    row, col = chain.start
    return f"{index + 1}   {col}, {row}   {counted(len(chain.directions), 'step')}"
