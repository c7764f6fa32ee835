"""What of a batch is to be done: its parts, with options of their own, but for those that are done already."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING

from .. import __version__
from ..core.digest import content_digest
from ..core.errors import HitofudeError, InputError
from ..core.input_file import read_input
from ..core.settings import config_folder
from ..usecases.batch.table import Files, results_csv, results_html
from ..usecases.batch.task import BatchExtras, BatchKind, BatchRow, BatchTask, BatchVerdict
from ..usecases.pixels.options import is_picture
from .batch_list import ListedPart, listed_parts, named_outputs
from .batch_options import kind_of
from .batch_store import BatchStore, Table
from .files import identity
from .program import load_command

if TYPE_CHECKING:
    from ..usecases.batch.task import PartOptions


@dataclass(frozen=True)
class PlannedPart:
    """A part that is to be done.

    Attributes:
        place: in the table.
        key: of its content, options and the program's version.
        task: what is done.
    """

    place: int
    key: str
    task: BatchTask


@dataclass(frozen=True)
class PlannedBatch:
    """A batch that is ready to begin.

    Attributes:
        table: makes the files of its table.
        store: its folder.
        rows: of the table, one a part: of those that are done, and open ones. outputs: of their programs.
        pending: parts that are to be done.
    """

    table: Table
    store: BatchStore
    rows: list[BatchRow]
    outputs: tuple[str, ...]
    pending: tuple[PlannedPart, ...]


def planned(arguments: argparse.Namespace) -> PlannedBatch:
    """Return what is to be done; options are read, and the folder is there and ours until its store is closed.

    Raises:
        HitofudeError: there is no part, or an option or the folder cannot be used.
    """
    kind = kind_of(arguments)
    parts = listed_parts(arguments.parts, arguments.output, kind)
    image, sheet = (f".{suffix}" if suffix else "" for suffix in (arguments.images, arguments.sheets))
    extras = BatchExtras(arguments.reports, image, sheet, arguments.language)
    title = f"{arguments.parts.resolve().name}: {kind.value}"

    def table(rows: Sequence[BatchRow], files: Files) -> dict[str, bytes]:
        return {"results.csv": results_csv(rows, files), "results.html": results_html(rows, files, title)}

    return planned_parts(arguments, kind, parts, extras, table)


def planned_parts(
    arguments: argparse.Namespace, kind: BatchKind, parts: Sequence[ListedPart], extras: BatchExtras, table: Table
) -> PlannedBatch:
    """Return what of some parts is to be done.

    Args:
        extras: what else is written of each. table: what is told of all.

    Raises:
        HitofudeError: an option or the folder cannot be used.
    """
    outputs = named_outputs(parts)
    _ensure_apart(parts, [arguments.output / each for each in outputs])
    passed = tuple(arguments.passed or ())
    options = [_options_of(kind, (*passed, *part.options), is_picture(part.path.name)) for part in parts]
    unread = [
        BatchTask(part.name, b"", kind, own, output, extras, file=part.path.name)
        for part, output, own in zip(parts, outputs, options, strict=True)
    ]
    store = BatchStore(arguments.output)
    try:
        rows, pending = _compared(store, [part.path for part in parts], unread, arguments.again)
    except BaseException:
        store.close()
        raise
    return PlannedBatch(table, store, rows, tuple(outputs), pending)


def _compared(
    store: BatchStore, paths: Sequence[Path], unread: Sequence[BatchTask], again: bool
) -> tuple[list[BatchRow], tuple[PlannedPart, ...]]:
    """Return a row for each part, and the parts that are not done yet.

    Args:
        paths: of the parts. unread: tasks without their files' bytes. again: do all, whatever is done.
    """
    rows, pending = [], []
    for place, (path, each) in enumerate(zip(paths, unread, strict=True)):
        row = BatchRow(each.name, BatchVerdict.OPEN)
        try:
            task = replace(each, data=read_input(path))
        except HitofudeError as error:
            row = BatchRow(each.name, BatchVerdict.REFUSED, findings=(str(error),), counting=1)
        else:
            key = content_digest(__version__, task, _own_posts())
            known = None if again else store.known(each.output, key)
            row = known or row
            pending += [] if known else [PlannedPart(place, key, task)]
        rows.append(row)
    return rows, tuple(pending)


@cache
def _options_of(kind: BatchKind, words: tuple[str, ...], picture: bool) -> PartOptions:
    """Return the options of a command, its files read.

    Raises:
        HitofudeError: one is none, or cannot be used.
    """
    command = load_command(kind.value)
    name = "part.png" if picture else "part.dxf" if kind is BatchKind.MAKE else "part.ngc"
    output = () if kind is BatchKind.CHECK else ("-o", "out.ngc")
    arguments = command.arguments([name, *output, *words])
    if kind is BatchKind.MAKE:
        from .make_options import read_make_options

        return read_make_options(arguments)
    if kind is BatchKind.CHECK:
        from .check_options import examine_options

        return examine_options(arguments)
    from .smooth_options import smooth_options

    return smooth_options(arguments)


@cache
def _own_posts() -> tuple[tuple[str, bytes], ...]:
    """Return the user's own posts: what is written depends on them, whoever names one."""
    folder = config_folder() / "posts"
    return tuple((path.name, path.read_bytes()) for path in sorted(folder.glob("*.toml"))) if folder.is_dir() else ()


def _ensure_apart(parts: Sequence[ListedPart], outputs: Sequence[Path]) -> None:
    """Refuse to write over a part."""
    inputs = {identity(part.path): part.path for part in parts}
    for path in outputs:
        if (own := inputs.get(identity(path))) is not None:
            raise InputError(f"--output: {own} is a part, and would be written over; choose another folder")
