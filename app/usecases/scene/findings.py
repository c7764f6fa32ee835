"""What is wrong with a scene before anything is written: holes in meshes, a size that nobody means, and its place in
the stock.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from ...core.tolerances import LEVEL
from ...core.wording import in_plane
from ...model.finding import Finding, FindingKind
from ...model.moves import Purpose
from ...model.scene import Passes
from ...model.scene_shapes import MeshShape
from ...model.stock_box import StockBox
from ...model.tool import Tool
from ...operations.parallel.surface_moves import SurfaceMoves
from ...simulation.field.solid import SolidStock
from ...surfaces.meshes.holes import MeshHole, holes
from ...surfaces.patches.build import BuiltSurface
from ...surfaces.patches.facets import SurfaceFacets

NAMED = 20
"""Holes that are told one by one."""

DIP = 0.005
"""mm; where a tool sinks less into a hole, it is a crack that nobody will see."""

SMALL, LARGE = 0.1, 5000.0
"""Of a tool's diameter that surfaces are wide at least, and mm that they are wide at most."""

OUTSIDE = 0.1
"""Of the surfaces' extent that may lie beside the stock, where that is no more than a tool's radius in any case."""


def scene_findings(
    built: Sequence[BuiltSurface], facets: SurfaceFacets, stock: StockBox, tools: Sequence[Tool]
) -> Iterator[Finding]:
    """Yield what is wrong with the surfaces of a scene.

    Args:
        built: its surfaces. facets: of all that are machined.
        tools: that machine them, at least one for anything that depends on a tool.
    """
    yield from _size(facets, tools)
    yield from _place(facets, stock, tools)
    yield from _holes(built, facets, tools)


def moves_findings(moves: SurfaceMoves, stock: StockBox, tools: Sequence[Tool]) -> Iterator[Finding]:
    """Yield what is wrong with where the tips of a scene's tools go: into the table, or nowhere into the metal."""
    ends, purpose = moves.moves.end, moves.moves.purpose
    cuts = (purpose == Purpose.CONTOUR) | (purpose == Purpose.LINK)
    if not cuts.any():
        return
    wide = max(tool.radius for tool in tools)
    over = (
        (ends[:, 0] > stock.x0 - wide)
        & (ends[:, 0] < stock.x1 + wide)
        & (ends[:, 1] > stock.y0 - wide)
        & (ends[:, 1] < stock.y1 + wide)
    )
    if not (cuts & over & (ends[:, 2] < stock.z1 - LEVEL)).any():
        yield Finding(
            FindingKind.SIZE,
            f"Nothing is cut: no pass goes into the stock, whose top is at Z {stock.z1:.3f}; check the "
            "surfaces' scale and place, and the stock's box.",
        )
    low = int(np.argmin(np.where(cuts, ends[:, 2], np.inf)))
    if ends[low, 2] < stock.z0 - LEVEL:
        x, y, z = ends[low].tolist()
        text = (
            f"The tool's tip goes {stock.z0 - z:.3f} mm below the stock's underside, Z {stock.z0:.3f}, where the "
            f"table is, at {in_plane(x, y)}; give the passes a floor, floor = {stock.z0:g}, or put something under "
            "the stock."
        )
        yield Finding(FindingKind.BELOW_TABLE, text, x, y, amount=stock.z0 - z)


def floor_findings(moves: SurfaceMoves, passes: Sequence[Passes]) -> Iterator[Finding]:
    """Yield where tips go below the floor of their passes, which are those of the moves' operations, in order."""
    ends, operation = moves.moves.end, moves.moves.operation
    for number, each in enumerate(passes):
        if each.floor is None:
            continue
        low = int(np.argmin(np.where(operation == number, ends[:, 2], np.inf)))
        x, y, z = ends[low].tolist()
        if operation[low] == number and z < each.floor - LEVEL:
            name = each.name or f"with T{each.tool}"
            text = (
                f"The tool's tip goes {each.floor - z:.3f} mm below the floor of passes {name}, Z {each.floor:.3f}, at "
                f"{in_plane(x, y)}; do not use this program, and report this with the scene."
            )
            yield Finding(FindingKind.GOUGE, text, x, y, amount=each.floor - z)


