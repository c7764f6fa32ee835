"""Text E step by step: the rounds of figure 4 with region and witness, the test of figures 5 to 8 on one chord."""

from __future__ import annotations

import math
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from ...core.progress import NO_PROGRESS, Progress
from ...fitting.point_curves.bspline import FitRound, SplineFit, fit_spline
from ...fitting.point_curves.corners import corners
from ...fitting.point_curves.proven_curve import LONGEST
from ...fitting.point_curves.region_profile import RegionProfile, judge_in_profile, profile_of_formula
from ...fitting.point_curves.space_curve import SpaceCurve, curve_of_nurbs
from ...fitting.point_curves.spheroid import portion_of
from ...fitting.point_curves.tube import TubeAnswer, TubeJudgement
from ...model.motion import Floats
from .step import FilmFigure, FilmStep, PublishedText, TextFilm
from .step_drawing import AMBER, AREA, BLUE, BOLD, DASHED, FAINT, FINE, GREEN, LINE, RED, StepDrawing, broadest

USUAL = "0.02 + 0.03*sin(pi*z)"
"""The region's outline that a film is made with unless another is asked for."""

_MOST_ROUNDS = 12
"""That are shown: the first ones, and the last."""
_CORNER = math.radians(60.0)
"""Radians; what bends more is a corner."""
_DEEPEST = 30
"""Halvings of a chord, at most."""
_NO_POWER, _REAL = 1e-11, 1e-6
"""Coefficients of a raised curve's highest powers are nothing but rounding; roots so near to the real axis are real."""


@dataclass(frozen=True, eq=False)
class SeenRound:
    """A round of figure 4, judged.

    Attributes:
        fit: as the fitting saw it. curve: of it. judgement: in the region that was asked for.
    """

    fit: FitRound
    curve: SpaceCurve
    judgement: TubeJudgement


@dataclass(frozen=True, eq=False)
class SurfaceWitness:
    """The shortest way from P to Q by the region's surface (figures 7 and 8).

    Attributes:
        p, q: ends of an interval of the curve, mm. x: the place of the surface by which the way is shortest.
        length: of the interval at most: that of its control polygon, mm. way: of P, X, Q, mm.
    """

    p: Floats
    q: Floats
    x: Floats
    length: float
    way: float


def proven_film(
    name: str, points: Floats, profile: RegionProfile | None = None, progress: Progress = NO_PROGRESS
) -> TextFilm:
    """Return text E's steps on some points.

    Args:
        name: of the program that they are from.
        points: (n, 3) mm, n >= 4, no two in a row alike.
        profile: of the region; None: `USUAL`.

    Raises:
        Cancelled: the job was asked to stop.
    """
    profile = profile or profile_of_formula(USUAL)
    run = _longest_run(points)
    rounds: list[SeenRound] = []

    def see(fit: FitRound) -> None:
        if not fit.spread:
            curve = SpaceCurve(fit.pieces, np.zeros(len(fit.pieces), np.int64))
            rounds.append(SeenRound(fit, curve, judge_in_profile(curve, run, profile)))

    progress.step(0.1, "Fitting a curve round by round")
    for tube in profile.tried:
        made = fit_spline(run, tube, 3, progress.part(0.1, 0.7), see)
        if isinstance(made, SplineFit) and _inside(made, run, profile):
            break
    final = curve_of_nurbs(made.curve) if isinstance(made, SplineFit) else rounds[-1].curve
    judged = judge_in_profile(final, run, profile)
    progress.step(0.8, "Looking at one chord")
    work = _ProvenSteps(run, profile, tuple(rounds), final, judged)
    return TextFilm(PublishedText.E, name, (*work.setting(), *work.rounds(), *work.chord(), work.result()))


def _inside(made: SplineFit, points: Floats, profile: RegionProfile) -> bool:
    return judge_in_profile(curve_of_nurbs(made.curve), points, profile).answer is TubeAnswer.INSIDE


def _longest_run(points: Floats) -> Floats:
    """Return the points between two corners that are the most."""
    at = corners(points, _CORNER, 0.2)
    first = int(np.argmax(np.diff(at)))
    return np.ascontiguousarray(points[at[first] : at[first + 1] + 1])


