"""The compound surface as it is generated: plane by plane the topmost points, and where they pass from surface to
surface.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from ...core.memory import MemoryRemedy, ask, fitting

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]

NO_SURFACE = -1
"""Beside a boundary point where the compound surface begins or ends."""


class BoundaryKind(IntEnum):
    """How the topmost passes from one surface to another."""

    CROSSING = 0
    """Both go on; one comes up through the other."""
    EDGE = 1
    """One ends, at the height of the other, or where there is none."""
    JUMP = 2
    """One ends above or beside the other: two heights at one place."""
    TANGENT = 3
    """They touch, at a place or along a stretch, rather than cross."""


@dataclass(frozen=True, slots=True)
class CuttingPlanes:
    """Parallel cutting planes, upright on the XY plane.

    Attributes:
        origin: x, y of the place from which distances along the planes and across them count, mm.
        angle: of the planes to the X axis, radians.
        offsets: how far each lies to the left of the origin, mm, rising.
    """

    origin: tuple[float, float]
    angle: float
    offsets: tuple[float, ...]

    @property
    def along(self) -> tuple[float, float]:
        """Unit vector x, y along the planes."""
        return math.cos(self.angle), math.sin(self.angle)

    def place(self, plane: int, distance: float) -> tuple[float, float]:
        """Return x, y of a place on a plane, so far along it, mm."""
        (x, y), (c, s), offset = self.origin, self.along, self.offsets[plane]
        return x + distance * c - offset * s, y + distance * s + offset * c

    def ask_memory(self, needed: float) -> None:
        """Ask for the memory, bytes, of what grows with the number of planes.

        Raises:
            MemoryShortError: there is not as much.
        """
        count = len(self.offsets)
        apart = (self.offsets[-1] - self.offsets[0]) / max(count - 1, 1)
        larger = f"{apart / fitting(needed) * 1.05:.2g}"
        ask(
            needed,
            f"Passes on {count:,} planes",
            MemoryRemedy(f"set them {larger} mm apart or more (pitch = {larger} in the scene)"),
        )


@dataclass(frozen=True, eq=False)
class SectionRun:
    """A sequence of points on one plane without a gap.

    Attributes:
        plane: number of the plane.
        points: (n, 3) mm, n >= 2, in the order of generation.
        owner: (n - 1,) number of the surface that each chord is on.
    """

    plane: int
    points: Floats
    owner: Ints


@dataclass(frozen=True, eq=False)
class PlaneSection:
    """Where a plane cuts one surface.

    Attributes:
        plane, owner: numbers of the plane and of the surface.
        points: (n, 3) on the surface, mm, in order. parameters: (n, 2) of the surface there, each from 0 to 1; NaN on
            meshes.
    """

    plane: int
    owner: int
    points: Floats
    parameters: Floats


@dataclass(frozen=True, eq=False)
class BoundaryPoints:
    """m boundary points CRij, in the order of generation.

    Attributes:
        plane: (m,) number of the plane.
        before, after: (m,) numbers i and j of the surfaces, NO_SURFACE beyond the ends of the compound surface.
        place: (m, 3) mm, on i. end: (m, 3) on j: the other height of a jump, the end of a stretch of contact; else
            `place`.
        before_at, after_at: (m, 2) parameters on both, each from 0 to 1; NaN on meshes and beyond ends.
        kind: (m,) BoundaryKind.
    """

    plane: Ints
    before: Ints
    after: Ints
    place: Floats
    end: Floats
    before_at: Floats
    after_at: Floats
    kind: NDArray[np.uint8]

    def __len__(self) -> int:
        return len(self.kind)

    @staticmethod
    def none() -> BoundaryPoints:
        """Return those of a compound whose surfaces meet nowhere."""
        number, place, at = np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros((0, 2))
        return BoundaryPoints(
            plane=number,
            before=number,
            after=number,
            place=place,
            end=place,
            before_at=at,
            after_at=at,
            kind=np.zeros(0, np.uint8),
        )


@dataclass(frozen=True, eq=False)
class CompoundSurface:
    """A compound surface, or the path of a cutter over one, which is that of the offset surfaces.

    Attributes:
        planes: that it was cut by. runs: its points, plane by plane. boundaries: where they pass from surface to
            surface.
        curves: of every surface on every plane, also below others; none for the path of a cutter.
    """

    planes: CuttingPlanes
    runs: tuple[SectionRun, ...]
    boundaries: BoundaryPoints
    curves: tuple[PlaneSection, ...] = ()

    def numbered(self, numbers: Ints) -> CompoundSurface:
        """Return it with other numbers of surfaces: `numbers[k]` for k."""
        at = np.append(numbers, NO_SURFACE)
        marks = self.boundaries
        return CompoundSurface(
            self.planes,
            tuple(replace(run, owner=at[run.owner]) for run in self.runs),
            replace(marks, before=at[marks.before], after=at[marks.after]),
            tuple(replace(curve, owner=int(at[curve.owner])) for curve in self.curves),
        )
