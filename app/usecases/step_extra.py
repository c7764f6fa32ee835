"""Open CASCADE, which reads STEP files: whether it is there, and how it is fetched."""

from __future__ import annotations

import importlib
import importlib.util
import subprocess
import sys
from collections.abc import Sequence

from ..core.errors import InputError
from ..core.progress import NO_PROGRESS, Progress

PACKAGE = "cadquery-ocp>=8.0,<9"
"""As the extra `step` of the program names it."""

COMMAND = (sys.executable, "-m", "pip", "install", "--disable-pip-version-check", "--progress-bar", "off", PACKAGE)
_WORDS = ("Collecting", "Downloading", "Using cached", "Installing", "Successfully")
_LAST_LINES = 3
"""Of what the installer said, which tell why it failed."""


def step_files_readable() -> bool:
    """Return whether STEP files can be read here."""
    return importlib.util.find_spec("OCP") is not None


def fetch_step_reader(command: Sequence[str] = COMMAND, progress: Progress = NO_PROGRESS) -> None:
    """Install what reads STEP files beside the program.

    Args:
        command: that does it; its lines tell how far it is.
        progress: asked at every line.

    Raises:
        InputError: it could not be installed, with the last thing that was said.
        Cancelled: the job was asked to stop; what was begun is left.
    """
    progress.step(0.0, "Fetching Open CASCADE")
    said: list[str] = []
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as child:
        assert child.stdout is not None
        try:
            for line in child.stdout:
                said = [*said, line.strip()][-_LAST_LINES:]
                stage = next((k for k, word in enumerate(_WORDS) if line.strip().startswith(word)), 0)
                progress.step(stage / len(_WORDS), line.strip()[:60] or "Fetching Open CASCADE")
        except BaseException:
            child.kill()
            raise
    if child.returncode:
        why = " ".join(said) or "nothing was said"
        raise InputError(f"Open CASCADE could not be fetched: {why}. Look whether there is a network, and try again.")
    importlib.invalidate_caches()
