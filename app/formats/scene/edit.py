"""Changes of a scene's text: one value, one table, and every remark, order and spelling beside it stays as it was
written.
"""

from __future__ import annotations

from collections.abc import Mapping, MutableMapping, MutableSequence
from itertools import pairwise
from typing import Any, cast

import tomlkit
from tomlkit.exceptions import TOMLKitError

from ...core.errors import InputError
from .toml import in_own_units

Place = tuple[str | int, ...]
"""Keys and, in lists, numbers from 0: ("surface", 1, "shape", "radius")."""


def with_value(text: str, place: Place, value: object) -> str:
    """Return a scene's text with another value, mm; None takes the key away, so that its default counts.

    Raises:
        InputError: the text is no TOML, or has nothing at that place.
    """
    tree = _tree(text)
    table: Any = tree
    for key, below in pairwise(place):
        if isinstance(key, str) and key not in table and isinstance(below, str):
            table[key] = tomlkit.table()
        try:
            table = table[key]
        except (KeyError, IndexError) as error:
            raise InputError(f"The scene has no {_spelled(place)}; it was changed meanwhile.") from error
    key = str(place[-1])
    if value is None:
        cast(MutableMapping[str, Any], table).pop(key, None)
    else:
        table[key] = _as_written(tree, key, value)
    return tomlkit.dumps(tree)


def with_table(text: str, name: str, table: Mapping[str, object]) -> str:
    """Return a scene's text with one more table at the end of a list; numbers are mm.

    Raises:
        InputError: the text is no TOML.
    """
    tree = _tree(text)
    made = tomlkit.table()
    for key, value in table.items():
        made[key] = _as_written(tree, key, value)
    made.add(tomlkit.nl())
    if name not in tree:
        tree[name] = tomlkit.aot()
    cast(MutableSequence[Any], tree[name]).append(made)
    return tomlkit.dumps(tree)


def without_table(text: str, name: str, number: int) -> str:
    """Return a scene's text without one table of a list.

    Raises:
        InputError: the text is no TOML, or has no such table.
    """
    tree = _tree(text)
    listed = _list(tree, name, number)
    del listed[number]
    if not len(listed):
        del tree[name]
    return tomlkit.dumps(tree)


def with_table_moved(text: str, name: str, number: int, way: int) -> str:
    """Return a scene's text with one table of a list moved on by `way`; at the end of the list it stays.

    Raises:
        InputError: the text is no TOML, or has no such table.
    """
    tree = _tree(text)
    listed = _list(tree, name, number)
    to = number + way
    if not 0 <= to < len(listed):
        return text
    tables = [listed[n] for n in range(len(listed))]
    tables.insert(to, tables.pop(number))
    if isinstance(tree[name], tomlkit.items.AoT):
        tree[name] = tomlkit.aot()
        for table in tables:
            cast(MutableSequence[Any], tree[name]).append(table)
    else:
        for n, table in enumerate(tables):
            listed[n] = table
    return tomlkit.dumps(tree)


def line_of(text: str, name: str, number: int) -> int:
    """Return the line, 1-based, on which a table of a list begins; 1 where that cannot be told."""
    seen = -1
    for row, line in enumerate(text.splitlines(), 1):
        if line.split("#")[0].strip().replace(" ", "") == f"[[{name}]]":
            seen += 1
            if seen == number:
                return row
    return 1


def _tree(text: str) -> tomlkit.TOMLDocument:
    try:
        return tomlkit.parse(text)
    except TOMLKitError as error:
        raise InputError(f"The text is no scene while it is wrong: {error}; correct it first.") from error


def _list(tree: tomlkit.TOMLDocument, name: str, number: int) -> Any:
    listed = tree.get(name, [])
    if not 0 <= number < len(listed):
        raise InputError(f"The scene has no {_spelled((name, number))}; it was changed meanwhile.")
    return listed


def _units(tree: tomlkit.TOMLDocument) -> str:
    return str(tree.get("units", "mm"))


def _as_written(tree: tomlkit.TOMLDocument, key: str, value: object) -> Any:
    """Return a value in the units of the text, tables in it on one line, numbers as short as they can be."""
    return _short(in_own_units({key: value}, _units(tree), back=True)[key])


def _short(value: Any) -> Any:
    if isinstance(value, Mapping):
        made = tomlkit.inline_table()
        for key, item in value.items():
            made[key] = _short(item)
        return made
    if isinstance(value, (list, tuple)):
        made_list = tomlkit.array()
        for item in value:
            made_list.append(_short(item))
        return made_list
    if not isinstance(value, float):
        return value
    value = float(f"{value:.12g}")  # 50.8 mm are 2 inches, whatever a factor makes of them
    return int(value) if value.is_integer() and abs(value) < 1e9 else value


def _spelled(place: Place) -> str:
    return " ".join(str(key + 1) if isinstance(key, int) else key for key in place)
