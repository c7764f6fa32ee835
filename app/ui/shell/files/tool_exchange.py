"""Tools from files into the user's library, and the job's tools into files."""

from __future__ import annotations

from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_atomically
from ....core.errors import HitofudeError, InputError
from ....formats.tools.at_path import tool_suffixes, tools_at
from ....formats.tools.files import write_tools
from ....formats.tools.library import ToolLibrary, own_folder, write_library
from ....model.part import Units
from ...framework.figures import counted
from ...framework.workspace import Workspace
from ...panels.side_panel import SidePanel

IN = f"Tools ({' '.join(f'*{suffix}' for suffix in tool_suffixes())});;All files (*)"
LIBRARY, SHEET, TABLE_MM, TABLE_INCH = (
    "Tool library (*.toml)",
    "Spreadsheet (*.csv)",
    "LinuxCNC tool table, mm (*.tbl)",
    "LinuxCNC tool table, inch (*.tbl)",
)
_NAMES = {Units.MM: "mm", Units.INCH: "inch"}


class ToolExchange(QObject):
    """Asks for files, reads and writes them, and says what became of it.

    Signals:
        said(sentence).
    """

    said = Signal(str)

    def __init__(self, panel: SidePanel, workspace: Workspace) -> None:
        super().__init__(panel)
        self._panel, self._workspace, self._log = panel, workspace, workspace.log
        panel.library.imported.connect(self.choose_file)
        panel.library.exported.connect(self.choose_place)

    def choose_file(self) -> None:
        """Ask for a file of tools and take it into the library."""
        name, _ = QFileDialog.getOpenFileName(
            self._panel, "Import tools", self._workspace.preferences.settings.last_folder, IN
        )
        if name:
            self.take(Path(name))

    def choose_place(self) -> None:
        """Ask where to, and write the job's tools."""
        start = str(self._workspace.preferences.last_folder / "tools.toml")
        name, kind = QFileDialog.getSaveFileName(
            self._panel, "Export tools", start, ";;".join((LIBRARY, SHEET, TABLE_MM, TABLE_INCH))
        )
        if name:
            suffix = {SHEET: ".csv", TABLE_MM: ".tbl", TABLE_INCH: ".tbl"}.get(kind, ".toml")
            path = Path(name)
            self.write(
                path if path.suffix else path.with_suffix(suffix), Units.INCH if kind == TABLE_INCH else Units.MM
            )

    def take(self, path: Path, units: Units = Units.MM, again: bool = False) -> None:
        """Take the tools of a file into the user's library.

        Args:
            path: the file.
            units: of a tool table.
            again: what is in the library under the file's name may be replaced.
        """
        place = own_folder() / f"{path.stem}.toml"
        if place.exists() and not again:
            self._workspace.notice.ask(
                f"There is a library {path.stem} already.",
                [("Replace it", lambda: self.take(path, units, again=True)), ("Keep it", lambda: None)],
            )
            return
        try:
            library, left_out = tools_at(path, units)
            _write(place, write_library(library))
        except HitofudeError as error:
            self._panel.refused.emit(str(error))
            return
        self._panel.read_libraries()
        told = f"{counted(len(library.tools), 'tool')} of {path.name} in the library."
        self._log.note(f"import {path.name}", " ".join([told, *left_out]))
        self._tell(path, units, f"{told}{f' Left out: {left_out[0]}' if left_out else ''}")

    def _tell(self, path: Path, units: Units, told: str) -> None:
        """Say what was taken; of a tool table also in which units, and offer the others."""
        if path.suffix.lower() != ".tbl":
            self._workspace.notice.ask(told)
            return
        other = Units.INCH if units is Units.MM else Units.MM
        self._workspace.notice.ask(
            f"{told} It names no units; it was read in {_NAMES[units]}.",
            [
                (f"Keep {_NAMES[units]}", lambda: None),
                (f"Read in {_NAMES[other]}", lambda: self.take(path, other, again=True)),
            ],
        )

    def write(self, path: Path, units: Units = Units.MM) -> None:
        """Write the job's tools to a file of the kind that its name tells."""
        tools = self._workspace.document.job.tools
        try:
            write_atomically(path, write_tools(path.name, ToolLibrary(path.stem, tools), units))
        except HitofudeError as error:
            self._panel.refused.emit(str(error))
            return
        self._log.note(f"export {path.name}", f"{counted(len(tools), 'tool')} written to {path}")
        self.said.emit(f"{path.name} is written.")


def _write(place: Path, data: bytes) -> None:
    """Write a library's file, in a folder that may have to be made."""
    try:
        place.parent.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError(f"Cannot make the folder {place.parent} of your tool libraries: {error.strerror}.") from error
    write_atomically(place, data)
