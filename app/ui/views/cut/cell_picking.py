"""What lies under the mouse: the cell that a line of sight meets first, found on the heights themselves. No Qt."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from .camera import SightRay
from .cut_picture import CutPicture, Floats


@dataclass(frozen=True, slots=True)
class SectionPlane:
    """A vertical plane; what lies on the side that its normal points to is taken away.

    Attributes:
        normal: (x, y), length 1.
        offset: distance of the plane from the origin along the normal, mm.
    """

    normal: tuple[float, float]
    offset: float

    def beyond(self, points: Floats) -> Floats:
        """Return how far points, (n, 2) or (n, 3), lie on the side that is taken away, mm; < 0 on the other side."""
        return np.asarray(points[:, 0] * self.normal[0] + points[:, 1] * self.normal[1] - self.offset)


@dataclass(frozen=True, slots=True)
class PickedCell:
    """The cell that is looked at.

    Attributes:
        row, column: of the cell.
        place: (x, y, z) where the line of sight meets the metal, mm.
        height: of the cell, mm; lower than it z is a wall.
        picture: whose cell it is.
    """

    row: int
    column: int
    place: tuple[float, float, float]
    height: float
    picture: CutPicture

    @property
    def move(self) -> int:
        """The move that cut the cell last; -1 = none, or nobody knows."""
        return self.picture.move_at(self.row, self.column)


def pick_finest(
    picture: CutPicture, detail: CutPicture | None, ray: SightRay, section: SectionPlane | None = None
) -> PickedCell | None:
    """Return the first cell that a line of sight meets, of the finer cells where there are some.

    Args:
        picture: all of the heights. detail: those of a part of it once more, finer; None = there are none.
        ray: line of sight.
        section: only what it leaves can be met.
    """
    hit = pick(picture, ray, section)
    fine = pick(detail, ray, section) if detail is not None else None
    if detail is None or fine is None or hit is None:
        return fine or hit
    covered = detail.holds(*hit.place[:2])
    nearer = np.dot(np.subtract(fine.place, hit.place), ray.direction) <= 0
    return fine if covered or nearer else hit


def pick(picture: CutPicture, ray: SightRay, section: SectionPlane | None = None) -> PickedCell | None:
    """Return the first cell that a line of sight meets; None where it passes by.

    Every cell is a column with a flat top, as the engine means it; one that was cut through to the floor is none. The
    ray's pieces between the lines of the grid are looked at all at once: a piece belongs to one cell, and meets it
    where its lower end is not above the cell's height.

    Args:
        picture: the heights.
        ray: line of sight.
        section: only what it leaves can be met.
    """
    span = _span(picture, ray, section)
    if span is None:
        return None
    cuts = crossings(picture, ray, *span)
    middles = ray.origin + (cuts[:-1] + cuts[1:])[:, None] / 2 * ray.direction
    columns, rows = (
        np.clip(np.floor((middles[:, axis] - corner) / picture.pitch).astype(np.int64), 0, count - 1)
        for axis, corner, count in ((0, picture.x0, picture.columns), (1, picture.y0, picture.rows))
    )
    heights = picture.heights[rows, columns].astype(float)
    heights[heights <= picture.floor] = -np.inf
    z = ray.origin[2] + cuts * ray.direction[2]
    met = np.flatnonzero(np.minimum(z[:-1], z[1:]) <= heights)
    if not len(met):
        return None
    first = int(met[0])
    t = cuts[first]
    if z[first] > heights[first]:
        t = (heights[first] - ray.origin[2]) / ray.direction[2]
    x, y, height = (float(value) for value in ray.origin + t * ray.direction)
    return PickedCell(int(rows[first]), int(columns[first]), (x, y, height), float(heights[first]), picture)


def _span(picture: CutPicture, ray: SightRay, section: SectionPlane | None) -> tuple[float, float] | None:
    """Return from where to where a ray is inside the box of the stock and on the side that a section leaves."""
    high = picture.high
    high[2] = max(picture.highest, picture.floor)
    low, begin, end = picture.low, -np.inf, np.inf
    planes = [
        (np.eye(3)[axis] * sign, sign * bound)
        for axis in range(3)
        for sign, bound in ((1, high[axis]), (-1, low[axis]))
    ]
    if section is not None:
        planes.append((np.array([*section.normal, 0.0]), section.offset))
    for normal, offset in planes:
        speed, ahead = float(normal @ ray.direction), float(offset - normal @ ray.origin)
        if abs(speed) < 1e-12:
            if ahead < 0:
                return None
        elif speed > 0:
            end = min(end, ahead / speed)
        else:
            begin = max(begin, ahead / speed)
    return (begin, end) if begin <= end else None


def crossings(picture: CutPicture, ray: SightRay, begin: float, end: float) -> Floats:
    """Return where a ray crosses lines of the grid between two of its points, these included, in order."""
    found = [np.array([begin, end])]
    for axis, corner, count in ((0, picture.x0, picture.columns), (1, picture.y0, picture.rows)):
        if abs(ray.direction[axis]) > 1e-12:
            lines = (corner + np.arange(count + 1) * picture.pitch - ray.origin[axis]) / ray.direction[axis]
            found.append(lines[(lines > begin) & (lines < end)])
    return np.sort(np.concatenate(found))
