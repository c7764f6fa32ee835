"""The folder that keeps machine code from start to start: only what this user wrote is read, and what is damaged is
thrown away.

An entry is one file: a check sum, then a pickle. Unpickling runs code, so an entry counts only in a folder, and as a
file, that belongs to this user and that nobody else may write. A program that was packed with its machine code has it
beside its own code, and is read there as it is, where the same hands as the code's alone may write.
"""

from __future__ import annotations

import atexit
import hashlib
import os
import shutil
import stat
import sys
import tempfile
import time
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path

import platformdirs

UNUSED_DAYS = 30
"""What no start has asked for in so many days is removed: the leftovers of older versions."""

FOLDER_VARIABLE = "HITOFUDE_KERNELS"
"""Names the folder for the processes that compile for another one."""

_MAGIC = b"hitofude kernel 1\n"
_DAY_S = 86400.0
"""A day, s."""
_STALE_PART_S = 3600.0  # no entry takes an hour to write, so its writer was killed
_OTHERS_MAY_WRITE = stat.S_IWGRP | stat.S_IWOTH


_SHIPPED = Path(__file__).resolve().parents[2] / "kernels"
"""What came with the program, where it was packed with it."""


class Store:
    """Entries by name, in one folder or, where nothing can be written, nowhere; and those that came with the program.

    Attributes:
        folder: where they are; None: nothing is kept.
        shipped: folders of what came with the program, the best first, which are read and never changed.
    """

    def __init__(self, folder: Path | None, kept: bool = True, shipped: tuple[Path, ...] = ()) -> None:
        self.folder, self.shipped = folder, shipped
        self._useless: set[str] = set()  # of what came with the program
        self._silent = False
        if folder is None:
            self._say("no folder for it can be written")
        elif not kept:
            self._say(f"{folder.parent} lasts only as long as this run")

    def path(self, name: str) -> Path | None:
        """Return where an entry is or would be."""
        return None if self.folder is None else self.folder / name

    def has(self, name: str) -> bool:
        """Return whether there is an entry; it may turn out to be damaged."""
        path = self.path(name)
        return (path is not None and path.exists()) or any(other.exists() for other in self._shipped(name))

    def read(self, name: str) -> bytes | None:
        """Return an entry's content, or None where there is none that is whole; a damaged one is removed."""
        own = self.path(name)
        if own is not None and (data := _read(own, _is_own)) is not None:
            if (content := _content(name, data)) is not None:
                return content
            _remove(own)
        for path in self._shipped(name):
            data = _read(path, _is_as_safe_as_the_code)
            content = None if data is None else _content(name, data)
            if content is not None:
                return content
        return None

    def _shipped(self, name: str) -> tuple[Path, ...]:
        return () if name in self._useless else tuple(folder / name for folder in self.shipped)

    def drop(self, name: str) -> None:
        """Remove an entry that is of no use; one that came with the program is not asked for again."""
        self._useless.add(name)
        path = self.path(name)
        if path is not None:
            _remove(path)

    def write(self, name: str, content: bytes) -> bool:
        """Keep an entry; where that fails say so once and return False."""
        path = self.path(name)
        if path is None:
            return False
        try:
            handle, part = tempfile.mkstemp(prefix=f"{name}.", suffix=".part", dir=path.parent)  # mode 0600
            try:
                with os.fdopen(handle, "wb") as file:
                    file.write(_head(name, content) + content)
                os.replace(part, path)
            except BaseException:
                with suppress(OSError):
                    os.unlink(part)
                raise
        except OSError as error:
            self._say(f"{path.parent}: {error.strerror or error}")
            return False
        return True

    def sweep(self) -> None:
        """Remove what nobody has used for `UNUSED_DAYS`, here and in the folders of other versions, and what killed
        runs left.
        """
        if self.folder is None:
            return
        now = time.time()
        for path in list(self.folder.parent.rglob("*")):
            with suppress(OSError):
                status = path.lstat()
                if not stat.S_ISDIR(status.st_mode):
                    kept_s = _STALE_PART_S if path.suffix == ".part" else UNUSED_DAYS * _DAY_S
                    if now - max(status.st_atime, status.st_mtime) > kept_s:
                        path.unlink()
        for folder in sorted((path for path in self.folder.parent.rglob("*") if path.is_dir()), reverse=True):
            if folder != self.folder:
                with suppress(OSError):
                    folder.rmdir()  # fails, as it should, where something is left in it

    def _say(self, why: str) -> None:
        if not self._silent and sys.stderr is not None:
            print(
                f"hitofude: compiled inner loops cannot be kept ({why}), so every start compiles them anew",
                file=sys.stderr,
            )
        self._silent = True


