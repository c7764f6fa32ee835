"""Beside the stages: what the step does and what was settled, its chain codes, the fill's rules, and how fine the
bitmap is.
"""

from __future__ import annotations

from enum import Enum

import numpy as np
from PySide6.QtCore import Qt, Signal
from PySide6.QtWidgets import QLabel, QWidget

from ....usecases.pixels.options import BitmapSize
from ...framework.boxes import v_box
from ...framework.fields import ChoiceField, NumberField, NumberSpec
from ...framework.figures import TIMES, counted, grouped
from ...framework.labels import muted, set_role
from ...framework.section import EDGE, hairline, heading
from ...framework.side_scroll import SideScroll
from .chains_panel import ChainsPanel
from .film import FilmFrame
from .film_set import FilmSet
from .step_notes import note

LEAST, MOST = 100, 2000
"""Rows and columns that can be asked for."""

_LEAST_ROUND = 16
"""Rows and columns of a bitmap that is as large as it must be, at the least."""

BY_THE_RULE = "Curves that operations choose were unknown in 1986: this is how it machines the whole drawing."
_TOLD_PX = 208
"""Height that nearly all explanations fit in, so that what is below stays where it is while stages follow one
another.
"""


class FillRules(Enum):
    """Which rules mark R in the fill."""

    SETTLED = "Settled"
    PUBLISHED = "Published"


