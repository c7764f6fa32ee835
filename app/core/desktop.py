"""What a desktop shows of the program: entry of the menu, icon, kinds of files, manual page; for one user."""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from .resources import PACKAGE, resource

PLACES = {
    "hitofude.desktop": "applications/hitofude.desktop",
    "hitofude.svg": "icons/hicolor/scalable/apps/hitofude.svg",
    "hitofude-mime.xml": "mime/packages/hitofude.xml",
    "hitofude.1": "man/man1/hitofude.1",
}
"""Where each file of `resources/desktop` belongs below a folder of shared data, as desktops look for them."""


def data_folder() -> Path:
    """Return the user's folder of shared data."""
    return Path(os.environ.get("XDG_DATA_HOME") or Path.home() / ".local/share")


def desktop_files(folder: Path) -> Mapping[Path, bytes]:
    """Return what belongs below a folder of shared data, by its place; the entry starts this very installation."""
    files = {folder / place: resource("desktop", name).read_bytes() for name, place in PLACES.items()}
    entry = folder / PLACES["hitofude.desktop"]
    files[entry] = files[entry].replace(b"Exec=hitofude ", f"Exec={_command()} ".encode())
    return files


def _command() -> str:
    """Return what starts this installation, as an entry of the menu has it."""
    script = shutil.which("hitofude", path=str(Path(sys.executable).parent))
    words = [script] if script else [sys.executable, "-P", "-m", PACKAGE]
    return " ".join(map(shlex.quote, words)).replace("%", "%%")


def refresh(folder: Path) -> None:
    """Have the desktop look at its tables again, where it has tables: without these tools it does so by itself."""
    for tool, below in (("update-mime-database", "mime"), ("update-desktop-database", "applications")):
        with suppress(OSError, subprocess.SubprocessError):
            subprocess.run([tool, str(folder / below)], capture_output=True, timeout=30, check=False)
