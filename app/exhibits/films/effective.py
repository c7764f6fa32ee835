"""Text D step by step: ranges of a faceted path (S111-S117), correction (S21-S23), the curve by what is left (S12)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...fitting.point_curves.corners import corners
from ...fitting.point_curves.correction import Correction, CorrectionCurve, CorrectionMove, CorrectionOptions, corrected
from ...fitting.point_curves.effective_method import EffectiveMethod
from ...fitting.point_curves.effective_points import EffectiveOptions, PointState, effective_points
from ...model.motion import Floats
from ...usecases.scene_program.smooth import chord_parameters
from ...usecases.smoothing.result import REACH, SmoothedProgram, SmoothOptions
from ...usecases.smoothing.smooth import smooth
from ...usecases.smoothing.source import AS_IT_LOOKS, SourceReading
from .measures import distances_to_polyline, feet_on_polyline
from .step import FilmFigure, FilmStep, PublishedText, TextFilm
from .step_drawing import AMBER, BLUE, BOLD, CHAIN, DOTTED, FAINT, FINE, GREEN, LINE, PURPLE, RED, StepDrawing, broadest

_BEFORE, _AFTER = 2, 3
"""Effective points beside a range that the text's example takes."""
_CORNER = np.radians(30.0)
"""Radians; what bends more is a corner."""
_OFF_SEEN = 0.08
"""Of the path's extent, how far the farthest curve is drawn from the facets."""
_CHORD = 1e-5
"""mm; a curve's picture, and what is measured of it, keep to it as near: less than what is told of it."""
_SHOWN = 6
"""Ranges that a picture of a place shows."""
_TABLED, _PLACES = 40, 2001
"""Trials in the table of S115, and places that the correction curve is drawn by."""


@dataclass(frozen=True)
class EffectiveFilmOptions:
    """How the steps are done.

    Attributes:
        epsilon: how far points of one facet may be off its segment, mm, > 0.
        tolerance: how far the written program may leave the facets, mm, > 0.
        reading: how the program is read.
    """

    epsilon: float = 0.01
    tolerance: float = 0.2
    reading: SourceReading = AS_IT_LOOKS


@dataclass(frozen=True, slots=True)
class RangeTrial:
    """Step S115 once.

    Attributes:
        first, last: the points looked at. off: how far those between are off their segment, mm, the largest.
        within: whether that is not more than epsilon.
    """

    first: int
    last: int
    off: float
    within: bool


def range_trials(points: Floats, epsilon: float, stops: frozenset[int]) -> tuple[RangeTrial, ...]:
    """Return every time that step S115 is done on a path, by the text's own loop (S111-S117).

    Args:
        points: (n, 3) mm, n >= 2. epsilon: mm. stops: points beyond which no range goes.
    """
    trials, first, last = [], 0, 1
    while last < len(points):
        off = _off(points[first + 1 : last], points[first], points[last])
        within = off <= epsilon and not any(first < stop < last for stop in stops)
        trials.append(RangeTrial(first, last, off, within))
        first, last = (first, last + 1) if within else (last - 1, last)
    return tuple(trials)


def _off(between: Floats, a: Floats, b: Floats) -> float:
    """Return how far points are off a segment, mm, the largest; 0 of none."""
    if not len(between):
        return 0.0
    chord = b - a
    share = np.clip((between - a) @ chord / max(float(chord @ chord), 1e-300), 0.0, 1.0)
    return float(np.linalg.norm(between - a - share[:, None] * chord, axis=1).max())


def ranges_of(trials: tuple[RangeTrial, ...]) -> list[tuple[int, int]]:
    """Return first and last point of each range that the trials part a path into."""
    ends = {trial.first: trial.last for trial in trials if trial.within or trial.last == trial.first + 1}
    return sorted(ends.items())


