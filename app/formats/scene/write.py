"""Scenes as TOML: what `read_scene` reads again; what has its default is left out."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import MISSING, Field, fields, is_dataclass, replace
from enum import Enum
from typing import Any

from ...core.toml_tables import spelled
from ...model.job import Job
from ...model.part import Part
from ...model.scene import Scene
from ..job.toml import settings_of
from ..job.write import setting_said, tool_lines

_LINE = 110
"""Letters from which a list goes on in lines of its own."""


def scene_text(scene: Scene) -> str:
    """Return a scene as the text of a scene file, in mm."""
    lines = [f"name = {spelled(scene.name)}"]
    lines += _settings(scene)
    lines += _table("stock", scene.stock, several=False)
    for tool in scene.tools:
        lines += tool_lines(tool)
    for surface in scene.surfaces:
        lines += _table("surface", surface, several=True)
    for passes in scene.passes:
        lines += _table("passes", passes, several=True)
    return "\n".join(lines) + "\n"


def _settings(scene: Scene) -> Iterator[str]:
    """Yield the tables that scenes have in common with jobs."""
    usual = Job(Part(), operations=())
    job = replace(
        usual,
        safe_z=scene.safe_z,
        retract_z=scene.retract_z,
        origin_xy=scene.origin_xy,
        post=scene.post,
        out_units=scene.out_units,
        exact_path=scene.exact_path,
        origin_z=usual.origin_z if scene.origin_z is None else scene.origin_z,
    )
    for path in ("heights", "origin", "output"):
        values = {
            key: setting_said(placed, job)
            for key, placed in settings_of(path).items()
            if placed.of(job) != placed.of(usual) or (key == "z" and scene.origin_z is not None)
        }
        if values:
            yield from ("", f"[{path}]", *(f"{key} = {spelled(value)}" for key, value in values.items()))


def _table(name: str, value: Any, several: bool) -> Iterator[str]:
    """Yield a dataclass as a table; what it holds of others follows as tables below its name."""
    plain: list[tuple[str, Any]] = []
    below: list[tuple[str, Any]] = []
    for each in fields(value):
        own = getattr(value, each.name)
        if own == _default(each):
            continue
        nested = own[0] if isinstance(own, tuple) and own else own
        (below if is_dataclass(nested) else plain).append((each.name, own))
    kind = getattr(type(value), "kind", "")
    if plain or below or kind or several:
        yield from ("", f"[[{name}]]" if several else f"[{name}]")
    if isinstance(kind, str) and kind:
        yield f"kind = {spelled(kind)}"
    for key, own in plain:
        yield f"{key} = {_value(own)}"
    for key, own in below:
        for part in own if isinstance(own, tuple) else (own,):
            yield from _table(f"{name}.{key}", part, isinstance(own, tuple))


def _default(each: Field[Any]) -> Any:
    """Return the default of a field; MISSING where it has none, which nothing is equal to."""
    return each.default_factory() if each.default_factory is not MISSING else each.default


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, Enum):
        return spelled(str(value.value))
    if isinstance(value, str):
        return spelled(value)
    if isinstance(value, tuple):
        parts = [_value(each) for each in value]
        whole = f"[{', '.join(parts)}]"
        return whole if len(whole) <= _LINE else "[\n" + "".join(f"  {part},\n" for part in parts) + "]"
    return repr(value)
