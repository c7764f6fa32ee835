"""Holes as canned cycles: a cycle is written only where it moves exactly as the tool path does."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import islice, pairwise

import numpy as np

from ...model.moves import MoveKind, Purpose
from ..posts.post import DrillingWords
from .work_moves import MoveLists, WorkMoves

Step = tuple[MoveKind, int]
"""A move along Z and where it ends, counts of the last decimal."""


@dataclass(frozen=True, slots=True)
class CycleHole:
    """A hole as a cycle.

    Attributes:
        cycle: G words of the height at which it ends, and of the cycle.
        x, y, z, r: place, bottom, and height from which it feeds, counts of the last decimal.
        peck: depth of a step, counts; 0 = in one go.
        feed: count of the last decimal of F.
        stop: index of the move behind it.
        dwell: P word of the wait at the bottom; "" = there is none.
        start: block before the first hole of a row; "" = none.
    """

    cycle: str
    x: int
    y: int
    z: int
    r: int
    peck: int
    feed: int
    stop: int
    dwell: str = ""
    start: str = ""


@dataclass(frozen=True, slots=True)
class CycleRules:
    """The control's cycles.

    Attributes:
        words: its G words.
        scale: counts of the last decimal of Z in an out unit.
        peck_gap, chip_gap: counts.
        near: counts by which a rounded height between two pecks may be off.
        dwells: how long the operations wait at the bottom, by index, s; those that do not are left out.
        taps: the blocks before a tapping cycle, by the index of the operations that tap. left: of these, those that
            tap to the left.
    """

    words: DrillingWords
    scale: int
    peck_gap: int
    chip_gap: int
    near: int = 1
    dwells: Mapping[int, float] = field(default_factory=dict)
    taps: Mapping[int, str] = field(default_factory=dict)
    left: frozenset[int] = frozenset()

    def wait(self, operation: int) -> str:
        """Return the block of an operation's wait at the bottom; "" = it does not wait."""
        seconds = self.dwells.get(operation, 0.0)
        return self.words.wait.format(dwell_s=f"{seconds:g}", dwell_ms=round(1000 * seconds)) if seconds else ""


def holes_of(moves: WorkMoves, rules: CycleRules) -> dict[int, CycleHole]:
    """Return the holes of a program that the control has cycles for, by the index of the move that each begins with.

    The first move of a tool, from wherever it was, is no part of a cycle.

    Args:
        moves: the program's.
        rules: what the control has.
    """
    if not rules.words.drill:
        return {}
    drilling = (moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.DRILL)
    soon = np.append(drilling, (False, False))
    begins = (
        (moves.kind == MoveKind.RAPID) & (soon[1:-1] | soon[2:]) & (np.diff(moves.tool, prepend=moves.tool[:1]) == 0)
    )
    holes: dict[int, CycleHole] = {}
    stop = 1
    for i in np.flatnonzero(begins).tolist():
        if i >= stop and (hole := hole_at(moves.lists, i, moves.lists.end[i - 1][2], rules)) is not None:
            holes[i], stop = hole, hole.stop
    return holes


def hole_at(moves: MoveLists, i: int, height: int, rules: CycleRules) -> CycleHole | None:
    """Return the hole that begins with move i, or None where the control has no cycle that moves like it.

    A hole is a rapid over it, a rapid down to R, feeds down marked as drilling, and a rapid up to R or to the height
    before it, which is where its row began too; with pecks, there are the rapids between that `DrillingWords` tells of.
    What is there already, the place or R, needs no rapid.

    Args:
        moves: the program's.
        i: index of a move.
        height: Z before move i, count of the last decimal.
        rules: what the control has.
    """
    feed = _first_feed(moves, i, height)
    last = _last_feed(moves, feed) if feed else None
    if not feed or not last or not rules.words.drill:
        return None
    operation = moves.operation[feed]
    taps = operation in rules.taps
    stop = last + 1 if taps and not rules.words.tap_to_initial else last + 2
    x, y, first = moves.end[feed]
    r = moves.end[feed - 1][2]
    done = [(moves.kind[k], moves.end[k][2]) for k in range(feed, stop)]
    bottom, clear = min(z for _, z in done), done[-1][1]
    level = {height: rules.words.to_initial, r: rules.words.to_r}.get(clear, "")
    wait, tap = rules.wait(operation), rules.words.tap_left if operation in rules.left else rules.words.tap
    one_go, peck = [(MoveKind.LINE, bottom), (MoveKind.RAPID, clear)], r - first
    out, up = (islice(_steps((r, peck, bottom), rules, by_r), len(done)) for by_r in (True, False))
    fed_out = [(MoveKind.LINE, bottom), (MoveKind.LINE, r), (MoveKind.RAPID, clear)][: stop - feed]
    ways = (
        (rules.words.dwell if wait else rules.words.drill, one_go, 0),
        ("" if wait else rules.words.peck, [*out, *one_go], peck),
        ("" if wait else rules.words.chip_break, [*up, *one_go], peck),
        (tap if taps else "" if wait else rules.words.feed_out, fed_out, 0),
    )
    for word, steps, q in ways:
        if word and level and _alike(steps, done, rules.near):
            pause = f"P{wait.rpartition('P')[2]}" if wait else ""
            start = rules.taps.get(operation, "")
            return CycleHole(f"{level} {word}", x, y, bottom, r, q, moves.feed[feed], stop, pause, start)
    return None