def effective_film(
    name: str, data: bytes, points: Floats, options: EffectiveFilmOptions, progress: Progress = NO_PROGRESS
) -> TextFilm:
    """Return text D's steps on the points of a program.

    Args:
        name, data: of the program, which is smoothed as a whole for the last step.
        points: (n, 3) of the stretch that is shown, mm.
        options: epsilon and tolerance.

    Raises:
        HitofudeError: the program cannot be smoothed so. Cancelled: the job was asked to stop.
    """
    work = _EffectiveSteps(points, options)
    progress.step(0.1, "Parting the path into ranges")
    steps = [*work.ranges(), *work.correction()]
    progress.step(0.4, "Smoothing by the effective points and by all")
    steps.append(work.final(_smoothed(name, data, options, True), _smoothed(name, data, options, False)))
    progress.step(1.0)
    return TextFilm(PublishedText.D, name, tuple(steps))


def _smoothed(name: str, data: bytes, options: EffectiveFilmOptions, effective: bool) -> SmoothedProgram:
    method = EffectiveMethod(EffectiveOptions(options.epsilon)) if effective else None
    dialect, units = options.reading.dialect, options.reading.units
    return smooth(name, data, SmoothOptions(options.tolerance, dialect=dialect, effective=method, units=units))


def _trial_row(trial: RangeTrial) -> tuple[str, str, str, str]:
    return str(trial.first), str(trial.last), f"{trial.off:.6f}", "yes" if trial.within else "no"


@dataclass(frozen=True, eq=False)
class _CorrectedRange:
    """The range that the correction is shown on.

    Attributes:
        first, last: its ends, by number. chosen: effective points about it, by number.
        made: what the correction makes of all points.
        curve, piece: places along the curve through the chosen ones, (m, 3), mm, all and those between its ends.
    """

    first: int
    last: int
    chosen: NDArray[np.int64]
    made: Correction
    curve: Floats
    piece: Floats

    @staticmethod
    def of(points: Floats, chosen: NDArray[np.int64], ends: NDArray[np.int64], made: Correction) -> _CorrectedRange:
        """Return it; its curve is the cubic spline through the chosen points by their chord lengths."""
        from scipy.interpolate import CubicSpline

        first, last = ends.tolist()
        along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points[chosen], axis=0), axis=1))])
        at = np.linspace(0.0, along[-1], _PLACES)
        begin, end = (float(along[int(np.flatnonzero(chosen == number)[0])]) for number in (first, last))
        curve = CubicSpline(along, points[chosen])
        return _CorrectedRange(first, last, chosen, made, curve(at), curve(at[(at >= begin) & (at <= end)]))

    @property
    def inner(self) -> NDArray[np.int64]:
        """The points between its ends, by number."""
        return np.arange(self.first + 1, self.last)