class StagesPanel(SideScroll):
    """Words for one stage, and what the whole film is made with.

    Signals:
        chain_picked(index): light this chain up. rules_chosen(FillRules): fill by these. size_chosen(BitmapSize): see
        it as finely.
    """

    chain_picked = Signal(int)
    rules_chosen = Signal(FillRules)
    size_chosen = Signal(BitmapSize)

    def __init__(self) -> None:
        super().__init__((EDGE + 1, 12, EDGE, 12), 6)
        self.title, self.place, self.sentence, self.notes = heading(""), muted(), QLabel(), muted()
        self.rules = ChoiceField("Fill", [(rules, rules.value) for rules in FillRules])
        self.wrong, self.chains = QLabel(), ChainsPanel()
        self.points = NumberField(
            NumberSpec("Resolution", "px", LEAST, MOST, 0, False, "Rows and columns of the bitmap; in 1986, 400.")
        )
        self.pitch = NumberField(
            NumberSpec(
                "Pitch", "mm", 0.0001, 1000, 4, True, "Size of a pixel; the bitmap is then as large as it must be."
            )
        )
        self.points.show_value(BitmapSize().points)
        self.pitch.hide()  # known with the first bitmap
        self.bitmap, self.given_up, self.rule, self.finding = muted(), muted(), muted(), QLabel()
        self.finding.setProperty("role", "error")
        self._shape = (0, 0)
        self._told = QWidget()
        self._lines = [hairline(), hairline()]
        self._of_still: tuple[QWidget, ...] = (
            self.place,
            self.sentence,
            self.notes,
            self.rules,
            self.wrong,
            self.chains,
            *self._lines,
            self.given_up,
            self.rule,
        )
        self._lay_out()
        self.rules.chosen.connect(self.rules_chosen)
        self.chains.picked.connect(self.chain_picked)
        self.points.committed.connect(lambda value: self.size_chosen.emit(BitmapSize(round(value))))
        self.pitch.committed.connect(lambda value: self.size_chosen.emit(BitmapSize(_LEAST_ROUND, value)))

    def _lay_out(self) -> None:
        made = (self.bitmap, self.given_up, self.rule, self.finding)
        for label in (self.title, self.sentence, self.notes, self.wrong, *made):
            label.setWordWrap(True)
        self.sentence.setTextInteractionFlags(Qt.TextInteractionFlag.TextSelectableByMouse)
        self.rules.show_value(FillRules.SETTLED)
        column = self.column
        told = v_box(self._told, spacing=6)
        for label in (self.title, self.place, self.sentence, self.notes):
            told.addWidget(label)
        told.addStretch(1)
        self._told.setMinimumHeight(_TOLD_PX)
        bitmap = (self.rules, self.wrong, self.points, self.pitch, *made)
        column.addWidget(self._told)
        for line, group in ((self._lines[0], (self.chains,)), (self._lines[1], bitmap)):
            column.addSpacing(2)
            column.addWidget(line)
            column.addSpacing(2)
            for each in group:
                column.addWidget(each)
        column.addStretch(1)

    def show_still(self, still: FilmFrame | None) -> None:
        """Tell of another stage; of none, only how fine the bitmap is."""
        for widget in self._of_still:
            widget.setVisible(still is not None)
        self.finding.setVisible(still is not None and bool(self.finding.text()))
        if still is None:
            self.title.setText("Stages")
            return
        self.title.setText(f"{still.number}  {still.name}")
        self.place.setText(_place(still))
        self.sentence.setText(still.sentence)
        self.notes.setText(note(still.number, self._shape))
        self.chains.show_chains(still.chains)

    def show_reel(self, reel: FilmSet) -> None:
        """Tell of another film: its fill, its bitmap, and what that costs."""
        frame, given_up = reel.part.frame, reel.made.given_up
        self._shape = frame.rows, frame.cols
        self.rules.show_value(FillRules.PUBLISHED if reel.request.published else FillRules.SETTLED)
        self._show_wrong(reel)
        picture = reel.request.pixels is not None
        for field in (self.points, self.pitch):
            field.setVisible(not picture)
        self.points.show_value(max(frame.rows, frame.cols))
        self.pitch.show_value(frame.pitch)
        self.bitmap.setVisible(picture)
        self.bitmap.setText(
            f"The picture's own {grouped(frame.cols, 0)} {TIMES} {grouped(frame.rows, 0)} px of {frame.pitch:.4g} mm"
        )
        cost = (
            f"Never gouging costs up to {given_up.most_mm:.3f} mm at the walls, {given_up.mean_mm:.3f} mm in the mean."
        )
        paths = any(each.levels for each in reel.made.paths)
        self.given_up.setText(f"{cost}{_rough(reel.made.unsmoothed)}" if paths else "")
        self.rule.setText("" if reel.job is reel.request.job else BY_THE_RULE)
        self.finding.setText(_finding(reel))
        self.finding.setVisible(bool(self.finding.text()))

    def _show_wrong(self, reel: FilmSet) -> None:
        masks = [still.wrong for still in reel.film.stills if still.wrong is not None]
        count = int(np.count_nonzero(masks[0])) if masks else 0
        if not reel.request.published:
            text, role = "Always right: parity comes from the crossings, not from the look of the pixels.", "muted"
        elif count:
            text, role = (
                f"The rules as published fill {counted(count, 'pixel')} wrongly here; they are red in 208 and 130.",
                "error",
            )
        else:
            text, role = "The rules as published get every pixel of this part right.", "ok"
        self.wrong.setText(text)
        set_role(self.wrong, role)


def _place(still: FilmFrame) -> str:
    """Return which region and which turn a stage is about."""
    region = f"Region {still.region}" if still.region else "All regions"
    what = "peel" if 301 <= still.number <= 305 else "path"
    return f"{region}, {what} {still.turn}" if still.number in (*range(301, 306), 145, 146, 147) else region


def _finding(reel: FilmSet) -> str:
    """Return what is wrong with the paths, the worst of it."""
    counting = [finding for finding in reel.made.program.findings if finding.counts]
    if not reel.made.paths and not counting:
        return "On pixels only pockets, and contours inside the walls, are cut; no operation is one of them."
    more = f" {counted(len(counting) - 1, 'more finding')}." if len(counting) > 1 else ""
    return f"{counting[0].text}{more}" if counting else ""


def _rough(count: int) -> str:
    if not count:
        return ""
    paths = counted(count, "path stays a line", "paths stay lines")
    return f" {paths} from pixel to pixel, since nothing smoother keeps clear of the walls."
