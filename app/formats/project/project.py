"""Project files, `.hito`: a drawing with its names, its layers, its job and how it was looked at, as one TOML text.

`resources/docs/project.md` explains every key. A file of a newer version is refused rather than half read; of an older
one `UPGRADES` makes the newest.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path, PurePath
from typing import Any, NamedTuple

from ...core.errors import InputError
from ...core.toml_tables import brief, parsed, shown, spelled
from ...drafting.expressions.grammar import read_script
from ...drafting.expressions.syntax import CommandDefinition
from ...drafting.expressions.values import Curves, Length, Value
from ...drafting.history import HistoryState
from ...drafting.recorded_lines import RecordedLine
from ...model.curves import Point
from ...model.notes import Note
from ...model.part import Entity, Layer, Part, Units
from ..drawing import Drawing
from ..drawing_account import on_layers, other_units, switched_off
from ..job.tables import (
    JobTable,
    JobText,
    one_of,
    read_flag,
    read_number,
    read_points,
    read_text,
    read_texts,
    read_whole,
)
from ..job.toml import TABLES, UNITS, read_kept_job, with_line
from ..job.write import empty_lists, job_lines, word_of
from .curves import MOST_THINGS, TextBlock, curve_lines, note_lines, read_curves, read_notes
from .depths import depth_lines, read_depths
from .extras import NOTHING_BESIDE, ProjectExtras, beside_lines, read_beside
from .source import read_source, source_lines

SUFFIX = ".hito"
FORMAT, VERSION = "hitofude", 1
"""What a project file says of itself; a later version has what this program cannot read."""
MOST_BYTES = 64 * 2**20
"""Of a project that is read."""
MOST_HEAD = 8 * 2**20
"""Letters of all but curves and notes; the reader of TOML takes its time over a text that is made to be slow."""

UPGRADES: Mapping[int, Callable[[dict[str, Any]], dict[str, Any]]] = {}
"""By version: what makes of a file's tables those of the next version."""

_HEADER = (
    "# A project of Hitofude: a drawing and the job that is cut from it. resources/docs/project.md explains every key."
)
_OWN = (
    "format",
    "version",
    "part",
    "layer",
    "view",
    "underlay",
    "text",
    "source",
    "told_depth",
    "names",
    "commands",
    "curves",
    "notes",
)
_REMEDY = "mend the file, or open its backup, the file of the same name with ~ behind it"


@dataclass(frozen=True, slots=True)
class SavedView:
    """How a drawing was looked at.

    Attributes:
        shown: which view was at the front, by its name, or "".
        centre: what was in the middle, mm; None where nobody looked. scale: px per mm, > 0.
    """

    shown: str = ""
    centre: Point | None = None
    scale: float = 5.0


@dataclass(frozen=True)
class Project:
    """What a project file holds."""

    state: HistoryState
    look: SavedView = SavedView()
    beside: ProjectExtras = NOTHING_BESIDE

    def from_folder(self, folder: Path) -> Project:
        """Return it with the paths of other files as they are seen from elsewhere, where they are told from this
        folder.
        """
        source = self.state.source
        state = self.state if source is None else replace(self.state, source=source.from_folder(folder))
        return replace(self, state=state, beside=self.beside.from_folder(folder))

    def in_folder(self, folder: Path) -> Project:
        """Return it with the paths of other files told from this folder, where they lie in that."""
        source = self.state.source
        state = self.state if source is None else replace(self.state, source=source.in_folder(folder))
        return replace(self, state=state, beside=self.beside.in_folder(folder))


def write_project(project: Project) -> bytes:
    """Return the bytes of a project file, from which `read_project` makes the same project."""
    return ("\n".join(_lines(project)) + "\n").encode("utf-8", "replace")