def waits_of(moves: WorkMoves, rules: CycleRules, holes: Mapping[int, CycleHole]) -> dict[int, str]:
    """Return the blocks of waits at the bottom of holes that no cycle makes, by the index of the move that follows."""
    if not rules.dwells:
        return {}
    inside = {k for first, hole in holes.items() for k in range(first, hole.stop)}
    lines = np.flatnonzero((moves.kind == MoveKind.LINE) & (moves.purpose == Purpose.DRILL)).tolist()
    found = {}
    for k, following in pairwise([*lines, len(moves)]):
        deeper = following < len(moves) and moves.lists.end[following][:2] == moves.lists.end[k][:2]
        wait = rules.wait(moves.lists.operation[k])
        if wait and k not in inside and not deeper and k + 1 < len(moves):
            found[k + 1] = wait
    return found


def untapped(moves: WorkMoves, rules: CycleRules, holes: Mapping[int, CycleHole]) -> bool:
    """Tell whether a move of a tap is in no tapping cycle, so that the spindle would not turn back."""
    tapping = np.isin(moves.operation, list(rules.taps)) & (moves.kind == MoveKind.LINE)
    for first, hole in holes.items():
        tapping[first : hole.stop] = False
    return bool(tapping.any())


def _first_feed(moves: MoveLists, i: int, height: int) -> int | None:
    """Return the index of the feed behind the rapids over a hole and down to R, which begin with move i."""
    for k in range(i, min(i + 3, len(moves) - 1)):
        z = moves.end[k][2]
        if z > height or _belonging(moves, k) != _belonging(moves, i):
            return None
        if k > i and moves.kind[k] is MoveKind.LINE:
            return k if z < height else None
        if moves.kind[k] is not MoveKind.RAPID:
            return None
        height = z
    return None


def _last_feed(moves: MoveLists, feed: int) -> int | None:
    """Return the index of the last feed that drills the hole and has a move of the hole behind it; None where there is
    none.
    """
    last = None
    for k in range(feed, len(moves) - 1):
        if any(_belonging(moves, j) != _belonging(moves, feed) for j in (k, k + 1)):
            break
        if moves.kind[k] is MoveKind.LINE:
            if moves.purpose[k] != Purpose.DRILL or moves.feed[k] != moves.feed[feed]:
                break
            last = k
    return last


def _belonging(moves: MoveLists, k: int) -> tuple[int, ...]:
    """Return place, tool and operation of a move."""
    return (*moves.end[k][:2], moves.tool[k], moves.operation[k])


def _steps(depths: tuple[int, int, int], rules: CycleRules, by_r: bool) -> Iterator[Step]:
    """Yield what a control does before the last feed, given R, Q and bottom; heights added up as it adds them up.

    Args:
        depths: R, Q and bottom, counts of the last decimal.
        rules: its gaps.
        by_r: up to R after each step, and down again; else only a little up.
    """
    r, peck, bottom = (count / rules.scale for count in depths)
    gap = rules.peck_gap if by_r else rules.chip_gap
    height = r - peck
    while height > bottom:
        count = round(height * rules.scale)
        yield MoveKind.LINE, count
        if by_r:
            yield MoveKind.RAPID, depths[0]
        yield MoveKind.RAPID, count + gap
        height -= peck


def _alike(steps: list[Step], done: list[Step], near: int) -> bool:
    """Tell whether two sequences are the same but for the rounding of heights; where they end is that of both."""
    return len(steps) == len(done) and all(
        a is b and abs(z - w) <= near for (a, z), (b, w) in zip(steps, done, strict=True)
    )
