"""`hitofude smooth`: straight feed moves of any NC program become lines, arcs or splines within a proven tolerance.

What goes out is read back from its own bytes, and each stretch that was written anew is judged against the moves it
stands for. One that does not pass, or takes more blocks than it had, stays as it was.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..core.effort import announce
from ..core.errors import HitofudeError, InputError
from ..core.progress import NO_PROGRESS, Progress
from ..fitting.fitted import FittedPath, RefusalReason, SplineRefusal
from ..fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from ..fitting.point_curves.corners import bends, corners
from ..fitting.point_curves.effective_method import EffectiveMethod, PointClasses, states_across, without_repeats
from ..fitting.point_curves.proven_curve import SplineOptions, fit_splines
from ..fitting.point_curves.region_profile import judge_in_profile
from ..fitting.point_curves.smoothness import of_curve, of_points
from ..fitting.point_curves.space_curve import SpaceCurve, curve_of_motions, joined
from ..fitting.point_curves.through_points import through_points
from ..fitting.point_curves.tube import ToleranceTube, TubeAnswer, TubeJudgement, judge
from ..gcode.interpreter.options import PATIENT, ReadOptions
from ..gcode.interpreter.program import NcProgram
from ..gcode.interpreter.reader import read_program
from ..gcode.interpreter.text import ProgramBuffer
from ..gcode.posts.post import NurbsForm
from ..gcode.rework.rewrite import RewrittenText, rewrite
from ..gcode.rework.stretches import FoundStretches, find_stretches
from ..gcode.writer.blocks import Blocks
from ..gcode.writer.curve_blocks import BlockFormat, curve_blocks
from ..gcode.writer.linuxcnc_biarcs import driven
from ..geometry.coincident_points import near
from ..model.motion import Floats, MotionKind, Motions, Nurbs
from .smooth_effort import smooth_effort
from .smooth_report import certificate
from .smooth_result import (
    REACH,
    TOLERANCES,
    OutputForm,
    RoundFigures,
    SmoothedProgram,
    SmoothedStretch,
    SmoothOptions,
    WrittenKinds,
    figures_of,
)
from .smooth_source import SourceProgram, read_source

__all__ = ["TOLERANCES", "OutputForm", "SmoothOptions", "SmoothedProgram", "SmoothedStretch", "smooth"]

_FOR_CUBICS = 0.25
"""Of the tolerance: what cubics in place of a spline of degree 5 take up."""
_FINE = 0.1
"""Of the nearness: how far chords may be from the splines that they stand for."""

LARGEST_RADIUS = 10_000.0
"""mm; what is flatter is written as a line."""


def smooth(name: str, data: bytes, options: SmoothOptions, progress: Progress = NO_PROGRESS) -> SmoothedProgram:
    """Return a program whose stretches of straight feed moves are written anew.

    Args:
        name: of the file, for messages.
        data: its bytes.
        options: tolerance and form.
        progress: told of how much is done.

    Raises:
        InputError: the program cannot be read to its end, or has nothing that can be smoothed.
        Cancelled: the job was asked to stop.
    """
    ready = read_source(name, data, options.dialect, options.post, progress.part(0.0, 0.15))
    if options.insist and ready.post.nurbs.form is NurbsForm.NONE:
        raise InputError(
            f"{ready.post.title} knows no splines, so none can be insisted on; leave --insist out, or name a post "
            "that has them, --post fanuc or --post linuxcnc."
        )
    found = find_stretches(ready.program, ProgramBuffer(ready.data), progress.part(0.15, 0.2))
    announce(smooth_effort(found.stretches, options.form, options.effective), progress)
    work = _SmoothingRun(options, ready, found)
    blocks, kept = work.written(progress.part(0.2, 0.7))
    while True:
        new = rewrite(ready.data, found.stretches, blocks, ())
        after = read_program(new.data, ReadOptions(ready.post.dialect, limits=PATIENT), progress.part(0.7, 0.8))
        if after.error is not None:
            raise InputError(f"{ready.post.title} does not read what is written for it: {after.error.message(name)}")
        judged = work.judged(after, new, progress.part(0.8, 1.0))
        failed = {k: each.fault for k, each in judged.items() if each.fault}
        if not failed:
            break
        for k, fault in failed.items():
            del blocks[k]
            if not work.narrower(k):
                kept[k] = fault
                continue
            made = work.blocks_of(k, progress.part(0.2, 0.7))
            if isinstance(made, str):
                kept[k] = made
            else:
                blocks[k] = made
    work.require_the_rest(after, new)
    pieces = tuple(
        work.piece(k, judged.get(k), kept.get(k, ""), len(blocks.get(k, ()))) for k in range(len(found.stretches))
    )
    dialects = ready.dialect, ready.post.dialect
    done = SmoothedProgram(
        name, options, ready.source, ready.program, after, new.data, pieces, found, dialects, ready.off
    )
    done = replace(done, nearness=work.nearness)
    return replace(done, data=rewrite(ready.data, found.stretches, blocks, _comments(done, ready)).data)


def _comments(done: SmoothedProgram, ready: SourceProgram) -> list[str]:
    """Return the certificate as comment lines."""
    head = Blocks(ready.post, ready.program.states[0].units)
    for line in certificate(done):
        head.comment(line)
    return head.lines


@dataclass(frozen=True, eq=False)
class _JudgedStretch:
    """A stretch as it was written.

    Attributes:
        curve: what is driven along. judgement: of it. near: of it by the points of method D alone; None without it.
        cut: whether a corner is kept no more. rounded: how many bends beside shorter legs are not.
        kinds: what was read back.
    """

    curve: SpaceCurve
    judgement: TubeJudgement
    near: TubeJudgement | None
    cut: bool
    rounded: int
    kinds: WrittenKinds

    @property
    def fault(self) -> str:
        """Why it cannot stay as it was written, or ""."""
        if self.judgement.answer is not TubeAnswer.INSIDE:
            return "as it was written it is not proven to keep to the tolerance"
        if self.near is not None and self.near.answer is not TubeAnswer.INSIDE:
            return "as it was written it is not proven to go near the effective points"
        return "as it was written it would lose a corner" if self.cut else ""


class _SmoothingRun:
    """A program's stretches, on their way."""

    def __init__(self, options: SmoothOptions, source: SourceProgram, found: FoundStretches) -> None:
        self._options, self._source, self._found = options, source, found
        self._post, self._program = source.post, source.program
        own = [source.points(stretch) for stretch in found.stretches]
        self._astray = [k for k, points in enumerate(own) if points is None]
        self._points = [
            without_repeats(stretch.points if points is None else points)
            for stretch, points in zip(found.stretches, own, strict=True)
        ]
        self._widest = options.widest
        profile = options.profile
        self._tubes = (ToleranceTube(options.tolerance, options.middle),) if profile is None else profile.tried
        self._tried = [0] * len(own)
        self._classes: dict[int, PointClasses] = {}
        self._states: dict[int, NDArray[np.uint8]] = {}
        self._refusals: dict[int, tuple[SplineRefusal, ...]] = {}
        self._rounds: dict[int, list[RoundFigures]] = {}

    def written(self, progress: Progress) -> tuple[dict[int, tuple[str, ...]], dict[int, str]]:
        """Return the new blocks of stretches, and why others stay."""
        blocks: dict[int, tuple[str, ...]] = {}
        kept: dict[int, str] = {}
        count = len(self._found.stretches)
        for k in range(count):
            progress.step(k / count, f"Stretch {k + 1} of {count}")
            made = self.blocks_of(k, progress.part(k / count, (k + 1) / count))
            if isinstance(made, str):
                kept[k] = made
            else:
                blocks[k] = made
        return blocks, kept

    def blocks_of(self, k: int, progress: Progress) -> tuple[str, ...] | str:
        """Return the new blocks of a stretch, or why it stays."""
        stretch, insists = self._found.stretches[k], self._options.insist
        if len(self._points[k]) < 3 or k in self._astray:
            return "its moves are not the source's one by one" if k in self._astray else "it is too short"
        state = self._program.states[self._program.motions.state[stretch.first]]
        spelling = BlockFormat(self._post, state, stretch.feed, stretch.resumed)
        path = self._fitted(k, self._options.form, progress)
        made, self._refusals[k] = curve_blocks(path.motions, spelling), path.refusals
        if len(made) >= len(stretch.points) - 1 and self._options.form is OutputForm.NURBS and not insists:
            tried = len(made)
            made = curve_blocks(self._fitted(k, OutputForm.ARCS, progress).motions, spelling)
            self._refusals[k] = (SplineRefusal(RefusalReason.BLOCKS, tried, len(made)),)
        return "it would not take fewer blocks" if len(made) >= len(stretch.points) - 1 and not insists else made

    def narrower(self, k: int) -> bool:
        """Have a stretch fitted in a narrower part of its region; return whether there is one."""
        self._tried[k] += 1
        return self._tried[k] < len(self._tubes)

    def _fitted(self, k: int, form: OutputForm, progress: Progress) -> FittedPath:
        points, stretch, given = self._points[k], self._found.stretches[k], self._tubes[self._tried[k]]
        state = self._program.states[self._program.motions.state[stretch.first]]
        step = 10.0 ** -self._post.digits(state.units).X * state.units.value
        slack = 2.0 * step
        if not self._options.tolerance > 2 * slack:
            raise InputError(
                f"the tolerance of {self._options.tolerance:g} mm is too near to the last decimal of "
                f"{self._post.title}, {step:g} mm; use {5 * step:g} mm or more, or a post with more decimals."
            )
        if self._options.effective is not None:
            at = corners(points, self._options.corner, REACH * self._widest)
            classes = self._options.effective.classes(points, at, self._across(self._options.effective).get(k))
            self._classes[k] = classes
            points, spent = classes.passed, classes.off
            if len(points) < 2:  # a closed path that one range holds: only its seam is effective
                raise InputError(
                    f"Lines {' to '.join(map(str, self._source.lines(stretch)))} are one facet for this epsilon: only "
                    "the point where they close is effective. Use a smaller epsilon."
                )
            if not given.radius > slack + spent:
                raise InputError(
                    f"Points of lines {' to '.join(map(str, self._source.lines(stretch)))} are up to {spent:.4g} mm "
                    "off the path by the effective ones, which leaves nothing of the tolerance; use a smaller "
                    f"epsilon, or more than {slack + spent:.4g} mm."
                )
            tube = self._near(self._options.effective, slack, given.widest - slack - spent)
            if self._options.effective.on_shape:
                fine = _FINE * tube.radius
                tube = ToleranceTube(tube.radius - fine)
                at = corners(points, self._options.corner, REACH * self._widest)
                points = through_points(points, at, fine, given.widest - slack - spent - tube.radius)
        else:
            tube = given.narrower(slack)
        nurbs = self._post.nurbs.form
        largest = min(self._post.arcs.largest_radius_mm, LARGEST_RADIUS)
        arcs = ArcOptions(
            tube.radius, self._options.corner, largest, form is not OutputForm.LINES, tube.middle, self._options.bend
        )
        if form is not OutputForm.NURBS or nurbs is NurbsForm.NONE:
            return self._without_splines(fit_arcs(points, arcs, progress), form)
        level, rounds = nurbs is NurbsForm.BEZIER, self._rounds.setdefault(k, [])
        blocks, uncut = _quarters if level else _knots, replace(arcs, corner=math.pi)
        cubic = _FOR_CUBICS * tube.radius if self._options.degree != 3 else 0.0
        tube = tube.narrower(cubic)
        splines = SplineOptions(
            tube,
            self._options.degree,
            cubic,
            self._options.corner,
            blocks,
            level,
            lambda part, share: fit_arcs(part, uncut, share),
            self._options.insist,
            lambda seen: rounds.append(figures_of(seen)),
        )
        return fit_splines(points, splines, progress)

    def _without_splines(self, path: FittedPath, form: OutputForm) -> FittedPath:
        """Return a path of lines and arcs, with the reason where splines were asked for."""
        if form is not OutputForm.NURBS:
            return path
        return replace(path, refusals=(SplineRefusal(RefusalReason.CONTROL, 0, len(path.motions)),))

    def _across(self, method: EffectiveMethod) -> dict[int, NDArray[np.uint8]]:
        """Return what the points of stretches are by the facets of the surface that they lie on, where that is asked
        for; found once.
        """
        if method.across and not self._states:
            numbers = [k for k, points in enumerate(self._points) if len(points) > 2]
            paths = [self._points[k] for k in numbers]
            at = [corners(points, self._options.corner, REACH * self._widest) for points in paths]
            self._states = dict(zip(numbers, states_across(paths, at, method.choose.epsilon), strict=True))
        return self._states

    def _near(self, method: EffectiveMethod, slack: float, between: float) -> ToleranceTube:
        """Return the region round the points that method D goes by: near to them, as wide as may be between them."""
        nearness = method.nearness_for(self._step)
        if not nearness > slack:
            raise InputError(
                f"a nearness of {nearness:g} mm is too near to the last decimal of {self._post.title}; use more than "
                f"{slack:g} mm, or a post with more decimals."
            )
        return ToleranceTube(min(nearness - slack, between), between)

    def judged(self, after: NcProgram, new: RewrittenText, progress: Progress) -> dict[int, _JudgedStretch]:
        """Return what each stretch that was written anew has become, and the judge's answer."""
        order = np.argsort(after.motions.line, kind="stable")
        lines, answers = after.motions.line[order], {}
        for n, (k, (first, last)) in enumerate(new.lines.items()):
            progress.step(n / len(new.lines), "Proving what was written")
            rows = order[np.searchsorted(lines, first) : np.searchsorted(lines, last, side="right")]
            row, stop = int(rows.min()), int(rows.max()) + 1
            curve, ends = self._driven(after.motions, row, stop), after.motions.end[row:stop]
            near_by = self._judged_near(k, curve)
            judgement = self._judged_whole(k, curve)
            kinds = _kinds(after.motions.kind[row:stop])
            answers[k] = _JudgedStretch(curve, judgement, near_by, *self._lost(self._points[k], ends), kinds)
        return answers

    def _judged_whole(self, k: int, curve: SpaceCurve) -> TubeJudgement:
        """Return whether a curve is in the region that was asked for, whatever part of it the curve was fitted in."""
        profile = self._options.profile
        if profile is not None:
            return judge_in_profile(curve, self._points[k], profile)
        return judge(curve, self._points[k], self._tubes[0])

    def _judged_near(self, k: int, curve: SpaceCurve) -> TubeJudgement | None:
        """Return how near a curve goes to the points of method D; between them it may be as far as the tolerance."""
        if (nearness := self.nearness) is None:
            return None
        return judge(curve, self._classes[k].passed, ToleranceTube(nearness, max(self._widest, nearness)))

    def _lost(self, points: Floats, ends: Floats) -> tuple[bool, int]:
        """Return whether a corner is kept no more, and how many bends beside shorter legs are not: no written motion
        ends there.
        """
        sharp, legs = bends(points, self._options.corner)
        away = ~near(points[sharp], ends, self._step)
        corner = legs >= self._options.least_leg * (1 - 1e-9)
        return bool(np.any(away & corner)), int(np.sum(away & ~corner))

    def require_the_rest(self, after: NcProgram, new: RewrittenText) -> None:
        """Make sure that all motions outside of what was written anew are those of the text before, one by one.

        Raises:
            HitofudeError: they are not.
        """
        before = self._program.motions
        old, written = np.ones(len(before), np.bool_), np.zeros(int(after.motions.line.max(initial=0)) + 1, np.bool_)
        for k, (first, last) in new.lines.items():
            old[self._found.stretches[k].first : self._found.stretches[k].stop] = False
            written[first : last + 1] = True
        rows, others = np.flatnonzero(old), np.flatnonzero(~written[after.motions.line])
        if len(rows) == len(others):
            same = before.kind[rows] == after.motions.kind[others]
            ends = np.abs(before.end[rows] - after.motions.end[others]).max(axis=1, initial=0.0) <= self._step
            feeds = np.isclose(before.feed[rows], after.motions.feed[others], rtol=1e-9, atol=0.0, equal_nan=True)
            pairs, which = np.unique(
                np.column_stack([before.state[rows], after.motions.state[others]]), axis=0, return_inverse=True
            )
            states = np.array([self._program.states[a] == after.states[b] for a, b in pairs.tolist()], np.bool_)[
                which.ravel()
            ]
            wrong = np.flatnonzero(~(same & ends & feeds & states))
            if not len(wrong):
                return
            rows = rows[wrong]
        line = int(before.line[rows[0]]) if len(rows) else 1
        raise HitofudeError(
            f"What is smoothed is not proven to go on as before at line {line}, so it is not kept; please report this "
            "with the program."
        )

    @property
    def nearness(self) -> float | None:
        """How far from the points of method D curves may be, mm; None without it."""
        method = self._options.effective
        return None if method is None else method.nearness_for(self._step)

    @property
    def _step(self) -> float:
        """The last decimal of an axis word, mm: the coarser one where the program has two units."""
        units = {self._program.states[k].units for k in np.unique(self._program.motions.state).tolist()}
        return max((10.0 ** -self._post.digits(unit).X * unit.value for unit in units), default=0.0)

    def _driven(self, motions: Motions, first: int, stop: int) -> SpaceCurve:
        """Return what the control drives along in some motions of the written text."""
        if self._post.nurbs.form is not NurbsForm.BEZIER or not motions.splines:
            return curve_of_motions(motions, first, stop)
        rows = (first + np.flatnonzero(motions.kind[first:stop] == MotionKind.SPLINE)).tolist()
        parts, at = [], first
        for row in rows:
            parts += [curve_of_motions(motions, at, row)] if row > at else []
            parts.append(curve_of_motions(driven(motions.splines[row])))
            at = row + 1
        parts += [curve_of_motions(motions, at, stop)] if stop > at else []
        return joined(parts)

    def piece(self, k: int, judged: _JudgedStretch | None, kept: str, blocks: int) -> SmoothedStretch:
        """Return one stretch, before and after."""
        stretch, points, classes = self._found.stretches[k], self._points[k], self._classes.get(k)
        count = stretch.stop - stretch.first
        at = corners(points, self._options.corner, REACH * self._widest) if len(points) > 2 else np.array([0])
        before = of_points(points, points[at])
        alike = SmoothedStretch(
            stretch,
            points,
            (count, count),
            None,
            None,
            kept,
            before,
            before,
            at,
            classes,
            None,
            self._source.lines(stretch),
        )
        if judged is None:
            return alike
        return replace(
            alike,
            blocks=(count, blocks),
            curve=judged.curve,
            judgement=judged.judgement,
            kept="",
            after=of_curve(judged.curve, points[at]),
            near=judged.near,
            rounded=judged.rounded,
            kinds=judged.kinds,
            refusals=self._refusals.get(k, ()),
            rounds=tuple(self._rounds.get(k, ())),
        )


def _kinds(kind: NDArray[np.uint8]) -> WrittenKinds:
    """Return how many motions of each kind there are; one that goes nowhere is a line."""
    splines = int(np.sum(kind == MotionKind.SPLINE))
    lines = int(np.sum(kind <= MotionKind.LINE))
    return WrittenKinds(lines, len(kind) - lines - splines, splines)


def _knots(curve: Nurbs) -> int:
    """Blocks of a spline with knots."""
    return len(curve.knots) + 1


def _quarters(curve: Nurbs) -> int:
    """Blocks of a spline as cubic pieces."""
    return 5 * len(np.unique(curve.knots)) - 4