def _head(name: str, content: bytes) -> bytes:
    """Return what an entry begins with: an entry under another name is of as little use as a damaged one."""
    return _MAGIC + hashlib.sha256(name.encode() + b"\n" + content).digest()


_HEAD_SIZE = len(_head("", b""))


def _content(name: str, data: bytes) -> bytes | None:
    """Return what an entry holds, or None where it is damaged."""
    head, content = data[:_HEAD_SIZE], data[_HEAD_SIZE:]
    return content if head == _head(name, content) else None


def _remove(path: Path) -> None:
    with suppress(OSError):
        path.unlink()


def _read(path: Path, is_safe: Callable[[os.stat_result], bool]) -> bytes | None:
    """Return the bytes of a file, and note that it was used; None where it is not there or not safe."""
    try:
        handle = os.open(path, os.O_RDONLY | getattr(os, "O_NOFOLLOW", 0))
        with os.fdopen(handle, "rb") as file:
            status = os.fstat(handle)
            if not is_safe(status):
                return None
            if time.time() - status.st_mtime > _DAY_S:
                with suppress(OSError):
                    os.utime(path)  # file systems may not note when files are read
            return file.read()
    except OSError:
        return None


def _is_own(status: os.stat_result) -> bool:
    """Tell whether a file is this user's, and nobody else's to write."""
    return not hasattr(os, "geteuid") or (status.st_uid == os.geteuid() and not status.st_mode & _OTHERS_MAY_WRITE)


def _is_as_safe_as_the_code(status: os.stat_result) -> bool:
    """Tell whether nobody may write a file but those who may write the program's code."""
    code = Path(__file__).stat()
    return status.st_uid == code.st_uid and not status.st_mode & _OTHERS_MAY_WRITE & ~code.st_mode


def _own_folder(folder: Path) -> bool:
    """Make a folder of this user's alone, or say whether there is one: no link, not somebody else's, not open to
    others.
    """
    try:
        with suppress(FileExistsError):
            folder.mkdir(mode=0o700)
        status = folder.lstat()
        if not stat.S_ISDIR(status.st_mode) or (hasattr(os, "geteuid") and status.st_uid != os.geteuid()):
            return False
        if status.st_mode & _OTHERS_MAY_WRITE:
            folder.chmod(stat.S_IMODE(status.st_mode) & ~_OTHERS_MAY_WRITE)  # ours, but made with a generous umask
    except OSError:
        return False
    return os.access(folder, os.W_OK | os.X_OK)


def _all_own(base: Path, *names: str) -> Path | None:
    """Return base/names…, every folder of which from `base` on is this user's own, or None."""
    with suppress(OSError):
        base.parent.mkdir(parents=True, exist_ok=True)
    folder = base
    for name in ("", *names):
        folder = folder / name
        if not _own_folder(folder):
            return None
    return folder


def open_store(versions: tuple[str, ...]) -> Store:
    """Return the store of a compiler and a processor, in the first place that is safe and can be written.

    Args:
        versions: of both; then those whose machine code is of use, too, where it came with the program.

    That is the user's cache folder; else one in the temporary folder that is this user's alone; else a fresh one,
    removed when the program ends.
    """
    shipped = _shipped_folders(versions)
    own = f"hitofude-{os.geteuid()}" if hasattr(os, "geteuid") else "hitofude"
    for base in (Path(platformdirs.user_cache_dir("hitofude")), Path(tempfile.gettempdir()) / own):
        folder = _all_own(base, "kernels", versions[0])
        if folder is not None:
            return Store(folder, shipped=shipped)
    try:
        fresh = Path(tempfile.mkdtemp(prefix="hitofude-"))
    except OSError:
        return Store(None, shipped=shipped)
    atexit.register(shutil.rmtree, fresh, ignore_errors=True)
    return Store(_all_own(fresh, "kernels", versions[0]), kept=False, shipped=shipped)


@cache
def store(versions: tuple[str, ...]) -> Store:
    """Return this process's store: the one that the process which started this one names, or see `open_store`."""
    named = os.environ.get(FOLDER_VARIABLE)
    return Store(Path(named), shipped=_shipped_folders(versions)) if named else open_store(versions)


def _shipped_folders(versions: tuple[str, ...]) -> tuple[Path, ...]:
    return tuple(_SHIPPED / version for version in versions)