class _ProvenSteps:
    """One run of points, its rounds and its curve."""

    def __init__(
        self,
        points: Floats,
        profile: RegionProfile,
        rounds: tuple[SeenRound, ...],
        final: SpaceCurve,
        judged: TubeJudgement,
    ) -> None:
        self.points, self.profile, self.seen, self.final, self.judged = points, profile, rounds, final, judged

    def _drawn(self, curve: SpaceCurve | None, colour: str = GREEN) -> StepDrawing:
        sketch = StepDrawing(broadest(self.points))
        sketch.line(self.points, FAINT, FINE)
        sketch.dots(self.points, FAINT, 0.6)
        if curve is not None:
            sketch.line(curve.at(np.linspace(0, len(curve), max(600, 40 * len(curve)))), colour, LINE)
        return sketch

    def setting(self) -> list[FilmStep]:
        """Return figures 2 and 3: the points and the region."""
        chord = self._long_chord()
        length = float(np.linalg.norm(self.points[chord + 1] - self.points[chord]))
        outline = StepDrawing()
        z, r = self._outline()
        ends = self.profile.ends
        scale = self._exaggeration(length)
        outline.area(np.column_stack([np.concatenate([z, z[::-1]]) * length, np.concatenate([r, -r[::-1]]) * scale]))
        for at, radius in ((0.0, ends[0]), (length, ends[1])):
            angle = np.linspace(0, 2 * math.pi, 60)
            outline.line(np.column_stack([at + radius * np.cos(angle), radius * scale * np.sin(angle)]), BLUE, FINE)
        outline.line(np.array([[0, 0], [length, 0]]), FAINT, LINE)
        outline.dots(np.array([[0, 0], [length, 0]]), FAINT, 1.0)
        return [
            FilmStep(
                "figure 2",
                "The points",
                "A program's command points, joined by straight moves.",
                "",
                self._drawn(None).page(),
                (FilmFigure("points", len(self.points)),),
            ),
            FilmStep(
                "figure 3",
                "The region",
                "Round each segment, its axis z, lies a solid of revolution r = f(z): a cylinder, or any other that "
                "the user chooses, such as a barrel, wide between the points.",
                "At the points the region holds a ball, so that neighbours overlap at every corner. Here r = "
                f"{self.profile.text}; heights are drawn {scale:.0f} times too large.",
                outline.page(),
                (
                    FilmFigure("f at the points", self.profile.radius, "mm"),
                    FilmFigure("f at its widest", self.profile.widest, "mm"),
                ),
            ),
        ]

    def _outline(self) -> tuple[Floats, Floats]:
        z = np.linspace(0, 1, 257)
        return z, np.array([self.profile.outline.radius(float(each)) for each in z])

    def _exaggeration(self, length: float) -> float:
        return max(1.0, 0.3 * length / self.profile.widest)

    def _long_chord(self) -> int:
        return int(np.argmax(np.linalg.norm(np.diff(self.points, axis=0), axis=1)))

    def rounds(self) -> list[FilmStep]:
        """Return the rounds of figure 4."""
        shown = self.seen if len(self.seen) <= _MOST_ROUNDS else (*self.seen[: _MOST_ROUNDS - 1], self.seen[-1])
        return [self._round(number, seen) for number, seen in enumerate(shown, 1)]

    def _round(self, number: int, seen: SeenRound) -> FilmStep:
        fit, judged = seen.fit, seen.judgement
        inside = judged.answer is TubeAnswer.INSIDE
        sketch = self._drawn(seen.curve, GREEN if inside else RED)
        sketch.line(fit.control, AMBER, FINE, DASHED)
        sketch.dots(fit.control, AMBER, 0.8, hollow=True)
        if not inside:
            sketch.dots(np.array([judged.place]), BLUE, 1.4)
            sketch.word("X", judged.place, BLUE)
        where = "" if inside else f"chord {judged.chord}, at {judged.place[0]:.4f}, {judged.place[1]:.4f}"
        if inside:
            after = "It lies in the region as a whole: this is the curve."
        elif fit.outside:
            many = "One point is" if fit.outside == 1 else f"{fit.outside} points are"
            after = f"{many} too far from it, so control points are added where it fails."
        else:
            after = "All points are near, but it leaves the region between them, so control points are added there."
        return FilmStep(
            f"figure 4, round {number}",
            "Fit, look at the points, look at the region",
            "A least-squares B-spline with so many control points; are all command points near? Is the whole curve in "
            "the region? If not, control points are added, and the curve is made anew.",
            f"Spans that fail are halved. {after}",
            sketch.page(),
            (
                FilmFigure("control points", len(fit.control)),
                FilmFigure("points too far", fit.outside),
                FilmFigure("farthest point", fit.farthest, "mm"),
                FilmFigure("region", judged.answer.value),
                *((FilmFigure("leaves it at", where),) if where else ()),
                *((FilmFigure("off its chord there", judged.from_curve, "mm"),) if where else ()),
            ),
        )

    def chord(self) -> list[FilmStep]:
        """Return figures 5 to 8 on a chord: where a curve that fails leaves a cylinder, why one that holds cannot."""
        failing = next((each for each in reversed(self.seen) if each.judgement.answer is not TubeAnswer.INSIDE), None)
        steps = []
        if failing is not None:
            steps += self._crossings(failing)
        chord = int(np.argmax(self._off()))
        witness = self._witness(chord)
        if witness is not None:
            steps += self._spheroid(chord, witness)
        return steps

    def _off(self) -> Floats:
        """Return how far the curve leaves each chord, seen at places between its feet, mm."""
        feet = self._feet()
        if feet is None:
            return np.zeros(len(self.points) - 1)
        off = []
        for i in range(len(self.points) - 1):
            _, r = _about(
                self.final.at(np.linspace(feet[i], feet[i + 1], 65)), ChordAxis(self.points[i], self.points[i + 1])
            )
            off.append(float(r.max()))
        return np.array(off)

    def _feet(self) -> Floats | None:
        return self.judged.feet

    def _crossings(self, seen: SeenRound) -> list[FilmStep]:
        """Return figures 5 and 6: the parameters at which a curve passes a cylinder's surface."""
        chord, radius = seen.judgement.chord, self.profile.radius
        axis = ChordAxis(self.points[chord], self.points[chord + 1])
        low, high = float(seen.fit.feet[chord]), float(seen.fit.feet[chord + 1])
        cuts, held = intervals_in_cylinder(seen.curve, axis, radius, (low, high))
        length = float(np.linalg.norm(axis.end - axis.start))
        scale = self._exaggeration(length)
        at = _about(seen.curve.at(np.array(cuts)), axis) if cuts else (np.zeros(0), np.zeros(0))
        course = _about(seen.curve.at(np.linspace(low, high, 400)), axis)
        pictures = [
            self._crossing(length, np.column_stack(course), np.column_stack(at), only).page() for only in (False, True)
        ]
        left = (high - low) - sum(y - x for x, y in held)
        rows = (("from", "to", "in the cylinder"), *((f"{x:.6f}", f"{y:.6f}", "yes") for x, y in held))
        return [
            FilmStep(
                "figure 5",
                "Curve and cylinder",
                "Where the curve passes the surface of a cylinder is computed; between "
                "these parameters it is in it or not.",
                "The roots of squared distance less squared radius, a polynomial of each Bézier piece; the height over "
                f"the axis is drawn {scale:.0f} times too large.",
                pictures[0],
                (FilmFigure("chord", chord), FilmFigure("crossings", len(cuts)), FilmFigure("radius", radius, "mm")),
                rows,
            ),
            FilmStep(
                "figure 6",
                "What no cylinder holds",
                "An interval of the curve that is in no element of the region is "
                "left over: the curve is not in the region.",
                "Neighbouring regions hold balls at the points, and the outline may be wider than the cylinder "
                "between.",
                pictures[1],
                (FilmFigure("share of the stretch that is left over", left / max(high - low, 1e-12)),),
            ),
        ]

    def _crossing(self, length: float, course: Floats, cuts: Floats, only_outside: bool) -> StepDrawing:
        """Return the picture of a curve over a cylinder.

        Args:
            length: of the axis, mm. course: (n, 2) z and r of the curve, mm. cuts: (m, 2) the same of its crossings.
            only_outside: draw only what is not in the cylinder.
        """
        sketch, radius, scale, (z, r) = StepDrawing(), self.profile.radius, self._exaggeration(length), course.T
        sketch.area(np.array([[0, 0], [length, 0], [length, radius], [0, radius]]) * [1, scale])
        sketch.line(np.array([[0, radius], [length, radius]]) * [1, scale], BLUE, FINE)
        sketch.line(np.array([[0, 0], [length, 0]]), FAINT, LINE)
        out = np.ma.masked_where(r <= radius, r) if only_outside else r
        for part in _unmasked(z, out):
            sketch.line(part * [1, scale], RED if only_outside else GREEN, BOLD if only_outside else LINE)
        sketch.dots(cuts * [1, scale], AMBER, 1.1)
        return sketch

    def _witness(self, chord: int) -> SurfaceWitness | None:
        """Return the interval of a chord's stretch whose way by the surface is the narrowest; None if it is outside."""
        feet = self._feet()
        if feet is None:
            return None
        a, b = self.points[chord], self.points[chord + 1]
        found = [
            surface_witness(self.final, ChordAxis(a, b), self.profile, (low, high))
            for low, high in _by_pieces(float(feet[chord]), float(feet[chord + 1]))
        ]
        return min(found, key=lambda each: each.way - each.length, default=None)

    def _spheroid(self, chord: int, seen: SurfaceWitness) -> list[FilmStep]:
        """Return figures 7 and 8."""
        a, b = self.points[chord], self.points[chord + 1]
        length = float(np.linalg.norm(b - a))
        scale = self._exaggeration(length)
        section = _SpheroidSection.of(ChordAxis(a, b), seen)
        pictures = [self._section(chord, section, with_way).page() for with_way in (False, True)]
        return [
            FilmStep(
                "figure 7",
                "The spheroid",
                "All of the curve from P to Q lies in the spheroid with foci P and Q whose "
                "strings are as long as the curve.",
                f"The length is bounded by the control polygon's; heights are drawn {scale:.0f} times too large.",
                pictures[0],
                (
                    FilmFigure("chord", chord),
                    FilmFigure("P to Q", section.span, "mm"),
                    FilmFigure("curve, at most", seen.length, "mm"),
                    FilmFigure("half width of the spheroid", section.half_width, "mm"),
                ),
            ),
            FilmStep(
                "figure 8",
                "The shortest way by the surface",
                "If the curve from P to Q is shorter than the shortest way "
                "P, X, Q by way of any point X of the region's surface, it cannot leave the region.",
                "X is looked for on the whole surface here. What decides in the program is the spheroid against the "
                "outline, on ever shorter intervals, never a sample.",
                pictures[1],
                (
                    FilmFigure("curve, at most", seen.length, "mm"),
                    FilmFigure("shortest way P, X, Q", seen.way, "mm"),
                    FilmFigure("spare", seen.way - seen.length, "mm"),
                    FilmFigure("X along the axis", float((seen.x - a) @ (b - a)) / max(length, 1e-300), "mm"),
                    FilmFigure("cannot leave", "yes" if seen.length < seen.way else "not yet: halved"),
                ),
            ),
        ]

    def _section(self, chord: int, section: _SpheroidSection, with_way: bool) -> StepDrawing:
        """Return the picture of a spheroid in the region of a chord, with the way by its surface or without."""
        length = float(np.linalg.norm(self.points[chord + 1] - self.points[chord]))
        sketch, plane, scale, (z, r) = StepDrawing(), section.plane, self._exaggeration(length), self._outline()
        both = np.concatenate([r, -r[::-1]]) * scale
        sketch.area(np.column_stack([np.concatenate([z, z[::-1]]) * length, both]), AREA)
        sketch.line(np.array([[0, 0], [length, 0]]), FAINT, LINE)
        sketch.line(plane.seen(section.rim) * [1, scale], AMBER, LINE)
        feet = self._feet()
        if feet is not None:
            places = self.final.at(np.linspace(feet[chord], feet[chord + 1], 300))
            sketch.line(plane.seen(places) * [1, scale], GREEN, BOLD)
        ends = plane.seen(np.vstack([section.witness.p, section.witness.q])) * [1, scale]
        sketch.dots(ends, BLUE, 1.0)
        for name, place in zip("PQ", ends, strict=True):
            sketch.word(name, place, BLUE)
        if with_way:
            x = plane.seen(section.witness.x[None]) * [1, scale]
            sketch.line(np.vstack([ends[:1], x, ends[1:]]), RED, LINE, DASHED)
            sketch.dots(x, RED, 1.1)
            sketch.word("X", x[0], RED)
        return sketch

    def result(self) -> FilmStep:
        """Return the end of figure 4."""
        judged = self.judged
        sketch = self._drawn(self.final)
        knots = self.final.control[1:, 0]
        sketch.dots(knots, AMBER, 0.7)
        return FilmStep(
            "figure 4, end",
            "The curve",
            "The curve that is in the region is put out; a long program is cut into pieces that join smoothly.",
            f"Afterwards control points are taken away again as far as the proof holds. A run of more than {LONGEST:,} "
            "points is fitted in pieces, each of which goes on with the direction and the curvature of the one before; "
            "`smooth --report` lists every joint of what was written.",
            sketch.page(),
            (
                FilmFigure("Bézier pieces", len(self.final)),
                FilmFigure("region", judged.answer.value),
                FilmFigure("farthest from its chord, found", judged.from_curve, "mm"),
                FilmFigure("proven", judged.bound, "mm"),
            ),
        )


