"""What a surface, passes or a tool are at first, when the user adds one: of a size that suits the scene. No Qt."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ....model.scene import Scene
from ....model.scene_curves import SectionCurve

Table = Mapping[str, object]
Box = Sequence[float]
NEW_SCENE = """name = "untitled"

[[tool]]
number = 1
diameter = 6.0
kind = "ball"

[[surface]]
name = "dome"
shape = { kind = "sphere", centre = [0, 0, -15], radius = 30 }
trims = [{ circle = [0, 0, 24] }]

[[passes]]
tool = 1
pitch = 1.0
"""
"""A scene to begin with."""
KINDS = ("plane", "sphere", "cylinder", "cone", "torus", "bilinear", "bicubic", "loft", "ruled", "revolved", "swept")
"""Shapes that can be added with a size of their own."""
_MOST_DEPTHS = 8
"""So many depths a part is roughed in at most, however thin its tool: each takes as long to compute as a finishing."""
FROM_CURVES = ("loft", "ruled", "revolved", "swept")
"""Shapes that curves of the drawing make."""


def free_name(name: str, taken: Iterable[str]) -> str:
    """Return a name that no other surface has."""
    names, number = set(taken), 1
    while (made := name if number == 1 else f"{name} {number}") in names:
        number += 1
    return made


def new_surface(kind: str, scene: Scene, box: Box) -> Table:
    """Return a new surface of a kind, in the middle of a box x0, y0, z0, x1, y1, z1, mm."""
    name = free_name(kind, (surface.name for surface in scene.surfaces))
    return {"name": name, "shape": {"kind": kind, **_shape(kind, *_place(box))}}


def _place(box: Box) -> tuple[NDArray[np.float64], float]:
    """Return the middle of a box, at its top, and a size for what is new, mm; whole numbers where they are large."""
    low, high = np.array(box[:3]), np.array(box[3:])
    size = max(float((high - low)[:2].min()) / 4, 1.0)
    size = round(size) if size >= 4 else round(size, 2)
    return np.round(np.append((low + high)[:2] / 2, high[2]), 1), size


def _shape(kind: str, at: NDArray[np.float64], r: float) -> Table:
    def place(x: float, y: float, z: float) -> tuple[float, ...]:
        return tuple((at + r * np.array([x, y, z])).tolist())

    def arc(y: float) -> Table:
        return {"points": tuple(place(x, y, z) for x, z in ((-1, -0.5), (-0.4, 0.2), (0.4, 0.2), (1, -0.5)))}

    match kind:
        case "plane":
            return {"corner": place(-1, -1, 0), "along": (2.0 * r, 0.0, 0.0), "across": (0.0, 2.0 * r, 0.0)}
        case "sphere":
            return {"centre": place(0, 0, -0.5), "radius": r}
        case "cylinder":
            return {"start": place(-1, 0, -0.5), "end": place(1, 0, -0.5), "radius": r * 0.75}
        case "cone":
            return {"start": place(0, 0, -1), "end": place(0, 0, 0.5), "start_radius": r, "end_radius": r / 4}
        case "torus":
            return {"centre": place(0, 0, 0), "major": r, "minor": r * 0.3}
        case "bilinear":
            return {"corners": (place(-1, -1, 0), place(1, -1, 0.4), place(1, 1, 0), place(-1, 1, 0.4))}
        case "bicubic":
            return {
                "points": tuple(
                    tuple(place(-1 + 2 * i / 3, -1 + 2 * j / 3, 0.5 * (0 < i < 3 and 0 < j < 3)) for j in range(4))
                    for i in range(4)
                )
            }
        case "loft":
            return {"sections": (arc(-1), arc(0), arc(1))}
        case "ruled":
            return {"first": arc(-1), "second": {"points": (place(-1, 1, 0), place(1, 1, 0))}}
        case "revolved":
            return {
                "profile": {"points": (place(0.2, 0, 0.2), place(0.6, 0, 0), place(1, 0, -0.6))},
                "centre": tuple(at.tolist()),
            }
        case _:
            guide = {"points": (place(0, -1, 0), place(0.2, 0, 0), place(0, 1, 0))}
            return {
                "profile": {"points": (place(-0.6, -1, -0.4), place(0, -1, 0), place(0.6, -1, -0.4))},
                "guide": guide,
            }


def surface_from_curves(kind: str, curves: Sequence[SectionCurve], scene: Scene) -> Table:
    """Return a new surface from curves of the drawing.

    A loft stands its curves upright one behind the other, half as wide apart as they are long; a ruled surface goes
    from the first at z 0 to the second as far above it; a revolved one turns its profile, upright, about the Z axis; a
    swept one leads the first, upright and its start on the guide's, along the second.
    """
    name = free_name(kind, (surface.name for surface in scene.surfaces))
    upright = {"x_axis": (1.0, 0.0, 0.0), "y_axis": (0.0, 0.0, 1.0)}
    apart = round(max(max(float(np.ptp(np.array(curve.points), axis=0).max()) for curve in curves) / 2, 1.0), 1)
    first, second = _curve(curves[0]), _curve(curves[-1])
    match kind:
        case "loft":
            sections = tuple(
                {**_curve(curve), "origin": (0.0, apart * n, 0.0), **upright} for n, curve in enumerate(curves)
            )
            shape: dict[str, object] = {"sections": sections}
        case "ruled":
            shape = {"first": first, "second": {**second, "origin": (0.0, 0.0, apart)}}
        case "revolved":
            shape = {"profile": {**first, **upright}}
        case _:
            (x, z), (start_x, start_y) = curves[0].points[0][:2], curves[-1].points[0][:2]
            shape = {"profile": {**first, "origin": (start_x - x, start_y, -z), **upright}, "guide": second}
    return {"name": name, "shape": {"kind": kind, **shape}}


def _curve(curve: SectionCurve) -> dict[str, object]:
    """Return the table of a curve of control points."""
    made: dict[str, object] = {"form": "control", "degree": curve.degree, "points": curve.points}
    for key in ("knots", "weights"):
        if getattr(curve, key):
            made[key] = getattr(curve, key)
    return made


def new_passes(scene: Scene) -> Table:
    """Return new passes with the scene's last mill, across the ones there are."""
    tool = scene.tools[-1] if scene.tools else None
    turned = (scene.passes[-1].angle_deg + 90.0) % 180.0 if scene.passes else 0.0
    return {
        "tool": tool.number if tool else 1,
        "angle_deg": turned,
        "pitch": round(tool.diameter / 6, 3) if tool else 1.0,
    }


