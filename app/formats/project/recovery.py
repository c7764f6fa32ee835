"""Recovery files: what is drawn and in no file yet, kept for the next start should this one end in a crash.

Each window has a file of its own in the folder of the program's state, and holds a lock beside it as long as it lives;
the system lets go of the lock when the process ends, however it does. A recovery file is a project file whose first
line, a remark, tells of the file that was being edited.
"""

from __future__ import annotations

import json
import uuid
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from ...core.atomic import write_atomically
from ...core.errors import InputError
from ...core.file_lock import FileLock
from ...core.settings import state_folder
from .files import Stamp
from .project import Project, read_project, write_project

_NOTE = "# recovery of "
_DAMAGED = ".damaged"


@dataclass(frozen=True)
class EditedFile:
    """The file that was being edited.

    Attributes:
        path: None where the drawing was in no file yet.
        stamp: of the file as it was read or saved last.
    """

    path: Path | None = None
    stamp: Stamp | None = None


class RecoveryFile:
    """The recovery file of one window."""

    def __init__(self) -> None:
        """Begin with a lock, and no file.

        Raises:
            InputError: the folder of the state cannot be written.
        """
        folder = state_folder()
        self.path = folder / f"{uuid.uuid4().hex}.hito"
        self._lock = FileLock(self.path.with_suffix(".lock"))
        try:
            folder.mkdir(parents=True, exist_ok=True)
            self._lock.take()
        except OSError as error:
            raise InputError(f"No recovery files can be kept in {folder}: {error.strerror}.") from error

    def keep(self, project: Project, edited: EditedFile) -> None:
        """Write what is drawn.

        Raises:
            InputError: it cannot be written.
        """
        note = json.dumps([str(edited.path) if edited.path else None, edited.stamp])
        write_atomically(self.path, f"{_NOTE}{note}\n".encode() + write_project(project))

    def forget(self) -> None:
        """Take the file away: what is drawn lies in a file of the user's, or he has given it up."""
        with suppress(OSError):
            self.path.unlink()

    def close(self) -> None:
        """Take file and lock away."""
        self.forget()
        self._lock.let_go()


class RecoveredWork:
    """What a window that has crashed has left.

    Attributes:
        path: of the recovery file. when: it was written, s since 1970.
    """

    def __init__(self, path: Path, lock: FileLock) -> None:
        """Begin with a file whose lock is held."""
        self.path, self._lock = path, lock
        self.when = path.stat().st_mtime

    def edited(self) -> EditedFile:
        """Return which file was being edited; none where the first line does not tell."""
        with suppress(OSError, ValueError, TypeError):
            with self.path.open(encoding="utf-8") as file:
                first = file.readline(10_000)
            path, stamp = json.loads(first.removeprefix(_NOTE))
            return EditedFile(Path(path) if path else None, (stamp[0], stamp[1], stamp[2]) if stamp else None)
        return EditedFile()

    def load(self) -> Project:
        """Return what was drawn.

        Raises:
            InputError: the file is damaged.
        """
        try:
            return read_project(self.path.name, self.path.read_bytes())
        except OSError as error:
            raise InputError(f"The recovery file {self.path} cannot be read: {error.strerror}.") from error

    def discard(self) -> None:
        """Take the file away for good."""
        with suppress(OSError):
            self.path.unlink()
        self._lock.let_go()

    def set_aside(self) -> Path:
        """Rename a damaged file so that it is not offered again; return its new name."""
        aside = self.path.with_suffix(_DAMAGED)
        with suppress(OSError):
            self.path.replace(aside)
        self._lock.let_go()
        return aside

    def leave(self) -> None:
        """Leave it for the next start."""
        self._lock.let_go()


def recoveries() -> tuple[RecoveredWork, ...]:
    """Return what windows that are no longer there have left, the latest first; nobody else offers it meanwhile."""
    return tuple(sorted(_recoveries(), key=lambda each: each.when, reverse=True))


def _recoveries() -> Iterator[RecoveredWork]:
    with suppress(OSError):
        for name in sorted({path.stem for path in state_folder().iterdir() if path.suffix in (".hito", ".lock")}):
            path = state_folder() / f"{name}.hito"
            lock = FileLock(path.with_suffix(".lock"))
            if not lock.take():
                continue
            if path.is_file():
                yield RecoveredWork(path, lock)
            else:
                lock.let_go()
