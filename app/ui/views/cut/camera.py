"""From where the cut is looked at: a camera without perspective, so that equal lengths stay equal. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Size = tuple[float, float]
Pixel = tuple[float, float]

_STEEPEST = np.pi / 2
_LEAST_SCALE, _MOST_SCALE = 1e-3, 1e6
_EDGE = 0.9
"""Share of the room that a fitted box fills."""


class StandardView(Enum):
    """Directions with a name; the value is yaw and pitch, degrees."""

    ISOMETRIC = (-45.0, 35.264389682754654)
    TOP = (0.0, 90.0)
    FRONT = (0.0, 0.0)
    RIGHT = (90.0, 0.0)


@dataclass(frozen=True, slots=True)
class SightRay:
    """A line of sight: points origin + t direction for every t; the direction leads away from the eye, length 1."""

    origin: Floats
    direction: Floats


@dataclass(frozen=True, slots=True)
class Camera:
    """An orthographic camera.

    Attributes:
        target: (3,) the point in the middle of the picture, mm.
        yaw: how far the eye stands round Z, radians; 0 = at -Y, pi/2 = at +X.
        pitch: height of the eye over the horizon, radians, in [-pi/2, pi/2].
        scale: px per mm.
    """

    target: tuple[float, float, float] = (0.0, 0.0, 0.0)
    yaw: float = -np.pi / 4
    pitch: float = 0.6154797
    scale: float = 5.0

    @property
    def axes(self) -> Floats:
        """Rows: to the right, up, and towards the eye; unit vectors."""
        cy, sy, cp, sp = np.cos(self.yaw), np.sin(self.yaw), np.cos(self.pitch), np.sin(self.pitch)
        return np.array([[cy, sy, 0.0], [-sp * sy, sp * cy, cp], [cp * sy, -cp * cy, sp]])

    def project(self, points: Floats, size: Size) -> Floats:
        """Return (n, 3): px from the left, px from the top, mm towards the eye.

        Args:
            points: (n, 3) mm.
            size: of the picture, px.
        """
        seen = (np.asarray(points, float) - self.target) @ self.axes.T
        return np.column_stack(
            [size[0] / 2 + seen[:, 0] * self.scale, size[1] / 2 - seen[:, 1] * self.scale, seen[:, 2]]
        )

    def ray(self, at: Pixel, size: Size) -> SightRay:
        """Return the line of sight through a pixel, px from the left and from the top."""
        right, up, towards = self.axes
        across, above = (at[0] - size[0] / 2) / self.scale, (size[1] / 2 - at[1]) / self.scale
        return SightRay(np.asarray(self.target) + across * right + above * up, -towards)

    def matrix(self, size: Size, reach: float) -> NDArray[np.float32]:
        """Return the (4, 4) matrix from mm to clip space, column vectors.

        Args:
            size: of the picture, px.
            reach: nothing that is seen is farther than this from the target along the line of sight, mm.
        """
        gain = np.array([2 * self.scale / size[0], 2 * self.scale / size[1], -1.0 / reach])
        made = np.eye(4)
        made[:3, :3] = self.axes * gain[:, None]
        made[:3, 3] = -made[:3, :3] @ np.asarray(self.target)
        return made.astype(np.float32)

    def panned(self, right: float, down: float) -> Camera:
        """Move the picture by px."""
        along, up, _ = self.axes
        target = np.asarray(self.target) + (down * up - right * along) / self.scale
        return replace(self, target=_triple(target))

    def zoomed(self, factor: float, at: Pixel, size: Size) -> Camera:
        """Zoom; what is seen at a pixel stays there."""
        scale = float(np.clip(self.scale * factor, _LEAST_SCALE, _MOST_SCALE))
        share = 1.0 - self.scale / scale
        moved = self.panned((size[0] / 2 - at[0]) * share, (size[1] / 2 - at[1]) * share)
        return replace(moved, scale=scale)

    def orbited(self, yaw: float, pitch: float, about: Floats) -> Camera:
        """Turn by angles, radians, round a point, mm, that keeps its place in the picture."""
        turned = replace(self, yaw=self.yaw + yaw, pitch=float(np.clip(self.pitch + pitch, -_STEEPEST, _STEEPEST)))
        before, now = (camera.project(about[None], (0.0, 0.0))[0] for camera in (self, turned))
        return turned.panned(before[0] - now[0], before[1] - now[1])

    def seen_from(self, view: StandardView) -> Camera:
        """Look from a standard direction."""
        yaw, pitch = np.radians(view.value)
        return replace(self, yaw=float(yaw), pitch=float(pitch))

    def fitted(self, low: Floats, high: Floats, size: Size) -> Camera:
        """Show a whole box, mm, in the direction that is looked in."""
        corners = np.array(np.meshgrid(*zip(low, high, strict=True))).reshape(3, -1).T
        middle = (np.asarray(low) + high) / 2
        spread = np.ptp((corners - middle) @ self.axes[:2].T, axis=0)
        scale = _EDGE * min(size[0] / max(spread[0], 1e-6), size[1] / max(spread[1], 1e-6))
        return replace(self, target=_triple(middle), scale=float(np.clip(scale, _LEAST_SCALE, _MOST_SCALE)))

    def towards(self, other: Camera, share: float) -> Camera:
        """Return the camera on the way to another one, share in [0, 1]; it turns the short way round."""
        turn = (other.yaw - self.yaw + np.pi) % (2 * np.pi) - np.pi
        target = np.asarray(self.target) * (1 - share) + np.asarray(other.target) * share
        return Camera(
            _triple(target),
            self.yaw + turn * share,
            self.pitch + (other.pitch - self.pitch) * share,
            self.scale * (other.scale / self.scale) ** share,
        )


def _triple(point: Floats) -> tuple[float, float, float]:
    x, y, z = (float(value) for value in point)
    return x, y, z
