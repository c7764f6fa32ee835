"""The formats of drawings: each is registered by its folder, and asked for by the suffix of a file's name.

What a format is, what it takes and what it can write stands in its `DrawingFormat` alone; readers, options, the
window's dialogs and the checks of what was asked walk these.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ..model.job import Job
from ..model.part import Part
from ..model.reading import ReadingOptions
from .drawing import Drawing, WrittenDrawing


@dataclass(frozen=True)
class FormatWriter:
    """One way to write a format.

    Attributes:
        key: its name in the program, such as a version.
        words: its name for people.
        write: returns a part as a file's bytes, and what the format could not hold; it raises GeometryError.
    """

    key: str
    words: str
    write: Callable[[Part], WrittenDrawing]


@dataclass(frozen=True)
class DrawingFormat:
    """A kind of file that holds a drawing.

    Attributes:
        suffixes: of its files, in lower case, with the dot.
        read: returns the drawing in a file's bytes; it takes the file's name, and raises InputError.
        takes: names of those fields of `ReadOptions` that say something of such a file only, beside what holds for all.
        foreign: whether other programs write it, so that its units may be missing or nobody's choice, and it may be
            read again in another way.
        scaled_page: whether other units scale a page, so that only reading it again tells its size, and the reader
            itself tells how it was read.
        job: returns the job that lies in such a file beside the drawing; it raises InputError. None = none does.
        hidden: suffixes that are read and not offered, such as of a backup.
        writers: ways to write it, the usual one first; () = it is written by no export.
    """

    suffixes: tuple[str, ...]
    read: Callable[[str, bytes, ReadingOptions], Drawing]
    takes: frozenset[str] = frozenset()
    foreign: bool = False
    scaled_page: bool = False
    job: Callable[[str, bytes], Job] | None = None
    hidden: tuple[str, ...] = ()
    writers: tuple[FormatWriter, ...] = ()

    def writer(self, key: str) -> FormatWriter:
        """Return the way to write of a key, else the usual one."""
        return next((each for each in self.writers if each.key == key), self.writers[0])


FORMATS: dict[str, DrawingFormat] = {}
"""By suffix, in the order in which they were registered."""


def register(format_: DrawingFormat) -> None:
    """Make a format of drawings known to the command line and the window.

    Raises:
        ValueError: another format has one of its suffixes.
    """
    for suffix in format_.suffixes:
        if FORMATS.setdefault(suffix, format_) is not format_:
            raise ValueError(f"two formats of drawings have the suffix {suffix}")


def withdraw(format_: DrawingFormat) -> None:
    """Forget a format."""
    for suffix in format_.suffixes:
        FORMATS.pop(suffix, None)
