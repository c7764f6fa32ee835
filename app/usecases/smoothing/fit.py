"""A stretch of straight feed moves as new blocks: the curve through its points, and the words that drive along it."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from ...core.errors import InputError
from ...core.progress import Progress
from ...fitting.fitted import FittedPath, RefusalReason, SplineRefusal
from ...fitting.line_arcs.arc_fit import ArcOptions, fit_arcs
from ...fitting.point_curves.effective_method import EffectiveMethod, PointClasses
from ...fitting.point_curves.proven_curve import SplineOptions, fit_splines
from ...fitting.point_curves.through_points import SplineLimits, through_points
from ...fitting.point_curves.tube import ToleranceTube
from ...gcode.posts import NurbsForm
from ...gcode.writer.curve_blocks import BlockFormat, curve_blocks
from ...model.motion import Floats, Nurbs
from .context import SmoothContext
from .result import OutputForm, RoundFigures, figures_of

_FOR_CUBICS = 0.25
"""Of the tolerance: what cubics in place of a spline of degree 5 take up."""
_FINE = 0.1
"""Of the nearness: how far chords may be from the splines that they stand for."""

LARGEST_RADIUS = 10_000.0
"""mm; what is flatter is written as a line."""


@dataclass(frozen=True, eq=False)
class StretchFit:
    """What became of a stretch.

    Attributes:
        blocks: that stand for it; none where it stays as it was.
        kept: why it stays; "" = it does not.
        tube: number of the region that it was fitted in.
        classes: what its points are by method D; None without it, and of a stretch that is too short.
        refusals: where splines were asked for and something else stands.
        rounds: of the splines that were tried.
    """

    blocks: tuple[str, ...] = ()
    kept: str = ""
    tube: int = 0
    classes: PointClasses | None = None
    refusals: tuple[SplineRefusal, ...] = ()
    rounds: tuple[RoundFigures, ...] = ()


def fit_all(context: SmoothContext, progress: Progress) -> list[StretchFit]:
    """Return what becomes of every stretch in the widest region."""
    fits, count = [], len(context.found.stretches)
    for k in range(count):
        progress.step(k / count, f"Stretch {k + 1} of {count}")
        fits.append(fit_stretch(context, k, StretchFit(), progress.part(k / count, (k + 1) / count)))
    return fits


def fit_stretch(context: SmoothContext, k: int, before: StretchFit, progress: Progress) -> StretchFit:
    """Return the new blocks of a stretch, or why it stays.

    Args:
        k: its number. before: what is known of it, and the region that it is fitted in.

    Raises:
        InputError: the control's decimals, or method D, leave nothing of the tolerance.
    """
    stretch, options = context.found.stretches[k], context.options
    if k in context.astray:
        return replace(before, kept="its moves are not the source's one by one")
    if len(context.points[k]) < 3:
        return replace(before, kept="it is too short")
    spelling = BlockFormat(context.post, context.state(k), stretch.feed, stretch.resumed)
    goal = _goal(context, k, context.tubes[before.tube])
    rounds = list(before.rounds)
    path = _fitted(context, goal, options.form, rounds, progress)
    blocks, refusals = curve_blocks(path.motions, spelling), path.refusals
    too_many = len(stretch.points) - 1
    if len(blocks) >= too_many and options.form is OutputForm.NURBS and not options.insist:
        arcs = curve_blocks(_fitted(context, goal, OutputForm.ARCS, rounds, progress).motions, spelling)
        blocks, refusals = arcs, (SplineRefusal(RefusalReason.BLOCKS, len(blocks), len(arcs)),)
    made = StretchFit(blocks, "", before.tube, goal.classes, refusals, tuple(rounds))
    if len(blocks) >= too_many and not options.insist:
        return replace(made, blocks=(), kept="it would not take fewer blocks")
    return made


@dataclass(frozen=True, eq=False)
class _FitGoal:
    """What a curve goes by: points (n, 3), mm, and the region round them, what writing takes of it taken off."""

    points: Floats
    tube: ToleranceTube
    classes: PointClasses | None = None


def _goal(context: SmoothContext, k: int, given: ToleranceTube) -> _FitGoal:
    """Return what the curve of a stretch goes by: its points, or by method D the effective ones."""
    options, points, step = context.options, context.points[k], context.digit(k)
    slack = 2.0 * step
    if not options.tolerance > 2 * slack:
        raise InputError(
            f"the tolerance of {options.tolerance:g} mm is too near to the last decimal of "
            f"{context.post.title}, {step:g} mm; use {5 * step:g} mm or more, or a post with more decimals."
        )
    if options.effective is None:
        return _FitGoal(points, given.narrower(slack))
    classes = _classes(context, k, options.effective)
    points, spent = classes.passed, classes.off
    lines = " to ".join(map(str, context.source.lines(context.found.stretches[k])))
    if len(points) < 2:  # a closed path that one range holds: only its seam is effective
        raise InputError(
            f"Lines {lines} are one facet for this epsilon: only the point where they close is effective. Use a "
            "smaller epsilon."
        )
    if not given.radius > slack + spent:
        raise InputError(
            f"Points of lines {lines} are up to {spent:.4g} mm off the path by the effective ones, which leaves "
            f"nothing of the tolerance; use a smaller epsilon, or more than {slack + spent:.4g} mm."
        )
    between = given.widest - slack - spent
    tube = _near(context, options.effective, slack, between)
    if options.effective.on_shape:
        fine = _FINE * tube.radius
        tube = ToleranceTube(tube.radius - fine)
        limits = SplineLimits(fine, between - tube.radius)
        points = through_points(points, context.corners(points), limits, classes.passed_sides)
    return _FitGoal(points, tube, classes)


def _classes(context: SmoothContext, k: int, method: EffectiveMethod) -> PointClasses:
    """Return what the points of a stretch are by method D."""
    points, stray = context.points[k], method.stray_for(context.coarsest_digit, context.own_digit(k))
    return method.classes(points, context.corners(points), context.states_across.get(k), stray)


def _near(context: SmoothContext, method: EffectiveMethod, slack: float, between: float) -> ToleranceTube:
    """Return the region round the points that method D goes by: near to them, as wide as may be between them."""
    nearness = method.nearness_for(context.coarsest_digit)
    if not nearness > slack:
        raise InputError(
            f"a nearness of {nearness:g} mm is too near to the last decimal of {context.post.title}; use more than "
            f"{slack:g} mm, or a post with more decimals."
        )
    return ToleranceTube(min(nearness - slack, between), between)


def _fitted(
    context: SmoothContext, goal: _FitGoal, form: OutputForm, rounds: list[RoundFigures], progress: Progress
) -> FittedPath:
    """Return lines, arcs or splines by points; figures of each round of splines are put behind `rounds`."""
    options, nurbs, tube = context.options, context.post.nurbs.form, goal.tube
    largest = min(context.post.arcs.largest_radius_mm, LARGEST_RADIUS)
    arcs = ArcOptions(tube.radius, options.corner, largest, form is not OutputForm.LINES, tube.middle, options.bend)
    if form is not OutputForm.NURBS:
        return fit_arcs(goal.points, arcs, progress)
    if nurbs is NurbsForm.NONE:
        path = fit_arcs(goal.points, arcs, progress)
        return replace(path, refusals=(SplineRefusal(RefusalReason.CONTROL, 0, len(path.motions)),))
    level = nurbs is NurbsForm.BEZIER
    blocks, uncut = _quarters if level else _knots, replace(arcs, corner=math.pi)
    cubic = _FOR_CUBICS * tube.radius if options.degree != 3 else 0.0
    splines = SplineOptions(
        tube.narrower(cubic),
        options.degree,
        cubic,
        options.corner,
        blocks,
        level,
        lambda part, share: fit_arcs(part, uncut, share),
        options.insist,
        lambda seen: rounds.append(figures_of(seen)),
    )
    return fit_splines(goal.points, splines, progress)


def _knots(curve: Nurbs) -> int:
    """Blocks of a spline with knots."""
    return len(curve.knots) + 1


def _quarters(curve: Nurbs) -> int:
    """Blocks of a spline as cubic pieces."""
    return 5 * len(np.unique(curve.knots)) - 4
