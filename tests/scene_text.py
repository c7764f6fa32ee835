"""A scene as the text of a scene file."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from app.core.toml_tables import spelled, write_tables
from app.formats.job.toml import ORIGIN_XY, ORIGIN_Z, OUT_UNITS
from app.formats.job.write import tool_lines, word_of
from app.formats.scene.toml import _Tables
from app.model.scene import Scene


def write_scene(scene: Scene) -> bytes:
    """Return a scene as the TOML text that `read_scene` makes it of, in mm."""
    lines = [f"name = {spelled(scene.name)}", 'units = "mm"', *([] if scene.tools else ["tool = []"])]
    lines += _table("heights", {"safe_z": scene.safe_z, "retract_z": scene.retract_z})
    height = {} if scene.origin_z is None else {"z": word_of(ORIGIN_Z, scene.origin_z)}
    lines += _table("origin", {"xy": word_of(ORIGIN_XY, scene.origin_xy), **height})
    lines += _table(
        "output", {"post": scene.post, "units": word_of(OUT_UNITS, scene.out_units), "exact_path": scene.exact_path}
    )
    for tool in scene.tools:
        lines += tool_lines(tool)
    rest = write_tables(replace(_Tables(), stock=scene.stock, surface=scene.surfaces, passes=scene.passes))
    return ("\n".join(lines) + "\n" + rest.partition("\n")[2]).encode()


def _table(name: str, values: Mapping[str, Any]) -> list[str]:
    return ["", f"[{name}]", *(f"{key} = {spelled(value)}" for key, value in values.items())]
