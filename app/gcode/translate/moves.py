"""The motions of a block in another control's words: each place rounded once, arcs as that control takes them, cycles
written out where it has none that is known to do the same.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from ...model.motion import Floats, MotionKind, Motions, Nurbs
from ...model.motion_path import ArcPaths, arc_paths, fine_spline_points
from ..interpreter.block import BlockStep
from ..interpreter.codes import CYCLES, ModalGroup
from ..interpreter.dialect import DIALECT_RULES
from ..interpreter.program import EventKind, NcProgram
from ..posts import ArcCentre
from ..writer.curve_blocks import BlockFormat, curve_blocks
from ..writer.template_fields import Position, counts, numeral
from ..writer.work_moves import ArcRules, ReferenceArc, written_pieces
from .translatable import TAPPING
from .translated_text import TranslatedText

LARGEST_RADIUS = 10_000.0
"""mm; flatter arcs of a spline are lines."""

_SAME = 1e-9
"""mm; heights that differ by less are the same."""


class MotionWriter:
    """Writes the motions of a program's blocks on a sheet."""

    def __init__(self, output: TranslatedText, program: NcProgram) -> None:
        self._output, self._program = output, program
        self._motions: Motions = program.motions
        self._arcs: ArcPaths = arc_paths(program.motions)
        self._initial = self._feed = 0.0
        self._dwells = {
            (event.line, event.before): event.value for event in program.events if event.kind is EventKind.DWELL
        }

    @property
    def _unit(self) -> float:
        return self._output.modal.units.value

    def write(self, step: BlockStep) -> None:
        """Write what a block does beside its modes.

        Raises:
            InputError: it cannot be said.
        """
        once = step.block.codes.get(ModalGroup.ONCE)
        if once in ("G28", "G30", "G53"):
            self._by_machine(step, once)
        elif once in ("G10", "G92"):
            self._zero(step, once)
        elif once in ("G52", "G92.1"):
            self._zero(step, once if step.states[0].shift != step.states[1].shift else "")
        elif step.motion in CYCLES and step.rows[1] > step.rows[0]:
            self._cycle(step)
        else:
            for row in range(*step.rows):
                self._row(step, row, self._letters(step, row))

    def _letters(self, step: BlockStep, row: int) -> str:
        """Return the axes that a block names, and those along which its motion goes without: cutter compensation has
        moved it.
        """
        start, end = self._place(row, self._motions.start[row]), self._place(row, self._motions.end[row])
        return "".join(letter for k, letter in enumerate("XYZ") if step.block.has(letter.lower()) or start[k] != end[k])

    def _said(self, step: BlockStep, letters: str) -> list[str]:
        """Return length words of a block as they stand there."""
        words, rules = [], DIALECT_RULES[self._output.source.dialect]
        least = rules.least_inch if self._unit != 1.0 else rules.least_mm
        for letter in letters:
            value = step.block.get(letter.lower())
            if value is not None:
                digits = self._digits(letter)
                scaled = value * (least if letter.lower() in step.block.whole else 1.0)
                words.append(letter + self._numeral(counts(np.array([scaled]), digits)[0], digits))
        return words

    def _digits(self, letter: str) -> int:
        return int(getattr(self._output.post.digits(self._output.modal.units), letter))

    def _numeral(self, count: int, digits: int) -> str:
        return numeral(count, digits, self._output.post.words.trailing_zeros)

    def _by_machine(self, step: BlockStep, once: str) -> None:
        """Write a way to a place of the machine."""
        self._output.leave_cycle()
        head = [once, self._output.post.words.motion[MotionKind.RAPID]] if once == "G53" else [once]
        self._output.emit(" ".join([*head, *self._said(step, "XYZ")]))
        self._output.motion = ""

    def _zero(self, step: BlockStep, code: str) -> None:
        """Write what sets a zero; nothing where it stays as it is."""
        if not code:
            return
        self._output.leave_cycle()
        table = [f"L2 P{round(step.block.values['p'])}"] if code == "G10" else []
        self._output.emit(" ".join([code, *table, *self._said(step, "XYZ")]))
        self._output.motion = ""

    def _place(self, row: int, place: Floats) -> Position:
        """Return a place of a motion as counts of the last decimals, from the zero in force."""
        state = self._program.states[self._motions.state[row]]
        own = (place - np.array(state.shift)) / self._unit
        x, y, z = (counts(own[axis : axis + 1], self._digits("XYZ"[axis]))[0] for axis in range(3))
        return (x, y, z)

    def _row(self, step: BlockStep, row: int, letters: str) -> None:
        """Write one motion; of a line with the axes that are named."""
        self._feed = float(self._motions.feed[row])
        kind = MotionKind(self._motions.kind[row])
        start, end = self._place(row, self._motions.start[row]), self._place(row, self._motions.end[row])
        if kind in (MotionKind.RAPID, MotionKind.LINE):
            self._straight(step, kind, (start, end), letters)
        elif kind in (MotionKind.ARC_CW, MotionKind.ARC_CCW):
            self._arc(step, row, start, end)
        else:
            self._spline(step, row)

    def _straight(self, step: BlockStep, kind: MotionKind, ends: tuple[Position, Position], letters: str) -> None:
        words = {letter: self._axis(letter, *ends) for letter in letters}
        length = self._output.taken_length() if "Z" in letters else ""
        if words:
            self._block(step, kind, words, length)

    def _axis(self, letter: str, start: Position, end: Position) -> str:
        """Return the number of an axis word: where to, or under G91 how far."""
        axis = "XYZ".index(letter)
        count = end[axis] if self._output.modal.absolute else end[axis] - start[axis]
        return self._numeral(count, self._digits(letter))

    def _block(self, step: BlockStep, kind: MotionKind, words: dict[str, str], length: str = "") -> None:
        output = self._output
        output.leave_cycle()
        motion = output.post.words.motion[kind]
        head = [] if motion == output.motion and output.post.words.modal_motion and not length else [motion]
        feed = "" if kind is MotionKind.RAPID else output.feed_word(step, self._feed)
        body = [letter + words[letter] for letter in "XYZIJK" if letter in words]
        output.emit(" ".join([*head, *([length] if length else []), *body, *([feed] if feed else [])]))
        output.motion = motion

    def _spline(self, step: BlockStep, row: int) -> None:
        """Write a spline as lines and arcs near it, whose end is the next block's start.

        Raises:
            InputError: it lies in no plane of the control, or the block is in force in another way.
        """
        output, state = self._output, self._output.modal
        feed = output.feed_word(step, self._feed)
        own = replace(state, arc_absolute=output.post.arcs.centre is ArcCentre.ABSOLUTE)
        largest = min(output.post.arcs.largest_radius_mm, LARGEST_RADIUS)
        motions = near_arcs(self._motions.splines[row], 10.0 ** -self._digits("X") * self._unit, largest)
        if not state.absolute:
            output.emit("G90")
        for block in curve_blocks(motions, BlockFormat(output.post, own, feed.removeprefix("F"), resumed=True)):
            output.emit(block)
        if not state.absolute:
            output.emit("G91")
        output.motion = ""

    def _arc(self, step: BlockStep, row: int, start: Position, end: Position) -> None:
        """Write an arc or a helix: its centre anew, as the rounding of both ends allows."""
        output, arcs = self._output, self._arcs
        k = int(np.searchsorted(arcs.rows, row))
        u, v, w = arcs.axes[k].tolist()
        if output.waiting is not None and start[w] != end[w]:
            raise output.source.refusal(step.line, f"the tool length cannot begin in an arc on {output.post.title}")
        shift = self._program.states[self._motions.state[row]].shift
        meant = ReferenceArc(
            (complex(*arcs.centre[k]) - complex(shift[u], shift[v])) / self._unit,
            arcs.start_radius[k] / self._unit,
            arcs.end_radius[k] / self._unit,
            float(arcs.angle[k]),
            float(arcs.sweep[k]),
        )
        at = start
        rules = ArcRules.of(self._output.post, self._output.modal.units)
        for piece in written_pieces(meant, (start[u], start[v]), (end[u], end[v]), rules):
            place = list(start)
            place[u], place[v] = piece.end
            place[w] = end[w] if piece.fraction == 1.0 else round(start[w] + (end[w] - start[w]) * piece.fraction)
            to = (place[0], place[1], place[2])
            if piece.centre is None:
                self._straight(
                    step, MotionKind.LINE, (at, to), "XYZ"[u] + "XYZ"[v] + ("XYZ"[w] if to[w] != at[w] else "")
                )
            else:
                self._turn(step, MotionKind(self._motions.kind[row]), (at, to), ((u, v, w), piece.centre))
            at = to
        if at != end:
            self._straight(
                step, MotionKind.LINE, (at, end), "".join("XYZ"[axis] for axis in (u, v, w) if at[axis] != end[axis])
            )

    def _turn(
        self,
        step: BlockStep,
        kind: MotionKind,
        ends: tuple[Position, Position],
        centre: tuple[tuple[int, int, int], tuple[int, int]],
    ) -> None:
        (u, v, w), offsets = centre
        digits = self._output.post.digits(self._output.modal.units)
        words = {letter: self._axis(letter, *ends) for letter in ("XYZ"[u], "XYZ"[v])}
        if ends[0][w] != ends[1][w]:
            words["XYZ"[w]] = self._axis("XYZ"[w], *ends)
        for axis, offset in zip((u, v), offsets, strict=True):
            if self._output.post.arcs.centre is ArcCentre.ABSOLUTE:
                offset += ends[0][axis] * 10 ** (digits.I - self._digits("XYZ"[axis]))
            words["IJK"[axis]] = self._numeral(offset, digits.I)
        self._block(step, kind, words)

    def _cycle(self, step: BlockStep) -> None:
        """Write a drilling cycle: as the control's own where that is surely the same, else move by move."""
        if step.motion in TAPPING:
            self._tap(step)
            return
        if self._drilled(step):
            return
        self._output.leave_cycle()
        for row in range(*step.rows):
            self._wait(step, row)
            self._output.spin(self._program.states[self._motions.state[row]].spindle)
            self._moved(step, row)
        self._wait(step, step.rows[1])
        self._output.spin(step.states[1].spindle)

    def _moved(self, step: BlockStep, row: int) -> None:
        """Write one motion of a cycle, along the axes along which it goes."""
        moved = self._motions.end[row] != self._motions.start[row]
        self._row(step, row, "".join(letter for letter, moves in zip("XYZ", moved.tolist(), strict=True) if moves))

    def _tap(self, step: BlockStep) -> None:
        """Write a tapped hole as the control's own cycle, at feed out to R; the ways before and behind it are moves.

        Raises:
            InputError: the way out at feed goes where the tool has not come down.
        """
        output, motions = self._output, self._motions
        output.leave_cycle()
        hole = tapped_hole(motions, step)
        if hole is None:
            raise output.source.refuse(
                step, "g", step.motion, f"out of a tapped hole {output.post.title} goes at feed to R alone; use G99"
            )
        for row in range(step.rows[0], hole.into):
            self._moved(step, row)
        output.spin(self._program.states[motions.state[hole.into]].spindle)
        self._feed = float(motions.feed[hole.into])
        (x, y, top), (_, _, bottom) = (self._place(hole.into, end[hole.into]) for end in (motions.start, motions.end))
        values = (("X", x, "X"), ("Y", y, "Y"), ("Z", bottom, "Z"), ("R", top, "Z"))
        body = [letter + self._numeral(count, self._digits(like)) for letter, count, like in values]
        output.emit(" ".join(["G99", step.motion, *body, output.feed_word(step, self._feed)]).strip())
        output.emit("G80")
        output.modal = replace(output.modal, spindle=step.states[1].spindle)
        output.motion = ""
        if hole.beyond:
            self._straight(step, MotionKind.RAPID, ((x, y, top), self._place(hole.out, motions.end[hole.out])), "Z")
        for row in range(hole.out + 1, step.rows[1]):
            self._moved(step, row)

    def _wait(self, step: BlockStep, row: int) -> None:
        """Write the dwell that a cycle has before a motion."""
        seconds = self._dwells.get((step.line, row))
        if row > step.rows[0] and seconds is not None:
            self._output.dwell(step, seconds)

    def _drilled(self, step: BlockStep) -> bool:
        """Write a hole as the control's own drilling cycle; False where it is none that is surely the same."""
        output, motions, words = self._output, self._motions, self._output.post.drilling
        state = step.states[1]
        lines = [row for row in range(*step.rows) if motions.kind[row] == MotionKind.LINE]
        plain = step.motion == words.drill == "G81" and state.absolute and not state.plane and not step.block.has("lk")
        if not plain or len(lines) != 1 or output.waiting is not None:
            return False
        row, first, last = lines[0], step.rows[0], step.rows[1] - 1
        high, r, clear = float(motions.start[first, 2]), float(motions.start[row, 2]), float(motions.end[last, 2])
        initial = self._initial if output.cycle else high
        level = r if state.retract_to_r else initial
        if high < r - _SAME or abs(clear - level) > _SAME or last != row + 1:
            return False
        (_, _, top), (x, y, z) = self._place(row, motions.start[row]), self._place(row, motions.end[row])
        values = (("X", x, "X"), ("Y", y, "Y"), ("Z", z, "Z"), ("R", top, "Z"))
        body = [letter + self._numeral(count, self._digits(like)) for letter, count, like in values]
        feed = output.feed_word(step, float(motions.feed[row]))
        output.emit(
            " ".join(
                [words.to_r if state.retract_to_r else words.to_initial, words.drill, *body, *([feed] if feed else [])]
            )
        )
        output.cycle, output.motion, self._initial = words.drill, "", initial
        return True


