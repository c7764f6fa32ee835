"""Scene files: surfaces, passes, tools and stock as TOML; resources/samples/compound.toml shows one.

Tools, heights, origin and output are spelled as in job files. Files that a scene names are read by others, who know its
place.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Any

from ...core.errors import HitofudeError, InputError
from ...core.file_bytes import FileBytes
from ...core.toml_tables import tables_of
from ...core.wording import either
from ...model.job import Job, OriginZ
from ...model.part import Part
from ...model.scene import Passes, Scene, SceneStock, Surface
from ...model.scene_curves import SceneFiles
from ..job.tables import JobText
from ..job.toml import job_tree, read_job_tables
from ..readers import read_drawing

JOB_TABLES = ("tool", "heights", "origin", "output")
"""Tables that are those of job files."""

_UNITS = {"mm": 1.0, "in": 25.4}
_NO_LENGTHS = frozenset(
    {
        "number",
        "flutes",
        "spindle_speed",
        "tip_angle",
        "feeds",
        "angle_deg",
        "rotate_deg",
        "turn_deg",
        "scale",
        "degree",
        "degree_u",
        "degree_v",
        "faces",
        "knots",
        "knots_u",
        "knots_v",
        "weights",
        "x_axis",
        "y_axis",
        "axis",
    }
)
"""Keys whose numbers are the same in inches."""


@dataclass(frozen=True)
class _Tables:
    """The tables of a scene that job files do not have."""

    name: str = "untitled"
    stock: SceneStock = field(default_factory=SceneStock)
    surface: tuple[Surface, ...] = ()
    passes: tuple[Passes, ...] = ()


def sources_of(data: Callable[[str], bytes]) -> SceneFiles:
    """Return what builds a scene's surfaces reads files by; `data` returns the bytes of a file that a scene names."""

    def part(name: str) -> Part:
        return read_drawing(name, data(name)).part

    return SceneFiles(data, part)


def read_scene(name: str, data: bytes) -> Scene:
    """Return the scene that a TOML text describes; what it leaves out takes its default.

    Args:
        name: of the file, shown in errors.
        data: its bytes, UTF-8.

    Raises:
        InputError: `name:line: key …`, what is wrong and what is expected.
    """
    text, tree = job_tree(name, data, "compound.toml")
    units = tree.pop("units", "mm")
    if not isinstance(units, str) or units not in _UNITS:
        raise InputError(f"{name}:{text.line('', 0, 'units')}: units is {units!r}; use {either(_UNITS)}")
    if _UNITS[units] != 1.0:
        tree = _scaled(tree, _UNITS[units])
    shared = {key: tree.pop(key) for key in JOB_TABLES if key in tree}
    own_height = "z" in shared.get("origin", {})
    job = read_job_tables(text, shared).job
    tables = tables_of(_Tables, tree, FileBytes(name, data), {})
    if not shared.get("tool"):
        job = replace(job, tools=() if "tool" in shared else Scene().tools)
    return _scene(text, tables, job, job.origin_z if own_height else None)


def _scene(text: JobText, tables: _Tables, job: Job, origin_z: OriginZ | None) -> Scene:
    """Return the scene of its tables; a name used twice, or a tool that is missing, is told where it is."""
    for index, surface in enumerate(tables.surface):
        if surface.name in [other.name for other in tables.surface[:index]]:
            raise InputError(
                f"{text.name}:{text.line('surface', index, 'name')}: name {surface.name} is taken by another surface; "
                "give each its own"
            )
    scene = Scene(
        tables.name,
        tables.surface,
        tables.stock,
        job.tools,
        tables.passes,
        job.origin_xy,
        origin_z,
        job.safe_z,
        job.retract_z,
        job.post,
        job.out_units,
        job.exact_path,
    )
    for index, passes in enumerate(tables.passes):
        try:
            scene.tool(passes.tool)
        except HitofudeError as error:
            raise InputError(f"{text.name}:{text.line('passes', index, 'tool')}: {error}") from error
    return scene


def in_own_units(tables: dict[str, Any], units: str, back: bool) -> dict[str, Any]:
    """Return tables of a text whose lengths are in `units` in mm, or, `back`, those in mm in its units; others as they
    are.
    """
    size = _UNITS.get(units, 1.0)
    scaled: dict[str, Any] = tables if size == 1.0 else _scaled(tables, 1.0 / size if back else size)
    return scaled


def _scaled(value: Any, factor: float) -> Any:
    """Return tables with every length in mm."""
    if isinstance(value, dict):
        return {
            key: item if key in _NO_LENGTHS or (key == "tool" and isinstance(item, int)) else _scaled(item, factor)
            for key, item in value.items()
        }
    if isinstance(value, list):
        return [_scaled(item, factor) for item in value]
    return value * factor if type(value) in (int, float) else value