def read_project(name: str, data: bytes) -> Project:
    """Return what a project file holds.

    Args:
        name: shown in errors.
        data: the whole file.

    Raises:
        InputError: it is none, is damaged, too large or of a newer version; with the line where that is known.
    """
    text, tree = _tree(name, data)
    lines = JobText(name, tuple(text.split("\n")))
    for key in tree:
        if key not in (*_OWN, *TABLES):
            raise InputError(f"{name}:{lines.line('', 0, key)}: {key} is no part of a project file; {_REMEDY}.")
    job = read_kept_job(lines, {key: tree[key] for key in TABLES if key in tree})
    part, layer, last = _part(name, text, lines, tree)
    names = {key: _value(name, key, value) for key, value in _table(tree, lines, "names").items()}
    commands = {key: _command(name, key, value) for key, value in _table(tree, lines, "commands").items()}
    beside = read_beside(lines, {path: _table(tree, lines, path) for path in ("underlay", "text")})
    source = read_source(lines, _table(tree, lines, "source"))
    part = part if source is None else replace(part, reading=source.reading.how)
    return Project(
        HistoryState(replace(job, part=part), layer, last, names, commands, RecordedLine(part), source),
        _look(tree, lines),
        beside,
    )


def project_drawing(data: bytes, name: str, units: Units | None = None, layers: tuple[str, ...] = ()) -> Drawing:
    """Return the drawing of a project file; arguments and errors as for `read_drawing`."""
    part = replace(read_project(name, data).state.job.part, name=PurePath(name).stem)
    chosen = on_layers(part, layers, name)
    return Drawing(chosen, (*other_units(units, part.units), *switched_off(chosen, layers)))


def check_size(name: str, data: bytes) -> None:
    """Refuse the bytes of a project file that are too many to be read.

    Raises:
        InputError: they are.
    """
    if len(data) > MOST_BYTES:
        raise InputError(
            f"{name}: the project has {len(data) / 2**20:.0f} MB; at most {MOST_BYTES >> 20} are read. Part the "
            "drawing."
        )
    blocks = sum(len(found[0]) for found in re.finditer(rb"(?m)^lines = '''\r?\n[^']*'''\r?$", data))
    if len(data) - blocks > MOST_HEAD:
        raise InputError(
            f"{name}: beside its curves the project has {(len(data) - blocks) >> 20} MB; at most {MOST_HEAD >> 20} are "
            "read."
        )


