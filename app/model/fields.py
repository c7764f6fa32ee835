"""Parameters, each declared once: a field of a frozen dataclass with unit, range, default, help, and when it has an
effect.

Whatever asks for a parameter, reads it, writes it, checks it or explains it walks the declarations (`parameters_of`):
options of the command line and their help, job files, projects, forms, NC headers and their reading back, reports, the
manual's table.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from enum import Enum
from functools import cache
from numbers import Real
from typing import Any, TypeVar, cast

from ..core.errors import ParameterError

Value = TypeVar("Value")
Whole = TypeVar("Whole")


class Unit(Enum):
    """What a parameter is; the value says how much of it is written: "depth_mm" in reports."""

    LENGTH = "mm"
    ANGLE = "deg"  # kept in radians, told in degrees
    SHARE = "share"  # kept as a part of 1, asked for in per cent
    COUNT = "count"
    FLAG = "flag"
    CHOICE = "choice"  # of an enum
    NAMES = "names"
    CURVES = "curves"  # selectors, see curve_selectors
    POINTS = "points"
    SPEED = "rpm"
    RATE = "mm_min"
    TIME = "s"
    TEXT = "text"
    OUTLINE = "outline"  # of a holder, by its points or its name
    FEEDS = "feeds"  # rows of feeds, by material


@dataclass(frozen=True)
class Condition:
    """When a parameter has an effect.

    Attributes:
        holds: of the operation that it belongs to.
        with_: what the operation has where it does, behind "with".
        remedy: how a job file asks for it.
        option: says the same with options; None where that goes without saying.
    """

    holds: Callable[[Any], bool]
    with_: str
    remedy: str
    option: Callable[[], str] | None = None


@dataclass(frozen=True)
class Parameter:
    """What there is to know about a parameter beside its value.

    Attributes:
        key: its name in job files, projects, reports and headers; one name stands for one thing in all kinds of
            operation.
        label: its name in forms and errors; `short` where a group's heading says the rest.
        help: what it means, a sentence without a capital and a full stop.
        unit, low, high: what it is, and the range, ends included, in the unit that it is kept in.
        option: on the command line, without dashes; "" = it has none of its own.
        auto: what None stands for; "" = there is always a value.
        group: where it stands in the form.
        needs: when it has an effect; None = always.
        on_pixels: whether the bitmap way knows it too.
        table, word: of a job's parameter: the table of a job file that it stands in, and its key there, where that is
            another one.
        choices: words for the members of its enum in forms, for False and True of a flag that is no switch.
        not_taken: members of its enum that this kind of operation refuses, so that its form does not offer them.
    """

    key: str
    label: str
    help: str
    unit: Unit
    low: float = 0.0
    high: float = 99_999.0
    option: str = ""
    auto: str = ""
    group: str = ""
    needs: Condition | None = None
    on_pixels: bool = False
    choices: tuple[str, ...] = ()
    not_taken: tuple[Enum, ...] = ()
    short: str = ""
    table: str = ""
    word: str = ""

    def shown(self, value: float) -> float:
        """Return a value in the unit that people read: degrees, per cent."""
        return math.degrees(value) if self.unit is Unit.ANGLE else 100 * value if self.unit is Unit.SHARE else value

    def kept(self, value: float) -> float:
        """Return a value in the unit that it is kept in, of one in the unit that people read."""
        if self.unit is Unit.COUNT:
            return int(value)
        return math.radians(value) if self.unit is Unit.ANGLE else value / 100 if self.unit is Unit.SHARE else value

    @property
    def sign(self) -> str:
        """What stands behind a number in a sentence, with its space."""
        return {
            Unit.LENGTH: " mm",
            Unit.ANGLE: " degrees",
            Unit.SHARE: " %",
            Unit.SPEED: " rpm",
            Unit.RATE: " mm/min",
            Unit.TIME: " s",
        }.get(self.unit, "")

    def range_words(self) -> str:
        """Return the range in words: "0 to 10 mm"."""
        return f"{self.shown(self.low):.3g} to {self.shown(self.high):.6g}{self.sign}"

    def check(self, value: Any) -> None:
        """Refuse a value that is out of the range.

        Raises:
            ParameterError: it is, or it is None where there must be a value.
        """
        if value is None and self.auto:
            return
        if self.unit in _RANGED and not self.low <= value <= self.high * (1 + 1e-12):
            raise ParameterError(f"{self.label} is {self.shown(value):g}{self.sign}; use {self.range_words()}.")


_RANGED = frozenset({Unit.LENGTH, Unit.ANGLE, Unit.SHARE, Unit.COUNT, Unit.TIME})
_NUMBERS = _RANGED | {Unit.SPEED, Unit.RATE}
_PARAMETER, _PART = "parameter", "part"


def parameter(
    default: Value, key: str, label: str, help: str, unit: Unit, **more: Any
) -> Value:  # help: the field's own word
    """Declare a parameter: the value of a dataclass's field. `more`: attributes of `Parameter`; `option=True` names it
    after the key.
    """
    if more.get("option") is True:
        more["option"] = key.replace("_", "-")
    held: Any = dataclasses.field(default=default, metadata={_PARAMETER: Parameter(key, label, help, unit, **more)})
    return cast(Value, held)


def required(key: str, label: str, help: str, unit: Unit, **more: Any) -> Any:
    """Declare a parameter without a default."""
    return dataclasses.field(metadata={_PARAMETER: Parameter(key, label, help, unit, **more)})


def part(kind: type[Value]) -> Value:
    """Declare a field that holds a whole of parameters, such as the way into the metal, with its defaults."""
    held: Any = dataclasses.field(default=kind(), metadata={_PART: kind})
    return cast(Value, held)


def required_part(kind: type[Value]) -> Value:
    """Declare a field that holds a whole of parameters, some of which have no default."""
    held: Any = dataclasses.field(metadata={_PART: kind})
    return cast(Value, held)


@dataclass(frozen=True)
class ParameterPlace:
    """A parameter where it stands.

    Attributes:
        path: names of fields from the whole down to it.
        parameter: what there is to know about it.
        default: its value where nobody says one; `dataclasses.MISSING` where somebody must.
    """

    path: tuple[str, ...]
    parameter: Parameter
    default: Any

    @property
    def key(self) -> str:
        """Its name."""
        return self.parameter.key

    @property
    def enum(self) -> type[Enum] | None:
        """The enum that it is a member of."""
        return type(self.default) if isinstance(self.default, Enum) else None

    def of(self, whole: Any) -> Any:
        """Return its value."""
        for name in self.path:
            whole = getattr(whole, name)
        return whole

    def has_effect(self, whole: Any) -> bool:
        """Return whether the whole is such that the value has an effect."""
        return self.parameter.needs is None or self.parameter.needs.holds(whole)


def declared_of(kind: type[Any]) -> Mapping[str, ParameterPlace]:
    """Return the parameters of a dataclass and its parts by key, in the order of their declaration."""
    return _declared(cast(Any, kind))


def parameters_of(kind: type[Any]) -> Mapping[str, ParameterPlace]:
    """Return the parameters that have an effect: a kind names keys of its parts that have none in `UNUSED`."""
    return _effective(cast(Any, kind))


@cache
def _declared(kind: Any) -> Mapping[str, ParameterPlace]:
    return {placed.key: placed for placed in _walk(kind, ())}


@cache
def _effective(kind: Any) -> Mapping[str, ParameterPlace]:
    unused: frozenset[str] = getattr(kind, "UNUSED", frozenset())
    return {key: placed for key, placed in _declared(kind).items() if key not in unused}


def _walk(kind: type[Any], above: tuple[str, ...]) -> Iterator[ParameterPlace]:
    for field in dataclasses.fields(kind):
        path = (*above, field.name)
        if _PART in field.metadata:
            yield from _walk(field.metadata[_PART], path)
        elif _PARAMETER in field.metadata:
            yield ParameterPlace(path, field.metadata[_PARAMETER], field.default)


def with_values(whole: Whole, values: Mapping[str, Any]) -> Whole:
    """Return a whole with other values, by key, all put in at once.

    Raises:
        ParameterError: one is out of its range, or does not go with another one.
        KeyError: the whole has no such parameter.
    """
    known = declared_of(type(whole))
    return cast(Whole, _replaced(whole, {known[key].path: value for key, value in values.items()}))


def _replaced(whole: Any, values: Mapping[tuple[str, ...], Any]) -> Any:
    """Return a whole with values at paths from it down."""
    below: dict[str, dict[tuple[str, ...], Any]] = {}
    own: dict[str, Any] = {}
    for path, value in values.items():
        if len(path) == 1:
            own[path[0]] = value
        else:
            below.setdefault(path[0], {})[path[1:]] = value
    return dataclasses.replace(
        whole, **own, **{name: _replaced(getattr(whole, name), inner) for name, inner in below.items()}
    )


def check_ranges(whole: Any) -> None:
    """Refuse a dataclass one of whose own parameters is out of its range; its parts have checked theirs.

    Raises:
        ParameterError: one is, or is nothing of its kind.
    """
    check_kinds(whole)
    for name, declared in _own(cast(Any, type(whole))):
        declared.check(getattr(whole, name))


def check_kinds(whole: Any) -> None:
    """Refuse a dataclass one of whose own parameters is a text where it is a number or a choice, as in scripts.

    Raises:
        ParameterError: one is.
    """
    for field in dataclasses.fields(whole):
        declared, value = field.metadata.get(_PARAMETER), getattr(whole, field.name)
        if declared is None or (value is None and declared.auto):
            continue
        if declared.unit in _NUMBERS and not isinstance(value, Real):
            raise ParameterError(f"{declared.label} is {value!r}; it must be a number.")
        if declared.unit is Unit.CHOICE and isinstance(value, str):
            raise ParameterError(
                f"{declared.label} is {value!r}; it must be a member of {type(field.default).__name__}."
            )


@cache
def _own(kind: Any) -> tuple[tuple[str, Parameter], ...]:
    return tuple(
        (field.name, field.metadata[_PARAMETER]) for field in dataclasses.fields(kind) if _PARAMETER in field.metadata
    )


def built(kind: type[Value], values: Mapping[str, Any]) -> Value:
    """Return a whole of values by key; what is not among them has its default.

    Raises:
        ParameterError: a value is out of its range, or does not go with another one.
        KeyError: a value is missing that has no default.
    """
    return cast(Value, _built(kind, values))


def _built(kind: type[Any], values: Mapping[str, Any]) -> Any:
    given: dict[str, Any] = {}
    for field in dataclasses.fields(kind):
        if _PART in field.metadata:
            given[field.name] = _built(field.metadata[_PART], values)
        elif _PARAMETER in field.metadata:
            key = field.metadata[_PARAMETER].key
            if key in values:
                given[field.name] = values[key]
            elif field.default is dataclasses.MISSING:
                raise KeyError(key)
    return kind(**given)
