"""How the drawing is read that a program is compared with: as was asked, else as the program's own header tells that it
was made.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace

from ..formats.readers import fit_for
from ..model.finding import Finding, FindingKind
from ..model.part import Units
from ..model.read_options import AS_DRAWN, OPTION_OF, DrawingOptions


@dataclass(frozen=True, slots=True)
class ToldReading:
    """Options for reading a drawing, and what there is to say where two of them differ.

    Attributes:
        how: it is read.
        findings: where what was asked is not what the program tells.
    """

    how: DrawingOptions
    findings: tuple[Finding, ...] = ()


def told_reading(asked: DrawingOptions, told: DrawingOptions, name: str, units: Units | None = None) -> ToldReading:
    """Return how a drawing is read: what was asked stands before what a program tells.

    Args:
        asked: on the command line. told: in the program's header.
        name: of the drawing; what the header tells of another kind of file says nothing of this one.
        units: that are asked for, which say the same as pixels to the inch.
    """
    told = fit_for(told, name)
    told = told if units is None else replace(told, pixels_per_inch=None)
    given = {
        each.name: value
        for each in fields(DrawingOptions)
        if (value := getattr(asked, each.name)) != getattr(AS_DRAWN, each.name)
    }
    lenient = "without_layers" not in given and bool(told.without_layers)
    return ToldReading(replace(told, **given, lenient=lenient), tuple(_differing(given, told)))


def _differing(given: dict[str, object], told: DrawingOptions) -> Iterator[Finding]:
    for field, option in OPTION_OF.items():
        before = getattr(told, field)
        if field in given and before != getattr(AS_DRAWN, field) and _plain(before) != _plain(given[field]):
            yield _as_asked(_words(option, before), _words(option, given[field]))


def other_units(asked: Units | None, told: Units | None, read: Units) -> Iterator[Finding]:
    """Say that a drawing is read in other units than those in which the program was made of it, as asked."""
    if asked is not None and told is not None and told is not read:
        yield _as_asked(f"units {told.name.lower()}", f"units {read.name.lower()}")


def other_names(option: str, asked: tuple[str, ...], told: tuple[str, ...]) -> Iterator[Finding]:
    """Say that other layers are compared than those of which the program was made, as asked."""
    if asked and told and _plain(asked) != _plain(told):
        yield _as_asked(_words(option, told), _words(option, asked))


def other_length(option: str, asked: float | None, told: float | None) -> Iterator[Finding]:
    """Say that a length is another one than that with which the program was made, as asked."""
    if asked is not None and told is not None and abs(asked - told) > 1e-6:
        yield _as_asked(f"{option} {told:g}", f"{option} {asked:g}")


def _as_asked(before: str, now: str) -> Finding:
    return Finding(
        FindingKind.ASSUMED, f"The program was made with {before}; here it is {now}, as asked.", counts=False
    )


def _plain(value: object) -> object:
    if isinstance(value, tuple):
        return frozenset(name.casefold() for name in value)
    return value.casefold() if isinstance(value, str) else value


def _words(option: str, value: object) -> str:
    """Return an option as it is typed."""
    values = value if isinstance(value, tuple) else (f"{value:g}" if isinstance(value, float) else str(value),)
    short = (each[:60] for each in values)
    return " ".join(f"{option} {each}" if each.isalnum() else f'{option} "{each}"' for each in short)
