"""Export of a computed scene: NC program, plot, table of points or report; the suffix of the name says which."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QFileDialog

from ....core.atomic import write_together
from ....core.progress import Progress
from ....model.finding import FindingKind
from ...framework.controller import Controller
from ...framework.figures import counted, grouped
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from .scene_computation import ProvenScene
from .shown_scene import ShownScene
from .view import SurfacesView, ViewDirection

if TYPE_CHECKING:
    from ....usecases.scene_program.nc import WrittenScene

FORMATS: Mapping[str, str] = {
    "NC program (*.ngc)": ".ngc",
    "Plot, SVG (*.svg)": ".svg",
    "Plot, PDF (*.pdf)": ".pdf",
    "Plot, PNG (*.png)": ".png",
    "Plot for pen plotters, HP-GL/2 (*.hpgl)": ".hpgl",
    "Table of points (*.csv)": ".csv",
    "Report (*.json)": ".json",
}
"""What the file dialog offers, by suffix."""
_PLOTS = (".svg", ".pdf", ".png", ".hpgl", ".plt")
_VIEWS = {ViewDirection.SPACE: "isometric", ViewDirection.PLAN: "plan", ViewDirection.SECTION: "front"}


@dataclass(frozen=True)
class _ExportRequest:
    """What to write of: a scene, its program if it is proven, and from where it is looked at."""

    shown: ShownScene
    proven: ProvenScene | None
    view: str


@dataclass(frozen=True)
class _ExportedScene:
    paths: tuple[Path, ...]
    size: int
    remark: str


class SceneExportController(Controller):
    """Writes what was made of the scene that is shown.

    Signals:
        written(path).

    Attributes:
        choose_file: asks the user for a path, given a first choice; None = he changed his mind.
    """

    written = Signal(Path)

    def __init__(self, view: SurfacesView, proven: Callable[[], ProvenScene | None], workspace: Workspace) -> None:
        """Make one; `proven` tells what the scene that is shown came to as NC, None while nobody knows."""
        super().__init__(view)
        self._view, self._proven, self._log, self._notice = view, proven, workspace.log, workspace.notice
        self._worker = Worker(self)
        self.choose_file: Callable[[Path], Path | None] = self._choose
        self._worker.done.connect(self._on_done)
        self._worker.failed.connect(lambda answer: self.failed.emit(f"{answer.error} Nothing was written."))
        workspace.activity.ended.connect(lambda: self._worker.finish(10.0))

    def start(self) -> None:
        """Ask for a file and write it."""
        view = self._view
        if view.shown is None:
            self.failed.emit("No scene is computed yet, so there is nothing to export.")
            return
        chosen = self.choose_file(view.shown.path.with_suffix(".ngc"))
        if chosen is not None:
            self._worker.start(
                partial(_export, _ExportRequest(view.shown, self._proven(), _VIEWS[view.look]), chosen), 0
            )

    def _choose(self, first: Path) -> Path | None:
        dialog = QFileDialog(self._view, "Export scene", str(first), ";;".join(FORMATS))
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setDefaultSuffix("ngc")
        dialog.filterSelected.connect(lambda name: dialog.setDefaultSuffix(FORMATS[name][1:]))
        return Path(dialog.selectedFiles()[0]) if dialog.exec() else None

    def _on_done(self, answer: JobOutcome) -> None:
        exported = answer.value
        assert isinstance(exported, _ExportedScene)
        first, said = exported.paths[0], exported.remark
        self._log.note(
            f"export {first.name}", f"{grouped(exported.size / 1000, 1)} kB written to {first.parent}. {said}".strip()
        )
        self.said.emit(f"{first.name} is written.")
        if said:
            self._notice.ask(f"{first.name} is written. {said}")
        self.written.emit(first)


def _export(request: _ExportRequest, path: Path, progress: Progress) -> _ExportedScene:
    """Write one file, or one a tool or sheet."""
    from ....formats.plot.surface_plot import VIEWS
    from ....usecases.scene.plot import PlotScene, PlottedPart
    from ....usecases.scene.points import scene_points_csv
    from ....usecases.scene_program.nc import write_scene_nc
    from ....usecases.scene_program.report import surface_report
    from ....usecases.surface_files import plot_files, program_files

    computed, suffix, remark = request.shown.computed, path.suffix.lower(), ""
    if suffix in _PLOTS:
        texts = plot_files(computed, path, PlotScene(VIEWS[request.view], drawn=PlottedPart.PATHS))
    elif suffix == ".csv":
        texts = {path: scene_points_csv(computed)}
    else:
        written = request.proven.written if request.proven is not None else write_scene_nc(computed, progress)
        report = suffix == ".json"
        texts = {path: surface_report(computed, written).text().encode()} if report else program_files(written, path)
        remark = _remark(written)
    write_together(texts)
    return _ExportedScene(tuple(texts), sum(len(data) for data in texts.values()), remark)


def _remark(written: WrittenScene) -> str:
    """Return what the user has to know of a program, or ""."""
    findings = written.findings()
    if not findings:
        return ""
    unproven = f"{counted(len(written.unproven), 'move')} could not be proven. " if len(written.unproven) else ""
    worst = next((each for each in findings if each.kind is FindingKind.GOUGE), findings[0])
    more = f" ({counted(len(findings) - 1, 'more finding')})" if len(findings) > 1 and not unproven else ""
    return f"{unproven}{worst.text}{more}"
