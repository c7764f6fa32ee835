"""The manual's table of all parameters of operations, from their declarations."""

from __future__ import annotations

from collections.abc import Iterator

from ..model.fields import Placed, Unit
from ..model.operation import Operation, parameters

HEAD = """# Parameters of operations

Each stands in a job file under its key, on the command line as its option, in the window under its name,
and in every program's header.

| Key | Option | Name | What it means | Values | Default | Of |
|---|---|---|---|---|---|---|
"""


def parameter_table() -> str:
    """Return the page in Markdown; `resources/docs/parameters.md` is this text."""
    return HEAD + "".join(f"| {' | '.join(_cells(placed, kinds))} |\n" for placed, kinds in parameters().values())


def _cells(placed: Placed, kinds: tuple[type[Operation], ...]) -> Iterator[str]:
    declared = placed.parameter
    yield f"`{declared.key}`"
    yield f"`--{declared.option}`" if declared.option else ""
    yield declared.label
    yield declared.help + (f"; with {declared.needs.with_}" if declared.needs else "")
    yield _values(placed)
    yield _default(placed)
    yield ", ".join(kind.WORD for kind in kinds)


def _values(placed: Placed) -> str:
    declared = placed.parameter
    if placed.enum is not None:
        return ", ".join(str(each.value) for each in placed.enum)
    words = {Unit.FLAG: "true, false", Unit.CURVES: "selectors", Unit.POINTS: "points [x, y], mm"}
    return words.get(declared.unit) or declared.range_words()


def _default(placed: Placed) -> str:
    declared, value = placed.parameter, placed.default
    if placed.enum is not None:
        return str(value.value)
    if value is None:
        return declared.auto
    if declared.unit is Unit.FLAG:
        return str(value).lower()
    if isinstance(value, int | float):
        return f"{declared.shown(value):g}{declared.sign}"
    return "none" if value == () else ""
