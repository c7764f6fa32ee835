"""A file as it was read."""

from __future__ import annotations

from typing import NamedTuple


class FileBytes(NamedTuple):
    """A file.

    Attributes:
        name: for errors; its suffix tells the format.
        data: its bytes.
    """

    name: str
    data: bytes
