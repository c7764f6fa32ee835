"""A file that somebody has named, read whole."""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from .atomic import read_whole
from .errors import InputError


def read_input(path: Path) -> bytes:
    """Return a file's bytes.

    Raises:
        InputError: it is missing, no file, unreadable, empty or too large.
    """
    try:
        if path.is_dir():
            raise InputError(f"{path} is a folder; name a file in it")
        data = read_whole(path)
    except FileNotFoundError as error:
        raise InputError(f"{path} does not exist; check the name") from error
    except (OSError, ValueError) as error:
        raise InputError(
            f"{path} cannot be read: {getattr(error, 'strerror', None) or error}; name another file"
        ) from error
    if not data:
        raise InputError(f"{path} is empty; export it again")
    return data


# A file as it was read.


class FileBytes(NamedTuple):
    """A file.

    Attributes:
        name: for errors; its suffix tells the format.
        data: its bytes.
    """

    name: str
    data: bytes
