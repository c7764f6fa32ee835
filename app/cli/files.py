"""The files of a command: read whole, checked before any work is done; and how far the work is, on a terminal."""

from __future__ import annotations

import os
import threading
import time
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..core.atomic import read_whole, sweep
from ..core.errors import InputError
from ..core.progress import Progress
from .output import on_terminal, say, show

EVERY = 5.0
"""Seconds between lines that tell how far a job is, where they are no terminal's."""


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
        raise InputError(f"{path} cannot be read: {getattr(error, 'strerror', None) or error}; name another file") from error
    if not data:
        raise InputError(f"{path} is empty; export it again")
    return data


def check_outputs(outputs: Mapping[str, Path], inputs: Sequence[Path]) -> None:
    """Refuse files to write that cannot be, or that are inputs or one another; take away what killed runs have left beside them.

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
            raise InputError(f"--{name} {path}: the folder {path.parent} cannot be written; choose another or change its permissions")
        if identity(path) in taken:
            raise InputError(f"--{name} {path} is named twice or is also an input; give every file its own name")
        if not path.is_char_device():
            taken.append(identity(path))
    for folder in {path.parent for path in outputs.values()}:
        sweep(folder)


def identity(path: Path) -> object:
    """Return what tells whether two names mean the same file."""
    try:
        status = path.stat()
    except (OSError, ValueError):
        return os.path.realpath(path)
    return (status.st_dev, status.st_ino)


def shown_progress(quiet: bool, stopped: threading.Event) -> Progress:
    """Return a progress that shows itself on stderr: on a terminal all the time, elsewhere in a line every EVERY seconds."""
    if quiet:
        return Progress(None, stopped)
    alone = on_terminal()
    shown = [0.0 if alone else time.monotonic()]

    def told(fraction: float, text: str) -> None:
        if time.monotonic() - shown[0] > (0.1 if alone else EVERY) or (alone and fraction >= 1):
            shown[0] = time.monotonic()
            if not alone:
                say(f"hitofude: {fraction:.0%} {text}".rstrip())
                return
            end = "\r\x1b[K" if fraction >= 1 else ""
            show(f"\r\x1b[K{fraction:4.0%} {text}{end}")

    return Progress(told, stopped)
