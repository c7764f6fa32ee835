"""Posts from their data files: read `resources/posts/NAME.toml` and say exactly what is wrong with it."""

from __future__ import annotations

import string
import tomllib
import typing
from dataclasses import fields, is_dataclass
from enum import Enum
from pathlib import Path
from typing import Any

from app.errors import InputError
from app.nc.post import Post, ProgramLines
from app.resources import resource

LETTERS = ("N", "G", "X", "Y", "Z", "I", "J", "F")
EVERYWHERE = frozenset({"units", "blending", "program"})
WITH_TOOL = EVERYWHERE | {"tool", "speed", "dwell_s", "dwell_ms", "coolant_on", "coolant_off", "preselect"}
FIELDS = {"tool": WITH_TOOL | {"clearance"}, "leave": WITH_TOOL}
EXPECTED = {str: "a text", bool: "true or false", int: "a whole number", float: "a number", tuple[str, ...]: "a list of texts"}
RANGES = {
    "decimals": (0, 6),
    "comments.width": (60, 250),
    "numbers.start": (0, 99999),
    "numbers.step": (1, 1000),
    "arcs.largest_sweep_deg": (60, 359),
    "arcs.smallest_radius_mm": (1e-6, 1),
    "arcs.largest_radius_mm": (10, 1e9),
    "arcs.radius_mismatch_mm": (0.0005, 10),
    "blending.tolerance_mm": (0, 10),
    "spindle.dwell_s": (0, 600),
    "program.number": (1, 7999),
}


def post_names() -> tuple[str, ...]:
    """Return the names of all posts, sorted."""
    return tuple(sorted(path.stem for path in resource("posts").glob("*.toml")))


def load_post(name: str) -> Post:
    """Return the post `resources/posts/NAME.toml`.

    Raises:
        InputError: there is no such post, or its file is not as app/nc/post.py says.
    """
    if name not in post_names():
        raise InputError(f"There is no post {name!r}; choose one of {', '.join(post_names())}.")
    return read_post(resource("posts", f"{name}.toml"))


def read_post(path: Path) -> Post:
    """Return the post in a file.

    Raises:
        InputError: the text is no TOML, or a key is missing, unknown, of the wrong kind or out of its range.
    """
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path.name}: this is no TOML file ({error}); correct it.") from error
    post: Post = _table(Post, data, (path.name,))
    _check_words(post, path.name)
    _check_templates(post, path.name)
    return post


def _table(kind: Any, data: dict[str, Any], where: tuple[str, ...]) -> Any:
    """Make a dataclass of a TOML table, key by key; `where` is the file's name and the tables down to here."""
    types = typing.get_type_hints(kind)
    for key in data:
        if key not in types:
            raise InputError(f"{_place(where, key)} is not known; expected are {', '.join(types)}.")
    for field in fields(kind):
        if field.name not in data:
            raise InputError(f"{_place(where, field.name)} is missing; add {_expected(types[field.name])}.")
    return kind(**{key: _value(types[key], value, (*where, key)) for key, value in data.items()})


def _value(kind: Any, value: Any, where: tuple[str, ...]) -> Any:
    """Return a TOML value as what its field holds."""
    if is_dataclass(kind) and isinstance(value, dict):
        return _table(kind, value, where)
    if isinstance(kind, type) and issubclass(kind, Enum) and value in [choice.value for choice in kind]:
        return kind(value)
    if kind == tuple[str, ...] and isinstance(value, list) and all(isinstance(item, str) for item in value):
        return tuple(value)
    if kind in (int, float) and type(value) in (int, kind):
        return _in_range(value, where)
    if kind in (str, bool) and isinstance(value, kind):
        return value
    raise InputError(f"{_place(where[:-1], where[-1])} is {value!r}; expected is {_expected(kind)}.")


def _in_range(value: float, where: tuple[str, ...]) -> float:
    """Return a number if it is in the range of its key."""
    low, high = RANGES["decimals" if where[1] == "decimals" else ".".join(where[1:])]
    if not low <= value <= high:
        raise InputError(f"{_place(where[:-1], where[-1])} is {value:g}; expected is a number from {low:g} to {high:g}.")
    return value


def _expected(kind: Any) -> str:
    """Return what a key of this type holds, in words."""
    if is_dataclass(kind):
        return f"a table with {', '.join(field.name for field in fields(kind))}"
    if isinstance(kind, type) and issubclass(kind, Enum):
        return " or ".join(repr(choice.value) for choice in kind)
    return EXPECTED[kind]


def _place(where: tuple[str, ...], key: str) -> str:
    """Return the file and the dotted key: "mill.toml: arcs.centre"."""
    return f"{where[0]}: {'.'.join((*where[1:], key))}"


def _check_words(post: Post, file: str) -> None:
    """Check what a single key cannot tell: letters, the four motions, like digits for the two axes of the plane."""
    if sorted(post.words.order) != sorted(LETTERS):
        raise InputError(f"{file}: words.order is {list(post.words.order)}; expected is each of {', '.join(LETTERS)} once.")
    if len(post.words.motion) != 4:
        raise InputError(f"{file}: words.motion has {len(post.words.motion)} texts; expected are rapid, line, clockwise and "
                         "counter-clockwise arc.")
    for name, digits in (("mm", post.decimals.mm), ("inch", post.decimals.inch)):
        if digits.X != digits.Y or digits.I != digits.J or digits.I < digits.X:
            raise InputError(f"{file}: decimals.{name} must be alike for X and Y, and for I and J, and I not less than X.")


def _check_templates(post: Post, file: str) -> None:
    """Check that templates name only fields that there are."""
    _check_template(post.blending.blend, frozenset({"blend"}), f"{file}: blending.blend")
    for field in fields(ProgramLines):
        if field.name != "number":
            for template in getattr(post.program, field.name):
                _check_template(template, FIELDS.get(field.name, EVERYWHERE), f"{file}: program.{field.name}")


def _check_template(template: str, known: frozenset[str], place: str) -> None:
    """Check the fields of one template, and that it can be filled in."""
    try:
        used = {name for _, name, _, _ in string.Formatter().parse(template) if name is not None}
    except ValueError as error:
        raise InputError(f"{place}: {template!r} has a brace without its partner.") from error
    if used - known:
        raise InputError(f"{place}: {{{min(used - known)}}} in {template!r} is not known; expected are {', '.join(sorted(known))}.")
    try:
        template.format(**dict.fromkeys(known, "1"))
    except ValueError as error:
        raise InputError(f"{place}: {template!r} cannot be filled in ({error}); fields are texts, as in {{program:0>4}}.") from error
