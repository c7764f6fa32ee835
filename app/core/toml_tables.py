"""Data files into dataclasses and back: a TOML table is a dataclass, a key is a field, and an error names file, line
and key.
"""

from __future__ import annotations

import re
import tomllib
import types
import typing
from collections.abc import Mapping, Sequence
from dataclasses import MISSING, Field, dataclass, fields, is_dataclass
from difflib import get_close_matches
from enum import Enum
from functools import cache
from typing import Any, TypeVar

from .errors import HitofudeError, InputError
from .input_file import FileBytes
from .wording import either

Kind = TypeVar("Kind")


class Keyword:
    """A thing that stands as a word in a file, one of some that may grow: unlike an Enum, others can be added.

    Attributes:
        value: the word.
    """

    value: str

    @classmethod
    def words(cls) -> Mapping[str, Any]:
        """Return all of them by their words."""
        raise NotImplementedError

    @classmethod
    def other_words(cls) -> Mapping[str, str]:
        """Return the words of those that are also called something else, by what they are called."""
        return {}


Range = tuple[float, float]

_LONGEST, QUOTED = 200, 60
"""So many letters of an error, and of a wrong value, are shown."""
_NAMED = 8
"""Of many known words so many are named."""
_ENDLESS = re.compile(r"(?<![\w.'\"])[-+]?[0-9][0-9_]{3999,}")

EXPECTED = {
    str: "a text",
    bool: "true or false",
    int: "a whole number",
    float: "a number",
    tuple[str, ...]: "a list of texts",
    tuple[float, ...]: "a list of numbers",
    tuple[int, ...]: "a list of whole numbers",
}


@dataclass(frozen=True)
class _Place:
    """Where in a file a table is: the file's name, its lines, and the tables down to here."""

    file: str
    lines: tuple[str, ...]
    tables: tuple[str, ...] = ()

    def inside(self, key: str) -> _Place:
        """Return the place of a table in this one."""
        return _Place(self.file, self.lines, (*self.tables, key))

    def item(self, key: str, number: int) -> _Place:
        """Return the place of the number-th table, from 1 on, of a list of tables in this one."""
        return self.inside(f"{key}[{number}]")

    def error(self, key: str, text: str) -> InputError:
        """Return an error that names a key: "mill.toml:7: x.rapid is ..."."""
        return InputError(f"{self.file}:{self._line(key)}: {brief('.'.join((*self.tables, key)), QUOTED)} {text}")

    def begin(self) -> str:
        """Return the file and the line of the table's header; of the file's own keys, the file alone."""
        return f"{self.file}:{self._line('')}" if self.tables else self.file

    def _line(self, key: str) -> int:
        """Return the 1-based line of a key; where it is missing, that of its table, or 1."""
        table, found = "", 1
        here, counts = ".".join(self.tables), dict[str, int]()
        for number, line in enumerate(self.lines, 1):
            if header := re.match(r"\s*(\[{1,2})\s*([\w.\"'-]+)\s*\]", line):
                table = _numbered(header[2], counts, begins=header[1] == "[[")
                found = number if table == here else found
                if table in (f"{here}.{key}".lstrip("."), f"{here}.{key}[1]".lstrip(".")):
                    return number
            elif table == here and re.match(rf"\s*[\"']?{re.escape(key)}[\"']?\s*=", line):
                return number
        if found == 1 and self.tables:  # a table within a line, or none: where the one that holds it is
            return _Place(self.file, self.lines, self.tables[:-1])._line(re.sub(r"\[\d+\]$", "", self.tables[-1]))
        return found


def _numbered(header: str, counts: dict[str, int], begins: bool) -> str:
    """Return a table's path with the numbers of the lists in it: "tool.feeds" -> "tool[2].feeds[1]".

    Args:
        header: the path as the file has it.
        counts: how many tables each list holds up to here; changed.
        begins: this header begins another table of a list.
    """
    path = ""
    parts = header.split(".")
    for depth, part in enumerate(parts, 1):
        path = f"{path}.{part}".lstrip(".")
        counts[path] = counts.get(path, 0) + (begins and depth == len(parts))
        path += f"[{counts[path]}]" * bool(counts[path])
    return path


