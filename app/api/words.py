"""What a script gives in the place of options of the command line, in sentences of the Python door."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import ParamSpec, TypeVar

from ..core.options import spelled

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")

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

_UNITS = {"mm": "Units.MM", "in": "Units.INCH", "m": "Units.M", "cm": "Units.CM", "ft": "Units.FOOT"}
"""The units of a drawing, by the words of the command line."""

_ENUMS = {"as": "OutputForm", "side": "Side", "compensation": "CutterCompensation"}
"""Options whose values are members of an enum."""

_TRUE = ("to-zero", "insist", "depths")
"""Options that a script switches on; what one of them takes on the command line goes without saying."""

_NAMED = ("layer", "skip-layer", "skip-type", "layout", "post", "material")
"""Options whose values are names, and so texts of a script."""

_LISTS = ("skip-layer", "skip-type", "layer", "drill", "keep-out")
"""Options that are given again for each value, in whose place a script gives all in a tuple."""


def in_python(name: str, value: str) -> str:
    """Return what a script writes for an option, with its value where it has one.

    Args:
        name: without its dashes. value: as it is typed, "" = none.
    """
    parameter = _NAMES.get(name, name.replace("-", "_"))
    if name in _TRUE:
        return f"{parameter}=True"
    return f"{parameter}={_value(name, value)}" if value else parameter


def _value(name: str, value: str) -> str:
    """Return an option's value as a script writes it."""
    if name == "tool":
        return _tools(*value.split("=", 1))
    if name == "units":
        return _UNITS.get(value, value)
    if name in _ENUMS:
        return f"{_ENUMS[name]}.{value.upper()}"
    if name == "stock" and "," in value:
        return f"box_stock(({value.replace(',', ', ')}))"
    text = f'"{value.strip(chr(34))}"' if name in _NAMED and value != "NAME" else value
    return f"({text},)" if name in _LISTS else text


def _tools(number: str, shape: str) -> str:
    """Return a table of one tool, by its number and its shape, kind:diameter and what else shapes it."""
    kind, diameter = shape.split(":")[:2]
    return f"{{{number}: Tool({max(int(number), 1)}, {diameter}, ToolKind.{kind.upper()})}}"


def speaks_python(call: Callable[Arguments, Result]) -> Callable[Arguments, Result]:
    """Return a call of the Python door whose errors and findings name parameters in the place of options."""

    @wraps(call)
    def spoken(*arguments: Arguments.args, **named: Arguments.kwargs) -> Result:
        with spelled(in_python):
            return call(*arguments, **named)

    return spoken
