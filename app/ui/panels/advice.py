"""Which tool? What the drawing asks of its tools, and what each of the usual ones would do, in the side panel."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QPushButton

from ...model.tool import Tool
from ..framework.boxes import put_away
from ..framework.figures import clock, counted, grouped
from ..framework.icons import IconButton
from ..framework.labels import muted
from ..framework.section import ListRow, PanelSection, theme_children
from ..framework.themed import Themed
from .library import side_by_side

if TYPE_CHECKING:
    from ...toolpath.advice.advise import Advice, RegionAdvice, SizedPlace, ToolChoice
    from ...usecases.batch.task import BatchRow

DIAMETER_PX, SHARE_PX, LEFT_PX = 56, 64, 84
ALL = 0.99995
"""Share of an area from which all of it is said to be reached."""


class AdviceSection(Themed, PanelSection):
    """A list of tools with what each would do, and the tightest places of the drawing.

    Signals:
        closed(). for_pocket(tool), for_contour(tool): take a tool for pockets, or for contours and rest machining.
        place_requested(x, y): show a place, mm. trials_requested(tools): make the program with each of these.
    """

    closed = Signal()
    for_pocket = Signal(object)
    for_contour = Signal(object)
    place_requested = Signal(float, float)
    trials_requested = Signal(object)

    def __init__(self) -> None:
        super().__init__("Which tool?")
        close = IconButton("cancel", "Close (Esc)")
        close.clicked.connect(self.closed)
        self.head.addWidget(close)
        self.said = QLabel()
        self.said.setWordWrap(True)
        self.add_indented(self.said)
        self.rows.addSpacing(4)
        heads = (("Flat", DIAMETER_PX), ("reaches", SHARE_PX), ("leaves", LEFT_PX))
        self._head = ListRow(*(self._cell(muted(text), wide) for text, wide in heads), muted("time"), stretch_after=2)
        self._head.setFocusPolicy(Qt.FocusPolicy.NoFocus)
        self._head.setEnabled(False)
        self.rows.addWidget(self._head)
        self.pocket_button, self.contour_button = QPushButton("For pockets"), QPushButton("For contours and rest")
        self.pocket_button.clicked.connect(lambda: self._send(self.for_pocket.emit))
        self.contour_button.clicked.connect(lambda: self._send(self.for_contour.emit))
        self.trial_button = QPushButton("Make and time all")
        self.trial_button.setToolTip(
            "Makes and proves the program with each of these tools for pockets, some at a time in processes of their "
            "own; true times take the place of the estimates"
        )
        self.trial_button.clicked.connect(lambda: self.trials_requested.emit(self._timed_tools()))
        self._made: list[ListRow] = []
        self._tools: list[Tool] = []
        self._times: list[QLabel] = []
        self._places: list[QPushButton] = []
        self._chosen = -1
        self._after = self.rows.count()
        self.rows.addSpacing(8)
        self.add_indented(side_by_side(self.pocket_button, self.contour_button))
        self.add_indented(self.trial_button)
        self.rows.addSpacing(8)
        self.show_advice(None, "")

    @staticmethod
    def _cell(label: QLabel, wide: int) -> QLabel:
        label.setFixedWidth(wide)
        return label

    def show_advice(self, advice: Advice | None, instead: str) -> None:
        """Show advice, or a sentence while there is none."""
        for widget in (*self._made, *self._places):
            self.rows.removeWidget(widget)
            put_away(widget)
        self._made, self._places, self._tools, self._times, self._chosen = [], [], [], [], -1
        self.said.setText(advice.why if advice is not None else instead)
        for widget in (self._head, self.pocket_button, self.contour_button, self.trial_button):
            widget.setVisible(advice is not None)
        if advice is None:
            return
        worth = [choice for choice in advice.choices if choice.share > 0]
        for k, choice in enumerate(worth):
            self._add_choice(k, choice, advice)
        for text, spot in tight_places(advice.regions):
            self._add_place(text, spot)
        theme_children(self, self._theme)
        self._choose(next(k for k, choice in enumerate(worth) if choice.tool is advice.pocket))

    def _add_choice(self, k: int, choice: ToolChoice, advice: Advice) -> None:
        name = QLabel(f"{choice.tool.diameter:g} mm")
        best = choice.tool in (advice.pocket, advice.contour)
        name.setStyleSheet("font-weight: 600;" if best else "")
        share = "all" if choice.share > ALL else "> 99.9 %" if choice.share > 0.999 else f"{100 * choice.share:.1f} %"
        left = "" if choice.share > ALL else f"{grouped(choice.left_mm2, 1)} mm\u00b2"
        time = QLabel(clock(choice.times.total) if choice.times is not None else "")
        cells = ((name, DIAMETER_PX), (QLabel(share), SHARE_PX), (muted(left), LEFT_PX))
        row = ListRow(*(self._cell(label, wide) for label, wide in cells), time, stretch_after=2)
        row.setToolTip(
            f"{counted(choice.parts, 'area')}; the largest disc it leaves is {choice.left_disc:.2f} mm wide; "
            f"time with {advice.contour.label} for walls and rest, roughly"
        )
        row.clicked.connect(lambda: self._choose(k))
        row.stepped.connect(lambda way: self._step(k + way))
        self.rows.insertWidget(self._after + k, row)
        self._made.append(row)
        self._tools.append(choice.tool)
        self._times.append(time)

    def _timed_tools(self) -> tuple[Tool, ...]:
        """Return the tools of which there is an estimate: those that are no thinner than the contour tool."""
        return tuple(tool for tool, time in zip(self._tools, self._times, strict=True) if time.text())

    def show_trials(self, rows: Mapping[Tool, BatchRow]) -> None:
        """Show what programs take that were made and proven, instead of estimates."""
        for tool, time, made in zip(self._tools, self._times, self._made, strict=True):
            if (row := rows.get(tool)) is None:
                continue
            time.setText(row.verdict.words if row.time_s is None else clock(row.time_s))
            time.setStyleSheet("font-weight: 600;")
            left = "" if row.left_mm2 is None else f"{row.left_mm2:.2f} mm\u00b2 are left"
            made.setToolTip("\n".join(filter(None, ("Made and proven.", left, *row.findings[:1]))))

    def _add_place(self, text: str, spot: SizedPlace) -> None:
        button = QPushButton()
        button.setText(text)
        button.setProperty("role", "link")
        button.setToolTip("Show the place")
        button.setCursor(Qt.CursorShape.PointingHandCursor)
        button.clicked.connect(lambda: self.place_requested.emit(spot.x, spot.y))
        self.add_indented(button)
        self._places.append(button)

    def _step(self, k: int) -> None:
        if 0 <= k < len(self._made):
            self._made[k].setFocus()
            self._choose(k)

    def _choose(self, k: int) -> None:
        self._chosen = k
        for at, row in enumerate(self._made):
            row.set_chosen(at == k)

    def _send(self, emit: Callable[[Tool], None]) -> None:
        if 0 <= self._chosen < len(self._tools):
            emit(self._tools[self._chosen])


def tight_places(regions: tuple[RegionAdvice, ...]) -> list[tuple[str, SizedPlace]]:
    """Return the tightest places of all regions, each in a few words with where it is."""
    passage = min((region.passage for region in regions), key=lambda spot: spot.size)
    disc = max((region.disc for region in regions), key=lambda spot: spot.size)
    found = [(f"Narrowest passage {passage.size:.3f} mm", passage), (f"Largest disc {disc.size:.3f} mm", disc)]
    sharp = [region.corner for region in regions if region.corner is not None]
    round_ = [region.inner_radius for region in regions if region.inner_radius is not None]
    if sharp:
        worst = min(sharp, key=lambda spot: spot.size)
        count = counted(sum(region.corners for region in regions), "sharp inner corner")
        found.append((f"{count}, the sharpest {math.degrees(worst.size):.0f}\u00b0", worst))
    if round_:
        tight = min(round_, key=lambda spot: spot.size)
        found.append((f"Smallest inner radius {tight.size:.3f} mm", tight))
    return found
