"""Dataclasses from TOML and back, for every kind of field."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar

import pytest

from app.core.errors import InputError
from app.core.toml_tables import read_tables, write_tables


class Colour(Enum):
    RED = "red"
    BLUE = "blue"


@dataclass(frozen=True)
class Inner:
    size: float
    names: tuple[str, ...] = ()


@dataclass(frozen=True)
class Outer:
    title: str
    count: int
    colour: Colour
    inner: Inner
    place: tuple[float, float] | None = None
    ready: bool = True


FULL = Outer('a "b"\\\n刃', 3, Colour.BLUE, Inner(1.5, ("x", "y")), (1.0, -2.5), False)


@pytest.mark.parametrize("value", [FULL, Outer("", -1, Colour.RED, Inner(1e-7))])
def test_what_is_written_is_read_again(value: Outer) -> None:
    assert read_tables(Outer, "a.toml", write_tables(value).encode(), {}) == value


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ('colour = "blue"', 'colour = "green"', r"a\.toml:3: colour is 'green'; expected is 'red' or 'blue'"),
        ("count = 3", "count = 3.5", r"a\.toml:2: count is 3\.5; expected is a whole number"),
        ("count = 3", "count = true", r"a\.toml:2: count is True; expected is a whole number"),
        ("ready = false", "ready = 0", r"ready is 0; expected is true or false"),
        ("[1.0, -2.5]", "[1.0]", r"a\.toml:4: place is \[1\.0\]; expected is a list of 2 numbers"),
        ('["x", "y"]', '["x", 2]', r"inner\.names is \['x', 2\]; expected is a list of texts"),
        ("size = 1.5", "size = 9", r"a\.toml:8: inner\.size is 9; expected is a number from 0 to 5"),
        ("size = 1.5", "", r"inner\.size is missing; add a number"),
        ("[inner]", "[other]", r"other is not known"),
        ("[inner]", "inner = 3\n[x]", r"is not known|inner is 3"),
    ],
)
def test_what_is_wrong_is_named_with_file_line_and_key(old: str, new: str, words: str) -> None:
    text = write_tables(FULL)
    assert old in text
    with pytest.raises(InputError, match=words):
        read_tables(Outer, "a.toml", text.replace(old, new, 1).encode(), {"inner.size": (0, 5)})


def test_a_range_of_a_table_is_that_of_its_numbers() -> None:
    with pytest.raises(InputError, match=r"inner\.size is 1\.5; expected is a number from 0 to 1"):
        read_tables(Outer, "a.toml", write_tables(FULL).encode(), {"inner": (0, 1)})


@dataclass(frozen=True)
class Disc:
    kind: ClassVar[str] = "disc"
    radius: float


@dataclass(frozen=True)
class Ring:
    kind: ClassVar[str] = "ring"
    radii: tuple[float, ...]
    holes: tuple[Disc, ...] = ()


@dataclass(frozen=True)
class Drawer:
    shape: Disc | Ring
    spare: Disc | None = None


@pytest.mark.parametrize(
    "value",
    [
        Drawer(Disc(2.0)),
        Drawer(Ring((1.0, 2.0)), Disc(3.0)),
        Drawer(Ring((1.0, 2.0, 3.0), (Disc(0.5), Disc(0.25)))),
        Drawer(Ring(())),
    ],
)
def test_one_of_several_tables_is_told_by_its_kind(value: Drawer) -> None:
    text = write_tables(value)
    assert f'[shape]\nkind = "{value.shape.kind}"\n' in text
    assert read_tables(Drawer, "a.toml", text.encode(), {}) == value


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("[shape]\nradius = 1", r'^a\.toml:1: shape\.kind is missing; add kind = "disc" or "ring"\.$'),
        (
            "[shape]\nradius = 1\nkind = 'star'",
            r"^a\.toml:3: shape\.kind is 'star'; expected is \"disc\" or \"ring\"\.$",
        ),
        ("[shape]\nkind = ['disc']", r"^a\.toml:2: shape\.kind is \['disc'\]; expected is"),
        ("shape = 3", r"^a\.toml:1: shape is 3; expected is a table with kind = \"disc\" or \"ring\"\.$"),
        (
            "[shape]\nkind = 'ring'\nradii = [1, 'a']",
            r"^a\.toml:3: shape\.radii is \[1, 'a'\]; expected is a list of numbers\.$",
        ),
        (
            "[shape]\nkind = 'ring'\nradii = []\nholes = [1, 2]",
            r"^a\.toml:4: shape\.holes is 1; expected is a table with radius\.$",
        ),
        (
            "\nshape = { kind = 'disc', size = 1 }",
            r"^a\.toml:2: shape\.size is not known; expected are kind, radius\.$",
        ),
        (
            "\nshape = { kind = 'ring', radii = [], holes = [{ radius = 'a' }] }",
            r"^a\.toml:2: shape\.holes\[1\]\.radius is 'a'; expected",
        ),
    ],
)
def test_a_table_of_a_wrong_kind_is_told_with_its_line(text: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        read_tables(Drawer, "a.toml", text.encode(), {})
