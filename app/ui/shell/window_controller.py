"""What happens when: connects the window's parts with the document, the worker and one another."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject, Qt
from PySide6.QtWidgets import QWidget

from ...core.resources import resource
from ...core.settings import Language, ThemeChoice
from ...drafting.document import DocumentChange
from ...model.operation_kinds import OPERATION_KINDS
from ..framework.commands import on_trigger
from ..framework.controller import Controller
from ..framework.figures import counted
from ..framework.verdict import VerdictLevel, verdict_summary
from ..framework.view import View, views
from ..framework.workspace import Workspace
from ..panels.changes import Subject, SubjectKind
from ..views.canvas.modes import CanvasTool
from ..views.curves.better_controller import BetterController
from ..views.curves.controller import SmoothingController
from ..views.cut.controller import CutController
from ..views.cut.image_controller import ImageController
from ..views.cut.recording_controller import RecordingController
from ..views.nc.action_controller import NcActionController
from ..views.nc.controller import NcController
from ..views.plot.controller import PlotController
from ..views.session1986.controller import SessionController
from ..views.stages.controller import StagesController
from ..views.stages.figure_eleven_controller import FigureElevenController
from ..views.stages.import_controller import ImportController
from ..views.stages.text_film_controller import TextFilmController
from ..views.surfaces.controller import SceneController
from ..views.surfaces.export_controller import SceneExportController
from .announcing import Announcing
from .bars.actions import Actions
from .bars.command_line_controller import CommandLineController
from .bars.command_palette import CommandPalette
from .bars.shortcuts import Shortcuts
from .bars.snap_controller import SnapController
from .bars.unit_choice import UnitChoice
from .display_controller import DisplayController
from .drawing.advice_controller import AdviceController
from .drawing.cleanup_controller import CleanUpController
from .drawing.context_menu import ContextMenu
from .drawing.contour_store import ContourStore
from .drawing.drawing_page_controller import PAGE as DRAWING_PAGE
from .drawing.drawing_page_controller import DrawingPageController
from .drawing.engagement_controller import EngagementController
from .drawing.inlay_controller import InlayController
from .drawing.owned_curves_controller import OwnedCurvesController
from .drawing.proposal_controller import ProposalController
from .drawing.purpose_words import PurposeWords
from .drawing.selection_ribbon import SelectionRibbon
from .drawing.selection_ways import SelectionWays
from .drawing.shape_language_controller import ShapeLanguageController
from .drawing.tab_controller import TabController
from .drawing.template_controller import TemplateController
from .drawing.unseen_controller import UnseenController
from .file_controller import FileController, Openers
from .files.drawing_export_controller import DrawingExportController
from .files.open_controller import SAMPLE_PROGRAMS
from .files.own_film_files import OwnFilmFiles
from .files.sheet_export_controller import SheetExportController
from .files.tool_exchange import ToolExchange
from .files.underlay_controller import UnderlayController
from .focus_keeping import FocusKeeper
from .help.about import show_about
from .help.help_window import HelpWindow
from .help.keys_window import KeysWindow
from .help.tour import Landmarks, Tour
from .help.what_is_this import WhatIsThis
from .main_window import MainWindow
from .memory_choice import MemoryChoice
from .new_job import NewPart, new_job
from .program_coordinator import ProgramCoordinator
from .recovery_controller import RecoveryController
from .scene_coordinator import SceneCoordinator
from .stages_coordinator import StagesCoordinator
from .start_page.controller import StartController
from .text_page_coordinator import TextPageCoordinator
from .translation import TranslationController
from .view_stack import ViewStack
from .zoom_coordinator import ZoomCoordinator

TOOLS = {f"tool_{tool.value}": tool for tool in CanvasTool}
JOB_PAGE = "Job"
WORDS = {
    "compute": "compute",
    "cancel": "cancel",
    "f": "fit",
    "fit": "fit",
    "export": "export",
    "new": "new",
    "open": "open",
    "findings": "findings",
    "save": "save",
}


class WindowController(QObject):
    """The window's behaviour."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self.window_, self.document, self.computation = window, window.document, window.computation
        workspace, commands = window.workspace, window.actions_
        self.workspace, self.log = workspace, workspace.log
        self._on, self._contours = partial(on_trigger, commands), ContourStore()
        self.display_controller = DisplayController(window)
        self._make_controllers(window.views, workspace)
        openers = Openers(
            self.nc.open,
            self.import_controller.open,
            self.scenes.open,
            self.scenes.open_solid,
            self._open_tools,
            lambda path: self.template_controller.apply(path),
        )
        self.files = FileController(window, self.display_controller, self.log, openers)
        self.recovery_controller = RecoveryController(self.files, window.card, workspace)
        self._make_choices(workspace, commands)
        self._make_drawing_parts(workspace, commands)
        self._make_helpers(workspace, commands)
        self._make_coordinators(window)
        self._connect_files()
        self._connect_edit()
        self._connect_view()
        self._connect_job()
        self._connect_canvas()
        self._connect_controllers()
        self._connect_pages()
        self._connect_helpers()
        self._connect_start()
        self.document.subscribe(self._on_change)
        self.display_controller.show_view(View.DRAW)
        self.display_controller.refresh(DocumentChange.ALL)

    def _make_controllers(self, views: ViewStack, workspace: Workspace) -> None:
        """Make what acts for the views, each of its own parts."""
        window = self.window_
        self.nc = NcController(views.nc, workspace)
        self._nc_wiring = NcActionController(views.nc, self.nc, self.computation, window.actions_)
        self.cut_controller = CutController(views.cut_page, window.cut_panel, window.cut_form, workspace)
        self.image_controller, self.recorder = (
            ImageController(views.cut, workspace),
            RecordingController(views.cut_page, workspace),
        )
        self.stages_controller = StagesController(views.stages, window.stages_panel, workspace)
        own = OwnFilmFiles(self.nc, window.scene, self.cut_controller)
        self.film_controller = TextFilmController(views.stages, window.film_panel, own.of, workspace)
        self.figure_eleven = FigureElevenController(views.stages, window.film_panel, own.of, workspace)
        self.import_controller = ImportController(views.stages, window.import_panel, workspace)
        self.smoothing_controller = SmoothingController(views.curves, window.curves_panel, self.nc, workspace)
        self.better_controller = BetterController(views.curves, window.curves_panel, self.nc, workspace)
        self.scenes = SceneController(views.surfaces, window.scene_side, window.scene, workspace)
        self.scene_export = SceneExportController(views.surfaces, lambda: self.scenes.work.proven, workspace)
        self.plot_controller = PlotController(views.plot, window.plot_panel, workspace)
        self.session_1986 = SessionController(window, workspace)

    def _make_choices(self, workspace: Workspace, commands: Actions) -> None:
        """Make what lets the user choose and remembers it."""
        window, preferences = self.window_, workspace.preferences
        self.memory_choice = MemoryChoice(preferences, commands)
        self.unit_choice = UnitChoice(window, window.status, preferences, commands)
        self.snap_controller = SnapController(window.canvas.snap_state, window.status, commands["polar"], preferences)
        self.shortcuts = Shortcuts(commands, preferences)
        self.translation_controller = TranslationController(window, preferences, commands)
        for choice in Language:  # lists are made in the language that is spoken then
            on_trigger(commands, f"language_{choice.value}", window.panel.refresh)

    def _make_drawing_parts(self, workspace: Workspace, commands: Actions) -> None:
        """Make what serves the drawing and its job."""
        window, canvas = self.window_, self.window_.canvas
        self.drawing_export = DrawingExportController(window, workspace)
        self.sheet_export = SheetExportController(window, workspace)
        self.inlay_controller = InlayController(window, workspace, commands)
        self.tools = ToolExchange(window.panel, workspace)
        self.tab_controller = TabController(window.panel, canvas, self.document)
        self.underlay_controller = UnderlayController(canvas, workspace, commands)
        self.language = ShapeLanguageController(window.command_line.edit, HelpWindow(window), workspace, commands)
        self.files.save_controller.beside.watch(self.underlay_controller, self.language.control)
        self.unseen_controller = UnseenController(canvas, self.language.lines, workspace)
        self.advice_controller = AdviceController(window.panel, workspace)
        self.proposal_controller = ProposalController(window.panel, workspace, commands)
        self.template_controller = TemplateController(window.panel, workspace, commands)
        self.purpose_words = PurposeWords(window.panel, canvas, workspace, self.proposal_controller, self._contours)
        self.owned_curves = OwnedCurvesController(window.panel, canvas, workspace, self._contours)
        self.drawing_page_controller = DrawingPageController(window.drawing_page, window.notice, commands)
        self.cleanup_controller = CleanUpController(window.drawing_page.cleanup, canvas, workspace)
        self.engagement_controller = EngagementController(canvas, window.views.legend, workspace)
        self.announcing = Announcing(workspace, self)
        self.command_line_controller = CommandLineController(window.command_line, canvas, workspace)
        self.focus_keeper = FocusKeeper(window, window.views.take_focus)
        self.start_controller = StartController(window.views.start, workspace)

    def _make_helpers(self, workspace: Workspace, commands: Actions) -> None:
        """Make what helps to find one's way."""
        window, views, preferences = self.window_, self.window_.views, workspace.preferences
        self.what_is_this = WhatIsThis(window, self.language.help)
        self.palette = CommandPalette(views, commands, preferences, window.command_line.begin, self.files.open_file)
        self.palette.set_theme(window.theme)
        marks = Landmarks(views, window.tool_strip, window.command_line, window.status.badge, window.top_bar)
        self.tour = Tour(window, marks, preferences)

    def _make_coordinators(self, window: MainWindow) -> None:
        """Make what connects a view's controllers with one another and with the window."""
        display = self.display_controller
        StagesCoordinator(window, display, self.stages_controller, self.film_controller, self.import_controller)
        self._scene = SceneCoordinator(window, display, self.scenes, self.nc, self.cut_controller)
        self._programs = ProgramCoordinator(window, display, self.nc, self.cut_controller)
        TextPageCoordinator(window, display, self.language)
        self._zoom = ZoomCoordinator(window, display, self.nc, self.smoothing_controller)
        window.side.chosen.connect(self._on_side_page)

    def _on_side_page(self, name: str) -> None:
        if name != DRAWING_PAGE:
            self.cleanup_controller.give_up()

    def _connect_helpers(self) -> None:
        window, views = self.window_, self.window_.views
        self._on("export_drawing", self.drawing_export.start)
        self._on("sheet", lambda: self.proposal_controller.before(self.sheet_export.start))
        self.files.open_controller.opened.connect(self.proposal_controller.know)
        self.files.without_job.connect(self.proposal_controller.offer)
        makers = (self.inlay_controller, self.proposal_controller, self.template_controller)
        for part in (self.drawing_export, self.sheet_export, *makers):
            part.failed.connect(self._say_error)
            part.said.connect(self._say)
        self.tools.said.connect(self._say)
        self.underlay_controller.refused.connect(lambda text: window.status.show_message(text, error=True))
        window.panel.advice.place_requested.connect(lambda x, y: window.canvas.go_to(x, y, closely=True))
        self.drawing_page_controller.front_requested.connect(partial(self._show_side_page, DRAWING_PAGE))
        self._on("what_is_this", self.what_is_this.ask)
        self._on("palette", self.palette.open)
        self._on("tour", self.tour.start)
        for helper in (self.palette, self.tour):
            helper.left.connect(views.take_focus)

    def _connect_controllers(self) -> None:
        """Show what the controllers of views tell, and tell them whether their view is at the front."""
        self._connect_controller(self.stages_controller, View.STAGES)
        self._connect_controller(self.film_controller, View.STAGES)
        self._connect_controller(self.figure_eleven, View.STAGES)
        self._connect_controller(self.import_controller, View.STAGES)
        self._connect_controller(self.cut_controller, View.CUT)
        self._connect_controller(self.image_controller, View.CUT)
        self._connect_controller(self.recorder, View.CUT)
        self._connect_controller(self.smoothing_controller, View.CURVES)
        self._connect_controller(self.better_controller, View.CURVES)
        self._connect_controller(self.scenes, View.SURFACES)
        self._connect_controller(self.scene_export, View.SURFACES)
        self._connect_controller(self.nc, View.NC)
        for view, page in self.display_controller.pages.items():
            if page.controller is not None:
                self._connect_controller(page.controller, view)

    def _connect_controller(self, controller: Controller, view: View) -> None:
        self.display_controller.ask(controller, view)
        controller.failed.connect(self._say_error)
        controller.said.connect(self._say)
        controller.changed.connect(self.display_controller.show_state)
        controller.front_requested.connect(partial(self.display_controller.show_view, view))
        self.display_controller.view_changed.connect(lambda shown: controller.see(shown is view))

    def _connect_pages(self) -> None:
        """What lies over the views for a while: sheets of paper, a session of 1986."""
        plotting, session = self.plot_controller, self.session_1986
        self._on("curves_smooth", self.smoothing_controller.bring_and_smooth)
        self._on("plot", plotting.start)
        plotting.failed.connect(self._say_error)
        plotting.said.connect(self._say)
        plotting.front_requested.connect(self._show_plot)
        plotting.left.connect(lambda: self.display_controller.show_view(self.display_controller.view))
        self.display_controller.view_changed.connect(lambda _: plotting.see(False))
        self._on("session_1986", session.open)
        session.left.connect(self.window_.views.take_focus)
        session.taken.connect(self._show_paths)

    def _show_plot(self) -> None:
        self.window_.views.show_plot()
        self.display_controller.show_missing()

    def _show_paths(self) -> None:
        self.display_controller.show_view(View.PATHS)
        self.window_.canvas.fit()

    def _show_side_page(self, name: str) -> None:
        """Bring a page of the right side to the front; where another view has something else there, Draw."""
        if self.window_.side.isHidden():
            self.display_controller.show_view(View.DRAW)
        self.window_.side.show_page(name)

    def _beside_job(self, act: Callable[[], object]) -> None:
        """Do something in the job's panel, which is brought to the front, so that it is seen."""
        self._show_side_page(JOB_PAGE)
        act()

    def _switch(self, section: QWidget, switch: Callable[[], None]) -> None:
        """Open a section of the job's panel, or close it where it is seen; one that is covered comes to the front."""
        seen = section.isVisible()
        self._show_side_page(JOB_PAGE)
        if seen or section.isHidden():
            switch()

    def _connect_files(self) -> None:
        files = self.files
        self._on("new", files.ask_new)
        self._on("open", files.choose_file)
        self._on("sample", files.open_sample)
        for name in SAMPLE_PROGRAMS:
            self._on(f"program_{name}", partial(files.open_file, resource("samples", f"{name}.ngc")))
        on_trigger(
            self.window_.actions_,
            "save",
            lambda: self.scenes.save() if self._scene.at_front else files.save_controller.save(),
        )
        on_trigger(
            self.window_.actions_,
            "save_as",
            lambda: self.scenes.save_as() if self._scene.at_front else files.save_controller.save_as(),
        )
        self._on("save_copy", files.save_controller.save_copy)
        files.save_controller.failed.connect(self._say_error)
        self._on("export", self.export)
        self._on("frame", files.export_controller.start_frame)
        self._on("quit", self.window_.close)
        for part in (files.open_controller, files.reread_controller):
            part.failed.connect(self._say_error)
        files.export_controller.failed.connect(self._say_error)
        files.export_controller.show_findings.connect(self._programs.show_worst)

    def _connect_start(self) -> None:
        """The page that the window begins with."""
        page, files = self.window_.views.start, self.files
        self.start_controller.shown.connect(self.display_controller.show_start)
        page.opened.connect(files.open_file)
        page.sampled.connect(files.open_sample)
        page.new.begun.connect(self._begin)
        page.left.connect(lambda: self.display_controller.show_view(View.DRAW))
        self.display_controller.view_changed.connect(lambda _: self.start_controller.close())
        files.begun.connect(self.open_start)

    def open_start(self) -> None:
        """Show the last files, samples, and what a new part is to be; what was said of the part before goes."""
        self.window_.notice.dismiss()
        self.start_controller.open(self.window_.theme)
        self.window_.views.start.new.lengths[0].edit.setFocus()

    def _begin(self, part: NewPart) -> None:
        """Begin a new part of a size, for a machine and a material."""
        self.document.load(new_job(part))
        self.computation.forget()
        self.display_controller.show_view(View.DRAW)
        self.window_.lay_out_now()
        fit = self.window_.canvas.fit
        if part.outline:
            self.language.lines.ran.connect(lambda *_: fit(), Qt.ConnectionType.SingleShotConnection)
            self.run(part.line())
        else:
            fit()

    def _open_tools(self, path: Path) -> None:
        """Take tools into the library, and show it."""
        self._show_side_page(JOB_PAGE)
        if self.window_.panel.library.isHidden():
            self.window_.panel.switch_library()
        self.tools.take(path)

    def _connect_edit(self) -> None:
        scene = self.window_.scene.document
        on_trigger(
            self.window_.actions_, "undo", lambda: scene.undo() if self._scene.at_front else self.document.undo()
        )
        on_trigger(
            self.window_.actions_, "redo", lambda: scene.redo() if self._scene.at_front else self.document.redo()
        )
        on_trigger(
            self.window_.actions_,
            "delete",
            lambda: (
                self.run("delete") if self.document.selection else self._say("Nothing is selected; click a line first.")
            ),
        )
        self._on("select_all", lambda: self.run("select all"))
        line = self.window_.command_line
        line.entered.connect(self._on_entered)
        line.accepted.connect(self.window_.canvas.accept)
        line.cancelled.connect(self._on_escape)

    def _connect_view(self) -> None:
        canvas, actions = self.window_.canvas, self.window_.actions_
        self._on("cut_picture", self.image_controller.choose)
        self._on("record", self.recorder.ask)
        for view in views():
            self._on(view.value, partial(self.display_controller.show_view, view))
        self._on("fit", lambda: self.window_.views.viewport.fit())
        self._on("zoom_in", lambda: self.window_.views.viewport.zoom_by(1.5))
        self._on("zoom_out", lambda: self.window_.views.viewport.zoom_by(1 / 1.5))
        status = self.window_.status
        switches = (
            ("snap", status.snap, canvas.set_snap),
            ("ortho", status.ortho, canvas.set_ortho),
            ("grid", status.grid, canvas.set_grid_snap),
        )
        for name, button, switch in switches:
            actions[name].toggled.connect(switch)
            actions[name].toggled.connect(button.setChecked)
            button.clicked.connect(actions[name].setChecked)
        actions["snap"].setChecked(True)
        actions["log"].toggled.connect(lambda _: self.display_controller.show_log())
        actions["log"].setChecked(True)
        self._on("command", self.window_.command_line.edit.setFocus)
        for choice in ThemeChoice:
            self._on(f"theme_{choice.value}", partial(self.window_.choose_theme, choice))
        on_trigger(
            self.window_.actions_,
            "keys",
            lambda: KeysWindow(self.window_, self.window_.actions_, self.shortcuts).show(),
        )
        self._on("about", lambda: show_about(self.window_))

    def _connect_job(self) -> None:
        panel, computation = self.window_.panel, self.computation
        self._on("job_properties", partial(self._beside_job, lambda: panel.choose(Subject(SubjectKind.JOB))))
        self._on("add_tool", partial(self._beside_job, panel.tools.added.emit))
        self._on("tool_library", partial(self._switch, panel.library, panel.switch_library))
        self._on("which_tool", partial(self._switch, panel.advice, panel.switch_advice))
        self._on("import_tools", self.tools.choose_file)
        self._on("export_tools", self.tools.choose_place)
        for word, kind in OPERATION_KINDS.items():
            self._on(f"add_{word}", partial(self._beside_job, partial(panel.operations.added.emit, kind)))
        self._on("compute", self.compute)
        self._on("cancel", self.cancel)
        self._on("findings", self.display_controller.open_findings)
        panel.refused.connect(self._say_error)
        computation.failed.connect(self._say_error)
        computation.finished.connect(self._on_computed)
        self.window_.status.cancelled.connect(self.cancel)

    def _connect_canvas(self) -> None:
        canvas, window = self.window_.canvas, self.window_
        for name, tool in TOOLS.items():
            self._on(name, partial(self._take_tool, tool))
        window.actions_["tool_select"].setChecked(True)
        canvas.cursor_moved.connect(window.status.show_place)
        canvas.view_changed.connect(lambda: window.status.show_grid(canvas.grid_step))
        window.status.show_grid(canvas.grid_step)
        canvas.prompt_changed.connect(lambda _: self.display_controller.show_prompt())
        canvas.hovered.connect(self.display_controller.show_hovered)
        canvas.message.connect(lambda text: window.status.show_message(text, error=True))
        for typed in (canvas.key_typed, window.key_typed):
            typed.connect(window.command_line.begin)
        canvas.tool_changed.connect(self._on_tool)
        self.selection_ways = SelectionWays(window.workspace, self._contours, window)
        self.ribbon = SelectionRibbon(canvas, self.document, window.actions_, self.selection_ways)
        self.context_menu = ContextMenu(canvas, self.document, window.actions_, self.selection_ways)

    def _take_tool(self, tool: CanvasTool) -> None:
        """Take a tool in hand, on the canvas."""
        if self.display_controller.view not in (View.DRAW, View.PATHS) or self.window_.views.starting:
            self.display_controller.show_view(View.DRAW)
        self.window_.canvas.set_tool(tool)
        self._on_tool(self.window_.canvas.tool)

    def _on_tool(self, tool: CanvasTool) -> None:
        """Show which tool is in hand, where it can be used."""
        self.window_.actions_[f"tool_{tool.value}"].setChecked(True)
        if tool is not CanvasTool.SELECT:
            if self.display_controller.view not in (View.DRAW, View.PATHS):
                self.display_controller.show_view(View.DRAW)
            self.window_.views.take_focus()

    def _on_change(self, change: DocumentChange) -> None:
        """Let nothing stand that speaks of what was before; the cut of another program goes with the drawing beside
        which it was looked at.
        """
        if change & (DocumentChange.PART | DocumentChange.JOB):
            self.window_.notice.lapse()
        if change & DocumentChange.LOADED:
            self.cut_controller.back()
        if change & DocumentChange.PART and self.window_.views.starting:
            self.display_controller.show_view(View.DRAW)
        self.display_controller.refresh(change)

    def run(self, line: str) -> None:
        """Carry out one line of the drawing language; what is wrong with it stands in the log."""
        self.language.lines.run(line)

    def compute(self) -> None:
        """Compute the paths and show them; where a scene is worked on its own, from its file as it is now; a picture
        that is looked at becomes the part first.
        """
        self.window_.notice.dismiss()
        if self._scene.at_front:
            self.scenes.compute()
            return
        if self.display_controller.on_picture() and not self.display_controller.opening:
            self.import_controller.take(self._compute_drawing)
            return
        self.files.open_controller.once_open(self._compute_drawing)

    def _compute_drawing(self) -> None:
        self._programs.show_own()
        self.proposal_controller.before(self._compute_job)

    def _compute_job(self) -> None:
        self.computation.start()
        if self.display_controller.view in (View.DRAW, View.SURFACES):
            self.display_controller.show_view(View.PATHS)

    def export(self) -> None:
        """Export what is worked on: the job's program, or of a scene a program, plot or table."""
        if self._scene.at_front:
            self.scene_export.start()
        else:
            before = partial(self.proposal_controller.before, self.files.export_controller.start)
            self.files.open_controller.once_open(before)

    def cancel(self) -> None:
        """Leave the running job."""
        if self.window_.activity.cancel():
            self._say("Cancelled; nothing has changed.")

    def _on_entered(self, text: str) -> None:
        name = None if self.window_.canvas.runner.takes(text) else WORDS.get(text.lower())
        if name is not None:
            self.window_.actions_[name].trigger()
            self.window_.views.take_focus()
        elif not self.window_.canvas.type_text(text):
            self.run(self.unit_choice.meant(text))
        elif not self.window_.canvas.runner.wants_words:
            self.window_.views.take_focus()

    def _on_escape(self) -> None:
        self.window_.canvas.cancel()
        self.window_.views.take_focus()

    def _on_computed(self) -> None:
        made = self.computation.made
        if made is not None:
            answer = verdict_summary(made.findings, made.report.data)
            self.log.note(
                "compute",
                f"{counted(len(made.program.moves), 'move')}. {answer.text}",
                error=answer.level is VerdictLevel.BAD,
            )

    def _say(self, text: str) -> None:
        self.window_.status.show_message(text)

    def _say_error(self, text: str) -> None:
        self.window_.notice.ask(text, error=True, of_job=True)
