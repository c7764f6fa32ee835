"""The verdict badge, and the list of findings that a click on it opens."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from PySide6.QtCore import QPoint, QSize, Qt, QTimer, Signal
from PySide6.QtGui import QPaintEvent
from PySide6.QtWidgets import (
    QFrame,
    QLabel,
    QPushButton,
    QScrollArea,
    QStyle,
    QStyleOptionButton,
    QStylePainter,
    QWidget,
)

from ....model.finding import Finding
from ...framework.boxes import empty, h_box, v_box
from ...framework.catalogue import tr
from ...framework.controller import OfferedMend
from ...framework.figures import counted
from ...framework.labels import muted, restyle
from ...framework.section import ListRow, heading
from ...framework.verdict import VerdictLevel, VerdictSummary, finding_level, short, worst_first

MendsOf = Callable[[Finding], Sequence[OfferedMend]]

_TURN = "◐◓◑◒"
_TURN_MS = 150
_TEXT_PX, _BUTTON_PX = 472, 24
_LEAST_PX = 120
_PART = " · "


class Badge(QPushButton):
    """The product in one line: grey, turning, green with figures, or the worst finding.

    Where room is short, whole parts of the line give way, the last ones first; the tool tip has them all.
    """

    def __init__(self) -> None:
        super().__init__()
        self.setProperty("role", "badge")
        self.setCursor(Qt.CursorShape.PointingHandCursor)
        self.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        self.setFixedHeight(24)
        self._turn = 0
        self._timer = QTimer(self)
        self._timer.setInterval(_TURN_MS)
        self._timer.timeout.connect(self._advance)
        self.show_verdict(VerdictSummary(VerdictLevel.NONE, "Not computed"))

    def show_verdict(self, verdict: VerdictSummary) -> None:
        """Show a verdict that stands."""
        self._timer.stop()
        self.setToolTip("\n".join(filter(None, (verdict.text if _PART in verdict.text else "", verdict.tip))))
        self._show(verdict.level, verdict.text)

    def show_running(self) -> None:
        """Turn while a job runs."""
        if not self._timer.isActive():
            self._timer.start()
            self._advance()

    def minimumSizeHint(self) -> QSize:  # noqa: N802 (Qt's name)
        """Room for the first words."""
        return QSize(_LEAST_PX, super().minimumSizeHint().height())

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint the button with as much of its line as fits."""
        option = QStyleOptionButton()
        self.initStyleOption(option)
        option.text = self.fitting(self.width() - (self.sizeHint().width() - self._width_of(self.text())))
        QStylePainter(self).drawControl(QStyle.ControlElement.CE_PushButton, option)

    def fitting(self, width: int) -> str:
        """Return as much of the line as fits in a width, px."""
        parts = self.text().split(_PART)
        for count in range(len(parts), 0, -1):
            text = _PART.join(parts[:count]) + ("" if count == len(parts) else f"{_PART}…")
            if self._width_of(text) <= width:
                return text
        return self.fontMetrics().elidedText(parts[0], Qt.TextElideMode.ElideRight, width)

    def _width_of(self, text: str) -> int:
        return self.fontMetrics().horizontalAdvance(text)

    def _advance(self) -> None:
        self._turn = (self._turn + 1) % len(_TURN)
        self._show(VerdictLevel.NONE, f"{_TURN[self._turn]} Computing")

    def _show(self, level: VerdictLevel, text: str) -> None:
        self.setText(text)
        self.setAccessibleName(f"Verdict: {text}")
        if self.property("verdict") != level.value:
            self.setProperty("verdict", level.value)
            restyle(self)


