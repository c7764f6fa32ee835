"""New, Open, Save, Export, Close: what they ask above the canvas, and what they leave in the log."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Signal
from PySide6.QtWidgets import QFileDialog

from ...drafting.document import DocumentChange
from ...formats.project.project import Project, SavedView
from ...formats.readers import offered_suffixes
from ...formats.tools.at_path import holds_tools, tool_suffixes
from ...gcode.posts import load_post
from ...model.job import Job, Stock
from ...model.part import Part
from ...model.reading import AS_THE_FILE_SAYS, ReadingOptions
from ...usecases.pixels.options import PICTURES, is_picture
from ...usecases.scene.solid_files import SOLIDS, is_solid
from ..framework.figures import counted, grouped
from ..framework.log import Log
from ..framework.view import View, views
from ..views.canvas.view_transform import ViewTransform as CanvasView
from ..views.nc.program_reader import SUFFIXES as PROGRAMS
from ..views.nc.program_reader import is_program, looks_like_program
from ..views.surfaces.shown_scene import is_scene
from .display_controller import DisplayController
from .files import open_controller as opening_files
from .files.nc_export_controller import ExportPlace, NcExportController, post_filters
from .files.open_controller import OpenController, OpenedDrawing, UndecidedDrawing
from .files.reread_controller import RereadController
from .files.save_controller import SaveController
from .main_window import MainWindow, opened_suffixes

_ROUND_FIG_2 = Stock(margin=5.0)
"""So that each of its areas has walls all round: 100 by 100 mm, as wide as the display."""

FIRST_START = "This is fig. 2 of the 1986 patent. Change the tool and press F5, or draw your own."


def open_filter() -> str:
    """Return what the dialog of Open shows: every kind of file that can be opened."""
    shown = " ".join(f"*{each}" for each in (".DXF", *opened_suffixes()))
    return f"Drawings, solids, scenes, pictures, tools and NC programs ({shown});;All files (*)"


def unknown_kind(name: str) -> str:
    """Return what is said of a file of a kind that nothing opens."""
    drawings, solids, pictures, programs, tools = (
        " ".join(dict.fromkeys(each)) for each in (offered_suffixes(), SOLIDS, PICTURES, PROGRAMS, tool_suffixes())
    )
    return (
        f"{name} is of no kind that can be opened. Save it as a drawing ({drawings}), a solid ({solids}), a picture "
        f"({pictures}), an NC program ({programs}), tools ({tools}), a scene or a job (.toml)."
    )


@dataclass(frozen=True, eq=False)
class Openers:
    """Who opens what is no drawing: an NC program, a picture, a scene, a solid, tools, a job for the drawing that is
    open.
    """

    program: Callable[[Path], None]
    picture: Callable[[Path], None]
    scene: Callable[[Path], None]
    solid: Callable[[Path], None]
    tools: Callable[[Path], None]
    job: Callable[[Path], None]

    def of(self, path: Path) -> Callable[[Path], None] | None:
        """Return who opens a file beside the drawing, of which nothing is lost then; None = it is a drawing, or
        becomes one.
        """
        kinds = (
            (is_program(path), self.program),
            (is_scene(path), self.scene),
            (is_solid(path.name), self.solid),
            (holds_tools(path), self.tools),
            (path.suffix.lower() == ".toml", self.job),
            (not path.name.lower().endswith(opened_suffixes()) and looks_like_program(path), self.program),
        )
        return next((opens for fits, opens in kinds if fits), None)


class FileController(QObject):
    """Everything between the window and files.

    Signals:
        begun(): an empty drawing; what it is to be may be asked. without_job(name): a drawing was opened that says
            nothing about machining.
    """

    begun = Signal()
    without_job = Signal(str)

    def __init__(self, window: MainWindow, showing: DisplayController, log: Log, open_others: Openers) -> None:
        super().__init__(window)
        self._preferences = window.preferences
        self._window, self._showing, self._log = window, showing, log
        self._document, self._computation = window.document, window.computation
        self._given_up: object = None
        self._others = open_others
        self.open_controller = OpenController(window.document, window.worker)
        self.reread_controller = RereadController(
            window.drawing_page.reading, window.card, window.worker, window.workspace
        )
        self.reread_controller.taken.connect(self._see_all)
        self.reread_controller.possible.connect(window.actions_["reading"].setEnabled)
        window.actions_["reading"].setEnabled(False)
        self.save_controller = SaveController(window, self._look_now, window.actions_["backups"], window.workspace)
        self.save_controller.said.connect(window.status.show_message)
        self.export_controller = NcExportController(window.computation, window.notice, self._choose_nc_file)
        window.dropped.connect(lambda path: self.open_file(Path(path)))
        window.closing.connect(self._on_closing)
        window.actions_.recent.aboutToShow.connect(self._list_recent)
        self.open_controller.read.connect(lambda opened: showing.know_extent(opened.job.part, opened.extent))
        self.open_controller.opened.connect(self._on_opened)
        self.open_controller.opening_changed.connect(showing.show_opening)
        self.open_controller.asked.connect(self._ask_how)
        self.export_controller.written.connect(self._on_written)
        self.export_controller.post_chosen.connect(self._choose_post)
        window.document.subscribe(lambda change: window.card.hide() if change & DocumentChange.LOADED else None)

    @property
    def _would_lose(self) -> bool:
        document = self._document
        drawn = document.part.entities or document.part.notes or document.path
        changed = (document.modified and bool(drawn)) or self.save_controller.beside.unsaved
        return changed and document.state is not self._given_up

    def ask_new(self) -> None:
        """Begin an empty drawing, after asking when changes would be lost."""
        self._leave_drawing("Begin a new drawing", self.new)

    def open_file(self, path: Path, reading: ReadingOptions = AS_THE_FILE_SAYS) -> None:
        """Open a drawing, after asking when changes would be lost; NC programs, scenes and solids are shown beside it,
        tools go into the library, and a job is applied to it, and nothing is lost.

        Args:
            path: of the file. reading: how it is read, if it is a drawing.
        """
        opens = self._others.of(path)
        if opens is not None:
            opens(path)
            return
        if not path.name.lower().endswith(opened_suffixes()):
            self._window.notice.ask(unknown_kind(path.name), error=True)
            return
        if is_picture(path.name):
            self._leave_drawing(f"Open {path.name}", lambda: self._others.picture(path))
            return
        self._leave_drawing(f"Open {path.name}", lambda: self.open_controller.open(path, reading))

    def open_sample(self, path: Path | None = None) -> None:
        """Open a sample with a job of its own, after asking when changes would be lost: fig. 2, which is computed at
        once, a drawing, for which operations are proposed, or a scene.
        """
        sample = path or opening_files.sample_path()
        if is_scene(sample):
            self._others.scene(sample)
        else:
            job = Job(Part(), stock=_ROUND_FIG_2 if sample == opening_files.sample_path() else Stock())
            self._leave_drawing("Open the sample", lambda: self.open_controller.open(sample, before=job))

    def new(self) -> None:
        """Begin an empty drawing with the same tools."""
        self._document.load(replace(self._document.job, part=Part()))
        self._computation.forget()
        self._log.note("new", "Empty drawing, same tools.")
        self._window.notice.turn_over()
        self._showing.show_view(View.DRAW)
        self.begun.emit()

    def choose_file(self) -> None:
        """Ask for a drawing or a program and open it."""
        name, _ = QFileDialog.getOpenFileName(
            self._window, "Open", self._preferences.settings.last_folder, open_filter()
        )
        if name:
            self.open_file(Path(name))

    def _list_recent(self) -> None:
        menu = self._window.actions_.recent
        menu.clear()
        for name in self._preferences.settings.recent_files:
            if Path(name).is_file():
                menu.addAction(name.replace("&", "&&"), partial(self.open_file, Path(name)))
        if menu.isEmpty():
            menu.addAction("Nothing was opened yet").setEnabled(False)
        else:
            menu.addSeparator()
            menu.addAction("Clear this list", self._forget_recent)

    def _forget_recent(self) -> None:
        self._preferences.keep(replace(self._preferences.settings, recent_files=()))

    def _choose_nc_file(self, suffix: str, post: str) -> ExportPlace | None:
        """Ask for a file and, by its kind, for the control; that of a frame is the job's."""
        stem = self._document.path.stem if self._document.path else self._document.part.name
        posts = post_filters()
        own = next((each for each, name in posts.items() if name == post), "NC programs (*)")
        offered = list(posts) if not suffix else [own]
        dialog = QFileDialog(
            self._window, "Export NC", str(self._preferences.last_folder / f"{stem}{suffix}"), ";;".join(offered)
        )
        dialog.setAcceptMode(QFileDialog.AcceptMode.AcceptSave)
        dialog.setLabelText(QFileDialog.DialogLabel.FileType, "Control:")
        dialog.filterSelected.connect(lambda each: dialog.setDefaultSuffix(load_post(posts.get(each, post)).extension))
        dialog.selectNameFilter(own)
        dialog.setDefaultSuffix(load_post(post).extension)
        if not dialog.exec():
            return None
        return ExportPlace(Path(dialog.selectedFiles()[0]), posts.get(dialog.selectedNameFilter(), post))

    def _choose_post(self, post: str) -> None:
        """Have the job written for another control."""
        self._document.change_job("Post", replace(self._document.job, post=post))

    def _leave_drawing(self, what: str, act: Callable[[], None]) -> None:
        self.leave(f"{what}?", act)

    def leave(self, question: str, act: Callable[[], None]) -> None:
        """Do what ends the work on this drawing, after asking when changes would be lost."""
        if not self._would_lose:
            act()
            return
        path = self._document.path
        what = f"The changes to {path.name} are not saved." if path else "This drawing is in no file yet."
        self._window.notice.ask(
            f"{question} {what}",
            [
                ("Save", lambda: self.save_controller.save(lambda: self.leave(question, act))),
                ("Give up the changes", act),
                ("Keep drawing", lambda: None),
            ],
            stays=True,
        )

    def _on_closing(self) -> None:
        self._window.may_close = not self._would_lose
        if self._window.may_close:
            self._preferences.save()
        else:
            self.leave("Close?", self._close_anyway)

    def _close_anyway(self) -> None:
        self._given_up = self._document.state
        self._window.close()

    def _on_written(self, paths: list[Path], lines: int) -> None:
        names = ", ".join(path.name for path in paths)
        self._log.note(f"export {names}", f"{counted(lines, 'line')} written to {paths[0].parent}")
        self._window.status.show_message(f"{names} {'is' if len(paths) == 1 else 'are'} written.")

    def _on_opened(self, opened: OpenedDrawing) -> None:
        window = self._window
        if not opening_files.is_sample(opened.path):
            self._preferences.add_recent(opened.path)
        self.save_controller.known = opened.stamp
        self._computation.forget(opened.drawing.findings)
        self._log.note(f"open {opened.path.name}", self._opened_sentence(opened))
        window.notice.turn_over()
        self.reread_controller.know(opened)
        if opened.project is not None:
            self.save_controller.beside.mark_saved(opened.project.beside)
            self.bring(opened.project)
            return
        self._showing.show_view(View.DRAW)
        if opened.path == opening_files.sample_path():
            self._computation.start()
            self._showing.show_view(View.PATHS)
            tour = [] if window.preferences.settings.tour else [("Show me round", window.actions_["tour"].trigger)]
            window.notice.ask(FIRST_START, [*tour, ("Draw your own", self.ask_new)], of_job=True)
        elif opening_files.is_sample(opened.path):
            window.actions_["propose"].trigger()
        elif opened.drawing.question is not None:
            self._ask_after(opened)
        elif opened.job.part.entities:
            self.without_job.emit(opened.path.name)
        self._see_all()

    def _see_all(self) -> None:
        self._window.lay_out_now()
        self._window.canvas.fit()

    def bring(self, project: Project) -> None:
        """Bring back what a project file holds beside the document."""
        self._look(project.look)
        if wrong := self.save_controller.beside.bring(project.beside):
            self._log.note("picture", wrong, error=True)
            self._window.status.show_message(wrong, error=True)

    def _look_now(self) -> SavedView:
        """Return what is looked at, as a project file keeps it."""
        canvas = self._window.canvas
        return SavedView(self._showing.view.value, canvas.view.to_world(canvas.area.center()), canvas.view.scale)

    def _look(self, look: SavedView) -> None:
        canvas = self._window.canvas
        self._showing.show_view(next((view for view in views() if view.value == look.shown), View.DRAW))
        self._window.lay_out_now()
        if look.centre is None:
            canvas.fit()
        else:
            canvas.set_view(CanvasView(look.scale).zoomed(1.0, canvas.area.center()).centred(look.centre, canvas.area))

    def _opened_sentence(self, opened: OpenedDrawing) -> str:
        wide, high = opened.size
        findings = len(opened.drawing.findings)
        more = f" {counted(findings, 'remark')} on the drawing: see Compute, Findings." if findings else ""
        return f"{counted(len(opened.job.part.entities), 'curve')}, {grouped(wide)} by {grouped(high)} mm.{more}"

    def _ask_how(self, asked: UndecidedDrawing) -> None:
        """Ask how a drawing is to be read that cannot be opened before; what was to be said of changes has been
        said.
        """
        state = self._document.state

        def answer(reading: ReadingOptions) -> None:
            if self._document.state is state:
                self.open_controller.open(asked.path, reading)
            else:
                self.open_file(asked.path, reading)

        self._window.notice.dismiss()
        self._window.card.ask(asked.path.name, asked.question, answer, waits=True)

    def _ask_after(self, opened: OpenedDrawing) -> None:
        """Ask about a drawing that is open: what something was assumed about; once it was worked on, the answer is a
        step.
        """
        state, question = self._document.state, opened.drawing.question
        assert question is not None

        def answer(reading: ReadingOptions) -> None:
            if self._document.state is state:
                self.open_controller.open(opened.path, reading)
            else:
                self.reread_controller.ask(reading)

        self._window.card.ask(opened.path.name, question, answer, waits=False)
