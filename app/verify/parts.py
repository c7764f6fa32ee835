"""What is to come out of the metal: a drawing milled to depths, or a solid. What a cut is judged against."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

from ..core.progress import NO_PROGRESS, Progress
from ..model.finding import Finding, FindingKind
from ..model.job import Job
from ..model.moves import Area, DogBone, Moves, Program, Tab
from ..model.part import Contour, Region
from ..model.stock_box import StockBox, extent
from ..simulation.field.solid import SolidStock

if TYPE_CHECKING:
    from ..toolpath.coverage.floor_target import FloorTarget
    from .solid_depth import DepthInSolid

TOLERANCE = 0.01
"""mm; metal within this of the part is neither gouged nor left."""


@dataclass(frozen=True, eq=False)
class FlatPart:
    """Regions of a drawing, sunk into the metal.

    Attributes:
        job: whose operations say how deep, how much stock is left on walls, and which tools are there; its part is the
            drawing.
        regions: that are machined, part coordinates; their walls are upright, and Z 0 is the part's top.
        origin: the program's zero, mm, part coordinates: program = part - origin.
        wall_tolerance: within which a wall counts as met, mm: what path and writing may be off.
        tolerance: of heights, mm.
        allowance: so thick a skin may paths made from pixels leave along the walls, mm.
        areas, lines, clamps, tabs, dog_bones: as of a `Program`.
        floors: what is to be cleared, where it is known already.
    """

    job: Job
    regions: tuple[Region, ...]
    origin: tuple[float, float, float] = (0.0, 0.0, 0.0)
    wall_tolerance: float = 0.002
    tolerance: float = TOLERANCE
    allowance: float = 0.0
    areas: tuple[Area, ...] = ()
    lines: tuple[Contour, ...] = ()
    clamps: tuple[Region, ...] = ()
    tabs: tuple[Tab, ...] = ()
    dog_bones: tuple[DogBone, ...] = ()
    floors: tuple[FloorTarget, ...] | None = None

    @cached_property
    def targets(self) -> tuple[FloorTarget, ...]:
        """What is to be cleared, the shallowest floor first."""
        from ..toolpath.build import MovesBuilder  # a solid needs none of it
        from ..toolpath.coverage.floor_target import floor_targets

        return floor_targets(self.program(MovesBuilder().moves()), self.job) if self.floors is None else self.floors

    def program(self, moves: Moves) -> Program:
        """Return moves as a program that makes this part."""
        return Program(
            moves,
            self.regions,
            allowance_mm=self.allowance,
            areas=self.areas,
            lines=self.lines,
            clamps=self.clamps,
            tabs=self.tabs,
            dog_bones=self.dog_bones,
        )


@dataclass(frozen=True, eq=False)
class SolidPart:
    """A solid, program coordinates.

    Attributes:
        solid: closed.
        leave: stock to be left on all of its surface, mm, >= 0.
        tolerance: within which its surface counts as met, mm.
        block: what it is cut from, program coordinates, where it is surfaces seen from above: these may go on beyond
            it.
        allowance: so much more metal may stay on its surface, square to it, mm: how far paths may lie above theirs. It
            is taken off what is told to be left, and says nothing of gouges.
    """

    solid: SolidStock
    leave: float = 0.0
    tolerance: float = TOLERANCE
    block: StockBox | None = None
    allowance: float = 0.0
    _depths: list[DepthInSolid] = field(default_factory=list, init=False, repr=False)

    def depths(self, progress: Progress = NO_PROGRESS) -> DepthInSolid:
        """Return what tells how deep places lie in it, asked of its bodies together; made when somebody asks first.

        Raises:
            Cancelled: by progress.
        """
        from .solid_depth import DepthInSolid  # compiled code: loaded where it is used

        if not self._depths:
            self._depths.append(DepthInSolid(self.solid, self.leave, progress))
        return self._depths[0]


Part = FlatPart | SolidPart


def part_box(part: Part) -> StockBox | None:
    """Return the box round a part, program coordinates: what of it is machined, for a drawing; None where that is
    nothing.
    """
    if isinstance(part, SolidPart):
        low, high = part.solid.triangles.min(axis=(0, 1)).tolist(), part.solid.triangles.max(axis=(0, 1)).tolist()
        return StockBox(*low, *high)
    box = extent((*(contour for region in part.regions for contour in region.contours), *part.lines))
    if box is None:
        return None
    (x, y, z), depth = (
        part.origin,
        max((each.cut.depth for each in part.job.operations if each.cut.enabled), default=0.0),
    )
    return StockBox(box[0] - x, box[1] - y, -depth - z, box[2] - x, box[3] - y, -z)


def beyond(part: Part, stock: StockBox) -> Iterator[Finding]:
    """Yield how far a part reaches beyond its stock, if it does; a drawing's top and the metal under it do not count.

    Args:
        stock: the box round all of it, program coordinates.
    """
    box = part_box(part)
    if box is None or (isinstance(part, SolidPart) and part.block is not None):
        return
    sides = {"-X": stock.x0 - box.x0, "+X": box.x1 - stock.x1, "-Y": stock.y0 - box.y0, "+Y": box.y1 - stock.y1}
    if isinstance(part, SolidPart):
        sides |= {"-Z": stock.z0 - box.z0, "+Z": box.z1 - stock.z1}
    side, far = max(sides.items(), key=lambda item: item[1])
    if far > part.tolerance:
        text = (
            f"The part reaches {far:.3f} mm beyond the stock towards {side}, and there nothing can be judged; check "
            "the stock, and where the part's zero lies (its origin and units)."
        )
        yield Finding(FindingKind.BEYOND_STOCK, text, amount=far)