def _tree(name: str, data: bytes) -> tuple[str, dict[str, Any]]:
    """Return the text and its tables, of the newest version."""
    check_size(name, data)
    try:
        text = data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputError(f"{name}:{line}: this is no text in UTF-8; {_REMEDY}.") from error
    try:
        tree = parsed(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{name}:{with_line(brief(str(error)), text)}; the file is damaged: {_REMEDY}.") from error
    if tree.get("format") != FORMAT:
        raise InputError(f'{name}: this is no project of Hitofude, for it does not say format = "{FORMAT}"; {_REMEDY}.')
    return text, _newest(name, tree)


def _newest(name: str, tree: dict[str, Any]) -> dict[str, Any]:
    version = tree.get("version")
    if type(version) is not int or version < 1:
        raise InputError(f"{name}: version is {shown(version)}; it is a whole number from 1 on; {_REMEDY}.")
    if version > VERSION:
        raise InputError(
            f"{name}: the file is of version {version}, and this Hitofude reads up to version {VERSION}; "
            "open it with a newer one. The file stays as it is."
        )
    for each in range(version, VERSION):
        tree = UPGRADES[each](tree)
    return tree


def _table(tree: dict[str, Any], lines: JobText, path: str) -> dict[str, Any]:
    values = tree.get(path, {})
    if not isinstance(values, dict):
        raise InputError(
            f"{lines.name}:{lines.line('', 0, path)}: {path} is a table; write [{path}] and its keys below."
        )
    return values


class _DrawnPart(NamedTuple):
    """The drawing, the layer that is drawn on, and the point that was given last."""

    part: Part
    layer: str
    last: Point


def _part(name: str, text: str, lines: JobText, tree: dict[str, Any]) -> _DrawnPart:
    """Return the drawing."""
    table = JobTable(lines, "part", 0, dict(_table(tree, lines, "part")))
    table.take("name", read_text)
    table.take("units", lambda value: one_of(read_text(value), UNITS, "unit"))
    table.take("used_id", read_whole)
    table.take("layer", read_text)
    table.take("last", lambda value: read_points([value])[0])
    table.done("name, units, used_id, layer, last")
    layers = tuple(_layers(tree, lines)) or Part().layers
    entities = read_curves(_block(name, text, lines, tree, "curves"))
    notes = read_notes(_block(name, text, lines, tree, "notes"))
    known, ids = {layer.name for layer in layers}, {entity.id for entity in entities}
    things: tuple[Entity | Note, ...] = (*entities, *notes)
    for thing in things:
        if thing.layer not in known:
            raise InputError(
                f"{name}: curve {thing.id} lies on the layer {thing.layer}, which is in no [[layer]]; {_REMEDY}."
            )
    if len(ids) + len(notes) > MOST_THINGS or not ids.isdisjoint(note.id for note in notes):
        raise InputError(
            f"{name}: a note has the number of a curve, or there are more than {MOST_THINGS} of both; {_REMEDY}."
        )
    said = table.taken
    part = Part(
        entities, layers, said.get("units", Units.MM), said.get("name", Part.name), said.get("used_id", 0), notes
    )
    highest = max((thing.id for thing in things), default=0)
    part = replace(part, used_id=max(part.used_id, highest)) if part.used_id else part
    part = replace(part, depths=read_depths(lines, tree.get("told_depth", [])))
    return _DrawnPart(part, said.get("layer", layers[0].name), said.get("last", (0.0, 0.0)))


def _layers(tree: dict[str, Any], lines: JobText) -> Iterator[Layer]:
    given = tree.get("layer", [])
    if not isinstance(given, list) or not all(isinstance(each, dict) for each in given):
        raise InputError(
            f"{lines.name}:{lines.line('', 0, 'layer')}: layer is a list of tables; write [[layer]] before each."
        )
    for index, each in enumerate(given):
        table = JobTable(lines, "layer", index, dict(each))
        table.take("name", read_text)
        table.take("colour", read_text)
        table.take("visible", read_flag)
        table.take("locked", read_flag)
        table.done("name, colour, visible, locked")
        if not re.fullmatch(r"(#[0-9a-fA-F]{6})?", table.taken.get("colour", "")):
            raise table.error("colour", "is no colour; write #rrggbb, or nothing for the ink of the theme")
        if any(each.get("name", "0") == before.get("name", "0") for before in given[:index]):
            raise table.error("name", "is that of another layer too; give each its own")
        yield Layer(**table.taken)


def _block(name: str, text: str, lines: JobText, tree: dict[str, Any], path: str) -> TextBlock:
    """Return the lines of curves or notes, and where in the file they begin."""
    table = JobTable(lines, path, 0, dict(_table(tree, lines, path)))
    table.take("lines", read_text)
    table.done("lines")
    before = text.find(f"[{path}]\nlines = '''\n")
    return TextBlock(name, text.count("\n", 0, max(before, 0)) + 3, table.taken.get("lines", ""))


def _value(file: str, name: str, value: Any) -> Value:
    """Return what a name stands for: a number, a length such as "25.4mm", a point as a list of two, curves such as "4
    7-9".
    """
    try:
        if isinstance(value, str) and value.endswith("mm"):
            return Length(read_number(float(value.removesuffix("mm"))))
        if isinstance(value, str):
            return Curves(tuple(_numbers(value)))
        return read_points([value])[0] if isinstance(value, list) else read_number(value)
    except (InputError, ValueError) as error:
        raise InputError(
            f"{file}: {name} in [names] is {str(value)[:60]!r}: no number, point, or numbers of curves; {_REMEDY}."
        ) from error


def _numbers(text: str) -> Iterator[int]:
    count = 0
    for run in text.split():
        first, _, last = run.partition("-")
        count += int(last or first) - int(first) + 1
        if count > MOST_THINGS:
            raise ValueError("too many")
        yield from range(int(first), int(last or first) + 1)


def _command(file: str, name: str, value: Any) -> CommandDefinition:
    """Return the command of the user's own that lines define."""
    try:
        statements = read_script("\n".join(read_texts(value)))
    except InputError as error:
        raise InputError(f"{file}: {name} in [commands] cannot be read: {error} {_REMEDY}.") from error
    if (
        len(statements) != 1
        or not isinstance(statements[0], CommandDefinition)
        or statements[0].name.text.lower() != name
    ):
        raise InputError(f"{file}: {name} in [commands] is not one define of that name; {_REMEDY}.")
    return statements[0]


def _look(tree: dict[str, Any], lines: JobText) -> SavedView:
    table = JobTable(lines, "view", 0, dict(_table(tree, lines, "view")))
    table.take("shown", read_text)
    table.take("centre", lambda value: read_points([value])[0])
    table.take("scale", read_number)
    table.done("shown, centre, scale")
    if not 1e-9 < table.taken.get("scale", 1.0) < 1e9:
        raise table.error("scale", "is out of range; it is px per mm")
    return SavedView(**table.taken)


def _lines(project: Project) -> Iterator[str]:
    state, part = project.state, project.state.job.part
    yield _HEADER
    yield f'format = "{FORMAT}"'
    yield f"version = {VERSION}"
    yield from empty_lists(state.job)
    yield from (
        "",
        "[part]",
        f"name = {spelled(part.name)}",
        f"units = {spelled(word_of(UNITS, part.units))}",
        f"used_id = {part.used_id}",
        f"layer = {spelled(state.layer)}",
        f"last = {spelled(state.last)}",
    )
    for layer in part.layers:
        yield from (
            "",
            "[[layer]]",
            f"name = {spelled(layer.name)}",
            f"colour = {spelled(layer.colour)}",
            f"visible = {spelled(layer.visible)}",
            f"locked = {spelled(layer.locked)}",
        )
    yield from _look_lines(project.look)
    yield from beside_lines(project.beside)
    yield from source_lines(state.source, part)
    yield from depth_lines(part.depths)
    yield from _name_lines(state)
    yield from job_lines(state.job)
    for title, things in (("curves", curve_lines(part.entities)), ("notes", note_lines(part.notes))):
        yield from ("", f"[{title}]", "lines = '''", *things, "'''")


def _look_lines(look: SavedView) -> Iterator[str]:
    yield from ("", "[view]", f"shown = {spelled(look.shown)}", f"scale = {spelled(look.scale)}")
    if look.centre is not None:
        yield f"centre = {spelled(look.centre)}"


def _name_lines(state: HistoryState) -> Iterator[str]:
    if state.names:
        yield from ("", "[names]")
    for name, value in state.names.items():
        said = (
            " ".join(_runs(value.ids))
            if isinstance(value, Curves)
            else f"{value!r}mm"
            if isinstance(value, Length)
            else value
        )
        yield f"{_key(name)} = {spelled(said)}"
    if state.commands:
        yield from ("", "[commands]")
    for name, command in state.commands.items():
        yield f"{_key(name)} = ["
        yield from (f"    {spelled(line)}," for line in command.source.splitlines())
        yield "]"


def _runs(ids: tuple[int, ...]) -> Iterator[str]:
    """Yield numbers in their order, neighbours as runs."""
    at = 0
    while at < len(ids):
        end = at
        while end + 1 < len(ids) and ids[end + 1] == ids[end] + 1:
            end += 1
        yield f"{ids[at]}" if end == at else f"{ids[at]}-{ids[end]}"
        at = end + 1


def _key(name: str) -> str:
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else spelled(name)
