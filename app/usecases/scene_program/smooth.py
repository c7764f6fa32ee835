"""Curves over surfaces that cannot gouge: a tube that opens away from the walls alone, in one tolerance a surface.

`smooth` holds a curve within so much of the moves, on either side, and moves lie on the surfaces. So passes are made
that stand off by the radius of the tube: the tube then touches the surfaces and nowhere enters them. How far a cutter
is from a surface changes by no more than the cutter is moved, so what was proven of the moves, and what is proven of
the curves beside them, say together that no curve goes deeper than a move; all the freedom lies on the open side.
Whether that is so is looked at once more, curve by curve, against the surfaces themselves.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...fitting.point_curves.space_curve import SpaceCurve
from ...gcode.posts import load_post
from ...model.finding import Finding, FindingKind
from ...model.scene import Passes, Scene
from ...model.scene_shapes import StepShape
from ...surfaces.passes.path import ALLOWED, Follower, FollowOptions
from ..scene.compute import ComputedScene
from ..smoothing.report import findings as smooth_findings
from ..smoothing.report import report as smooth_report
from ..smoothing.result import OutputForm, SmoothedProgram, SmoothOptions
from ..smoothing.smooth import smooth
from ..tolerance_budget import BudgetShare, Evidence, ToleranceBudget
from .nc import WrittenScene

Floats = NDArray[np.float64]
Json = dict[str, Any]

_CHORD = 2e-5
"""mm; chords that stand for a curve where it is looked at once more are nowhere farther from it."""
_MOST_CHORDS = 4096
"""Of one piece of a curve."""
_CHORDS = 0.2
"""Of the tolerance: chords take no more of it, however coarse passes may be else. They cost points, of which none is
written, and what they take the curves lack: blocks are some three fifths where it is a fifth in place of a half.
"""
_DIGITS = 2.0
"""Steps of the last decimal that rounding takes: of the passes, and of the curves."""


@dataclass(frozen=True)
class CurvesOverSurfaces:
    """How a scene's program becomes curves.

    Attributes:
        tolerance: all that may lie between a surface and the path that touches it, square to it, mm: the facets that
            stand for it, chords, curves, digits. None of it goes into the metal.
        form: what curves are written as.
    """

    tolerance: float
    form: OutputForm = OutputForm.ARCS

    def chords(self, passes: Passes) -> float:
        """Return the chord tolerance of passes that curves stand for, mm."""
        return min(passes.chord_tolerance, _CHORDS * self.tolerance)

    def tube(self, passes: Passes, sag: float, grid: float) -> float:
        """Return the radius of the tube round passes, mm: half of what is left to the curves.

        Args:
            passes: with their own chord tolerance. sag: of facets in place of surfaces, mm. grid: last decimal, mm.

        Raises:
            InputError: nothing is left.
        """
        chords = self.chords(passes)
        spare = (self.tolerance - chords - sag - _DIGITS * grid) / 2
        if not spare > 4 * grid:
            least = (sag + _DIGITS * grid + 10 * grid) / (1 - _CHORDS)
            raise InputError(
                f"{option('smooth', f'{self.tolerance:g}')} mm leaves {max(2 * spare, 0.0):.4g} mm to the curves: "
                f"chords of {passes.name or 'the passes'} take {chords:g} mm, facets of surfaces "
                f"{sag:g} mm; use more than {least:.3g} mm, or a smaller chord_tolerance."
            )
        return spare


@dataclass(frozen=True, eq=False)
class SmoothedScene:
    """A scene's program as curves.

    Attributes:
        how: as was asked. written: the program that they stand for, whose passes stand off.
        done: each file, smoothed. tube: radius of the tube, mm.
        gouging: (k, 3) ends of motions, scene coordinates, that may go deeper than ALLOWED. chords: looked at.
        budgets: of each surface, by its name.
    """

    how: CurvesOverSurfaces
    written: WrittenScene
    done: tuple[SmoothedProgram, ...]
    tube: float
    gouging: Floats
    chords: int
    budgets: dict[str, ToleranceBudget]

    def findings(self) -> tuple[Finding, ...]:
        """Return what somebody has to know."""
        gouges = (
            Finding(
                FindingKind.GOUGE,
                f"The curve to ({x:.3f}, {y:.3f}, {z:.3f}) could not be proven to stay within {ALLOWED:g} mm of the "
                "surfaces; make the tolerance larger.",
                x,
                y,
            )
            for x, y, z in self.gouging.tolist()
        )
        budgets = (
            Finding(FindingKind.TOLERANCE, f"{name}: {budget.lines()[-1]}; use a larger tolerance.")
            for name, budget in self.budgets.items()
            if not budget.kept
        )
        return (*gouges, *budgets, *(found for each in self.done for found in smooth_findings(each)))

    def lines(self) -> tuple[str, ...]:
        """Return it in words."""
        before, after = (sum(piece.blocks[k] for each in self.done for piece in each.pieces) for k in (0, 1))
        proven = f"{self.chords} chords of the curves as written, none deeper than {ALLOWED:g} mm"
        if len(self.gouging):
            proven = f"{len(self.gouging)} of {self.chords} chords of the curves are not proven"
        return (
            f"  curves: {before} blocks before, {after} after; a tube of {self.tube:.6f} mm round passes that stand "
            f"off as much; {proven}",
            *(f"  {name}: {line}" for name, budget in self.budgets.items() for line in budget.lines()[-1:]),
        )

    def report(self) -> Json:
        """Return it for the report, lengths in mm."""
        return {
            "tolerance_mm": self.how.tolerance,
            "tube_mm": self.tube,
            "chords_looked_at": self.chords,
            "unproven": self.gouging.tolist(),
            "surfaces": {name: budget.report() for name, budget in self.budgets.items()},
            "programs": [smooth_report(each) for each in self.done],
        }


def standing_off(scene: Scene, how: CurvesOverSurfaces) -> Scene:
    """Return a scene whose passes stand off its surfaces by the radius of their tube, mm.

    Raises:
        InputError: the tolerance leaves nothing to the curves.
    """
    sag, grid = sag_of(scene), _grid(scene)
    passes = []
    for each in scene.passes:
        off = how.tube(each, sag, grid)
        name = f"{each.name} standing off {off:.6f} mm".strip()
        leave = each.stock_to_leave + off
        passes.append(replace(each, stock_to_leave=leave, chord_tolerance=how.chords(each), name=name))
    return replace(scene, passes=tuple(passes))


def sag_of(scene: Scene) -> float:
    """Return how far the facets in place of a scene's surfaces may be off these, mm: of STEP faces; others are exact,
    or are what is meant, as meshes are.
    """
    return max((each.shape.tolerance for each in scene.surfaces if isinstance(each.shape, StepShape)), default=0.0)


def _grid(scene: Scene) -> float:
    digits = load_post(scene.post).digits(scene.out_units)
    return float(scene.out_units.value * 10.0 ** -min(digits.X, digits.Y, digits.Z))


def smooth_scene(
    scene: Scene, written: WrittenScene, how: CurvesOverSurfaces, progress: Progress = NO_PROGRESS
) -> SmoothedScene:
    """Return the program of a scene whose passes stand off as curves, proven to go into no surface.

    Args:
        scene: as it was, before its passes stood off. written: the program of those that do.

    Raises:
        HitofudeError: it cannot be smoothed. Cancelled: the job was asked to stop.
    """
    sag, grid = sag_of(scene), written.computed.grid
    tube = min(how.tube(each, sag, grid) for each in scene.passes if each.enabled)
    options = SmoothOptions(tube, how.form, post=written.post, dialect=written.post.dialect)
    done = []
    for k, file in enumerate(written.files):
        share = progress.part(0.7 * k / len(written.files), 0.7 * (k + 1) / len(written.files))
        done.append(smooth(f"{scene.name}{file.suffix}", file.nc.text.encode(), options, share))
    gouging, chords = _gouging(scene, written.computed, done, progress.part(0.7, 1.0))
    bound = max((each.bound for each in done), default=0.0)
    budgets = {
        surface.name: _budget(surface.shape, how, (tube, bound), written.computed)
        for surface in scene.surfaces
        if surface.enabled
    }
    return SmoothedScene(how, written, tuple(done), tube, gouging, chords, budgets)


def _budget(
    shape: object, how: CurvesOverSurfaces, curves: tuple[float, float], computed: ComputedScene
) -> ToleranceBudget:
    """Return who spends what of one surface's tolerance; `curves` are the radius of the tube and what is proven."""
    sag = shape.tolerance if isinstance(shape, StepShape) else 0.0
    tube, bound = curves
    chords = max(family.passes.chord_tolerance for family in computed.families)
    return ToleranceBudget(
        how.tolerance,
        (
            BudgetShare("facets", sag, sag, Evidence.MEASURED if sag else Evidence.PROVEN, "in place of the surface"),
            BudgetShare("chords", chords, chords, Evidence.PROVEN, "passes above the surface, never deeper"),
            BudgetShare("smoothing", 2 * tube, tube + bound, Evidence.PROVEN, "passes stand off, curves beside them"),
            BudgetShare("digits", _DIGITS * computed.grid, _DIGITS * computed.grid, Evidence.PROVEN, "last decimals"),
            BudgetShare("cells", 0.0, 0.0, Evidence.PROVEN, "nothing of it is read from cells"),
        ),
    )


