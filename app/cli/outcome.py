"""What a command has made, and how it is delivered: files written together, lines printed, the exit status."""

from __future__ import annotations

import argparse
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from ..core.atomic import write_together
from ..core.errors import InputError
from ..core.progress import Progress
from .output import tell_lines
from .signals import undisturbed


@dataclass(frozen=True)
class CommandOutcome:
    """What a command has made.

    Attributes:
        files: bytes by the path that they are written to; all are made before the first is written.
        lines: of the summary.
        counts: whether something was found that counts, so that the exit status is 1.
        folders: for the files, made in this order where there are none.
    """

    files: Mapping[Path, bytes]
    lines: Sequence[str]
    counts: bool = False
    folders: Sequence[Path] = ()

    def delivered(self, arguments: argparse.Namespace, progress: Progress) -> int:
        """Write the files, print the summary unless the command is to be quiet, and return the exit status.

        Raises:
            HitofudeError: a file cannot be written; none is.
            Cancelled: the command was asked to stop before the first file took its place.
        """
        progress.step(1.0)
        if self.files:
            with undisturbed():
                for folder in self.folders:
                    _make_folder(folder)
                write_together(self.files)
        if not arguments.quiet:
            tell_lines(self.lines)
        return 1 if self.counts else 0


def _make_folder(folder: Path) -> None:
    try:
        folder.mkdir(exist_ok=True)
    except OSError as error:
        raise InputError(
            f"Cannot write {folder}: {error.strerror or error}; choose another folder or change its permissions"
        ) from error


def by_path(outputs: Mapping[str, Path], texts: Mapping[str, bytes]) -> dict[Path, bytes]:
    """Return what was made for options by the path that each option names."""
    return {outputs[option]: text for option, text in texts.items()}
