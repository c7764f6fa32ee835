"""Files appear whole or not at all, several together; and are read whole, if they are files.

What waits to take a file's place is called .NAME.OWNER.RANDOM.part, and what was there before the same with .old, where
OWNER is the process and the machine that it runs on: what a killed one has left is known by it, and swept.
"""

from __future__ import annotations

import errno
import hashlib
import os
import platform
import re
import shutil
import stat
import tempfile
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from types import MappingProxyType

from .errors import InputError

MOST_BYTES = 256 * 2**20
"""A larger file is none that anybody means to open."""


def read_whole(path: Path) -> bytes:
    """Return a file's bytes.

    Raises:
        OSError: it cannot be read, is larger than `MOST_BYTES`, or is a pipe, which may wait for ever, or a device,
            which may never end; its `strerror` goes on after "cannot be read: ".
    """
    status = path.stat()
    if not stat.S_ISREG(status.st_mode) and not stat.S_ISDIR(status.st_mode):
        raise OSError(errno.EINVAL, "it is a pipe or a device and no file; copy what it gives into one", str(path))
    with path.open("rb") as file:
        data = file.read(MOST_BYTES + 1)
    if len(data) > MOST_BYTES:
        raise OSError(errno.EFBIG, f"it is larger than {MOST_BYTES >> 20} MB; part it", str(path))
    return data


def write_atomically(path: Path, data: bytes, backup: Path | None = None) -> None:
    """Write a file so that a reader sees the old content or the new one, never a part.

    The bytes go to a temporary file in the same folder, are forced to the disk, and take the old file's place in one
    step; its permissions stay. A link is followed. A device or a pipe is written straight, as it cannot be replaced.

    Args:
        path: of the file.
        data: its bytes.
        backup: where the old content is kept, once the new one is safe on the disk; None: nowhere.

    Raises:
        InputError: the file cannot be written; what was there before is untouched.
    """
    write_together({path: data}, {} if backup is None else {path: backup})


def sweep(*folders: Path) -> None:
    """Take away what writers that live no more have left in folders; what cannot be looked at or taken away stays.

    Of one on another machine, or from before names told the writer, nobody knows whether it lives: it goes when it is a
    day old. A folder goes with all that is in it, if its name tells the writer.
    """
    for folder in folders:
        with suppress(OSError), os.scandir(folder) as found:
            for entry in found:
                with suppress(OSError):
                    _sweep_one(entry)


def _sweep_one(entry: os.DirEntry[str]) -> None:
    left = _LEFT.fullmatch(entry.name)
    owner = None if left is None else left["owner"]
    if left is None or not _is_abandoned(owner, entry.stat(follow_symlinks=False).st_mtime):
        return
    if entry.is_file(follow_symlinks=False):
        os.unlink(entry.path)
    elif owner is not None and entry.is_dir(follow_symlinks=False):
        shutil.rmtree(entry.path, ignore_errors=True)


_LEFT = re.compile(r"\..+?(?:\.(?P<owner>[0-9]+-[0-9a-f]{6}))?\.[a-z0-9_]{8}\.part(?:\.old)?")
_ABANDONED_S = 86_400.0
"""A part of a file that nobody has written to for a day was left by a process that died."""


def _is_abandoned(owner: str | None, changed: float) -> bool:
    number, _, machine = (owner or "").partition("-")
    if machine != _machine() or os.name != "posix":
        return time.time() - changed > _ABANDONED_S
    try:
        os.kill(int(number), 0)
    except ProcessLookupError:
        return True
    except (OSError, OverflowError):
        return False
    return False


def _machine() -> str:
    """Return a short name for this machine."""
    return hashlib.sha256(platform.node().encode()).hexdigest()[:6]


def waiting_prefix(name: str) -> str:
    """Return what the name of a file or a folder begins with that waits to take another's place; it ends in .part."""
    return f".{name[:32]}.{os.getpid()}-{_machine()}."


def _keep_copy(path: Path, copy: Path) -> None:
    """Let a file's content stand under a second name too, in the place of what stood there; the file itself stays
    untouched.

    Raises:
        InputError: it cannot be; what was under the second name is untouched.
    """
    with _told(copy):
        handle, waiting = tempfile.mkstemp(prefix=waiting_prefix(copy.name), suffix=".part", dir=copy.parent)
        os.close(handle)
        try:
            os.unlink(waiting)
            try:
                os.link(os.path.realpath(path), waiting)
            except OSError:  # not every file system has two names for one file
                shutil.copy2(path, waiting)
            os.replace(waiting, copy)
        finally:
            with suppress(OSError):
                os.unlink(waiting)


def _flush(folder: Path) -> None:
    """Force a folder's names to the disk, where the system lets one do that."""
    with suppress(OSError):
        handle = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(handle)
        finally:
            os.close(handle)


def write_together(files: Mapping[Path, bytes], backups: Mapping[Path, Path] = MappingProxyType({})) -> None:
    """Write files as `write_atomically` does, all or none: where one cannot be written, all are as they were before.

    Args:
        files: bytes by path.
        backups: by path, where what was there is kept; of files that are there.

    Raises:
        InputError: naming the first file that cannot be written.
    """
    staged: list[_Staged] = []
    try:
        for path, data in files.items():
            with _told(path):
                target = Path(os.path.realpath(path))
                if target.is_dir():
                    raise IsADirectoryError("it is a folder; name a file in it")
                if path.exists() and not path.is_file():  # /dev/stdout leads to a pipe, whose own name leads nowhere
                    path.write_bytes(data)
                else:
                    staged.append(_Staged(path, target, data))
        for each in staged:
            if each.path in backups and each.existed:
                _keep_copy(each.path, backups[each.path])
        for each in staged:
            with _told(each.path):
                each.take_place()
        for folder in {each.folder for each in staged}:
            _flush(folder)
    except BaseException:
        for each in reversed(staged):
            each.put_back()
        raise
    finally:
        for each in staged:
            each.clean()


@contextmanager
def _told(path: Path) -> Iterator[None]:
    """Turn what the system says into a sentence that names the file."""
    try:
        yield
    except OSError as error:
        raise InputError(f"Cannot write {path}: {error.strerror or error}.") from error


class _Staged:
    """New content that waits beside its file to take its place, and the old content until all is well."""

    def __init__(self, path: Path, target: Path, data: bytes) -> None:
        """Write the new content beside the file.

        Raises:
            OSError: it cannot be written; nothing is left behind.
        """
        self.path, self._target, self.folder = path, target, target.parent
        self._old = ""
        self._placed, self.existed = False, target.exists()
        mode = stat.S_IMODE(target.stat().st_mode) if target.exists() else 0o666 & ~_umask()
        handle, self._new = tempfile.mkstemp(prefix=waiting_prefix(target.name), suffix=".part", dir=target.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
                file.flush()
                os.fsync(file.fileno())
            os.chmod(self._new, mode)
        except BaseException:
            self.clean()
            raise

    def take_place(self) -> None:
        """Replace the file in one step; keep the old one under another name, where the file system can."""
        if self.existed:
            old = f"{self._new}.old"
            with suppress(OSError):
                os.link(self._target, old)
                self._old = old
        os.replace(self._new, self._target)
        self._placed = True

    def put_back(self) -> None:
        """Make the file what it was before."""
        if self._placed and self._old:
            os.replace(self._old, self._target)
        elif self._placed and not self.existed:
            os.unlink(self._target)

    def clean(self) -> None:
        """Take away what is left of both."""
        for name in (self._new, self._old):
            with suppress(OSError):
                os.unlink(name)


def _umask() -> int:
    mask = os.umask(0o022)
    os.umask(mask)
    return mask