class ChordAxis(NamedTuple):
    """The axis of a chord's region: both ends of the chord, mm; it goes on beyond them."""

    start: Floats
    end: Floats

    @property
    def direction(self) -> Floats:
        """The unit vector along it."""
        way: Floats = self.end - self.start
        return way / max(float(np.linalg.norm(way)), 1e-300)

    def parts(self, places: Floats) -> tuple[Floats, Floats]:
        """Return how far along the axis places (n, 3) are, (n,) mm, and the vectors (n, 3) from it to them, mm."""
        z = (places - self.start) @ self.direction
        return z, places - self.start - z[:, None] * self.direction


def intervals_in_cylinder(
    curve: SpaceCurve, axis: ChordAxis, radius: float, between: tuple[float, float]
) -> tuple[list[float], list[tuple[float, float]]]:
    """Return where a stretch of a curve passes the surface of a cylinder, and the intervals in which it is inside.

    Args:
        axis: of the cylinder. radius: mm.
        between: first and last parameter of the stretch.

    References:
        JP 2014-242013, figure 5.
    """
    cuts: list[float] = []
    for low, high in _by_pieces(*between):
        piece = min(int(low), len(curve) - 1)
        _, off = axis.parts(curve.control[piece])
        square = np.zeros(2 * len(off) - 1)
        for k in range(3):
            square += np.convolve(_power(off[:, k]), _power(off[:, k]))
        square[0] -= radius**2
        cuts += [u for root in _real_roots(square) if low < (u := root + piece) < high]
    edges = [between[0], *cuts, between[1]]
    middles = curve.at(np.array([(a + b) / 2 for a, b in pairwise(edges)]))
    _, r = _about(middles, axis)
    held = [(edges[k], edges[k + 1]) for k in np.flatnonzero(r <= radius).tolist()]
    return cuts, held