# Tapped holes as another control leaves them: at feed to R alone, where LinuxCNC feeds up to the initial height.


_COLUMNS = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")


@dataclass(frozen=True, slots=True)
class TappedHole:
    """The motions of one tapped hole.

    Attributes:
        into, out: rows of the feeds into it and out of it.
        beyond: whether the one out of it goes on beyond R, up the way that the tool came down at rapid rate.
    """

    into: int
    out: int
    beyond: bool


def tapped_hole(motions: Motions, step: BlockStep) -> TappedHole | None:
    """Return the hole that a block taps; None where it is left in a way that no other control knows.

    Args:
        motions: of the program. step: a block under a tapping cycle that makes motions.
    """
    lines = [row for row in range(*step.rows) if motions.kind[row] == MotionKind.LINE]
    if len(lines) != 2:
        return None
    into, out = lines
    r, top = float(motions.start[into, 2]), float(motions.end[out, 2])
    if r == top:
        return TappedHole(into, out, beyond=False)
    came = into - 1
    down = (
        came >= step.rows[0]
        and motions.kind[came] == MotionKind.RAPID
        and bool(np.all(motions.start[came, :2] == motions.end[came, :2]))
    )
    return TappedHole(into, out, beyond=True) if down and r < top <= float(motions.start[came, 2]) else None


