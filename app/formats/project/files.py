"""Project files on the disk: written whole, with the version before kept, and never over what another program has made
of them.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import NamedTuple

from ...core.atomic import read_whole, write_atomically
from ...core.errors import InputError
from .project import MOST_BYTES, Project, check_size, read_project, write_project

Stamp = tuple[int, int, int]
"""What tells that a file is as it was: when it was changed, ns; its bytes; its number on the disk."""


class ChangedElsewhere(InputError):
    """The file is not the one that was read."""


def stamp_of(path: Path) -> Stamp | None:
    """Return the stamp of a file; None where there is none."""
    try:
        status = os.stat(path)
    except OSError:
        return None
    return (status.st_mtime_ns, status.st_size, status.st_ino)


def backup_of(path: Path) -> Path:
    """Return where the version before is kept."""
    return path.with_name(f"{path.name}~")


class LoadedProject(NamedTuple):
    """What a project file holds, and its stamp; None where it has none."""

    project: Project
    stamp: Stamp | None


def load_project(path: Path) -> LoadedProject:
    """Return what a project file holds, and its stamp.

    Raises:
        InputError: it cannot be read.
    """
    stamp = stamp_of(path)
    if stamp is not None and stamp[1] > MOST_BYTES:
        raise InputError(
            f"{path.name}: the file has {stamp[1] >> 20} MB; at most {MOST_BYTES >> 20} are read. Part the drawing."
        )
    try:
        data = read_whole(path)
    except OSError as error:
        raise InputError(f"Cannot read {path}: {error.strerror}. Choose another file.") from error
    return LoadedProject(read_project(path.name, data).from_folder(path.parent), stamp)


def save_project(path: Path, project: Project, known: Stamp | None = None, backup: bool = True) -> Stamp:
    """Write a project file whole or not at all, and return its stamp.

    Args:
        path: of the file.
        project: what it will hold.
        known: the stamp that the file must still have; None: whatever is there is replaced.
        backup: what was there stays, as `backup_of` names it.

    Raises:
        ChangedElsewhere: the file has changed since it had that stamp; nothing was written.
        InputError: it cannot be written; what was there is untouched.
    """
    data = write_project(project.in_folder(path.parent))
    there = stamp_of(path)
    if known is not None and there is not None and there != known:
        raise ChangedElsewhere(f"{path.name} was changed by another program since it was opened or saved here.")
    check_size(path.name, data)
    write_atomically(path, data, backup_of(path) if backup else None)
    stamp = stamp_of(path)
    assert stamp is not None
    return stamp
