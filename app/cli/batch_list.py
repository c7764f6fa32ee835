"""The parts of a batch: those of a folder, or those that a list names with options of their own."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.input_file import read_input
from ..formats.readers import suffixes
from ..usecases.batch.task import BatchKind
from .batch_options import actions_of

PROGRAMS = (".ngc", ".nc", ".tap", ".gcode", ".cnc", ".eia", ".min", ".mpf")
"""Suffixes of NC programs that a folder is searched for."""


@dataclass(frozen=True)
class ListedPart:
    """A part of a batch.

    Attributes:
        name: its path from the folder or the list.
        path: of its file.
        output: of its program, from the batch's folder; "" = named after the part.
        options: as they are typed behind its command.
    """

    name: str
    path: Path
    output: str = ""
    options: tuple[str, ...] = ()


def listed_parts(parts: Path, output: Path, kind: BatchKind) -> list[ListedPart]:
    """Return the parts of a folder, by their names, or of a list, in its order.

    Args:
        output: the batch's folder; what lies in it is no part.

    Raises:
        InputError: there is no part, or the list is not as it has to be.
    """
    if parts.is_dir():
        found = [ListedPart(path.relative_to(parts).as_posix(), path) for path in _in_folder(parts, output, kind)]
    elif parts.suffix.lower() == ".toml":
        found = _in_list(parts, kind)
    else:
        raise InputError(f"{parts} is neither a folder nor a list; name a folder of parts, or a LIST.toml")
    if not found:
        known = ", ".join(PROGRAMS if kind is not BatchKind.MAKE else suffixes())
        raise InputError(f"{parts} has no part in it: nothing that ends in {known}; choose another folder")
    return found


def _in_folder(folder: Path, output: Path, kind: BatchKind) -> Iterator[Path]:
    wanted, own = suffixes() if kind is BatchKind.MAKE else PROGRAMS, output.resolve()
    inside = own != folder.resolve()
    for path in sorted(folder.rglob("*")):
        hidden = any(part.startswith(".") for part in path.relative_to(folder).parts)
        if hidden or path.suffix.lower() not in wanted or not path.is_file():
            continue
        if not (inside and path.resolve().is_relative_to(own)):
            yield path


def _in_list(path: Path, kind: BatchKind) -> list[ListedPart]:
    try:
        told = tomllib.loads(read_input(path).decode("utf-8-sig"))
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: it is no TOML: {error}; see hitofude batch --help") from error
    unknown = [key for key in told if key not in ("options", "part")]
    tables = told.get("part", [])
    if unknown or not isinstance(tables, list) or not all(isinstance(each, dict) for each in tables):
        wrong = unknown[0] if unknown else "part"
        raise InputError(f"{path}: '{wrong}' is none of its tables; a list has [[part]] for each part, and [options]")
    common = told.get("options", {})
    if not isinstance(common, dict):
        raise InputError(f"{path}: 'options' is no table; write [options] above options for all parts")
    return [_part(path, number, table, common, kind) for number, table in enumerate(tables, 1)]


def _part(path: Path, number: int, table: Mapping[str, Any], common: Mapping[str, Any], kind: BatchKind) -> ListedPart:
    where = f"{path}: part {number}"
    file, output = table.get("file"), table.get("output", "")
    if not isinstance(file, str) or not file:
        raise InputError(f'{where}: it names no file; write file = "plate.dxf"')
    if not isinstance(output, str) or Path(output).is_absolute() or ".." in Path(output).parts:
        raise InputError(f"{where}: output is {output!r}; write a path below the batch's folder")
    own = {key: value for key, value in table.items() if key not in ("file", "output")}
    return ListedPart(file, path.parent / file, output, _typed({**common, **own}, kind, where, path.parent))


def _typed(options: Mapping[str, Any], kind: BatchKind, where: str, folder: Path) -> tuple[str, ...]:
    """Return options as they are typed; files that they name lie beside the list."""
    by_name = {name: action for action in actions_of(kind) for name in action.option_strings}
    words: list[str] = []
    for key, value in options.items():
        name = f"--{key.replace('_', '-')}"
        action = by_name.get(name)
        if action is None:
            raise InputError(f"{where}: '{key}' is no option of {kind.value}; see hitofude {kind.value} --help")
        if value is False:
            continue
        for each in value if isinstance(value, list) else [value]:
            if not isinstance(each, str | int | float):
                raise InputError(f"{where}: '{key}' is neither a text, a number nor true; write one of these")
            if (each is True) != (action.nargs == 0):
                wants = "true or false" if action.nargs == 0 else "a value"
                raise InputError(f"{where}: '{key}' wants {wants}; it is {each!r}")
            told = folder / str(each) if action.type is Path else each
            words.append(name if each is True else f"{name}={told}")
    return tuple(words)


def named_outputs(parts: Sequence[ListedPart]) -> list[str]:
    """Return the path of each part's program from the batch's folder: as its list says, else its own name with .ngc,
    and its whole name where another part has the same one.

    Raises:
        InputError: two are the same nevertheless.
    """
    short = [each.output or _inside(Path(each.name).with_suffix(".ngc")) for each in parts]
    shared = {name.lower() for name in short if [other.lower() for other in short].count(name.lower()) > 1}
    names = [
        own if own.lower() not in shared or each.output else _inside(Path(f"{each.name}.ngc"))
        for own, each in zip(short, parts, strict=True)
    ]
    seen: dict[str, str] = {}
    for name, each in zip(names, parts, strict=True):
        if (other := seen.setdefault(name.lower(), each.name)) is not each.name or list(names).count(name) > 1:
            raise InputError(f"{each.name} and {other} would both be {name}; give each an output of its own in a list")
    return names


def _inside(path: Path) -> str:
    """Return a path that stays below the batch's folder, whatever it begins with."""
    return Path(*[part for part in path.parts if part not in ("..", path.anchor)]).as_posix()
