"""A job as the TOML text of a job file: every tool, operation and setting, from which the same job is read."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, TypeVar

from ...core.toml_tables import spelled
from ...model.fields import ParameterPlace, Unit, declared_of, parameters_of
from ...model.job import Job
from ...model.operation import Operation
from ...model.tool import Tool
from ...model.tool_kind import shape_keys
from ..tools.library import shortest_degrees
from .toml import SETTINGS, TOOL_KEYS, WORDS, settings_of

Value = TypeVar("Value")


def job_lines(job: Job) -> Iterator[str]:
    """Yield the lines of a job file, all but the part."""
    for path in SETTINGS:
        yield from _table(path, {key: setting_said(placed, job) for key, placed in settings_of(path).items()})
    for tool in job.tools:
        yield from tool_lines(tool)
    for operation in job.operations:
        yield from _table("operation", dict(_operation(operation)), several=True)


def setting_said(placed: ParameterPlace, job: Job) -> Any:
    """Return a setting of a job as job files spell it."""
    value, known = placed.of(job), WORDS.get(placed.key)
    return word_of(known.words, value) if known else value


def empty_lists(job: Job) -> Iterator[str]:
    """Yield the lines that say that a job has no tool, or no operation; they stand before all tables."""
    for name, things in (("tool", job.tools), ("operation", job.operations)):
        if not things:
            yield f"{name} = []"


def _table(name: str, values: Mapping[str, Any], several: bool = False) -> Iterator[str]:
    yield ""
    yield f"[[{name}]]" if several else f"[{name}]"
    for key, value in values.items():
        yield f"{key} = {spelled(value)}"


def word_of(words: Mapping[str, Value], meant: Value) -> str:
    """Return the first word that stands for a value."""
    return next(word for word, value in words.items() if value is meant)


def tool_lines(tool: Tool) -> Iterator[str]:
    """Yield the lines of a [[tool]]."""
    usual = Tool(tool.number, tool.diameter)
    always = {
        "number",
        "diameter",
        "kind",
        "name",
        "flutes",
        "spindle_speed",
        "feed_rate",
        "plunge_rate",
        *shape_keys(tool.kind),
    }
    keys: Iterable[str] = (
        key for key in TOOL_KEYS if key != "feeds" and (key in always or getattr(tool, key) != getattr(usual, key))
    )
    yield from _table(
        "tool",
        {key: angle_said(tool.tip_angle) if key == "tip_angle" else getattr(tool, key) for key in keys},
        several=True,
    )
    for row in tool.feeds:
        yield from _table(
            "tool.feeds",
            {
                "material": row.material,
                "surface_speed": row.surface_speed,
                "feed_per_tooth": row.feed_per_tooth,
                "plunge_share": row.plunge_share,
            },
            several=True,
        )


def _operation(operation: Operation) -> Iterator[tuple[str, Any]]:
    """Yield keys and values: those that have an effect on the kind, and others where they are not as usual."""
    effective = parameters_of(type(operation))
    yield "kind", operation.WORD
    for key, placed in declared_of(type(operation)).items():
        value = placed.of(operation)
        if value is not None and (key in effective or value != placed.default):
            yield key, _said(placed.parameter.unit, value)


def _said(unit: Unit, value: Any) -> Any:
    """Return a value as a job file has it: angles in degrees, selectors of curves as texts."""
    if unit is Unit.CURVES:
        return tuple(each.text for each in value)
    return angle_said(value) if unit is Unit.ANGLE else value


def angle_said(angle: float) -> float | str:
    """Return degrees where some number of degrees is exactly the angle in radians, else the radians in words."""
    degrees = shortest_degrees(angle)
    return degrees if math.radians(degrees) == angle else f"{angle!r} rad"
