"""What the program remembers between two runs: a small JSON file in the user's configuration folder."""

from __future__ import annotations

import json
import os
from dataclasses import asdict, dataclass, fields, replace
from enum import Enum
from pathlib import Path
from typing import Any

import platformdirs

from .atomic import write_atomically
from .errors import InputError

RECENT_FILES = 10
"""How many files the list of recent files holds."""


class ThemeChoice(Enum):
    """Which colours the window uses."""

    SYSTEM = "system"
    LIGHT = "light"
    DARK = "dark"


class ShownUnits(Enum):
    """Which units rulers and the status bar count in."""

    MM = "mm"
    INCH = "inch"


class JobMemory(Enum):
    """How much of the machine's memory a job of the window may take."""

    QUARTER = "quarter"
    HALF = "half"
    MOST = "most"


class Phosphor(Enum):
    """Which light the 1986 session's tube gives."""

    GREEN = "green"
    AMBER = "amber"


class Language(Enum):
    """Which language the window speaks."""

    SYSTEM = "system"
    ENGLISH = "en"
    JAPANESE = "ja"


@dataclass(frozen=True)
class Settings:
    """Remembered choices of one user.

    Attributes:
        theme: "system" follows the desktop.
        recent_files: absolute paths, the latest first, each once.
        window_geometry: opaque text of the window tool-kit, or "".
        last_folder: folder of the last file dialog, or "".
        phosphor: of the 1986 session's tube.
        units: of rulers and status bar.
        backups: the version of a project before the one that is saved is kept.
        language: "system" follows the desktop.
        shortcuts: keys that the user changed, each as "action=key". recent_commands: names of the palette, the latest
            first.
        snaps: words of the kinds of points that the mouse snaps to. tracking: points it rested on draw it.
        polar_on: rays at multiples of `polar_step` degrees draw it.
        tour: "" until the tour was seen or skipped.
        memory: what a job may take.
    """

    theme: ThemeChoice = ThemeChoice.SYSTEM
    recent_files: tuple[str, ...] = ()
    window_geometry: str = ""
    last_folder: str = ""
    phosphor: Phosphor = Phosphor.GREEN
    units: ShownUnits = ShownUnits.MM
    backups: bool = True
    language: Language = Language.SYSTEM
    shortcuts: tuple[str, ...] = ()
    recent_commands: tuple[str, ...] = ()
    snaps: tuple[str, ...] = ("end", "mid", "cen", "qua", "nod", "int", "per", "tan")
    tracking: bool = True
    polar_on: bool = True
    polar_step: str = "45"
    tour: str = ""
    memory: JobMemory = JobMemory.HALF

    def with_recent_file(self, path: Path) -> Settings:
        """Return the settings with this file as the latest one."""
        name = str(path.absolute())
        others = tuple(other for other in self.recent_files if other != name)
        return replace(self, recent_files=(name, *others)[:RECENT_FILES], last_folder=str(path.absolute().parent))


def config_folder() -> Path:
    """Return the folder of the settings file: HITOFUDE_CONFIG if that is set, else the platform's own place."""
    return Path(os.environ.get("HITOFUDE_CONFIG") or platformdirs.user_config_dir("hitofude"))


def state_folder() -> Path:
    """Return the folder of what outlives a crash: in HITOFUDE_CONFIG if that is set, else the platform's own place."""
    own = os.environ.get("HITOFUDE_CONFIG")
    return Path(own, "state") if own else Path(platformdirs.user_state_dir("hitofude"))


def load_settings() -> Settings:
    """Return the saved settings; what is missing, damaged or of another version's kind takes its default."""
    try:
        saved = json.loads((config_folder() / "settings.json").read_text("utf-8"))
    except (OSError, ValueError):
        return Settings()
    if not isinstance(saved, dict):
        return Settings()
    return Settings(
        **{field.name: _checked(field.name, saved[field.name]) for field in fields(Settings) if field.name in saved}
    )


def _checked(name: str, value: object) -> Any:
    default = getattr(Settings(), name)
    if isinstance(default, Enum):
        return next((choice for choice in type(default) if choice.value == value), default)
    if isinstance(default, tuple):
        return tuple(item for item in value if isinstance(item, str)) if isinstance(value, list) else default
    return value if type(value) is type(default) else default


def save_settings(settings: Settings) -> None:
    """Write the settings file whole or not at all.

    Raises:
        InputError: the folder or the file cannot be written.
    """
    folder = config_folder()
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"Cannot make the settings folder {folder}: {error.strerror}.") from error
    # ASCII: a file's name may be no text in UTF-8
    text = json.dumps(asdict(settings), default=lambda choice: choice.value, indent=1)
    write_atomically(folder / "settings.json", text.encode() + b"\n")
