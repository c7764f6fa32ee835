"""Export drawing: DXF, SVG or the shape language; what the format cannot hold is told."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import partial
from pathlib import Path

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog, QWidget

from ....core.atomic import write_atomically
from ....core.progress import Progress
from ....formats.drawing import WrittenDrawing
from ....formats.readers import formats, known_format
from ....formats.registry import DrawingFormat
from ....model.part import Part
from ...framework.controller import Controller
from ...framework.figures import counted, grouped
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace


def offered() -> dict[str, str]:
    """Return what the file dialog offers, and the key of the writer: a version of DXF, or a suffix."""
    return {
        f"{writer.words} (*{each.suffixes[0]})": writer.key
        for each in sorted(formats(), key=lambda each: -len(each.writers))
        for writer in each.writers
    }


@dataclass(frozen=True)
class _ExportedDrawing:
    path: Path
    size: int
    remarks: tuple[str, ...]


class DrawingExportController(Controller):
    """Writes the drawing in another program's format.

    Signals:
        written(path).

    Attributes:
        choose_file: asks the user for a path and the key of a writer, given a first choice; None = he changed his mind.
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
        keys = offered()
        dialog = QFileDialog(self._over, "Export drawing", str(first), ";;".join(keys))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix("dxf")
        dialog.filterSelected.connect(lambda name: dialog.setDefaultSuffix(_format(keys[name]).suffixes[0][1:]))
        return (Path(dialog.selectedFiles()[0]), keys[dialog.selectedNameFilter()]) if dialog.exec() else None

    def _on_done(self, answer: JobOutcome) -> None:
        exported = answer.value
        assert isinstance(exported, _ExportedDrawing)
        said = " ".join(exported.remarks)
        size = grouped(exported.size / 1000, 1)
        self._log.note(f"export {exported.path.name}", f"{size} kB written to {exported.path.parent}. {said}".strip())
        self.said.emit(f"{exported.path.name} is written.")
        if exported.remarks:
            self._workspace.notice.ask(f"{exported.path.name} is written. {said}")
        self.written.emit(exported.path)


def _format(key: str) -> DrawingFormat:
    """Return the format that has the writer of a key."""
    return next(each for each in formats() if any(writer.key == key for writer in each.writers))


def _export(part: Part, path: Path, key: str, progress: Progress) -> _ExportedDrawing:
    """Write the drawing; the suffix of the name decides where it is one of another format."""
    progress.step(0.1, f"Writing {path.name}")
    named = known_format(path.name)
    format_ = named if named is not None and named.writers else _format(key)
    path = path if path.suffix.lower() in format_.suffixes else path.with_name(path.name + format_.suffixes[0])
    written = format_.writer(key).write(part)
    write_atomically(path, written.data)
    converted = (
        f"{counted(each.count, each.kind)} became lines and arcs, at most {each.deviation * 1000:.3f} µm away."
        for each in written.converted
    )
    renamed = (f"Layer {old} is called {new} there." for old, new in written.renamed)
    return _ExportedDrawing(path, len(written.data), (*converted, *renamed, *_left_out(written)))


def _left_out(written: WrittenDrawing) -> Iterator[str]:
    if written.too_small:
        yield f"{counted(written.too_small, 'curve')} too small for it left out."
    if written.notes_left_out:
        notes = counted(written.notes_left_out, "point, guide or dimension", "points, guides and dimensions")
        yield f"{notes} left out."
