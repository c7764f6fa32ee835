"""A smoothed program, ready to be shown: both paths, what stayed, corners, comb. Made on the worker's thread."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from ....core.progress import Progress
from ....fitting.point_curves.deviation import curvature
from ..nc.motion_shapes import Floats, Ints, MotionShapes, ViewSide, shape_motions
from ..nc.painting.motion_layer import MotionLayer
from ..nc.program_reader import ProgramSource, ShownProgram, read_shown
from .deviation_track import DeviationTrack, pieces_of_lines, track_of

if TYPE_CHECKING:
    from ....usecases.smoothing.result import SmoothedProgram, SmoothedStretch, SmoothOptions

_TEETH = 20_000
"""Teeth of the comb of a whole program, about."""
_MOST_TEETH = 8
_TALL = 95.0
"""The tooth that is as tall as so many of a hundred: one sharp bend must not make all others flat."""


@dataclass(frozen=True, eq=False)
class CurvatureComb:
    """k teeth on the new curves.

    Attributes:
        foot: (k, 3) mm. tooth: (k, 3) away from the centre of curvature, 1/mm. tall: what is a tall one, 1/mm, > 0.
        piece: (k,) the stretch that each stands on.
    """

    foot: Floats
    tooth: Floats
    tall: float
    piece: Ints


@dataclass(frozen=True, eq=False)
class SmoothedPoints:
    """k points that curves stand for.

    Attributes:
        was: (k, 3) mm. state: (k,) PointState: what each is to the curves.
        places: (k, 3) mm: where the curves are asked to go by; `was` but for those that are moved.
        told_apart: whether method D was asked for; else all are effective.
    """

    was: Floats
    state: NDArray[np.uint8]
    places: Floats
    told_apart: bool


@dataclass(frozen=True, eq=False)
class CurveLayers:
    """What is seen from one side.

    Attributes:
        curves: what was written anew. stayed: all else of the new program. before: the moves that curves stand for.
    """

    curves: MotionLayer
    stayed: MotionLayer
    before: MotionLayer


@dataclass(frozen=True, eq=False)
class CurvesModel:
    """A program before and after.

    Attributes:
        was: the program that came in. done: what smoothing made of it. now: the new text, read as it will be saved.
        before: shapes of what came in. track: deviation. comb: curvature.
        piece: (n,) stretch of each motion of the new program, -1 = none. corners: (k, 3) of stretches that changed, mm.
        points: of these stretches.
        layers: of the sides that were asked for.
    """

    was: ShownProgram
    done: SmoothedProgram
    now: ShownProgram
    before: MotionShapes
    track: DeviationTrack
    comb: CurvatureComb
    piece: Ints
    points: SmoothedPoints
    corners: Floats
    layers: dict[ViewSide, CurveLayers]

    @property
    def changed(self) -> Ints:
        """Numbers of the stretches that were written anew."""
        return np.array([k for k, piece in enumerate(self.done.pieces) if piece.judgement is not None], np.int64)

    def why(self, motion: int) -> str:
        """Return why a motion of the new program stayed as it was; "" of a curve, and of what is in no stretch."""
        piece = int(self.piece[motion])
        return self.done.pieces[piece].kept if piece >= 0 else ""


def smoothed(was: ShownProgram, options: SmoothOptions, side: ViewSide, progress: Progress) -> CurvesModel:
    """Return a program, smoothed.

    Raises:
        HitofudeError: it cannot be; a sentence.
        Cancelled: the job was asked to stop.
    """
    from ....model.motion_path import anchored
    from ....usecases.smoothing.smooth import smooth

    done = smooth(
        was.source.name, was.source.named_units(), replace(options, dialect=was.dialect), progress.part(0.0, 0.7)
    )
    name = Path(was.source.name)
    source = ProgramSource(
        f"{name.stem}-smooth{name.suffix}", done.data, dialect=done.dialects[1], tools=was.source.tools
    )
    now = read_shown(source, side, progress.part(0.7, 0.85))
    progress.step(0.85, "Preparing the picture")
    before = shape_motions(replace(done.before, motions=anchored(done.before.motions)))
    lines = now.program.motions.line.astype(np.int64)
    notes = int(lines[0] - done.after.motions.line[0]) if len(lines) else 0
    changed = [piece for piece in done.pieces if piece.judgement is not None]
    none = np.zeros((0, 3))
    corners = np.concatenate([none, *(piece.points[piece.corners] for piece in changed)])
    shown = CurvesModel(
        was,
        done,
        now,
        before,
        track_of(done),
        _comb(done),
        pieces_of_lines(done, lines, notes),
        _points(changed),
        corners,
        {},
    )
    shown.layers[side] = layers(shown, side, progress.part(0.9, 1.0))
    return shown


def layers(shown: CurvesModel, side: ViewSide, progress: Progress) -> CurveLayers:
    """Return what is seen of a smoothed program from a side.

    Raises:
        Cancelled: the job was asked to stop.
    """
    progress.step(0.0, "Preparing the picture")
    new = np.isin(shown.piece, shown.changed)
    stretches = [shown.done.pieces[k].stretch for k in shown.changed.tolist()]
    old = np.concatenate([np.zeros(0, np.int64), *(np.arange(each.first, each.stop) for each in stretches)])
    shapes = shown.now.shapes
    curves, stayed = (MotionLayer(shapes, side, np.flatnonzero(rows)) for rows in (new, ~new))
    progress.step(0.7, "Preparing the picture")
    return CurveLayers(curves, stayed, MotionLayer(shown.before, side, old))


def _points(changed: list[SmoothedStretch]) -> SmoothedPoints:
    """Return the points of stretches that changed."""
    from ....fitting.point_curves.effective_points import PointState

    classes = [piece.classes for piece in changed]
    was = np.concatenate([np.zeros((0, 3)), *(piece.points for piece in changed)])
    every = np.full(len(was), PointState.EFFECTIVE, np.uint8)
    known = [each for each in classes if each is not None]
    if len(known) < len(classes) or not known:
        return SmoothedPoints(was, every, was, False)
    return SmoothedPoints(
        was, np.concatenate([each.state for each in known]), np.concatenate([each.places for each in known]), True
    )


def _comb(done: SmoothedProgram) -> CurvatureComb:
    """Return the teeth of all curves."""
    curves = {k: piece.curve for k, piece in enumerate(done.pieces) if piece.curve is not None}
    if not curves:
        return CurvatureComb(np.zeros((0, 3)), np.zeros((0, 3)), 1.0, np.zeros(0, np.int64))
    per = int(np.clip(_TEETH // sum(len(curve) for curve in curves.values()), 1, _MOST_TEETH))
    made = [curvature(curve, per) for curve in curves.values()]
    tooth = -np.concatenate([bent for _, bent in made])
    size = np.linalg.norm(tooth, axis=1)
    tall = float(np.percentile(size[size > 0], _TALL)) if np.any(size > 0) else 1.0
    piece = np.repeat(np.array(list(curves)), [len(foot) for foot, _ in made])
    return CurvatureComb(np.concatenate([foot for foot, _ in made]), tooth, tall, piece)
