"""The files of a command: read whole, checked before any work is done; and how far the work is, on a terminal."""

from __future__ import annotations

import argparse
import os
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..core.atomic import sweep
from ..core.errors import InputError
from ..core.progress import Progress
from ..core.wording import either
from ..formats.sheet import SUFFIXES
from .output import on_terminal, say, show
from .signals import StopFlag

EVERY = 5.0
"""Seconds between lines that tell how far a job is, where they are no terminal's."""


def check_outputs(outputs: Mapping[str, Path], inputs: Sequence[Path]) -> None:
    """Refuse files to write that cannot be, or that are inputs or one another; take away what killed runs have left
    beside them.

    Args:
        outputs: by the name of their option.
        inputs: what is read.

    Raises:
        InputError: naming the option and the file.
    """
    taken = [identity(path) for path in inputs]
    for name, path in outputs.items():
        if path.is_dir():
            raise InputError(f"--{name} {path} is a folder; name a file in it")
        if not path.parent.is_dir():
            raise InputError(f"--{name} {path}: there is no folder {path.parent}; make it first")
        if not os.access(path.parent, os.W_OK) and not path.is_char_device():
            raise InputError(
                f"--{name} {path}: the folder {path.parent} cannot be written; choose another or change its permissions"
            )
        if identity(path) in taken:
            raise InputError(f"--{name} {path} is named twice or is also an input; give every file its own name")
        if not path.is_char_device():
            taken.append(identity(path))
    for folder in {path.parent for path in outputs.values()}:
        sweep(folder)


def named_files(arguments: argparse.Namespace, *options: str) -> dict[str, Path]:
    """Return the files that some options name, by option; those that were not given are not among them."""
    return {option: path for option in options if (path := getattr(arguments, option)) is not None}


def identity(path: Path) -> object:
    """Return what tells whether two names mean the same file."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return os.path.realpath(path)
    return (status.st_dev, status.st_ino)


def sheet_suffix(option: str, path: Path) -> str:
    """Return the suffix of a sheet.

    Raises:
        InputError: it is none of those that sheets have.
    """
    suffix = path.suffix.lower()
    if suffix not in SUFFIXES:
        raise InputError(f"--{option} {path}: a sheet is {either(SUFFIXES)}; change the name")
    return suffix


def shown_progress(quiet: bool, stopped: StopFlag) -> Progress:
    """Return a progress that shows itself on stderr: on a terminal all the time, elsewhere in a line every EVERY
    seconds.

    A line comes as often where the job tells nothing, from a compiled loop for instance; none while the command waits
    for what it has to say itself.
    """
    shown = _ProgressLine(on_terminal(), stopped)

    def told(fraction: float, text: str) -> None:
        stopped.stage = text or stopped.stage
        if not quiet:
            shown.report(fraction, text)

    stopped.tick = None if quiet else shown.tick
    return Progress(told, stopped, remarks=None if quiet else shown.remark)


class _ProgressLine:
    """How far a job is, as its user is told."""

    def __init__(self, alone: bool, stopped: StopFlag) -> None:
        self._alone, self._stopped = alone, stopped
        self._fraction, self._text, self._at = 0.0, "", 0.0 if alone else time.monotonic()

    def report(self, fraction: float, text: str) -> None:
        """Show it, if it is time to."""
        self._fraction, self._text = fraction, text
        if self._is_time() or (self._alone and fraction >= 1):
            self._show()

    def tick(self) -> None:
        """Show once more what was told last, if nothing was shown for so long; a terminal shows it still."""
        if not self._alone and self._text and self._fraction < 1 and self._is_time():
            self._show()

    def remark(self, sentence: str) -> None:
        """Say a sentence in a line of its own, above what a terminal goes on to show."""
        if self._alone:
            show("\r\x1b[K")
        say(f"hitofude: {sentence}")

    def _is_time(self) -> bool:
        quiet_since = self._at if self._alone else max(self._at, self._stopped.waited)
        return time.monotonic() - quiet_since > (0.1 if self._alone else EVERY)

    def _show(self) -> None:
        self._at = time.monotonic()
        if self._alone:
            show(f"\r\x1b[K{self._fraction:4.0%} {self._text}" + ("\r\x1b[K" if self._fraction >= 1 else ""))
        else:
            say(f"hitofude: {self._fraction:.0%} {self._text}".rstrip())
