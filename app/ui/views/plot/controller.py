"""Print or plot: shows the sheets beside what is asked of them, keeps them in step with the drawing, writes and prints
them.
"""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from pathlib import Path

from PySide6.QtCore import QMarginsF, QSizeF, Signal
from PySide6.QtGui import QPageLayout, QPageSize, QPainter
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_together
from ....core.progress import Progress
from ....drafting.document import DocumentChange
from ....formats.plot.content import DrawingContent
from ....formats.plot.layout import PlotOptions, lay_out
from ...framework.controller import Controller
from ...framework.figures import counted
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .panel import PlotPanel
from .preview import PlotPreview
from .sheet_files import FILTER, FORMATS, paint_all, plot_files
from .sheet_painter import PlotSheet, sheets


@dataclass(frozen=True)
class PreparedSheets:
    """Sheets that can be shown and written.

    Attributes:
        columns: sheets in a row. scale: size on paper over size of the part. size: of what is plotted, mm.
    """

    sheets: tuple[PlotSheet, ...]
    columns: int
    scale: float
    size: tuple[float, float]


def _made_ready(shown: DrawingContent, options: PlotOptions, today: str, progress: Progress) -> PreparedSheets:
    plot = lay_out(shown, options, today)
    progress.step(0.5, "Preparing the sheets")
    x0, y0, x1, y1 = shown.box() or (0.0, 0.0, 0.0, 0.0)
    return PreparedSheets(sheets(plot), plot.columns, plot.scale, (x1 - x0, y1 - y0))


@dataclass(frozen=True)
class WrittenSheets:
    """Files that were written, and how many sheets they hold."""

    paths: tuple[Path, ...]
    sheets: int


def _write(path: Path, those: tuple[PlotSheet, ...], name: str) -> WrittenSheets:
    files = plot_files(path, those, name)
    write_together(files)
    return WrittenSheets(tuple(files), len(those))


class PlotController(Controller):
    """Brings the page preview to the front and takes it away again.

    Signals:
        left(): what was at the front before shall come back.

    Attributes:
        ready: the sheets of the drawing as it is now; None while they are being made or cannot be.
    """

    left = Signal()

    def __init__(self, preview: PlotPreview, panel: PlotPanel, workspace: Workspace) -> None:
        super().__init__(preview)
        self._preview, self._panel = preview, panel
        self._document, self._computation = workspace.document, workspace.computation
        self._preferences, self._log = workspace.preferences, workspace.log
        self._seen = False
        self._today = date.today().isoformat
        self.ready: PreparedSheets | None = None
        self.worker = Worker(self, head_start_s=0.0)
        self.worker.failed.connect(self._on_failed)
        self.writer = Worker(self, head_start_s=0.0)
        self.writer.failed.connect(lambda answer: self.failed.emit(answer.error or ""))
        for worker in (self.worker, self.writer):
            workspace.activity.ended.connect(worker.finish)
        self._computation.changed.connect(self.refresh)
        self._panel.changed.connect(lambda _: self.refresh())
        self._panel.save_requested.connect(self.choose_place)
        self._panel.print_requested.connect(self.choose_printer)
        for leaving in (self._panel.left, self._preview.left):
            leaving.connect(self.left)
        self._document.subscribe(self._on_change)

    def start(self) -> None:
        """Show the drawing on paper."""
        self.see(True)
        self.front_requested.emit()
        self.refresh()

    def see(self, seen: bool) -> None:
        """Keep the sheets in step with the drawing only while they are seen."""
        self._seen = seen

    def _on_change(self, change: DocumentChange) -> None:
        if change & DocumentChange.PART:
            self.refresh()

    def refresh(self) -> None:
        """Lay the drawing out anew, if it is looked at."""
        if not self._seen:
            return
        request, program = self._panel.request, self._computation.program
        current = program is not None and not self._computation.outdated
        self._panel.show_paths_there(current)
        moves = program.moves if program is not None and current and request.paths else None
        shown, layout, today = (
            DrawingContent(self._document.part, moves, request.notes, request.black),
            request.layout,
            self._today(),
        )
        self.worker.start(
            lambda progress: _made_ready(shown, layout, today, progress), self._document.revision, self._on_ready
        )

    def _on_ready(self, ready: PreparedSheets) -> None:
        self.ready = ready
        self._preview.show_sheets(self.ready.sheets, self.ready.columns)
        self._panel.show_result(self.ready.scale, len(self.ready.sheets), self.ready.size)

    def _on_failed(self, answer: JobOutcome) -> None:
        self.ready = None
        self._preview.show_sheets((), 1)
        self._panel.refuse(answer.error or "")

    def choose_place(self) -> None:
        """Ask for a file and write the sheets."""
        stem = self._document.path.stem if self._document.path else self._document.part.name
        start = str(self._preferences.last_folder / f"{stem}.pdf")
        name, chosen = QFileDialog.getSaveFileName(self._preview, "Save plot", start, FILTER)
        if name:
            path = Path(name)
            suffix = next((each for each in FORMATS if f"*{each}" in chosen), ".pdf")
            self.save(path if path.suffix.lower() in FORMATS else Path(name + suffix))

    def save(self, path: Path) -> None:
        """Write the sheets in the format that the name ends in: every file, or none."""
        if self.ready is None:
            return
        sheets, name = self.ready.sheets, self._document.part.name
        self.said.emit(f"Writing {path.name}")
        self.writer.start(lambda progress: _write(path, sheets, name), 0, self._on_written)

    def _on_written(self, written: WrittenSheets) -> None:
        paths, count = written.paths, written.sheets
        names = paths[0].name if len(paths) == 1 else f"{paths[0].name} … {paths[-1].name}"
        self._log.note(f"plot {names}", f"{counted(count, 'sheet')} written to {paths[0].parent}")
        self.said.emit(f"{names} {'is' if len(paths) == 1 else 'are'} written.")

    def choose_printer(self) -> None:
        """Ask for a printer and print the sheets at true size."""
        # asks the system for its printers, which takes a while
        from PySide6.QtPrintSupport import (
            QPrintDialog,
            QPrinter,
        )

        if self.ready is None:
            return
        page = self.ready.sheets[0].page
        printer = QPrinter(QPrinter.PrinterMode.HighResolution)
        printer.setDocName(self._document.part.name)
        size = QPageSize(QSizeF(min(page.width, page.height), max(page.width, page.height)), QPageSize.Unit.Millimeter)
        lies = QPageLayout.Orientation.Landscape if page.width > page.height else QPageLayout.Orientation.Portrait
        printer.setPageLayout(QPageLayout(size, lies, QMarginsF()))
        printer.setFullPage(True)
        if QPrintDialog(printer, self._preview).exec():
            painter = QPainter(printer)
            paint_all(painter, self.ready.sheets, printer)
            painter.end()