@dataclass(frozen=True, eq=False)
class LeftAtR:
    """A program whose tapped holes are all left at feed to R alone.

    Attributes:
        program: it.
        rows: (n,) of each of its motions the one of the first program that it is, -1 where it is a part of one.
        holes: how many holes are left in another way than in the first program.
    """

    program: NcProgram
    rows: NDArray[np.int64]
    holes: int


def left_at_r(program: NcProgram, steps: tuple[BlockStep, ...]) -> LeftAtR:
    """Return a program in which the way out of each tapped hole is fed to R, and rapid from there on.

    It is the way that the tool came down at rapid rate, so nothing is in it.

    Args:
        program, steps: as they were read together.
    """
    motions = program.motions
    tapping = [step for step in steps if step.motion in TAPPING and step.rows[1] > step.rows[0]]
    found = [hole for step in tapping if (hole := tapped_hole(motions, step)) is not None and hole.beyond]
    rows = np.arange(len(motions))
    if not found:
        return LeftAtR(program, rows, 0)
    into, out = np.array([hole.into for hole in found]), np.array([hole.out for hole in found])
    count = np.ones(len(motions), np.int64)
    count[out] = 2
    rows = np.repeat(rows, count)
    columns = {name: getattr(motions, name)[rows] for name in _COLUMNS}
    behind = np.concatenate([[0], np.cumsum(count)])
    fed = behind[out]
    columns["end"][fed, 2] = columns["start"][fed + 1, 2] = motions.start[into, 2]
    columns["kind"][fed + 1], columns["feed"][fed + 1] = MotionKind.RAPID, 0.0
    columns["state"][fed + 1] = motions.state[into]  # the spindle turns again as it did before the hole
    rows[fed] = rows[fed + 1] = -1
    at = behind.tolist()
    known = motions.known_from
    cut = Motions(
        **columns,
        splines={at[row]: spline for row, spline in motions.splines.items()},
        known_from=(_at(at, known[0]), _at(at, known[1]), _at(at, known[2])),
    )
    events = tuple(replace(event, before=at[event.before]) for event in program.events)
    homeward = tuple(at[row] for row in program.homeward)
    return LeftAtR(replace(program, motions=cut, events=events, homeward=homeward), rows, len(found))


def _at(behind: list[int], row: int) -> int:
    return row if row < 0 else behind[row]


# A spline as lines and arcs so near to it that another control drives the same within its last decimals.


_NEAR, _SAG = 0.6, 0.05
"""Of the last decimal: how far lines and arcs may be from the points of a spline, and its chords from it."""

_MOST = 1 << 18
"""Chords of a spline, never more."""


def near_arcs(spline: Nurbs, step: float, largest: float) -> Motions:
    """Return lines and arcs along a spline.

    Args:
        step: the last decimal, mm; what is made is proven when it is read back.
        largest: radius of an arc of the control, mm; what is flatter is a line.
    """
    points = fine_spline_points(spline, _SAG * step, _MOST)
    far = np.concatenate([[True], np.any(np.diff(points, axis=0) != 0, axis=1)])
    return fit_arcs(points[far], ArcOptions(_NEAR * step, math.pi / 6, largest)).motions
