"""A file that one process holds at a time; the system lets go of it when the process ends, however it does."""

from __future__ import annotations

import os
import platform
from contextlib import suppress
from pathlib import Path


class FileLock:
    """A lock that lies in a file, with the process that holds it written into it."""

    def __init__(self, path: Path) -> None:
        """Make a lock that nobody holds yet.

        Args:
            path: of its file, in a folder that is there.
        """
        self.path = path
        self._handle = -1

    def take(self) -> bool:
        """Return whether the lock is ours now.

        Raises:
            OSError: its file cannot be made.
        """
        while True:
            handle = os.open(self.path, os.O_RDWR | os.O_CREAT, 0o600)
            try:
                _lock(handle)
            except OSError:
                os.close(handle)
                return False
            if self._is_there(handle):
                break
            os.close(handle)  # whoever held it has just taken the file away
        self._handle = handle
        os.truncate(handle, 0)
        os.write(handle, f"{os.getpid()} {platform.node()}\n".encode("utf-8", "replace"))
        return True

    def _is_there(self, handle: int) -> bool:
        """Tell whether an open file is still the one of that name."""
        try:
            return os.path.samestat(os.fstat(handle), self.path.stat())
        except OSError:
            return False

    def owner(self) -> str:
        """Return words for the process that holds it."""
        with suppress(OSError):
            pid, _, host = self.path.read_text("utf-8").partition(" ")
            if pid.isdecimal():
                return f"process {pid} of {host.strip()}"
        return "another process"

    def let_go(self) -> None:
        """Take the lock away."""
        if self._handle < 0:
            return
        with suppress(OSError):
            os.unlink(self.path)
        with suppress(OSError):
            os.close(self._handle)
        self._handle = -1


def _lock(handle: int) -> None:
    """Lock an open file for this process, or raise OSError at once."""
    try:
        import fcntl
    except ImportError:
        import msvcrt

        msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)  # type: ignore[attr-defined]
        return
    fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