@dataclass(frozen=True)
class _KeyPlace:
    """A key where it stands."""

    place: _Place
    key: str

    def error(self, text: str) -> InputError:
        """Return the error that its value is wrong."""
        return self.place.error(self.key, text)

    def inside(self) -> _Place:
        """Return the place of the table that it names."""
        return self.place.inside(self.key)


def read_tables(kind: type[Kind], file: str, data: bytes, ranges: Mapping[str, Range]) -> Kind:
    """Return the dataclass that a TOML text describes; fields with a default may be left out.

    Args:
        kind: a dataclass whose fields are texts, flags, numbers, Enums by their value, tuples of texts or of so many
            numbers, of any number of numbers or of such tuples, dataclasses, tuples of any number of them, one of these
            or None, or one of several dataclasses, told apart by a key `kind`: their class variable of that name.
        file: the file's name, for errors.
        data: its bytes, UTF-8.
        ranges: least and greatest number by dotted key; a table's name stands for all its numbers; others are free.

    Raises:
        InputError: the text is no TOML, or a key is missing, unknown, of the wrong kind or out of its range.
    """
    return tables_of(kind, read_tree(file, data), FileBytes(file, data), ranges)


def read_tree(file: str, data: bytes) -> dict[str, Any]:
    """Return what a TOML text holds.

    Raises:
        InputError: it is none.
    """
    try:
        return parsed(data.decode("utf-8-sig"))
    except (ValueError, RecursionError) as error:
        raise InputError(f"{file}: this is no TOML file ({brief(str(error))}); correct it.") from error


def parsed(text: str) -> dict[str, Any]:
    """Return what a TOML text holds; whole numbers are of 64 bits, as TOML promises them.

    Raises:
        ValueError: it is no TOML, or a whole number in it is larger.
        RecursionError: it is nested too deep.
    """
    try:
        tree = tomllib.loads(text)
    except tomllib.TOMLDecodeError:
        raise
    except ValueError:  # so many digits that Python itself refuses to read them
        found = _ENDLESS.search(text)
        where = f" (at line {text.count(chr(10), 0, found.start()) + 1}, column 1)" if found else ""
        raise ValueError(f"a whole number has thousands of digits; it has at most 64 bits{where}") from None
    _ensure_small(tree, "")
    return tree


def _ensure_small(value: Any, key: str) -> None:
    """Refuse whole numbers that no computer word holds."""
    if isinstance(value, dict):
        for name, item in value.items():
            _ensure_small(item, f"{key}.{name}".lstrip("."))
    elif isinstance(value, list):
        for item in value:
            _ensure_small(item, key)
    elif isinstance(value, int) and not -(2**63) <= value < 2**63:
        raise ValueError(f"{key} is a whole number of {value.bit_length()} bits; it has at most 64 bits")


def brief(text: str, most: int = _LONGEST) -> str:
    """Return a text for a message, cut after `most` letters: no longer than a line can hold."""
    return text if len(text) <= most else f"{text[:most]}…"


def known_words(word: str, known: Sequence[str]) -> str:
    """Return what might have been meant by a wrong word: all known ones where they are few, else those that are most
    like it.
    """
    if len(", ".join(known)) <= _LONGEST:
        return ", ".join(known)
    near = get_close_matches(word, known, n=3, cutoff=0.5)
    named = [*near, *(other for other in known if other not in near)][:_NAMED]
    return f"{', '.join(named)} or one of {len(known) - len(named)} others"


def shown(value: Any) -> str:
    """Return a wrong value for a message, cut after 60 letters."""
    return brief(repr(value), QUOTED)


def tables_of(kind: type[Kind], tree: dict[str, Any], source: FileBytes, ranges: Mapping[str, Range]) -> Kind:
    """Return the dataclass that tables describe, as `read_tables` does.

    Args:
        source: what they were read from, for errors.
    """
    lines = source.data.decode("utf-8-sig").splitlines()
    made: Kind = _table(kind, tree, _Place(source.name, tuple(lines)), ranges)
    return made


