"""What a tool looks like from the side: its cutting part, its shank, its holder. No Qt, no OpenGL."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from enum import IntEnum

import numpy as np

from ....model.tool import Tool
from .camera import Floats


class ToolPart(IntEnum):
    """What a stretch of a tool is; the shader knows these numbers."""

    CUTTING = 0
    SHANK = 1
    HOLDER = 2


_FLUTES, _MOST_OF_LENGTH = 3.0, 0.6
"""Flutes that nobody tells the length of: so many diameters, and not more than this share of a length that is known; a
cone's are as long as it is.
"""

_SHANK = 3.0
"""A shank that nobody tells the length of: so many of its diameters."""

_SAME = 1e-9
"""Points nearer than this, mm, are one."""

_STEPS = 24
"""Chords of a quarter of a circle."""


@dataclass(frozen=True, eq=False)
class OutlineSection:
    """One part of a tool.

    Attributes:
        part: what it is.
        points: (n, 2) height over the tip and radius, mm, from below; straight between them; it begins where the one
            before ends.
    """

    part: ToolPart
    points: Floats


@dataclass(frozen=True, eq=False)
class ToolOutline:
    """A tool from the side: from the axis at its tip to the axis at its top, without a gap; heights never fall.

    Attributes:
        stretches: from the tip up.
    """

    stretches: tuple[OutlineSection, ...]

    @property
    def height(self) -> float:
        """From the tip to the top, mm."""
        return float(self.stretches[-1].points[-1, 0])

    @property
    def widest(self) -> float:
        """The greatest radius, mm."""
        return max(float(stretch.points[:, 1].max()) for stretch in self.stretches)


@dataclass(frozen=True, eq=False)
class DrawnTool:
    """A tool as it is painted.

    Attributes:
        outline: from the side. flutes: cutting edges, >= 1. ink: place of its colour among those of tools, >= 0.
    """

    outline: ToolOutline
    flutes: int = 2
    ink: int = 0


def outline_of(tool: Tool) -> ToolOutline:
    """Return a tool from the side.

    A length that nobody tells is made up: flutes of three diameters, a shank as wide as the cutter that goes up to the
    holder or to the tool's end, and no holder. What is made up changes nothing but the picture.
    """
    profile, shank = profile_of(tool), tool.shank_diameter / 2 or tool.radius
    shoulder, known = float(profile[-1, 0]), tool.stick_out or tool.overall_length
    tapers = tool.kind.conical and not tool.kind.drills
    usual = 0.0 if tapers else min(_FLUTES * tool.diameter, _MOST_OF_LENGTH * known if known else math.inf)
    flutes = tool.flute_length or max(usual, shoulder)
    neck = max(flutes, shoulder)
    if tool.holder:
        face = tool.stick_out or min(neck + tool.diameter, tool.overall_length or math.inf)
    else:
        face = max(tool.overall_length or tool.stick_out or neck + _SHANK * 2 * shank, neck)
    body = np.vstack([profile, [neck, tool.radius], [neck, shank], [max(face, neck), shank]])
    body, _ = _split(body, face)
    cutting, above = _split(body, flutes)
    parts = [(ToolPart.CUTTING, cutting), (ToolPart.SHANK, above)]
    top = body[-1]
    if tool.holder:
        parts.append((ToolPart.HOLDER, np.vstack([top, np.array(tool.holder) + (top[0], 0.0)])))
    parts = [
        (part, points)
        for part, points in ((part, _without_doubles(points)) for part, points in parts)
        if len(points) > 1
    ]
    part, points = parts.pop()
    parts.append((part, _without_doubles(np.vstack([points, [points[-1, 0], 0.0]]))))
    return ToolOutline(tuple(OutlineSection(part, points) for part, points in parts))


def profile_of(tool: Tool) -> Floats:
    """Return (n, 2) height over the tip and radius of the cutter's end, mm, from the axis to where it is as wide as the
    tool.

    It is the profile by which the kind is cut with; a cone whose angle nobody tells has the kind's usual one.
    """
    shape = tool.shape
    if tool.kind.conical and not shape.half_angle:
        shape = replace(shape, half_angle=tool.kind.usual_angle / 2)
    profile = tool.kind.profile(shape)
    turn = math.pi / 2 - (math.atan(1.0 / profile.cone) if profile.cone else 0.0)
    end = _rounding(profile.flat, profile.fillet, turn)
    rise = (tool.radius - end[-1, 1]) * profile.cone
    return _without_doubles(np.vstack([[0.0, 0.0], end, [end[-1, 0] + rise, tool.radius]]))


def _rounding(flat: float, radius: float, turn: float) -> Floats:
    """Return a rounding that begins level at a radius `flat` and turns up by an angle, radians: (n, 2) height and
    radius, mm.
    """
    angles = np.linspace(0.0, turn, 1 + max(1, math.ceil(_STEPS * turn / (math.pi / 2)))) if radius else np.zeros(1)
    return np.column_stack([radius * (1.0 - np.cos(angles)), flat + radius * np.sin(angles)])


def _split(points: Floats, height: float) -> tuple[Floats, Floats]:
    """Return what of an outline lies below a height, and what above; a level step at that height is above."""
    first = int(np.searchsorted(points[:, 0], height - _SAME))
    if first == len(points):
        return points, points[:0]
    (low, near), (high, far) = points[first - 1], points[first]
    share = (height - low) / (high - low) if high > low else 1.0
    border = np.array([[height, near + share * (far - near)]])
    return np.vstack([points[:first], border]), np.vstack([border, points[first:]])


def _without_doubles(points: Floats) -> Floats:
    """Return points without those that stand where the one before does."""
    if not len(points):
        return points
    return np.asarray(points[np.append(True, np.any(np.abs(np.diff(points, axis=0)) > _SAME, axis=1))])
