"""What is said of a cut against the part: gouges, what is left, how near it is everywhere."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..model.finding import Finding, FindingKind
from ..simulation.field.workpiece import Grid
from .verdict import Gouge


class SpotKind(Enum):
    """What is wrong at a place. The value is the key in reports."""

    GOUGE = "gouge"
    LEFT = "left"
    UNREACHABLE = "unreachable"


@dataclass(frozen=True, slots=True)
class Spot:
    """The worst of one connected place.

    Attributes:
        x, y, z: where, mm, program coordinates.
        depth_mm: of a gouge how far into the part; of metal left how far it stands out of it.
        area_mm2: of the place, seen from above.
        disc_mm: diameter of the largest disc in it, mm.
        line: NC line of the motion that cut there last, 0 = none did.
        motion: its row among the motions of all programs, -1 = none.
    """

    kind: SpotKind
    x: float
    y: float
    z: float
    depth_mm: float
    area_mm2: float
    disc_mm: float
    line: int = 0
    motion: int = -1


_TELLING_CELLS = 10.0
"""A bound between the cells that is wider says nothing that a person could use."""

BANDS = (-1.0, -0.1, -0.03, 0.03, 0.1, 1.0)
"""mm; where the bands beyond the tolerance end, those within it beside."""


@dataclass(frozen=True, slots=True)
class Band:
    """How much of the area is so far from the part: low <= deviation < high, mm; area in mm2."""

    low: float
    high: float
    area_mm2: float


@dataclass(frozen=True, slots=True)
class Certificate:
    """What holds at every point, also between the cells' centres.

    Attributes:
        gouge_mm: no point deeper than this inside the part was cut.
        left_mm: no metal stands farther than this from the part, where some tool reaches it.
        pitch_mm: of the grid; both numbers are hardly ever below one or two cells.
    """

    gouge_mm: float
    left_mm: float
    pitch_mm: float

    @property
    def telling(self) -> bool:
        """Whether the bound on gouges says something: beside a wall that may be missed by a cell it is the wall's
        height.
        """
        return self.gouge_mm < _TELLING_CELLS * self.pitch_mm


@dataclass(frozen=True, eq=False)
class Judgement:
    """A cut compared with the part, stock to leave taken off.

    Attributes:
        deviation: (rows, cols) height over the part, mm: > 0 metal left, < 0 gouge; 0 where the part says nothing.
        unreachable: (rows, cols) metal left that no tool of the job reaches.
        gouge: the deepest one; where it is, in program coordinates; `move` is the row among the motions of all
            programs.
        reachable_mm2, unreachable_mm2: area of the metal left, seen from above.
        largest_disc_mm: diameter of the largest disc that fits where no tool reaches.
        skin_mm2: area of the skin that paths made from pixels leave along the walls; in none of the areas before.
        spots: the worst places, gouges first, then left, then unreachable; each kind worst first. counts: of all there
            are.
        bands: areas by deviation, from the lowest to the highest.
        certificate: what holds between the cells; None where only the cells were looked at.
        exact: gouge and areas were measured on the motions themselves, and the cells confirm them; else on the cells.
        tolerance: mm.
    """

    deviation: NDArray[np.float32]
    unreachable: NDArray[np.bool_]
    gouge: Gouge
    reachable_mm2: float
    unreachable_mm2: float
    largest_disc_mm: float
    spots: tuple[Spot, ...]
    counts: Mapping[SpotKind, int]
    bands: tuple[Band, ...]
    certificate: Certificate | None
    exact: bool
    tolerance: float
    skin_mm2: float = 0.0

    @property
    def clean(self) -> bool:
        """No gouge, and nothing left within reach."""
        return self.gouge.count == 0 and self.reachable_mm2 == 0


def findings_of(judgement: Judgement, where: Callable[[int], str]) -> tuple[Finding, ...]:
    """Return what there is to say of a judgement, in program coordinates; what is out of reach is a remark.

    Args:
        where: words for the place of a motion in the text, such as "NC line 7".
    """
    return tuple(_told(judgement, where))


def _told(judgement: Judgement, where: Callable[[int], str]) -> Iterator[Finding]:
    by_kind = {kind: [spot for spot in judgement.spots if spot.kind is kind] for kind in SpotKind}
    gouges, left, beyond = by_kind[SpotKind.GOUGE], by_kind[SpotKind.LEFT], by_kind[SpotKind.UNREACHABLE]
    for spot in gouges[:1]:
        line = f", {where(spot.motion)}" if spot.motion >= 0 else ""
        text = (
            f"The part is gouged in {_places(judgement.gouge.count)}, the worst {spot.depth_mm:.4f} mm deep at "
            f"({spot.x:.3f}, {spot.y:.3f}, {spot.z:.3f}){line}; do not run this program."
        )
        yield Finding(FindingKind.GOUGE, text, spot.x, spot.y, amount=spot.depth_mm, line=spot.line)
    for spot in left[:1]:
        text = (
            f"{judgement.reachable_mm2:.3f} mm2 of metal within reach is left in "
            f"{_places(judgement.counts[SpotKind.LEFT])}, the worst {spot.depth_mm:.3f} mm high and "
            f"{spot.disc_mm:.3f} mm wide at ({spot.x:.3f}, {spot.y:.3f})."
        )
        yield Finding(FindingKind.LEFT_REACHABLE, text, spot.x, spot.y, amount=judgement.reachable_mm2, line=spot.line)
    if judgement.skin_mm2:
        text = (
            f"{judgement.skin_mm2:.3f} mm2 of metal is left along the walls, the skin that paths made from pixels "
            "leave so as not to cut into them; a larger bitmap leaves less."
        )
        yield Finding(FindingKind.SKIN, text, counts=False, amount=judgement.skin_mm2)
    for spot in beyond[:1]:
        places = _places(judgement.counts[SpotKind.UNREACHABLE])
        text = (
            f"{judgement.unreachable_mm2:.3f} mm2 in {places} is out of reach of every tool; a disc of "
            f"{judgement.largest_disc_mm:.3f} mm would fit; a smaller tool reaches farther."
        )
        yield Finding(
            FindingKind.LEFT_UNREACHABLE, text, spot.x, spot.y, counts=False, amount=judgement.unreachable_mm2
        )


def _places(count: int) -> str:
    return "1 place" if count == 1 else f"{count} places"


# Connected places of cells, each with its worst cell.


MOST = 100
"""Places that are listed, the worst ones."""

ASKED = 5000
"""Cells of a place that are looked at one by one where it has more: the worst ones, and about as many spread over the
others.
"""


@dataclass(frozen=True, eq=False)
class CellPlace:
    """Cells that hang together, by edges or corners.

    Attributes:
        cells: row * cols + col of them, of very many the worst and some of the others.
        cell: the worst one, row and column. worst: its value.
        area_mm2: of all. disc_mm: diameter of the largest disc that fits, mm, to about a cell.
    """

    cells: NDArray[np.int64]
    cell: tuple[int, int]
    worst: float
    area_mm2: float
    disc_mm: float


class FoundPlaces(NamedTuple):
    """Places, that with the largest value first, not more than MOST, and how many there are."""

    places: tuple[CellPlace, ...]
    number: int


def places_of(mask: NDArray[np.bool_], value: NDArray[np.float32], grid: Grid) -> FoundPlaces:
    """Return the connected places of a mask.

    Args:
        mask: (rows, cols). value: (rows, cols), of which the largest is the worst.
    """
    if not mask.any():
        return FoundPlaces((), 0)
    import cv2  # there mostly is none

    count, labels, stats, _ = cv2.connectedComponentsWithStats(mask.astype(np.uint8), connectivity=8)
    cells = np.flatnonzero(labels)
    label, worth = labels.ravel()[cells], value.ravel()[cells]
    order = np.lexsort((worth, label))
    # where each label begins, and where the last one ends
    ends = np.searchsorted(label[order], np.arange(1, count + 1))
    framed = np.pad(mask, 1).astype(np.uint8)  # what lies beyond the grid is no place
    inner = cv2.distanceTransform(framed, cv2.DIST_L2, cv2.DIST_MASK_PRECISE)[1:-1, 1:-1].ravel()
    worst = worth[order[ends[1:] - 1]]
    found = []
    for k in np.argsort(-worst, kind="stable")[:MOST].tolist():
        mine = cells[order[ends[k] : ends[k + 1]]][::-1]  # the worst first
        area = float(stats[k + 1, cv2.CC_STAT_AREA]) * grid.pitch**2
        disc = (2 * float(inner[mine].max()) - 1) * grid.pitch
        requested = np.concatenate([mine[:ASKED], mine[ASKED :: 1 + len(mine) // ASKED]])
        found.append(CellPlace(requested, divmod(int(mine[0]), grid.cols), float(worst[k]), area, disc))
    return FoundPlaces(tuple(found), count - 1)