def _table(kind: Any, data: dict[str, Any], place: _Place, ranges: Mapping[str, Range]) -> Any:
    """Make a dataclass of a table, key by key."""
    hints = _types_of(kind)
    if typing.get_origin(hints.get("kind")) is typing.ClassVar:
        data = {key: value for key, value in data.items() if key != "kind"}
    for key in data:
        if key not in hints:
            raise place.error(key, f"is not known; expected are {known_words(key, list(hints))}.")
    for each in fields(kind):
        if each.name not in data and _required(each):
            raise place.error(each.name, f"is missing; add {_expected(hints[each.name])}.")
    values = {key: _value(hints[key], value, _KeyPlace(place, key), ranges) for key, value in data.items()}
    try:
        return kind(**values)
    except InputError:
        raise
    except HitofudeError as error:
        raise InputError(f"{place.begin()}: {error}") from error


@cache
def _types_of(kind: Any) -> dict[str, Any]:
    """Return the type of each field of a dataclass by its name."""
    return typing.get_type_hints(kind)


def _required(each: Field[Any]) -> bool:
    return each.default is MISSING and each.default_factory is MISSING


def _value(kind: Any, value: Any, at: _KeyPlace, ranges: Mapping[str, Range]) -> Any:
    """Return a TOML value as what its field holds."""
    if isinstance(kind, types.UnionType):
        return _value(_meant(kind, value, at), value, at, ranges)
    if _is_table(kind) and isinstance(value, dict):
        return _table(kind, value, at.inside(), ranges)
    if isinstance(value, str) and value in (words := _words(kind)):
        return words[value]
    if typing.get_origin(kind) is tuple and isinstance(value, list) and _alike(typing.get_args(kind), value):
        whole = typing.get_args(kind) == (int, ...)
        return tuple(item if whole or isinstance(item, str) else float(_in_range(item, at, ranges)) for item in value)
    if (part := _repeated(kind)) is not None and isinstance(value, list):
        return tuple(_item(part, item, at, number, ranges) for number, item in enumerate(value, 1))
    if kind in (int, float) and type(value) in (int, kind):
        return kind(_in_range(value, at, ranges))
    if kind in (str, bool) and isinstance(value, kind):
        return value
    raise at.error(f"is {shown(value)}; expected is {_expected(kind)}.")


def _meant(union: types.UnionType, value: Any, at: _KeyPlace) -> Any:
    """Return which type of a union a value is of: that which is not None, or the dataclass of its kind."""
    choices = [part for part in typing.get_args(union) if part is not types.NoneType]
    if len(choices) == 1:
        return choices[0]
    if not isinstance(value, dict):
        raise at.error(f"is {shown(value)}; expected is {_expected(union)}.")
    kinds = {part.kind: part for part in choices}
    place = at.inside()
    if "kind" not in value:
        raise place.error("kind", f"is missing; add kind = {_kinds_of(kinds)}.")
    if not isinstance(value["kind"], str) or value["kind"] not in kinds:
        raise place.error("kind", f"is {shown(value['kind'])}; expected is {_kinds_of(kinds)}.")
    return kinds[value["kind"]]


def _kinds_of(words: typing.Iterable[str]) -> str:
    return either(f'"{word}"' for word in words)


def _repeated(kind: Any) -> Any:
    """Return what a tuple of any number of tables or of tuples holds; None for other types."""
    parts = typing.get_args(kind) if typing.get_origin(kind) is tuple else ()
    return parts[0] if parts[1:] == (...,) and (_is_table(parts[0]) or typing.get_origin(parts[0]) is tuple) else None


def _item(kind: Any, value: Any, at: _KeyPlace, number: int, ranges: Mapping[str, Range]) -> Any:
    """Return one table or one tuple of a list of them, of which it is the number-th."""
    if _is_table(kind) and isinstance(value, dict):
        return _table(kind, value, at.place.item(at.key, number), ranges)
    return _value(kind, value, at, ranges)


