"""A solid that is opened by itself: the scene that it is first shown and milled in."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import PurePath

import numpy as np
from numpy.typing import NDArray

from ...core.progress import NO_PROGRESS, Progress
from ...core.toml_tables import spelled
from ...model.scene_curves import SceneFiles
from ...surfaces.meshes.read import read_mesh
from ...toolpath.advice.advise import SERIES
from .solid_files import STEPS

INCH = 25.4
"""mm."""
_WITHOUT_UNITS = (".stl", ".obj", ".ply")
_TOOL_SHARE = 1 / 8
"""Diameter of the first tool as a share of the solid's shorter side."""

_PASSES = 120
"""About so many passes are made at first: enough to see the shape, soon computed."""


@dataclass(frozen=True)
class OpenedSolid:
    """A solid file as a scene.

    Attributes:
        name: of the file. path: of the file, as the scene names it.
        size: along X, Y and Z, in units of the file; None where nobody has measured it.
        units_missing: the file does not say what its units are.
    """

    name: str
    path: str
    size: tuple[float, float, float] | None
    units_missing: bool

    def text(self, scale: float = 1.0) -> str:
        """Return the scene's text: the solid, a ball mill and passes that suit its size.

        Args:
            scale: mm for each unit of the file.
        """
        across = scale * min(self.size[:2]) if self.size is not None else 60.0
        fits = [diameter for diameter in SERIES if diameter <= max(across * _TOOL_SHARE, SERIES[0])]
        diameter = min(fits[-1], 12.0)
        pitch = round(max(diameter / 6, across / _PASSES), 2)
        kind = "step" if self.path.lower().endswith(STEPS) else "mesh"
        scaled = f", scale = {scale:g}" if scale != 1.0 else ""
        return (
            f"name = {spelled(PurePath(self.name).stem)}\n\n"
            f'[[tool]]\nnumber = 1\ndiameter = {diameter:g}\nkind = "ball"\n\n'
            f"[[surface]]\nname = {spelled(PurePath(self.name).stem)}\n"
            f'shape = {{ kind = "{kind}", file = {spelled(self.path)}{scaled} }}\n\n'
            f"[[passes]]\ntool = 1\npitch = {pitch:g}\n"
        )

    def question(self) -> str:
        """Return what is to be asked about its units, or ""."""
        if not self.units_missing or self.size is None:
            return ""
        x, y, z = (f"{value:.4g}" for value in self.size)
        return f"{self.name} does not say its units: {x} \u00d7 {y} \u00d7 {z}. It is taken as millimetres."


def open_solid(name: str, path: str, sources: SceneFiles, progress: Progress = NO_PROGRESS) -> OpenedSolid:
    """Read a solid's file as far as its first scene needs it.

    Args:
        name: of the file. path: by which `sources` finds it.

    Raises:
        InputError: it cannot be read. Cancelled: the job was asked to stop.
    """
    progress.step(0.0, f"Reading {name}")
    if name.lower().endswith(STEPS):
        return OpenedSolid(name, path, None, units_missing=False)
    size = _size(read_mesh(name, sources.data(path)))
    return OpenedSolid(name, path, size, name.lower().endswith(_WITHOUT_UNITS))


def _size(triangles: NDArray[np.float64]) -> tuple[float, float, float]:
    x, y, z = np.ptp(triangles.reshape(-1, 3), axis=0).tolist()
    return x, y, z
