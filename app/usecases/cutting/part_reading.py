"""How the drawing is read that a program is compared with: as was asked, else as the program's own header tells that it
was made.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

from ...core.options import option
from ...formats.readers import fit_for
from ...model.finding import Finding, FindingKind
from ...model.part import Units
from ...model.read_options import AS_DRAWN, OPTION_OF, DrawingOptions


@dataclass(frozen=True, slots=True)
class PartReading:
    """Options for reading a drawing, and what there is to say where two of them differ.

    Attributes:
        how: it is read.
        findings: where what was asked is not what the program tells.
    """

    how: DrawingOptions
    findings: tuple[Finding, ...] = ()


def part_reading(
    requested: DrawingOptions, noted: DrawingOptions, name: str, units: Units | None = None
) -> PartReading:
    """Return how a drawing is read: what was asked stands before what a program tells.

    Args:
        requested: on the command line. noted: in the program's header.
        name: of the drawing; what the header tells of another kind of file says nothing of this one.
        units: that are asked for, which say the same as pixels to the inch.
    """
    noted = fit_for(noted, name)
    noted = noted if units is None else replace(noted, pixels_per_inch=None)
    given = {
        each.name: value
        for each in fields(DrawingOptions)
        if (value := getattr(requested, each.name)) != getattr(AS_DRAWN, each.name)
    }
    lenient = "without_layers" not in given and bool(noted.without_layers)
    return PartReading(replace(noted, **given, lenient=lenient), tuple(_differing(given, noted)))


def _differing(given: dict[str, object], noted: DrawingOptions) -> Iterator[Finding]:
    for field, name in OPTION_OF.items():
        before = getattr(noted, field)
        if field in given and before != getattr(AS_DRAWN, field) and _plain(before) != _plain(given[field]):
            yield _as_asked(_words(name, before), _words(name, given[field]))


def other_units(requested: Units | None, noted: Units | None, read: Units) -> Iterator[Finding]:
    """Say that a drawing is read in other units than those in which the program was made of it, as asked."""
    if requested is not None and noted is not None and noted is not read:
        yield _as_asked(f"units {noted.name.lower()}", f"units {read.name.lower()}")


def other_names(name: str, requested: tuple[str, ...], noted: tuple[str, ...]) -> Iterator[Finding]:
    """Say that other layers are compared than those of which the program was made, as asked."""
    if requested and noted and _plain(requested) != _plain(noted):
        yield _as_asked(_words(name, noted), _words(name, requested))


def other_length(name: str, requested: float | None, noted: float | None) -> Iterator[Finding]:
    """Say that a length is another one than that with which the program was made, as asked."""
    if requested is not None and noted is not None and abs(requested - noted) > 1e-6:
        yield _as_asked(option(name, f"{noted:g}"), option(name, f"{requested:g}"))


def _as_asked(before: str, now: str) -> Finding:
    return Finding(
        FindingKind.ASSUMED, f"The program was made with {before}; here it is {now}, as asked.", counts=False
    )


def _plain(value: object) -> object:
    if isinstance(value, tuple):
        return frozenset(name.casefold() for name in value)
    return value.casefold() if isinstance(value, str) else value


def _words(name: str, value: object) -> str:
    """Return an option with its value."""
    values = value if isinstance(value, tuple) else (f"{value:g}" if isinstance(value, float) else str(value),)
    short = (each[:60] for each in values)
    return " ".join(option(name, each if each.isalnum() else f'"{each}"') for each in short)
