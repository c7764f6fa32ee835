"""What was written, as it is read back: each stretch against the moves that it stands for, all else as it was."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.errors import HitofudeError
from ...core.progress import Progress
from ...fitting.point_curves.corners import bends
from ...fitting.point_curves.region_profile import judge_in_profile
from ...fitting.point_curves.space_curve import SpaceCurve, curve_of_motions, joined
from ...fitting.point_curves.tube import ToleranceTube, TubeAnswer, TubeJudgement, judge
from ...gcode.interpreter.program import NcProgram
from ...gcode.posts import NurbsForm
from ...gcode.rework.stretches import RewrittenText
from ...gcode.writer.linuxcnc_biarcs import driven
from ...geometry.coincident_points import near
from ...model.motion import Floats, MotionKind, Motions
from .context import SmoothContext
from .fit import StretchFit
from .result import WrittenKinds


@dataclass(frozen=True, eq=False)
class JudgedStretch:
    """A stretch as it was written.

    Attributes:
        curve: what is driven along. judgement: of it. near: of it by the points of method D alone; None without it.
        lost: which bends are kept no more. kinds: what was read back.
    """

    curve: SpaceCurve
    judgement: TubeJudgement
    near: TubeJudgement | None
    lost: LostBends
    kinds: WrittenKinds

    @property
    def fault(self) -> str:
        """Why it cannot stay as it was written, or ""."""
        if self.judgement.answer is not TubeAnswer.INSIDE:
            return "as it was written it is not proven to keep to the tolerance"
        if self.near is not None and self.near.answer is not TubeAnswer.INSIDE:
            return "as it was written it is not proven to go near the effective points"
        return "as it was written it would lose a corner" if self.lost.corner else ""


@dataclass(frozen=True, slots=True)
class LostBends:
    """Bends where no written motion ends: whether a corner is among them, and how many lie beside shorter legs."""

    corner: bool
    rounded: int


def judged(
    context: SmoothContext, fits: list[StretchFit], after: NcProgram, new: RewrittenText, progress: Progress
) -> dict[int, JudgedStretch]:
    """Return what each stretch that was written anew has become, and the judge's answer, by number.

    Args:
        fits: of every stretch. after: the new text as its control reads it. new: which lines of it are new.
    """
    order = np.argsort(after.motions.line, kind="stable")
    lines, answers = after.motions.line[order], {}
    for n, (k, (first, last)) in enumerate(new.lines.items()):
        progress.step(n / len(new.lines), "Proving what was written")
        rows = order[np.searchsorted(lines, first) : np.searchsorted(lines, last, side="right")]
        row, stop = int(rows.min()), int(rows.max()) + 1
        curve, ends = _driven(context, after.motions, row, stop), after.motions.end[row:stop]
        answers[k] = JudgedStretch(
            curve,
            _judged_whole(context, context.points[k], curve),
            _judged_near(context, fits[k], curve),
            _lost(context, context.points[k], ends),
            _kinds(after.motions.kind[row:stop]),
        )
    return answers


def _judged_whole(context: SmoothContext, points: Floats, curve: SpaceCurve) -> TubeJudgement:
    """Return whether a curve is in the region that was asked for, whatever part of it the curve was fitted in."""
    profile = context.options.profile
    return judge(curve, points, context.tubes[0]) if profile is None else judge_in_profile(curve, points, profile)


def _judged_near(context: SmoothContext, fit: StretchFit, curve: SpaceCurve) -> TubeJudgement | None:
    """Return how near a curve goes to the points of method D; between them it may be as far as the tolerance."""
    nearness = context.nearness
    if nearness is None or fit.classes is None:
        return None
    return judge(curve, fit.classes.passed, ToleranceTube(nearness, max(context.options.widest, nearness)))


def _lost(context: SmoothContext, points: Floats, ends: Floats) -> LostBends:
    """Return which bends of a stretch no written motion ends at."""
    sharp, legs = bends(points, context.options.corner)
    away = ~near(points[sharp], ends, context.coarsest_digit)
    corner = legs >= context.options.least_leg * (1 - 1e-9)
    return LostBends(bool(np.any(away & corner)), int(np.sum(away & ~corner)))


def _driven(context: SmoothContext, motions: Motions, first: int, stop: int) -> SpaceCurve:
    """Return what the control drives along in some motions of the written text."""
    if context.post.nurbs.form is not NurbsForm.BEZIER or not motions.splines:
        return curve_of_motions(motions, first, stop)
    rows = (first + np.flatnonzero(motions.kind[first:stop] == MotionKind.SPLINE)).tolist()
    parts, at = [], first
    for row in rows:
        parts += [curve_of_motions(motions, at, row)] if row > at else []
        parts.append(curve_of_motions(driven(motions.splines[row])))
        at = row + 1
    parts += [curve_of_motions(motions, at, stop)] if stop > at else []
    return joined(parts)


def _kinds(kind: NDArray[np.uint8]) -> WrittenKinds:
    """Return how many motions of each kind there are; one that goes nowhere is a line."""
    splines = int(np.sum(kind == MotionKind.SPLINE))
    lines = int(np.sum(kind <= MotionKind.LINE))
    return WrittenKinds(lines, len(kind) - lines - splines, splines)


def require_the_rest(context: SmoothContext, after: NcProgram, new: RewrittenText) -> None:
    """Make sure that all motions outside of what was written anew are those of the text before, one by one.

    Raises:
        HitofudeError: they are not.
    """
    before, states = context.program.motions, context.program.states
    old, written = np.ones(len(before), np.bool_), np.zeros(int(after.motions.line.max(initial=0)) + 1, np.bool_)
    for k, (first, last) in new.lines.items():
        old[context.found.stretches[k].first : context.found.stretches[k].stop] = False
        written[first : last + 1] = True
    rows, others = np.flatnonzero(old), np.flatnonzero(~written[after.motions.line])
    if len(rows) == len(others):
        same = before.kind[rows] == after.motions.kind[others]
        far = np.abs(before.end[rows] - after.motions.end[others]).max(axis=1, initial=0.0)
        feeds = np.isclose(before.feed[rows], after.motions.feed[others], rtol=1e-9, atol=0.0, equal_nan=True)
        pairs, which = np.unique(
            np.column_stack([before.state[rows], after.motions.state[others]]), axis=0, return_inverse=True
        )
        alike = np.array([states[a] == after.states[b] for a, b in pairs.tolist()], np.bool_)[which.ravel()]
        wrong = np.flatnonzero(~(same & (far <= context.coarsest_digit) & feeds & alike))
        if not len(wrong):
            return
        rows = rows[wrong]
    line = int(before.line[rows[0]]) if len(rows) else 1
    raise HitofudeError(
        f"What is smoothed is not proven to go on as before at line {line}, so it is not kept; please report this with "
        "the program."
    )