def _alike(parts: tuple[Any, ...], values: list[Any]) -> bool:
    """Tell whether the values are those of a tuple type: texts, or so many numbers."""
    if parts == (str, ...):
        return all(isinstance(value, str) for value in values)
    if parts == (int, ...):
        return all(type(value) is int for value in values)
    if parts == (float, ...):
        return all(type(value) in (int, float) for value in values)
    return parts[1:] != (...,) and len(parts) == len(values) and all(type(value) in (int, float) for value in values)


def _in_range(value: float, at: _KeyPlace, ranges: Mapping[str, Range]) -> float:
    """Return a number if it is in the range of its key, or of the first table above it that has one."""
    path = [re.sub(r"\[\d+\]$", "", part) for part in (*at.place.tables, at.key)]
    found = [name for end in range(len(path), 0, -1) if (name := ".".join(path[:end])) in ranges]
    low, high = ranges[found[0]] if found else (float("-inf"), float("inf"))
    if not low <= value <= high:
        raise at.error(f"is {value:g}; expected is a number from {low:g} to {high:g}.")
    return value


def _expected(kind: Any) -> str:
    """Return what a key of this type holds, in words."""
    if isinstance(kind, types.UnionType):
        choices = [part for part in typing.get_args(kind) if part is not types.NoneType]
        return (
            _expected(choices[0])
            if len(choices) == 1
            else f"a table with kind = {_kinds_of(part.kind for part in choices)}"
        )
    if _is_table(kind):
        return f"a table with {', '.join(each.name for each in fields(kind))}"
    if words := _words(kind):
        return either(map(repr, words))
    if (part := _repeated(kind)) is not None:
        return f"a list, and in it {_expected(part)} each time"
    return EXPECTED.get(kind) or f"a list of {len(typing.get_args(kind))} numbers"


def _is_table(thing: Any) -> bool:
    """Tell whether a value, or all of a kind, stand as a table."""
    kind = thing if isinstance(thing, type) else type(thing)
    return is_dataclass(kind) and not issubclass(kind, Keyword)


def _words(kind: Any) -> Mapping[Any, Any]:
    """Return what the words of an Enum, or of another kind of worded things, stand for; nothing of other kinds."""
    if isinstance(kind, type) and issubclass(kind, Keyword):
        return kind.words()
    return {choice.value: choice for choice in kind} if isinstance(kind, type) and issubclass(kind, Enum) else {}


def write_tables(value: Any) -> str:
    """Return a dataclass as the TOML text that `read_tables` makes it of; what is None is left out."""
    return "\n".join(_lines(value, "")) + "\n"


def _lines(value: Any, table: str) -> list[str]:
    plain, tables = [], []
    if "kind" not in {each.name for each in fields(value)} and isinstance(getattr(value, "kind", None), str):
        plain.append(f"kind = {spelled(value.kind)}")
    for each in fields(value):
        item = getattr(value, each.name)
        if _is_table(item):
            path = f"{table}.{each.name}" if table else each.name
            tables += ["", f"[{path}]", *_lines(item, path)]
        elif isinstance(item, tuple) and item and _is_table(item[0]):
            path = f"{table}.{each.name}" if table else each.name
            tables += [line for one in item for line in ("", f"[[{path}]]", *_lines(one, path))]
        elif item is not None and not item == () == each.default:
            plain.append(f"{each.name} = {spelled(item)}")
    return plain + tables


def spelled(item: Any) -> str:
    """Return a number, a flag, a text, an Enum by its value or a tuple of such as TOML spells it."""
    if isinstance(item, Enum | Keyword):
        return spelled(item.value)
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, str):
        escaped = "".join(f"\\u{ord(c):04X}" if ord(c) < 32 or ord(c) == 127 or c in '"\\' else c for c in item)
        return f'"{escaped}"'
    if isinstance(item, tuple):
        return f"[{', '.join(spelled(part) for part in item)}]"
    return repr(float(item)) if isinstance(item, float) else repr(item)
