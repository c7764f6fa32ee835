"""Export drawing: DXF, SVG or the shape language; what the format cannot hold is told."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from ...core.atomic import write_atomically
from ...core.progress import Progress
from ...model.part import Part
from ..framework.controller import Controller
from ..framework.figures import counted, grouped
from ..framework.worker import Answer, Worker
from ..framework.workspace import Workspace

FORMATS = {
    "DXF, AutoCAD 2010 and later (*.dxf)": "R2010",
    "DXF 2018 (*.dxf)": "R2018",
    "DXF 2013 (*.dxf)": "R2013",
    "DXF 2007 (*.dxf)": "R2007",
    "DXF 2004 (*.dxf)": "R2004",
    "DXF 2000 (*.dxf)": "R2000",
    "DXF R12, lines and arcs alone (*.dxf)": "R12",
    "SVG (*.svg)": ".svg",
    "Shape language (*.draw)": ".draw",
}
"""What the file dialog offers: a version of DXF, or a suffix."""


@dataclass(frozen=True)
class _Exported:
    path: Path
    size: int
    remarks: tuple[str, ...]


class DrawingExport(Controller):
    """Writes the drawing in another program's format.

    Signals:
        written(path).

    Attributes:
        choose_file: asks the user for a path and one of `FORMATS`, given a first choice; None = he changed his mind.
    """

    written = Signal(Path)

    def __init__(self, over: QWidget, workspace: Workspace) -> None:
        """Make one; `over` is the widget over which it asks."""
        super().__init__(over)
        self._over, self._workspace, self._log = over, workspace, workspace.log
        self._worker = Worker(self)
        self.choose_file: Callable[[Path], tuple[Path, str] | None] = self._choose
        self._worker.done.connect(self._on_done)
        self._worker.failed.connect(lambda answer: self.failed.emit(f"{answer.error} Nothing was written."))
        workspace.activity.ended.connect(lambda: self._worker.finish(10.0))

    def start(self) -> None:
        """Ask for a file and write it."""
        document = self._workspace.document
        if not document.part.entities:
            self.failed.emit("Nothing is drawn yet, so there is nothing to export.")
            return
        folder = self._workspace.preferences.last_folder
        chosen = self.choose_file(folder / f"{document.path.stem if document.path else document.part.name}.dxf")
        if chosen is not None:
            self._worker.start(partial(_export, document.part, *chosen), document.revision)

    def _choose(self, first: Path) -> tuple[Path, str] | None:
        dialog = QFileDialog(self._over, "Export drawing", str(first), ";;".join(FORMATS))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix("dxf")
        dialog.filterSelected.connect(lambda name: dialog.setDefaultSuffix(_suffix(FORMATS[name])[1:]))
        return (Path(dialog.selectedFiles()[0]), FORMATS[dialog.selectedNameFilter()]) if dialog.exec() else None

    def _on_done(self, answer: Answer) -> None:
        exported = answer.value
        assert isinstance(exported, _Exported)
        said = " ".join(exported.remarks)
        size = grouped(exported.size / 1000, 1)
        self._log.note(f"export {exported.path.name}", f"{size} kB written to {exported.path.parent}. {said}".strip())
        self.said.emit(f"{exported.path.name} is written.")
        if exported.remarks:
            self._workspace.notice.ask(f"{exported.path.name} is written. {said}")
        self.written.emit(exported.path)


def _suffix(format_: str) -> str:
    return format_ if format_.startswith(".") else ".dxf"


def _export(part: Part, path: Path, format_: str, progress: Progress) -> _Exported:
    """Write the drawing; the suffix of the name decides where it is one of another format."""
    progress.step(0.1, f"Writing {path.name}")
    suffix = path.suffix.lower() if path.suffix.lower() in (".dxf", ".svg", ".draw") else _suffix(format_)
    path = path if path.suffix.lower() == suffix else path.with_name(path.name + suffix)
    data, remarks = _written(part, suffix, format_)
    write_atomically(path, data)
    return _Exported(path, len(data), remarks)


def _written(part: Part, suffix: str, format_: str) -> tuple[bytes, tuple[str, ...]]:
    if suffix == ".draw":
        from ...drafting.language.write import draw_text

        drawn = draw_text(part)
        return drawn.text.encode(), (
            f"{counted(drawn.left_out, 'curve')} too small for it left out.",
        ) if drawn.left_out else ()
    if suffix == ".svg":
        from ...formats.svg.write import svg_bytes

        written = svg_bytes(part)
    else:
        from ...formats.dxf.write import DxfVersion, dxf_bytes

        written = dxf_bytes(part, DxfVersion[format_] if format_ in DxfVersion.__members__ else DxfVersion.R2010)
    converted = (
        f"{counted(each.count, each.kind)} became lines and arcs, at most {each.deviation * 1000:.3f} µm away."
        for each in written.converted
    )
    renamed = (f"Layer {old} is called {new} there." for old, new in written.renamed)
    notes = (
        (f"{counted(len(part.notes), 'point, guide or dimension', 'points, guides and dimensions')} left out.",)
        if part.notes
        else ()
    )
    return written.data, (*converted, *renamed, *notes)
