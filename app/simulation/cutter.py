"""A cutter as numbers: a flat disc, rounded by a fillet, that goes over into a cone; every tool kind is a case of it.

The profile is height(radius) over the tip. It is convex and does not fall, so the cutter (all that lies above it,
within its radius) is convex, and the height of a cell over a straight move has one minimum. A concave form would be
several convex pieces, each swept for itself: the lowest of their heights.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

import numpy as np

from ..core.errors import ParameterError
from ..model.motion import Floats
from ..model.tool import Tool

LEAST_ANGLE = math.radians(1.0)
"""A cone more pointed than this is a mistake."""


@dataclass(frozen=True, slots=True)
class Cutter:
    """A convex cutter, tip at radius 0.

    Attributes:
        radius: the largest, mm, > 0.
        flat: radius of the flat disc at the tip, mm, in [0, radius].
        fillet: radius of the rounding between the disc and the cone, or the wall, mm, >= 0.
        slope: rise of the cone per mm of radius, > 0; infinite where the fillet ends in a vertical wall or there is no
            cone.
        centre_cutting: whether it may go straight down into metal.
        lift: how far the tip is above the point that is led along the path, mm.
    """

    radius: float
    flat: float = 0.0
    fillet: float = 0.0
    slope: float = math.inf
    centre_cutting: bool = True
    lift: float = 0.0

    def __post_init__(self) -> None:
        if not (
            0 < self.radius < 1e6
            and 0 <= self.flat <= self.radius
            and 0 <= self.fillet <= self.radius
            and self.slope > 0
        ):
            raise ParameterError(
                f"A cutter of radius {self.radius:g} mm with a flat of {self.flat:g} mm, a corner of {self.fillet:g} "
                f"mm and a slope of {self.slope:g} is no shape; the flat and the corner must lie within the radius."
            )
        if self.rim_of_fillet > self.radius * (1 + 1e-12):
            raise ParameterError(
                f"A corner of {self.fillet:g} mm round a flat of {self.flat:g} mm reaches over the cutter's "
                f"radius, {self.radius:g} mm; use a smaller corner."
            )
        if math.isinf(self.slope) and self.rim_of_fillet < self.radius * (1 - 1e-12):
            raise ParameterError(
                f"A cutter of radius {self.radius:g} mm has no shape between its corner, at "
                f"{self.rim_of_fillet:g} mm, and its rim; give its angle."
            )

    @property
    def fillet_span(self) -> float:
        """How much radius the fillet takes, mm: all of its own where a wall follows, less where a cone does."""
        return self.fillet if math.isinf(self.slope) else self.fillet * self.slope / math.hypot(1.0, self.slope)

    @property
    def rim_of_fillet(self) -> float:
        """Radius at which the fillet ends, mm."""
        return self.flat + self.fillet_span

    def radius_at(self, height: float) -> float:
        """Return how wide the cutter is at most up to a height over the tip, mm; 0 below the tip."""
        if height < 0:
            return 0.0
        top = self.fillet - math.sqrt(max(self.fillet**2 - self.fillet_span**2, 0.0))
        if height < top:
            return self.flat + math.sqrt(max(self.fillet**2 - (self.fillet - height) ** 2, 0.0))
        return (
            self.radius
            if math.isinf(self.slope)
            else min(self.radius, self.rim_of_fillet + (height - top) / self.slope)
        )

    def radii_at(self, heights: Floats) -> Floats:
        """Return `radius_at` of heights (n,), mm."""
        top = self.fillet - math.sqrt(max(self.fillet**2 - self.fillet_span**2, 0.0))
        on_fillet = self.flat + np.sqrt(np.maximum(self.fillet**2 - (self.fillet - heights) ** 2, 0.0))
        on_cone = np.full(len(heights), self.radius)
        if not math.isinf(self.slope):
            on_cone = np.minimum(self.radius, self.rim_of_fillet + (heights - top) / self.slope)
        found: Floats = np.where(heights < 0, 0.0, np.where(heights < top, on_fillet, on_cone))
        return found

    def grown(self, by: float) -> Cutter:
        """Return the cutter that cuts, at a point, at least as deep as this one does within `by` mm of it; by >= 0."""
        return replace(self, radius=self.radius + by, flat=self.flat + by)

    def shrunk(self, by: float) -> Cutter | None:
        """Return a cutter that cuts, at a point, nowhere deeper than this one does within `by` mm of it; None where
        nothing is left.

        The flat goes first, sideways. A fillet that ends in a wall shrinks towards its middle, which the profile moved
        sideways lies below; a cone or a fillet before one, nowhere steeper than the cone, moves up by its rise.
        """
        if by >= self.radius:
            return None
        rest = max(by - self.flat, 0.0)
        flat, radius = max(self.flat - by, 0.0), self.radius - by
        if not math.isinf(self.slope):
            whole = self.rim_of_fillet - self.flat + flat <= radius
            if not whole:
                return Cutter(radius, lift=self.lift + by * self.slope, slope=self.slope)
            return replace(self, radius=radius, flat=flat, lift=self.lift + rest * self.slope)
        return replace(
            self, radius=radius, flat=flat, fillet=min(self.fillet - rest, radius - flat), lift=self.lift + rest
        )

    def heights(self, radii: Floats) -> Floats:
        """Return the profile over the tip, mm; infinite beyond the radius.

        Args:
            radii: distances from the axis, mm, >= 0.
        """
        beyond = np.maximum(np.asarray(radii) - self.flat, 0.0)
        rounded = np.minimum(beyond, self.fillet_span)
        heights = self.fillet - np.sqrt(np.maximum(self.fillet**2 - rounded**2, 0.0))
        if not math.isinf(self.slope):
            heights = heights + self.slope * (beyond - rounded)
        return np.where(np.asarray(radii) <= self.radius, heights, math.inf)


_FINEST = 0.05
"""mm; places are no nearer to one another for the sake of a pointed cutter, which is as narrow as one likes."""


def sure_spacing(cutters: Iterable[Cutter], depth: float) -> float:
    """Return how far apart places along a line may be, mm, for none of the cutters to pass between two of them unseen
    whose tip is deeper than so many mm below it.

    What it cuts there is twice as wide as this at least, so it is met beside its middle, too.
    """
    return max(min((cutter.radius_at(depth) for cutter in cutters), default=math.inf), _FINEST)


def cutter_of(tool: Tool) -> Cutter:
    """Return the cutter that a tool is.

    A drill whose angle is not known has the usual one of its kind. Drills, balls, V tools and tapered mills cut at
    their centre; flat and bull-nose mills with two or three flutes are taken to, with more they are not; nor are those
    that cut threads. Such a tool is the cylinder within its teeth: what it leaves is a hole as wide as the thread's
    core.

    Raises:
        ParameterError: the tool lacks what its shape needs, or its numbers make no shape.
    """
    centre = not tool.kind.threads and (not tool.kind.level or tool.flutes <= 3)
    shape = replace(tool.shape, half_angle=_half_angle(tool)) if tool.kind.conical else tool.shape
    profile = tool.kind.profile(shape)
    return Cutter(
        profile.flat if tool.kind.threads else tool.radius,
        profile.flat,
        profile.fillet,
        profile.cone or math.inf,
        centre,
    )


def _half_angle(tool: Tool) -> float:
    """Return the angle between a tool's axis and its cone, radians."""
    angle = tool.tip_angle or tool.kind.assumed_angle
    if not LEAST_ANGLE <= angle < math.pi - LEAST_ANGLE:
        raise ParameterError(
            f"T{tool.number}: the full angle of its cone is {math.degrees(angle):g} degrees; a {tool.kind.value} tool "
            "needs one from 1 to 179 degrees to be cut with."
        )
    return angle / 2