def _real_roots(polynomial: Floats) -> list[float]:
    """Return the real roots of a polynomial by powers, in order; those of an eigenvalue solver, made better by Newton's
    steps.
    """
    kept = np.abs(polynomial) > _NO_POWER * np.abs(polynomial).max()
    if not kept.any():
        return []
    trimmed = polynomial[: int(np.flatnonzero(kept)[-1]) + 1]
    roots = np.polynomial.polynomial.polyroots(trimmed)
    real = roots[np.abs(roots.imag) < _REAL].real
    slope = np.polynomial.polynomial.polyder(trimmed)
    for _ in range(3):
        steep = np.polynomial.polynomial.polyval(real, slope)
        value = np.polynomial.polynomial.polyval(real, polynomial)
        real = real - np.where(steep != 0, value / np.where(steep == 0, 1.0, steep), 0.0)
    return sorted(real.tolist())


def _power(bernstein: Floats) -> Floats:
    """Return the coefficients of a polynomial in Bernstein form by powers of its parameter."""
    n = len(bernstein) - 1
    made = np.zeros(n + 1)
    differences = bernstein.copy()
    for k in range(n + 1):
        made[k] = math.comb(n, k) * differences[0]
        differences = np.diff(differences)
    return made


def surface_witness(
    curve: SpaceCurve, axis: ChordAxis, profile: RegionProfile, between: tuple[float, float]
) -> SurfaceWitness:
    """Return the shortest way by the surface of a chord's region from one end of an interval to the other.

    The interval is the whole of `between`, or the part of it at which halving, wherever the way is not yet longer than
    the curve, comes to one that is.

    Args:
        between: parameters within one piece.
    """
    low, high = between
    for _ in range(_DEEPEST):
        control = portion_of(curve, low, high)
        length = float(np.linalg.norm(np.diff(control, axis=0), axis=1).sum())
        way, x = _shortest_way(control[0], control[-1], axis, profile)
        if length < way:
            break
        high = (low + high) / 2
    return SurfaceWitness(control[0], control[-1], x, length, way)


