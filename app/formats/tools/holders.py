"""Holders by name: the outlines in `resources/holders.toml`, which a tool may refer to."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from ...core.errors import InputError
from ...core.resources import resource
from ...core.toml_tables import read_tables
from ...model.tool import HolderPoint

FORMAT = 1


@dataclass(frozen=True, slots=True)
class NamedHolder:
    """A holder that has a name.

    Attributes:
        name: such as "ER20". remark: what it is, for people.
        outline: as `Tool.holder`.
    """

    name: str
    outline: tuple[HolderPoint, ...]
    remark: str = ""


@dataclass(frozen=True, slots=True)
class _HoldersFile:
    format: int
    holder: tuple[NamedHolder, ...] = ()


@cache
def named_holders() -> tuple[NamedHolder, ...]:
    """Return every holder that ships, in the order of the file."""
    path = resource("holders.toml")
    return read_tables(_HoldersFile, path.name, path.read_bytes(), {"format": (1, FORMAT)}).holder


def outline_of(name: str) -> tuple[HolderPoint, ...]:
    """Return the outline of a holder by its name, in any case and however spaced.

    Raises:
        InputError: there is none of that name.
    """
    plain_name = _plain(name)
    for holder in named_holders():
        if _plain(holder.name) == plain_name:
            return holder.outline
    known = ", ".join(holder.name for holder in named_holders())
    raise InputError(
        f"'{name}' is no holder; use one of {known}, or its outline, heights and radii from the lower face up."
    )


def name_of_outline(outline: tuple[HolderPoint, ...]) -> str:
    """Return the name of the holder that has an outline; "" where none has."""
    return next((holder.name for holder in named_holders() if holder.outline == outline), "")


def _plain(name: str) -> str:
    return name.replace(" ", "").replace("-", "").casefold()