def passes_across(scene: Scene) -> Table | None:
    """Return passes square to the scene's last ones, with their tool, as dense as they; None where these are not the
    straight passes over everything, or such passes are there.
    """
    last = next((each for each in reversed(scene.passes) if each.enabled), None)
    if last is None or last.fan_deg is not None or last.guide or last.line or last.boundary:
        return None
    turned = (last.angle_deg + 90.0) % 180.0
    if any(each.enabled and each.angle_deg % 180.0 == turned and each.tool == last.tool for each in scene.passes):
        return None
    dense = {"pitch": last.pitch} if last.pitch is not None else {"scallop": last.scallop}
    return {"tool": last.tool, "angle_deg": turned, **dense}


def roughing_passes(scene: Scene, box: Box) -> tuple[Table, ...]:
    """Return passes in depths to go before the scene's first ones, with their tool and in their direction; none where
    these leave stock, so that they rough themselves, or do not go straight.

    Args:
        scene: with passes over the whole part. box: of the stock x0, y0, z0, x1, y1, z1, mm.
    """
    first = next((each for each in scene.passes if each.enabled), None)
    tool = next((each for each in scene.tools if first is not None and each.number == first.tool), None)
    if first is None or tool is None or first.stock_to_leave or first.fan_deg is not None or first.guide or first.line:
        return ()
    top, bottom = box[5], box[2] if first.floor is None else max(first.floor, box[2])
    depths = min(math.ceil((top - bottom) / (tool.diameter / 2)), _MOST_DEPTHS)
    left = round(min(tool.diameter / 12, 0.5), 3)
    floors = [round(top - (top - bottom) * n / depths, 3) for n in range(1, depths + 1)]
    return tuple(
        {
            "name": f"roughing to {floor:g}",
            "tool": tool.number,
            "angle_deg": first.angle_deg,
            "pitch": round(tool.diameter / 2, 3),
            "stock_to_leave": left,
            "chord_tolerance": max(first.chord_tolerance, round(left / 5, 4)),
            "floor": floor,
        }
        for floor in floors
    )


def new_tool(scene: Scene) -> Table:
    """Return a new ball end mill with a number of its own."""
    number = max((tool.number for tool in scene.tools), default=0) + 1
    return {"number": number, "diameter": 6.0, "kind": "ball"}