def _shortest_way(p: Floats, q: Floats, axis: ChordAxis, profile: RegionProfile) -> tuple[float, Floats]:
    """Return the length of the shortest way P, X, Q over all X of the outline turned about the axis, and X."""
    a, way = axis.start, axis.direction
    length = float(np.linalg.norm(axis.end - a))
    across = np.cross(way, [1.0, 0, 0] if abs(way[0]) < 0.9 else [0, 1.0, 0])
    across /= np.linalg.norm(across)
    other = np.cross(way, across)
    z_low, z_high, turn_low, turn_high = 0.0, 1.0, 0.0, 2 * math.pi
    for _ in range(5):
        z, turn = np.linspace(z_low, z_high, 161), np.linspace(turn_low, turn_high, 161)
        r = np.array([profile.outline.radius(float(each)) for each in z])
        places = (
            a
            + (z * length)[:, None, None] * way
            + r[:, None, None] * (np.cos(turn)[:, None] * across + np.sin(turn)[:, None] * other)
        )
        total = np.linalg.norm(places - p, axis=2) + np.linalg.norm(places - q, axis=2)
        row, col = np.unravel_index(int(np.argmin(total)), total.shape)
        best, x = float(total[row, col]), places[row, col]
        dz, dt = (z_high - z_low) / 40, (turn_high - turn_low) / 40
        z_low, z_high = max(z[row] - dz, 0.0), min(z[row] + dz, 1.0)
        turn_low, turn_high = turn[col] - dt, turn[col] + dt
    return best, x


