"""The manual's tables of all parameters of operations and of tools, from their declarations."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import MISSING

from ...core.toml_tables import Keyword
from ...model.fields import Parameter, ParameterPlace, Unit, declared_of
from ...model.operation import Operation
from ...model.operation_kinds import parameters
from ...model.tool import Tool

_PAGE = "Parameters"
_OPERATIONS = "Parameters of operations"
_ABOUT_OPERATIONS = (
    "Each stands in a job file under its key, on the command line as its option, in the window under its name, and in "
    "every program's header."
)
_OPERATION_COLUMNS = ("Key", "Option", "Name", "What it means", "Values", "Default", "Of")
_TOOLS = "Parameters of tools"
_ABOUT_TOOLS = (
    "Each stands in a job file and in a tool library under its key, and in a spreadsheet as a column. What is 0 or "
    "empty is not known."
)
_TOOL_COLUMNS = ("Key", "Name", "What it means", "Values", "Default")

Translation = Callable[[str], str]


def parameter_table(tr: Translation = str) -> str:
    """Return the page in Markdown; `resources/docs/parameters.md` is this text.

    Args:
        tr: gives words in the language of the page.
    """
    operations = (_cells(placed, kinds, tr) for placed, kinds in parameters().values())
    tools = (_tool_cells(placed, tr) for placed in declared_of(Tool).values())
    return (
        f"# {tr(_PAGE)}\n\n## {tr(_OPERATIONS)}\n\n{tr(_ABOUT_OPERATIONS)}\n\n{_head(_OPERATION_COLUMNS, tr)}"
        + "".join(map(_row, operations))
        + f"\n## {tr(_TOOLS)}\n\n{tr(_ABOUT_TOOLS)}\n\n{_head(_TOOL_COLUMNS, tr)}"
        + "".join(map(_row, tools))
    )


def _head(columns: tuple[str, ...], tr: Translation) -> str:
    return _row(iter([tr(each) for each in columns])) + f"|{'---|' * len(columns)}\n"


def _meaning(declared: Parameter, tr: Translation) -> str:
    """Return what a parameter means, as its form says it in a language, and what it needs."""
    said = f"{declared.help[:1].upper()}{declared.help[1:]}."
    words = tr(said)
    words = declared.help if words == said else words.rstrip("。")
    return f"{words}; {tr(f'with {declared.needs.with_}')}" if declared.needs else words


def _row(cells: Iterator[str]) -> str:
    return f"| {' | '.join(cells)} |\n"


def _tool_cells(placed: ParameterPlace, tr: Translation) -> Iterator[str]:
    declared = placed.parameter
    yield f"`{declared.key}`"
    yield tr(declared.label)
    yield _meaning(declared, tr)
    yield _values(placed, tr)
    yield "" if placed.default is MISSING else _default(placed, tr)


def _cells(placed: ParameterPlace, kinds: tuple[type[Operation], ...], tr: Translation) -> Iterator[str]:
    declared = placed.parameter
    yield f"`{declared.key}`"
    yield f"`--{declared.option}`" if declared.option else ""
    yield tr(declared.label)
    yield _meaning(declared, tr)
    yield _values(placed, tr)
    yield _default(placed, tr)
    yield ", ".join(kind.WORD for kind in kinds)


def _values(placed: ParameterPlace, tr: Translation) -> str:
    declared = placed.parameter
    if placed.enum is not None:
        return ", ".join(str(each.value) for each in placed.enum)
    if isinstance(placed.default, Keyword):
        return ", ".join(placed.default.words())
    words = {
        Unit.FLAG: "true, false",
        Unit.NAMES: "names",
        Unit.CURVES: "selectors",
        Unit.POINTS: "points [x, y], mm",
        Unit.TEXT: "text",
        Unit.OUTLINE: "points [height, radius], mm, or a name",
        Unit.FEEDS: "rows of material, surface_speed, feed_per_tooth, plunge_share",
    }
    return tr(words.get(declared.unit) or declared.range_words())


def _default(placed: ParameterPlace, tr: Translation) -> str:
    declared, value = placed.parameter, placed.default
    if placed.enum is not None or isinstance(value, Keyword):
        return str(value.value)
    if value is None:
        return tr(declared.auto)
    if declared.unit is Unit.FLAG:
        return str(value).lower()
    if isinstance(value, int | float):
        return tr(f"{declared.shown(value):g}{declared.sign}")
    return tr("none") if value == () else ""
