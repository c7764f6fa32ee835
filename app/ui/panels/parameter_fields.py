"""Fields of a form made from the declarations of parameters: a number, a choice, a switch or a list, whatever the
parameter is.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import Any

from ...model.fields import Parameter, ParameterPlace, Unit
from ...model.operation import Operation
from ..framework.fields import ChoiceField, ListField, NumberField, NumberSpec
from ..framework.form import SwitchField

Field = NumberField | ChoiceField | ListField | SwitchField

_LONG = 12  # letters; longer words than these do not stand side by side in a row
_DECIMALS = {Unit.LENGTH: 3, Unit.ANGLE: 2, Unit.SHARE: 0, Unit.COUNT: 0, Unit.TIME: 2}
_SIGNS = {Unit.LENGTH: "mm", Unit.ANGLE: "°", Unit.SHARE: "%", Unit.COUNT: "", Unit.TIME: "s"}


def spec_of(declared: Parameter) -> NumberSpec:
    """Return what a number field asks for."""
    empty = f"; empty: {declared.auto}" if declared.auto else ""
    return NumberSpec(
        declared.short or declared.label,
        _SIGNS[declared.unit],
        declared.shown(declared.low),
        declared.shown(declared.high),
        _DECIMALS[declared.unit],
        declared.unit is Unit.LENGTH,
        f"{sentence(declared.help)}{empty}.",
        "auto" if declared.auto else "",
    )


def sentence(words: str) -> str:
    """Return words with a capital."""
    return words[:1].upper() + words[1:]


@dataclass(frozen=True, eq=False)
class ParameterField:
    """A parameter and the field that shows it.

    Attributes:
        placed: the parameter, where it stands in an operation.
        field: in the form.
    """

    placed: ParameterPlace
    field: Field

    def show(self, operation: Operation, note: str = "") -> None:
        """Show an operation's value."""
        value = self.placed.of(operation)
        if isinstance(self.field, NumberField):
            self.field.show_value(None if value is None else self.placed.parameter.shown(value), note)
        else:
            if isinstance(self.field, ChoiceField):
                self.field.leave_out(self.placed.parameter.not_taken)
            self.field.show_value(value)

    def kept(self, value: Any) -> Any:
        """Return what the field gives in the unit that the parameter is kept in."""
        declared = self.placed.parameter
        if value is None or not isinstance(self.field, NumberField):
            return value
        return declared.kept(value)


def field_of(placed: ParameterPlace, read: Callable[[str], float] | None = None) -> Field:
    """Return the field for a parameter.

    Args:
        placed: the parameter.
        read: gives the value of a text in the place of the parameter's own reading.
    """
    declared, name = placed.parameter, placed.parameter.short or placed.parameter.label
    if placed.enum is not None or declared.choices:
        values: list[Any] = list(placed.enum or (False, True))
        choices = list(zip(values, declared.choices or map(_word, values), strict=True))
        if len(choices) > 3 or any(len(words) > _LONG for _, words in choices):
            return ListField(name, choices)
        return ChoiceField(name, choices)
    if declared.unit is Unit.FLAG:
        return SwitchField(name, f"{sentence(declared.help)}.")
    if declared.unit is Unit.CURVES:
        return ListField(name, [])
    return NumberField(spec_of(declared), read)


def _word(value: Enum) -> str:
    return sentence(str(value.value))