class _EffectiveSteps:
    """One path, and what is known of it."""

    def __init__(self, points: Floats, options: EffectiveFilmOptions) -> None:
        self.points, self.options = points, options
        self.kept = corners(points, _CORNER, REACH * min(options.tolerance, options.epsilon))
        choose, kept = EffectiveOptions(options.epsilon), self.kept.tolist()
        self.found = effective_points(points, choose, kept)
        self.passed = effective_points(
            points, choose, kept, at_bends=True, settled=True
        ).passed  # what the program goes by
        self.trials = range_trials(points, options.epsilon, frozenset(self.kept.tolist()))
        self.by_definition = ranges_of(self.trials)
        self.effective = self.found.passed

    def _path(self, first: int = 0, last: int | None = None) -> StepDrawing:
        part = self.points[first : None if last is None else last + 1]
        sketch = StepDrawing(broadest(part))
        sketch.line(part, FAINT, FINE)
        sketch.dots(part, FAINT, 0.5)
        return sketch

    def _place(self, trial: RangeTrial) -> StepDrawing:
        """Return the picture of one trial: the points, the segment, and who is how far off."""
        sketch = self._path(max(trial.first - 2, 0), min(trial.last + 3, len(self.points) - 1))
        pair = self.points[[trial.first, trial.last]]
        sketch.line(pair, BLUE if trial.within else RED, LINE)
        sketch.dots(self.points[trial.first + 1 : trial.last], AMBER, 0.8)
        sketch.dots(pair, BLUE, 1.0)
        sketch.word("Pi", pair[0], BLUE)
        sketch.word("Pk", pair[1], BLUE)
        return sketch

    def ranges(self) -> list[FilmStep]:
        """Return steps S111 to S117, in the order in which they are done first."""
        return [*self._widened(), self._tested(), *self._found()]

    def _widened(self) -> list[FilmStep]:
        """Return the steps that make a range longer: S111, S112, S114."""
        trials, first = self.trials, self.trials[0]
        wide = next((each for each in trials if each.within and each.last > each.first + 1), first)
        return [
            FilmStep(
                "S111",
                "The first two points",
                "Of the points in their order the first two are looked at: Pi and Pk.",
                "",
                self._place(first).page(),
                (FilmFigure("points", len(self.points)),),
            ),
            FilmStep(
                "S112",
                "Is there a point without a range?",
                "While points are left that are in no range, the one looked at is made longer; else it is the last.",
                "",
                self._place(wide).page(),
                (FilmFigure("times asked", len(trials) + 1),),
            ),
            FilmStep(
                "S114",
                "Widen",
                "k goes on by one: the range that is looked at has one point more.",
                "",
                self._place(wide).page(),
                (FilmFigure("times widened", sum(each.within for each in trials)),),
            ),
        ]

    def _tested(self) -> FilmStep:
        """Return S115, on the first range that has become too long."""
        failed = next((each for each in self.trials if not each.within), self.trials[-1])
        within = max((each.off for each in self.trials if each.within), default=0.0)
        return FilmStep(
            "S115",
            "All within epsilon?",
            "Every point between is to lie within epsilon of the segment from Pi to Pk.",
            "Distance is that to the segment, not to its line. A corner ends a range, too.",
            self._place(failed).page(),
            (
                FilmFigure("epsilon", self.options.epsilon, "mm"),
                FilmFigure("off here", failed.off, "mm"),
                FilmFigure("largest that was within", within, "mm"),
            ),
            (("i", "k", "off the segment, mm", "within epsilon"), *map(_trial_row, self.trials[:_TABLED])),
        )

    def _found(self) -> list[FilmStep]:
        """Return the steps that end a range: S116, S117, and S113, the last one."""
        follow = next((each for each in self.trials if each.first > 0), self.trials[-1])
        same = [tuple(row) for row in self.found.ranges.tolist()] == self.by_definition
        counts = (
            FilmFigure("ranges", len(self.by_definition)),
            FilmFigure("effective points", len(self.effective)),
            FilmFigure("invalid points", len(self.points) - len(self.effective)),
        )
        return [
            FilmStep(
                "S116",
                "A range is found",
                "If one is not, the range is what was looked at before: Pi to Pk-1. Its ends are effective, those "
                "between invalid.",
                "One cone of directions for each start finds the same ranges without the loop: "
                + ("compared here, all are the same." if same else "compared here, they differ.")
                + " For the final curve a range that bends at one point, as at an inflection, ends there.",
                self._range(0).page(),
                counts,
            ),
            FilmStep(
                "S117",
                "The next range",
                "The next one begins at the last point of this one: i is k-1.",
                "",
                self._place(follow).page(),
                (FilmFigure("begins at point", follow.first),),
            ),
            FilmStep(
                "S113",
                "The last range",
                "No point is left: what is looked at is the last range.",
                "",
                self._whole(self.effective).page(),
                counts,
            ),
        ]

    def _range(self, number: int) -> StepDrawing:
        first = int(self.found.ranges[number, 0])
        last = int(self.found.ranges[min(number + _SHOWN, len(self.found.ranges)) - 1, 1])
        sketch = self._path(first, last)
        inside = self.effective[(self.effective >= first) & (self.effective <= last)]
        sketch.line(self.points[inside], GREEN, LINE)
        sketch.dots(self.points[inside], GREEN, 1.0)
        return sketch

    def _whole(self, effective: NDArray[np.int64]) -> StepDrawing:
        sketch = self._path()
        sketch.dots(self.points[effective], GREEN, 0.9)
        return sketch

    def _gap(self) -> int:
        """Return the number of the range that corrections are shown on: with points inside, and as many effective ones
        about it as there are anywhere; of several such ranges one in the middle.
        """
        inside = np.diff(self.found.ranges, axis=1)[:, 0] > 1
        worth = np.where(inside, [len(self._about_gap(gap)) for gap in range(len(inside))], 0)
        best = np.flatnonzero(worth == worth.max())
        return int(best[len(best) // 2])

    def _about_gap(self, gap: int) -> NDArray[np.int64]:
        """Return the effective points about a range that its correction curve goes by: none beyond a corner."""
        first, last = self.found.ranges[gap].tolist()
        low = self.kept[np.searchsorted(self.kept, first, side="right") - 1]
        high = self.kept[np.searchsorted(self.kept, last, side="left")]
        near = self.effective[max(gap - _BEFORE, 0) : gap + 1 + _AFTER]
        found: NDArray[np.int64] = near[(near >= low) & (near <= high)]
        return found

    def correction(self) -> list[FilmStep]:
        """Return steps S21 to S23 on one range, and what they come to on all."""
        gap = self._gap()
        shown = _CorrectedRange.of(
            self.points,
            self._about_gap(gap),
            self.found.ranges[gap],
            self._corrected(CorrectionCurve.THROUGH),
        )
        return [self._choice(shown), self._curve(shown), self._moves(shown)]

    def _about(self, shown: _CorrectedRange) -> StepDrawing:
        return self._path(int(shown.chosen[0]), int(shown.chosen[-1]))

    def _choice(self, shown: _CorrectedRange) -> FilmStep:
        sketch = self._about(shown)
        sketch.dots(self.points[shown.chosen], GREEN, 1.1)
        for name, number in (("P(i-3)", shown.first), ("P(i)", shown.last)):
            sketch.word(name, self.points[number], GREEN)
        return FilmStep(
            "S21",
            "Choose effective points",
            "About an effective point so many effective ones before and after it are chosen: in the example two "
            "and three, which picks P(i-6), P(i-4), P(i-3), P(i), P(i+1) and P(i+3).",
            "",
            sketch.page(),
            (FilmFigure("chosen", len(shown.chosen)), FilmFigure("of effective", len(self.effective))),
        )

    def _curve(self, shown: _CorrectedRange) -> FilmStep:
        sketch = self._about(shown)
        sketch.line(shown.curve, PURPLE, BOLD)
        sketch.dots(self.points[shown.chosen], GREEN, 1.0)
        return FilmStep(
            "S22",
            "The correction curve",
            "A smooth curve goes through these, or near them.",
            "Through: the cubic spline by chord lengths, its outer two pieces one cubic. Near: the one cubic of "
            "least squares.",
            sketch.page(),
            (FilmFigure("points it goes by", len(shown.chosen)),),
        )

    def _moves(self, shown: _CorrectedRange) -> FilmStep:
        inner, made = shown.inner, shown.made
        moved = float(made.moved[inner].max(initial=0.0))
        off = float(distances_to_polyline(made.places[inner], shown.curve).max()) if len(inner) else 0.0
        near = self._corrected(CorrectionCurve.NEAR)
        return FilmStep(
            "S23",
            "Move the points",
            "Effective ends move to the curve, always; invalid points only if they are within a share of an end, "
            "or move less than a limit. The others are left out.",
            "An end that two ranges share takes the mean of both moves: with curves through the ends that is none, "
            f"with curves near them up to {near.moved[self.effective].max():.6f} mm here.",
            self._moved_points(shown).page(),
            (
                FilmFigure("largest move in this range", moved, "mm"),
                FilmFigure("moved points off the curve", off, "mm"),
                FilmFigure("largest move of all", float(made.moved.max()), "mm"),
                FilmFigure("corrected points", int(np.sum(made.state == PointState.CORRECTED))),
            ),
        )

    def _moved_points(self, shown: _CorrectedRange) -> StepDrawing:
        inner, places = shown.inner, shown.made.places
        sketch = StepDrawing(broadest(self.points[shown.first : shown.last + 1]))
        sketch.line(self.points[shown.first : shown.last + 1], FAINT, FINE)
        sketch.line(shown.piece, PURPLE, LINE)
        sketch.dots(self.points[inner], AMBER, 0.8, hollow=True)
        sketch.dots(places[inner], AMBER, 0.8)
        sketch.dots(self.points[[shown.first, shown.last]], GREEN, 1.0)
        for number in inner.tolist():
            sketch.line(np.vstack([self.points[number], places[number]]), AMBER, FINE, DOTTED)
        return sketch

    def _corrected(self, curve: CorrectionCurve) -> Correction:
        options = CorrectionOptions(curve=curve, move=CorrectionMove.NEAREST, before=_BEFORE, after=_AFTER)
        return corrected(self.points, self.found.state, options, self.kept.tolist())

    def final(self, by_effective: SmoothedProgram, by_all: SmoothedProgram) -> FilmStep:
        """Return step S12: the curve by the effective points, beside the one that all points have the same say in."""
        sketch, passed = self._whole(self.passed), self.points[self.passed]
        figures: list[FilmFigure] = []
        drawn = {
            colour: (done, places)
            for done, colour in ((by_all, RED), (by_effective, GREEN))
            if (places := _curve_near(done, self.points)) is not None
        }
        times = _exaggeration([places for _, places in drawn.values()], self.points)
        for colour, (done, places) in drawn.items():
            foot = feet_on_polyline(places, self.points)
            sketch.line(foot + times * (places - foot), colour, LINE, CHAIN if colour == RED else ())
            label = "effective points" if done is by_effective else "all points"
            off = distances_to_polyline(passed, places)
            figures.append(FilmFigure(f"by {label}: farthest effective point", float(off.max()), "mm"))
        if by_effective.nearness is not None:
            figures.append(FilmFigure("nearness that was proven", by_effective.nearness, "mm"))
        stayed = _why_it_stayed(by_effective, self.points)
        if not stayed:
            figures.append(FilmFigure("tolerance to the facets, proven", by_effective.bound, "mm"))
        return FilmStep(
            "S12",
            "The final curve",
            "The final curve goes through the effective points, or near them, and by no others.",
            "Two limits: the tolerance bounds how far the curve leaves the facets, the nearness how far it leaves the "
            "effective points. One for both would lose the method: by all points the curve strays as the red one does. "
            f"What curves are off the facets is drawn {times:.0f} times too large."
            + (f" By effective points this stretch stayed as it was: {stayed}." if stayed else ""),
            sketch.page(),
            tuple(figures),
        )


def _why_it_stayed(done: SmoothedProgram, points: Floats) -> str:
    """Return why the stretch that begins with some points was not written anew; "" where it was."""
    return next((piece.kept for piece in done.pieces if np.all(piece.points[0] == points[0])), "")


def _exaggeration(curves: list[Floats], points: Floats) -> float:
    """Return how many times larger the way from facets to curves is drawn, so that it is seen."""
    off = max((float(distances_to_polyline(places, points).max()) for places in curves), default=0.0)
    return max(1.0, float(np.round(_OFF_SEEN * np.ptp(points, axis=0).max() / max(off, 1e-9))))


def _curve_near(done: SmoothedProgram, points: Floats) -> Floats | None:
    """Return places along what was written for the stretch that begins with some points; None where it stayed."""
    for piece in done.pieces:
        if piece.curve is not None and np.all(piece.points[0] == points[0]):
            until = float(len(piece.curve))
            if piece.judgement is not None and piece.judgement.feet is not None:
                until = float(piece.judgement.feet[min(len(points), len(piece.points)) - 1])
            own = chord_parameters(piece.curve, _CHORD)
            return piece.curve.at(np.append(own[own < until], until))
    return None
