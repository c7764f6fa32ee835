"""Machine profiles from TOML: those that ship in `resources/machines`, and the user's own beside the settings."""

from __future__ import annotations

from pathlib import Path

from ..core.errors import InputError
from ..core.resources import resource
from ..core.settings import config_folder
from ..core.toml_tables import read_tables
from ..model.machine import Machine

RANGES = {
    **{f"{axis}.{end}": (-1e5, 1e5) for axis in "xyz" for end in ("low", "high")},
    **{f"{axis}.rapid": (1.0, 1e6) for axis in "xyz"},
    **{f"{axis}.acceleration": (1.0, 1e6) for axis in "xyz"},
    "spindle": (1.0, 1e6),
    "spindle.power": (0.0, 1e6),
    "largest_feed": (1.0, 1e6),
    "tool_change": (0.0, 3600.0),
    "corner": (0.0, 10.0),
    "work_origin": (-1e5, 1e5),
}
DEFAULT_MACHINE = "router"


def machine_files() -> dict[str, Path]:
    """Return every machine's file by its name, sorted; a user's file hides one of the same name that ships."""
    own = config_folder() / "machines"
    found = [*resource("machines").glob("*.toml"), *(own.glob("*.toml") if own.is_dir() else ())]
    return dict(sorted({path.stem: path for path in found}.items()))


def load_machine(name: str) -> Machine:
    """Return a machine by its name, or by the path of its file.

    Raises:
        InputError: there is no such machine, or its file is not as `resources/machines/router.toml` shows.
    """
    files = machine_files()
    path = files.get(name) or Path(name)
    try:
        return read_machine(path.name, path.read_bytes())
    except OSError as error:
        known = ", ".join(files)
        raise InputError(
            f"There is no machine '{name}'; choose one of {known}, or name a TOML file like those."
        ) from error


def read_machine(file: str, data: bytes) -> Machine:
    """Return the machine that a TOML text describes.

    Raises:
        InputError: file, line and key, what is wrong and what is expected.
    """
    return read_tables(Machine, file, data, RANGES)