def _gouging(
    scene: Scene, computed: ComputedScene, done: list[SmoothedProgram], progress: Progress
) -> tuple[Floats, int]:
    """Return the ends of curves that may go deeper than ALLOWED into the surfaces as they are, without what passes
    stand off, and how many chords of curves were looked at.
    """
    origin = np.array(computed.origin)
    least: dict[int, Follower] = {}
    enabled = [each for each in scene.passes if each.enabled]
    leave = {each.tool: min(one.stock_to_leave for one in enabled if one.tool == each.tool) for each in enabled}
    for family in computed.families:
        options = FollowOptions(leave[family.tool.number], family.follower.options.tolerance)
        least[family.tool.number] = Follower(family.follower.facets, family.tool, options)
    found, count = [np.zeros((0, 3))], 0
    for number, program in enumerate(done):
        for piece in program.pieces:
            progress.step(number / len(done), "Looking at the curves")
            if piece.curve is None:
                continue
            state = program.before.states[program.before.motions.state[piece.stretch.first]]
            follower = least.get(state.tool) or next(iter(least.values()))
            places = chords_of(piece.curve, _CHORD) + origin
            ways = np.concatenate([places[:-1], places[1:]], axis=1)
            clear = follower.proven(ways, allowed=ALLOWED - _CHORD - piece.curve.slack)
            count += len(ways)
            found.append(ways[~clear, 3:])
    return np.concatenate(found), count


def chords_of(curve: SpaceCurve, within: float) -> Floats:
    """Return places (n, 3) along a curve whose chords are nowhere farther from it than so much, mm.

    Raises:
        InputError: a piece would take too many.
    """
    return curve.at(chord_parameters(curve, within))


def chord_parameters(curve: SpaceCurve, within: float) -> Floats:
    """Return parameters (n,) of a curve whose chords are nowhere farther from it than so much, mm: each piece is left
    by a chord of 1 / n of it by no more than an eighth of its second derivative's bound over n².

    Raises:
        InputError: a piece would take too many.
    """
    control = curve.control
    degree = control.shape[1] - 1
    bent = np.linalg.norm(np.diff(control, 2, axis=1), axis=2).max(axis=1) * degree * (degree - 1)
    parts = np.clip(np.ceil(np.sqrt(bent / (8 * within))), 1, None)
    if parts.max(initial=1.0) > _MOST_CHORDS:
        raise InputError(f"A curve would take {int(parts.max())} chords of {within:g} mm; use a larger tolerance.")
    at = [piece + np.arange(int(count)) / count for piece, count in enumerate(parts.tolist())]
    return np.concatenate([*at, [math.nextafter(float(len(curve)), 0.0)]])