class FindingsList(QFrame):
    """Every finding, worst first; a click goes to its place, a button mends what one button can.

    Signals:
        picked(finding). left_out(layer): what is on it shall not be machined.
    """

    picked = Signal(Finding)
    left_out = Signal(str)

    def __init__(self, parent: QWidget) -> None:
        super().__init__(parent, Qt.WindowType.Popup)
        self.setObjectName("findings")
        self.rows: list[ListRow] = []
        self._layers: frozenset[str] = frozenset()
        self._mends: MendsOf = _no_mends
        self._column = v_box(self, (0, 12, 0, 8), 0)

    def show_findings(
        self,
        findings: tuple[Finding, ...],
        above: QWidget,
        empty: str,
        layers: frozenset[str] = frozenset(),
        mends: MendsOf | None = None,
    ) -> None:
        """Open above a widget.

        Args:
            findings: what to list, in any order.
            above: the badge; the list's right edge is the badge's.
            empty: what to say when there are none.
            layers: that can be left out. mends: tells what mends a finding; None = nothing does.
        """
        self._clear()
        self._layers, self._mends = layers, mends or _no_mends
        self._add_title(_count_words(findings))
        self._column.addWidget(self._list(findings) if findings else self._sentence(empty))
        self._open_above(above)

    def show_failure(
        self, error: str, findings: tuple[Finding, ...], above: QWidget, layers: frozenset[str] = frozenset()
    ) -> None:
        """Open above a widget, headed by why nothing could be computed.

        Args:
            error: why, a sentence.
            findings: what is known all the same, such as of the drawing. above, layers: as of `show_findings`.
        """
        self._clear()
        self._layers, self._mends = layers, _no_mends
        self._add_title("Could not be computed")
        self._column.addWidget(self._sentence(error))
        if findings:  # that there is none else is not known
            self._add_title(_count_words(findings, none=""))
            self._column.addWidget(self._list(findings))
        self._open_above(above)

    def _add_title(self, words: str) -> None:
        title = heading(words)
        title.setContentsMargins(16, 0, 16, 6)
        self._column.addWidget(title)

    def _open_above(self, above: QWidget) -> None:
        """Be as large as what is listed, with the right edge at that of a widget."""
        self.setFixedWidth(520)
        self.adjustSize()
        corner = above.mapToGlobal(QPoint(above.width() - self.width(), -self.height() - 4))
        self.move(corner)
        self.show()

    def _clear(self) -> None:
        self.rows = []
        empty(self._column)

    def _sentence(self, text: str) -> QLabel:
        made = muted(text)
        made.setWordWrap(True)
        made.setContentsMargins(16, 0, 16, 8)
        return made

    def _list(self, findings: tuple[Finding, ...]) -> QWidget:
        inner = QWidget()
        column = v_box(inner, spacing=0)
        for finding in worst_first(findings):
            column.addWidget(self._row(finding))
        area = QScrollArea()
        area.setWidgetResizable(True)
        area.setWidget(inner)
        area.setFixedHeight(min(inner.sizeHint().height(), 360))
        return area

    def _row(self, finding: Finding) -> ListRow:
        label = QLabel(tr(finding.text.replace("mm2", "mm²")))  # now, since its height is fixed
        label.setWordWrap(True)
        label.setFixedWidth(_TEXT_PX)
        label.setToolTip(short(finding))
        if finding_level(finding) is VerdictLevel.BAD:
            label.setProperty("role", "error")
        elif not finding.counts:
            label.setProperty("role", "muted")
        buttons = [self._hiding(finding.layer)] if finding.layer in self._layers else []
        buttons += [self._mending(mend) for mend in self._mends(finding)]
        row = ListRow(_above(label, buttons) if buttons else label)
        row.setFixedHeight(label.heightForWidth(_TEXT_PX) + 12 + (_BUTTON_PX if buttons else 0))
        row.call(label.text())
        self.rows.append(row)
        if finding.entity_ids or finding.x is not None:
            row.setCursor(Qt.CursorShape.PointingHandCursor)
            row.clicked.connect(lambda: self._pick(finding))
        else:
            row.setProperty("row", "false")
            row.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        return row

    def _hiding(self, layer: str) -> QPushButton:
        button = self._button(f"Hide layer {layer}", "What is on a hidden layer is not machined")
        button.clicked.connect(lambda: self.left_out.emit(layer))
        return button

    def _mending(self, mend: OfferedMend) -> QPushButton:
        tip = f"{mend.words}: {mend.change}. The paths are computed again; Ctrl+Z takes it back."
        button = self._button(mend.words, tip)
        button.clicked.connect(lambda: mend.act())
        return button

    def _button(self, words: str, tip: str) -> QPushButton:
        button = QPushButton(words)
        button.setProperty("role", "link")
        button.setToolTip(tip)
        button.setFocusPolicy(Qt.FocusPolicy.TabFocus)
        button.clicked.connect(self.hide)
        return button

    def _pick(self, finding: Finding) -> None:
        self.hide()
        self.picked.emit(finding)


def _count_words(findings: tuple[Finding, ...], none: str = "No findings") -> str:
    """Return how many findings there are, and remarks: "2 findings, 1 remark"; `none` stands for 0 findings."""
    counting = sum(f.counts for f in findings)
    remarks = counted(len(findings) - counting, "remark") if len(findings) > counting else ""
    return ", ".join(filter(None, (counted(counting, "finding") if counting else none, remarks)))


def _no_mends(_: Finding) -> tuple[OfferedMend, ...]:
    return ()


def _above(label: QLabel, buttons: Sequence[QPushButton]) -> QWidget:
    """Return the label above a row of buttons."""
    both = QWidget()
    column = v_box(both, (0, 6, 0, 4), 0)
    column.addWidget(label)
    row = h_box(spacing=4)
    column.addLayout(row)  # before anything stands in it, as in `PanelSection.add_indented`
    for button in buttons:
        row.addWidget(button)
    row.addStretch(1)
    return both
