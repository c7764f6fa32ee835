"""The closed forms of milling: speed, chip, force, power, and how far a shank gives way.

An edge that is engaged over an angle phi of the rim, from where its chip is thinnest, cuts a chip that is f_z sin(phi)
thick at its thickest up to 90 degrees, and f_z beyond (a circle in the place of the tooth's trochoid).

References:
    Kienzle (1952): a chip of width b and thickness h takes kc1.1 b h^(1 - mc). Euler-Bernoulli beam for the shank.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...model.stock_material import StockMaterial
from ...model.tool import Tool, ToolMaterial

YOUNGS_MODULUS = {ToolMaterial.HSS: 210e3, ToolMaterial.CARBIDE: 580e3}
"""N/mm2."""

FLUTE_CORE = 0.8
"""Diameter of the round bar that bends like the fluted part of an end mill, as a part of its diameter."""

RADIAL_SHARE = 0.5
"""Of the force along the cut: what presses the edge away from the metal. Sharp edges take 0.3, worn ones 0.5."""


def spindle_speed(surface_speed: float, diameter: float) -> float:
    """Return n = 1000 v / (pi d), rpm, for v in m/min and d in mm, both > 0."""
    return 1000 * surface_speed / (math.pi * diameter)


def surface_speed(rpm: float, diameter: float) -> float:
    """Return v = pi d n / 1000, m/min, for a diameter in mm."""
    return math.pi * diameter * rpm / 1000


def feed_rate(rpm: float, flutes: int, feed_per_tooth: float) -> float:
    """Return n z f_z, mm/min, for a chip load in mm."""
    return rpm * flutes * feed_per_tooth


def engaged_width(diameter: float, angle: float) -> float:
    """Return the width of cut, mm, at which the rim is engaged over an angle, radians in (0, pi]."""
    return diameter * (1 - math.cos(angle)) / 2


def engaged_angle(diameter: float, width: float) -> float:
    """Return the angle, radians, over which the rim is engaged in a cut of some width, mm in (0, diameter]."""
    return math.acos(max(-1.0, 1 - 2 * width / diameter))


def chip_thinning(angle: float) -> float:
    """Return how much thinner than the feed per tooth the thickest chip is, 1 / sin(phi) >= 1.

    Args:
        angle: engaged, radians in (0, pi].
    """
    return 1.0 if angle >= math.pi / 2 else 1 / math.sin(angle)


def mean_chip(feed_per_tooth: float, angle: float) -> float:
    """Return the mean thickness of a chip over its engaged angle, mm: f_z (1 - cos phi) / phi."""
    return feed_per_tooth * (1 - math.cos(angle)) / angle


@dataclass(frozen=True, slots=True)
class Chip:
    """A cut, as its forces see it.

    Attributes:
        depth: along the axis, mm, > 0. angle: engaged, radians in (0, pi].
        feed_per_tooth: mm, > 0. rpm: > 0.
    """

    depth: float
    angle: float
    feed_per_tooth: float
    rpm: float


def milling_power(chip: Chip, tool: Tool, material: StockMaterial) -> float:
    """Return the power at the tool, W: metal removed in a time times the specific force at the mean chip.

    A drill's section is its disc, and its chip half of its feed a turn thick.
    """
    if tool.kind.drills:
        section, thickness = math.pi * tool.diameter**2 / 4, chip.feed_per_tooth
    else:
        section = chip.depth * engaged_width(tool.diameter, chip.angle)
        thickness = mean_chip(chip.feed_per_tooth, chip.angle)
    removed = section * feed_rate(chip.rpm, tool.flutes, chip.feed_per_tooth)  # mm3/min
    return removed * material.cutting_force * math.pow(thickness, -material.force_exponent) / 60e3


def side_force(chip: Chip, tool: Tool, material: StockMaterial) -> float:
    """Return a bound of the force across the axis, N: as many edges as can be engaged at once, each at its thickest
    chip, and the radial force square to it.
    """
    edges = min(tool.flutes, math.floor(tool.flutes * chip.angle / (2 * math.pi)) + 1)
    thickest = chip.feed_per_tooth / chip_thinning(chip.angle)
    along = edges * material.cutting_force * chip.depth * math.pow(thickest, 1 - material.force_exponent)
    return along * math.hypot(1.0, RADIAL_SHARE)


def deflection(force: float, tool: Tool) -> float:
    """Return how far the tip of a tool gives way, mm, to a force across it there, N; 0: its stick-out is not known.

    A bar that is clamped in the holder: the flutes, and above them the shank. A flute length that is not known is taken
    to reach up to the holder, a shank that is not known to be as thick as the flutes' core.
    """
    if not tool.stick_out:
        return 0.0
    cutter = FLUTE_CORE * tool.diameter
    fluted = min(tool.flute_length or tool.stick_out, tool.stick_out)
    shank = tool.shank_diameter or cutter
    bent = fluted**3 / _second_moment(cutter) + (tool.stick_out**3 - fluted**3) / _second_moment(shank)
    return force * bent / (3 * YOUNGS_MODULUS[tool.edges])


def _second_moment(diameter: float) -> float:
    return math.pi * diameter**4 / 64