def _by_pieces(low: float, high: float) -> list[tuple[float, float]]:
    """Return a stretch of parameters cut where one piece ends and the next begins."""
    edges = [low, *(float(k) for k in range(math.floor(low) + 1, math.ceil(high))), high]
    return [(a, b) for a, b in pairwise(edges) if b > a]


def _about(places: Floats, axis: ChordAxis) -> tuple[Floats, Floats]:
    """Return how far along an axis and off it places are, mm."""
    z, off = axis.parts(places)
    return z, np.linalg.norm(off, axis=1)


class _SectionPlane(NamedTuple):
    """A plane through an axis, in which a region is drawn: where it begins, and unit vectors along and square to it."""

    origin: Floats
    along: Floats
    across: Floats

    @staticmethod
    def through(axis: ChordAxis, x: Floats) -> _SectionPlane:
        """Return the plane through an axis and a place."""
        out = axis.parts(x[None])[1][0]
        return _SectionPlane(axis.start, axis.direction, out / max(float(np.linalg.norm(out)), 1e-300))

    def seen(self, places: Floats) -> Floats:
        """Return places (n, 3) as seen along the axis and square to it, (n, 2) mm."""
        return np.column_stack([(places - self.origin) @ self.along, (places - self.origin) @ self.across])


class _SpheroidSection(NamedTuple):
    """A spheroid as the plane through the axis and the nearest way's place X cuts it.

    Attributes:
        witness: the interval whose spheroid it is. plane: that it is seen in.
        span, half_width: from P to Q, and of the spheroid square to that, mm. rim: (m, 3) of the spheroid, mm.
    """

    witness: SurfaceWitness
    plane: _SectionPlane
    span: float
    half_width: float
    rim: Floats

    @staticmethod
    def of(axis: ChordAxis, witness: SurfaceWitness) -> _SpheroidSection:
        """Return it; a spheroid with strings of length l has half axes l / 2 and sqrt(l^2 - |PQ|^2) / 2."""
        p, q = witness.p, witness.q
        span = float(np.linalg.norm(q - p))
        half, width = witness.length / 2, math.sqrt(max(witness.length**2 - span**2, 0.0)) / 2
        angle = np.linspace(0, 2 * math.pi, 200)
        middle, way = (p + q) / 2, (q - p) / max(span, 1e-300)
        side = np.cross(np.cross(way, witness.x - middle), way)
        side /= max(float(np.linalg.norm(side)), 1e-300)
        rim = middle + half * np.cos(angle)[:, None] * way + width * np.sin(angle)[:, None] * side
        return _SpheroidSection(witness, _SectionPlane.through(axis, witness.x), span, width, rim)


def _unmasked(z: Floats, r: Floats) -> list[Floats]:
    """Return the runs of a curve (z, r) whose r is not masked."""
    keep = ~np.ma.getmaskarray(r)
    edges = np.flatnonzero(np.diff(np.concatenate([[False], keep, [False]]).astype(np.int8))).reshape(-1, 2)
    return [np.column_stack([z[a:b], np.ma.getdata(r)[a:b]]) for a, b in edges.tolist() if b - a > 1]