def _size(facets: SurfaceFacets, tools: Sequence[Tool]) -> Iterator[Finding]:
    """Yield that surfaces are far too small for every tool, or far too large."""
    wide = float(np.ptp(facets.triangles[:, :, :2].reshape(-1, 2), axis=0).max())
    least = min((tool.diameter for tool in tools), default=0.0)
    if wide < SMALL * least:
        text = (
            f"The surfaces are only {wide:.3g} mm wide, and the tool has {least:g} mm; if their file is in metres or "
            "inches, give the mesh scale = 1000 or 25.4."
        )
        yield Finding(FindingKind.SIZE, text, amount=wide)
    if wide > LARGE:
        text = f"The surfaces are {wide:.0f} mm wide; if their file is in micrometres, give the mesh scale = 0.001."
        yield Finding(FindingKind.SIZE, text, amount=wide)


def _place(facets: SurfaceFacets, stock: StockBox, tools: Sequence[Tool]) -> Iterator[Finding]:
    """Yield that surfaces stand over the stock's top, lie beside it, or wholly below it."""
    corners = facets.triangles.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    x, y, top = corners[int(np.argmax(corners[:, 2]))].tolist()
    if top <= stock.z0:
        text = (
            f"The surfaces lie wholly below the stock: they reach up to Z {top:.3f} at {in_plane(x, y)}, and its "
            f"underside is at Z {stock.z0:.3f}; move them up, or correct the stock's box."
        )
        yield Finding(FindingKind.BEYOND_STOCK, text, x, y, amount=stock.z0 - top)
    elif top > stock.z1 + LEVEL:
        text = (
            f"The surfaces stand {top - stock.z1:.3f} mm over the stock's top, Z {stock.z1:.3f}, at ({x:.3f}, "
            f"{y:.3f}), where no metal is; move them down, or correct the stock's box."
        )
        yield Finding(FindingKind.BEYOND_STOCK, text, x, y, amount=top - stock.z1)
    radius, size = max((tool.radius for tool in tools), default=0.0), high - low
    sides = (
        ("-X", 0, stock.x0 - low[0]),
        ("+X", 0, high[0] - stock.x1),
        ("-Y", 1, stock.y0 - low[1]),
        ("+Y", 1, high[1] - stock.y1),
    )
    for side, axis, far in sides:
        if far > max(radius, OUTSIDE * size[axis]):
            text = (
                f"The surfaces reach {far:.3f} mm beyond the stock towards {side}, of {size[axis]:.3f} mm; move them "
                "into it, or correct the stock's box."
            )
            yield Finding(FindingKind.BEYOND_STOCK, text, amount=float(far))


def _holes(built: Sequence[BuiltSurface], facets: SurfaceFacets, tools: Sequence[Tool]) -> Iterator[Finding]:
    """Yield the holes in meshes that a tool sinks into, the largest first."""
    found = [
        (each.surface.name, hole)
        for each in built
        if isinstance(each.surface.shape, MeshShape) and each.surface.enabled and each.triangles is not None
        for hole in holes(each.triangles)
    ]
    found = [(name, hole) for name, hole in found if tools and max(_dip(tool, hole.radius) for tool in tools) > DIP]
    if not found:
        return
    tops = SolidStock(facets.triangles).tree.tops(np.array([(hole.x, hole.y) for _, hole in found]))
    deep = [(name, hole) for (name, hole), top in zip(found, tops.tolist(), strict=True) if top < hole.z - DIP]
    for name, hole in sorted(deep, key=lambda each: -each[1].radius)[:NAMED]:
        yield Finding(FindingKind.HOLE, _hole_words(name, hole), hole.x, hole.y, amount=2 * hole.radius)
    if len(deep) > NAMED:
        text = (
            f"The meshes have {len(deep) - NAMED} more holes that a tool sinks into; close them in the program that "
            "they come from."
        )
        yield Finding(FindingKind.HOLE, text, amount=float(len(deep) - NAMED))


def _hole_words(name: str, hole: MeshHole) -> str:
    return (
        f"Surface {name} has a hole of {hole.wide:.3f} x {hole.long:.3f} mm at ({hole.x:.3f}, {hole.y:.3f}, "
        f"{hole.z:.3f}), with {hole.edges} open edges, and the tool sinks into it; close it in the program that it "
        "comes from, or keep out by a boundary."
    )


def _dip(tool: Tool, radius: float) -> float:
    """Return how far a tool's tip sinks into a round hole, mm: as deep as there is nothing, where it is no wider than
    the hole.
    """
    if radius >= tool.radius:
        return math.inf
    if tool.kind.conical:
        return radius
    rounded = tool.profile.fillet
    inner = radius - (tool.radius - rounded)
    return rounded - math.sqrt(rounded**2 - inner**2) if inner > 0 else 0.0
