"""Sentences of the program in the words of Python: where they name options of the command line, what a script gives in
their place.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import wraps
from typing import ParamSpec, TypeVar

from ..core.errors import HitofudeError
from ..model.finding import Finding

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

_UNITS = {"mm": "MM", "in": "INCH", "m": "M", "cm": "CM", "ft": "FOOT"}
_NAMES = {
    "px-per-inch": "pixels_per_inch",
    "skip-layer": "without_layers",
    "skip-type": "without_types",
    "layer": "layers",
    "as": "form",
    "grid": "cells",
    "bitmap": "width",
    "contour-tool": "contour_diameter",
    "pocket-tool": "pocket_diameter",
    "tool": "tools",
    "depths": "drawn_depths",
    "drill": "drills",
}
"""Options whose parameter has another name than theirs with underscores."""
_ENUMS = {"as": "OutputForm", "side": "Side"}
_NAMED = ("layer", "type", "post")
"""What options end in whose values are names."""
_FLAGS = ("to-zero", "insist")
_LISTS = ("skip-layer", "skip-type", "layer", "drill", "keep-out")
_OPTION = re.compile(
    r"(?<![\w-])--(?P<name>[a-z][a-z-]*)"
    r"(?:[ =](?P<value>\d+=[a-z]+(?::(?:[\d.]*\d|[A-Z]+))+|(?:[A-Z]\d,)+[A-Z]\d|\"[^\"]*\"|"
    r"\d[\d.]*(?:e-?\d+)?(?![\w.])|"
    r"(?<=-layer )\w+|(?<=-type )[A-Z]+|(?<=--post )\w+|(?<=--as )\w+|(?<=--units )\w+|(?<=--side )\w+|"
    r"[DN]\b|NAME))?"
)


def in_python(text: str) -> str:
    """Return a sentence that names parameters in the place of options."""
    return _OPTION.sub(_parameter, text)


def _parameter(found: re.Match[str]) -> str:
    """Return what a script writes for an option, with its value where it has one."""
    option, value = found["name"], found["value"]
    name = _NAMES.get(option, option.replace("-", "_"))
    if option in _FLAGS:
        return f"{name}=True"
    if value is None or (option == "tool" and ":" not in value):
        return name
    if option == "tool":
        number, _, shape = value.partition("=")
        kind, diameter = shape.split(":")[:2]
        return f"tools={{{number}: Tool({max(int(number), 1)}, {diameter}, ToolKind.{kind.upper()})}}"
    if option == "units":
        return f"units=Units.{_UNITS.get(value, value)}"
    if option in _ENUMS:
        return f"{name}={_ENUMS[option]}.{value.upper()}"
    if option == "stock":
        return f"stock=box_stock(({value.replace(',', ', ')}))"
    named = option.endswith(_NAMED) and value[0] != '"'
    quoted = f'"{value}"' if named else value
    return f"{name}=({quoted},)" if option in _LISTS else f"{name}={quoted}"


def findings_in_python(findings: Iterable[Finding]) -> tuple[Finding, ...]:
    """Return findings whose sentences name parameters in the place of options."""
    return tuple(replace(each, text=in_python(each.text)) if "--" in each.text else each for each in findings)


def speaks_python(call: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Return a call of the Python door whose errors name parameters in the place of options."""

    @wraps(call)
    def spoken(*arguments: Arguments.args, **named: Arguments.kwargs) -> Result:
        try:
            return call(*arguments, **named)
        except HitofudeError as error:
            error.args = tuple(in_python(each) if isinstance(each, str) else each for each in error.args)
            raise

    return spoken
