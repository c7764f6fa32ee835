"""What happens when: connects the window's parts with the document, the worker and one another."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from pathlib import Path

from PySide6.QtCore import QObject

from ...core.settings import ThemeChoice
from ...drafting.document import DocumentChange
from ...model.operation import OPERATION_KINDS
from ..framework.controller import Controller
from ..framework.figures import counted
from ..framework.section import theme_children
from ..framework.verdict import Level, verdict
from ..framework.view import View, views
from ..framework.workspace import Workspace
from ..panels.changes import Subject, SubjectKind
from ..views.canvas.modes import CanvasTool
from ..views.curves.smoothing import Smoothing
from ..views.cut.cutting import Cutting
from ..views.cut.recorder import Recorder
from ..views.cut.saving import CutSaving
from ..views.nc.control import NcControl
from ..views.nc.reading import Shown
from ..views.nc.wiring import NcWiring
from ..views.plot.plotting import Plotting
from ..views.session1986.opening import SessionOpening
from ..views.stages.picturing import Picturing
from ..views.stages.staging import Staging
from ..views.surfaces.scene_control import SAMPLES, SceneControl, SceneProgram
from ..views.surfaces.scene_export import SceneExport
from .actions import Actions
from .advising import Advising
from .announcing import Announcing
from .cleaning import Cleaning
from .context_menu import ContextMenu
from .drawing_export import DrawingExport
from .engaging import Engaging
from .entering import Entering
from .files import Files, Openers
from .focus_keeping import FocusKeeper
from .help import show_about
from .help_window import HelpWindow
from .inspecting import PAGE as DRAWING_PAGE
from .inspecting import Inspecting
from .keys_window import KeysWindow
from .language import LanguageWiring
from .main_window import MainWindow
from .memory_choice import MemoryChoice
from .owning import OwnCurves
from .palette import Palette
from .proposing import ProposalControl
from .recovering import Recovering
from .shortcuts import Shortcuts
from .showing import Showing
from .snapping import Snapping
from .tabbing import Tabbing
from .tool_exchange import ToolExchange
from .tour import Landmarks, Tour
from .translation import Translating
from .underlaying import Underlaying
from .unit_choice import UnitChoice
from .views import Views
from .what_is_this import WhatIsThis

TOOLS = {f"tool_{tool.value}": tool for tool in CanvasTool}
TEXT_PAGE = "Text"
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


class Wiring(QObject):
    """The window's behaviour."""

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self.window_, self.document, self.computation = window, window.document, window.computation
        workspace, commands = window.workspace, window.actions_
        self.workspace, self.log = workspace, workspace.log
        self.showing = Showing(window)
        self._make_controllers(window.views, workspace)
        openers = Openers(self.nc.open, self.picturing.open, self.scenes.open)
        self.files = Files(window, self.showing, self.log, openers)
        self.recovering = Recovering(self.files, window.card, workspace)
        self._make_choices(workspace, commands)
        self._make_drawing_parts(workspace, commands)
        self._make_helpers(workspace, commands)
        self._connect_stages()
        self._connect_files()
        self._connect_scenes()
        self._connect_edit()
        self._connect_view()
        self._connect_job()
        self._connect_canvas()
        self._connect_controllers()
        self._connect_pages()
        self._connect_programs()
        self._connect_language()
        self._connect_helpers()
        self._unsubscribe = self.document.subscribe(self.showing.refresh)
        self.showing.show_view(View.DRAW)
        self.showing.refresh(DocumentChange.ALL)

    def _make_controllers(self, views: Views, workspace: Workspace) -> None:
        """Make what acts for the views, each of its own parts."""
        window = self.window_
        self.nc = NcControl(views.nc, workspace)
        self._nc_wiring = NcWiring(views.nc, self.nc, self.computation, window.actions_)
        self.cutting = Cutting(views.cut_page, window.cut_panel, window.cut_form, workspace)
        self.cut_saving, self.recorder = CutSaving(views.cut, workspace), Recorder(views.cut_page, workspace)
        self.staging = Staging(views.stages, window.stages_panel, workspace)
        self.picturing = Picturing(views.stages, window.import_panel, workspace)
        self.smoothing = Smoothing(views.curves, window.curves_panel, self.nc, workspace)
        self.scenes = SceneControl(views.surfaces, window.scene_side, window.scene, workspace)
        self.scene_export = SceneExport(views.surfaces, lambda: self.scenes.work.proven, workspace)
        self.plotting = Plotting(views.plot, window.plot_panel, workspace)
        self.session_1986 = SessionOpening(window, workspace)

    def _make_choices(self, workspace: Workspace, commands: Actions) -> None:
        """Make what lets the user choose and remembers it."""
        window, preferences = self.window_, workspace.preferences
        self.memory_choice = MemoryChoice(preferences, commands)
        self.unit_choice = UnitChoice(window, window.status, preferences, commands)
        self.snapping = Snapping(window.canvas.aiming, window.status, commands["polar"], preferences)
        self.shortcuts = Shortcuts(commands, preferences)
        self.translating = Translating(window, preferences, commands)

    def _make_drawing_parts(self, workspace: Workspace, commands: Actions) -> None:
        """Make what serves the drawing and its job."""
        window, canvas = self.window_, self.window_.canvas
        self.drawing_export = DrawingExport(window, workspace)
        self.tools = ToolExchange(window.panel, workspace)
        self.tabbing = Tabbing(window.panel, canvas, self.document)
        self.underlaying = Underlaying(canvas, workspace, commands)
        self.language = LanguageWiring(window.command_line.edit, HelpWindow(window), workspace, commands)
        self.files.saving.beside.watch(self.underlaying, self.language.control)
        self.advising = Advising(window.panel, workspace)
        self.proposing = ProposalControl(window.panel, workspace, commands)
        self.owning = OwnCurves(window.panel, canvas, workspace)
        self.inspecting = Inspecting(window.drawing_page, window.notice, commands)
        self.cleaning = Cleaning(window.drawing_page.cleanup, canvas, workspace)
        self.engaging = Engaging(canvas, window.views.legend, workspace)
        self.announcing = Announcing(workspace, self)
        self.entering = Entering(window.command_line, canvas, self.document)
        self.focus_keeper = FocusKeeper(window, window.views.take_focus)

    def _make_helpers(self, workspace: Workspace, commands: Actions) -> None:
        """Make what helps to find one's way."""
        window, views, preferences = self.window_, self.window_.views, workspace.preferences
        self.what_is_this = WhatIsThis(window, self.language.help)
        self.palette = Palette(views, commands, preferences, window.command_line.begin, self.files.open_file)
        self.palette.set_theme(window.theme)
        marks = Landmarks(views, window.tool_strip, window.command_line, window.status.badge, window.top_bar)
        self.tour = Tour(window, marks, preferences)

    def _connect_helpers(self) -> None:
        window, views = self.window_, self.window_.views
        self._on("export_drawing", self.drawing_export.start)
        self.drawing_export.failed.connect(self._say_error)
        for part in (self.drawing_export, self.tools, self.proposing):
            part.said.connect(self._say)
        self.proposing.failed.connect(self._say_error)
        self.underlaying.refused.connect(lambda text: window.status.show_message(text, error=True))
        window.panel.advice.place_wanted.connect(lambda x, y: window.canvas.go_to(x, y, closely=True))
        self.inspecting.front_wanted.connect(partial(self._show_side_page, DRAWING_PAGE))
        self._on("what_is_this", self.what_is_this.ask)
        self._on("palette", self.palette.open)
        self._on("tour", self.tour.start)
        for helper in (self.palette, self.tour):
            helper.left.connect(views.take_focus)

    def _connect_controllers(self) -> None:
        """Show what the controllers of views tell, and tell them whether their view is at the front."""
        self._connect_controller(self.staging, View.STAGES)
        self._connect_controller(self.picturing, View.STAGES)
        self._connect_controller(self.cutting, View.CUT)
        self._connect_controller(self.cut_saving, View.CUT)
        self._connect_controller(self.recorder, View.CUT)
        self._connect_controller(self.smoothing, View.CURVES)
        self._connect_controller(self.scenes, View.SURFACES)
        self._connect_controller(self.scene_export, View.SURFACES)
        self._connect_controller(self.nc, View.NC)
        for view, page in self.showing.pages.items():
            if page.controller is not None:
                self._connect_controller(page.controller, view)

    def _connect_controller(self, controller: Controller, view: View) -> None:
        controller.failed.connect(self._say_error)
        controller.said.connect(self._say)
        controller.changed.connect(self.showing.show_state)
        controller.front_wanted.connect(partial(self.showing.show_view, view))
        self.showing.view_changed.connect(lambda shown: controller.see(shown is view))

    def _connect_pages(self) -> None:
        """What lies over the views for a while: sheets of paper, a session of 1986."""
        plotting, session = self.plotting, self.session_1986
        self._on("plot", plotting.start)
        plotting.failed.connect(self._say_error)
        plotting.said.connect(self._say)
        plotting.front_wanted.connect(self._show_plot)
        plotting.left.connect(lambda: self.showing.show_view(self.showing.view))
        self.showing.view_changed.connect(lambda _: plotting.see(False))
        self._on("session_1986", session.open)
        session.left.connect(self.window_.views.take_focus)
        session.taken.connect(self._show_paths)

    def _show_plot(self) -> None:
        self.window_.views.show_plot()
        self.showing.show_missing()

    def _show_paths(self) -> None:
        self.showing.show_view(View.PATHS)
        self.window_.canvas.fit()

    def _connect_language(self) -> None:
        control, side = self.language.control, self.window_.side
        self.language.help.set_theme(self.window_.theme)
        side.add_page(TEXT_PAGE, control.page, "the drawing in words")
        theme_children(side, self.window_.theme)
        side.chosen.connect(self._on_side_page)
        control.page.editor.left.connect(self.window_.canvas.setFocus)
        control.tried.connect(self.window_.canvas.show_trial)
        control.front_wanted.connect(self._show_text)
        self.showing.view_changed.connect(lambda view: control.see(view in (View.DRAW, View.PATHS)))

    def _on_side_page(self, name: str) -> None:
        if name != DRAWING_PAGE:
            self.cleaning.give_up()
        self.showing.writing = name == TEXT_PAGE
        self.showing.show_missing()
        self.language.control.see(self.showing.view in (View.DRAW, View.PATHS))

    def _show_text(self) -> None:
        if self.showing.view not in (View.DRAW, View.PATHS):
            self.showing.show_view(View.DRAW)
        self.window_.side.show_page(TEXT_PAGE)

    def _show_side_page(self, name: str) -> None:
        """Bring a page of the right side to the front; where another view has something else there, Draw."""
        if self.window_.side.isHidden():
            self.showing.show_view(View.DRAW)
        self.window_.side.show_page(name)

    def _on(self, name: str, act: Callable[[], object]) -> None:
        self.window_.actions_[name].triggered.connect(lambda *_: act())

    def _connect_files(self) -> None:
        files = self.files
        self._on("new", files.ask_new)
        self._on("open", files.choose_file)
        self._on("sample", files.ask_sample)
        self._on("save", lambda: self.scenes.save() if self._on_scene else files.saving.save())
        self._on("save_as", lambda: self.scenes.save_as() if self._on_scene else files.saving.save_as())
        self._on("save_copy", files.saving.save_copy)
        files.saving.failed.connect(self._say_error)
        self._on("export", self.export)
        self._on("frame", files.exporting.start_frame)
        self._on("quit", self.window_.close)
        for part in (files.opening, files.rereading):
            part.failed.connect(self._say_error)
        files.exporting.failed.connect(self._say_error)
        files.exporting.show_findings.connect(self._show_worst)

    @property
    def _on_scene(self) -> bool:
        """Whether the scene is worked on rather than the drawing."""
        return self.showing.view is View.SURFACES and self.window_.scene.open

    def _connect_scenes(self) -> None:
        scenes = self.scenes
        self._on("scene_new", scenes.new)
        for name in SAMPLES:
            self._on(f"scene_{name}", partial(scenes.open_sample, name))
        self._on("scene_nc", scenes.show_nc)
        self._on("scene_cut", scenes.show_cut)
        scenes.nc_wanted.connect(self.nc.show_text)
        scenes.cut_wanted.connect(self._cut_scene)
        scenes.document.standing_changed.connect(self.showing.show_titles)
        scenes.close_wanted.connect(self.window_.close)
        self.window_.closing.connect(self._ask_scenes)
        view = self.window_.views.surfaces
        view.hovered.connect(self.showing.show_hovered)
        view.cursor_moved.connect(self.window_.status.show_place)

    def _ask_scenes(self) -> None:
        """Keep the window open while the scene's changes are asked about; those of the drawing come first."""
        self.window_.may_close = self.window_.may_close and self.scenes.may_close()

    def _connect_stages(self) -> None:
        view = self.window_.views.stages
        self.staging.changed.connect(self._show_stages)
        self._on("stages_again", self.staging.again)
        self.picturing.shown.connect(self._show_picture)
        self.picturing.taken.connect(self._on_picture_taken)
        view.hovered.connect(self.showing.show_hovered)
        view.pixels.cursor_moved.connect(self.window_.status.show_place)

    def _show_stages(self) -> None:
        self.showing.stages_missing = self.staging.missing

    def _show_picture(self) -> None:
        """Bring the picture to the front when it comes."""
        if self.picturing.preview is not None and self.showing.view is not View.STAGES:
            self.showing.show_view(View.STAGES)
        self.showing.show_prompt()
        self.showing.show_missing()

    def _on_picture_taken(self, path: Path) -> None:
        self.workspace.preferences.add_recent(path)
        self.window_.notice.hide()
        self.showing.show_view(View.STAGES)
        self.window_.canvas.fit()

    def _connect_edit(self) -> None:
        scene = self.window_.scene.document
        self._on("undo", lambda: scene.undo() if self._on_scene else self.document.undo())
        self._on("redo", lambda: scene.redo() if self._on_scene else self.document.redo())
        self._on(
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
        self._on("cut_picture", self.cut_saving.choose)
        self._on("record", self.recorder.ask)
        for view in views():
            self._on(view.value, partial(self.showing.show_view, view))
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
        actions["log"].toggled.connect(self.window_.command_line.log.setVisible)
        actions["log"].setChecked(True)
        self._on("command", self.window_.command_line.edit.setFocus)
        for choice in ThemeChoice:
            self._on(f"theme_{choice.value}", partial(self.window_.choose_theme, choice))
        self._on("keys", lambda: KeysWindow(self.window_, self.window_.actions_, self.shortcuts).show())
        self._on("about", lambda: show_about(self.window_))

    def _connect_job(self) -> None:
        panel, computation = self.window_.panel, self.computation
        self._on("job_properties", lambda: panel.choose(Subject(SubjectKind.JOB)))
        self._on("add_tool", panel.tools.added.emit)
        self._on("tool_library", panel.switch_library)
        self._on("which_tool", panel.switch_advice)
        self._on("import_tools", self.tools.choose_file)
        self._on("export_tools", self.tools.choose_place)
        for word, kind in OPERATION_KINDS.items():
            self._on(f"add_{word}", partial(panel.operations.added.emit, kind))
        self._on("compute", self.compute)
        self._on("cancel", self.cancel)
        self._on("findings", self.showing.open_findings)
        panel.refused.connect(self._say_error)
        computation.failed.connect(self._say_error)
        computation.finished.connect(self._on_computed)
        self.window_.status.cancelled.connect(self.cancel)

    def _connect_programs(self) -> None:
        """Show what the mouse is over in the NC and Curves views, and do what the NC view has the job do."""
        views, status, hovered = self.window_.views, self.window_.status, self.showing.show_hovered
        for path in (views.nc.path, views.curves.path):
            path.hovered.connect(hovered)
        views.curves.deviation.hovered.connect(hovered)
        views.nc.path.cursor_moved.connect(lambda x, y: status.show_place(x, y, views.nc.side.name))
        views.curves.path.cursor_moved.connect(lambda x, y: status.show_place(x, y, views.curves.side.name))
        self._on("curves_smooth", self.smoothing.bring_and_smooth)
        self.nc.export_wanted.connect(self.window_.actions_["export"].trigger)
        self.nc.compute_wanted.connect(self.window_.actions_["compute"].trigger)

    def _connect_canvas(self) -> None:
        canvas, window = self.window_.canvas, self.window_
        for name, tool in TOOLS.items():
            self._on(name, partial(self._take_tool, tool))
        window.actions_["tool_select"].setChecked(True)
        canvas.cursor_moved.connect(window.status.show_place)
        canvas.view_changed.connect(lambda: window.status.show_grid(canvas.grid_step))
        window.status.show_grid(canvas.grid_step)
        canvas.prompt_changed.connect(lambda _: self.showing.show_prompt())
        canvas.hovered.connect(self.showing.show_hovered)
        window.views.cut.hovered.connect(self.showing.show_hovered)
        window.views.cut.cell_picked.connect(lambda x, y, z, motion: self._go_to_motion(motion))
        window.cut_panel.line_wanted.connect(self._go_to_motion)
        self.nc.cut_wanted.connect(self._show_cut)
        window.views.cut.cursor_moved.connect(window.status.show_place)
        canvas.message.connect(lambda text: window.status.show_message(text, error=True))
        canvas.key_typed.connect(window.command_line.begin)
        canvas.tool_changed.connect(self._on_tool)
        self.context_menu = ContextMenu(canvas, self.document, window.actions_)

    def _take_tool(self, tool: CanvasTool) -> None:
        """Take a tool in hand, on the canvas."""
        if self.showing.view not in (View.DRAW, View.PATHS):
            self.showing.show_view(View.DRAW)
        self.window_.canvas.set_tool(tool)
        self._on_tool(self.window_.canvas.tool)

    def _on_tool(self, tool: CanvasTool) -> None:
        """Show which tool is in hand, where it can be used."""
        self.window_.actions_[f"tool_{tool.value}"].setChecked(True)
        if tool is not CanvasTool.SELECT:
            if self.showing.view not in (View.DRAW, View.PATHS):
                self.showing.show_view(View.DRAW)
            self.window_.views.take_focus()

    def run(self, line: str) -> None:
        """Carry out one line of the drawing language; what is wrong with it stands in the log."""
        self.language.lines.run(line)

    def compute(self) -> None:
        """Compute the paths and show them; in the Surfaces view the scene's, from its file as it is now."""
        self.window_.notice.dismiss()
        if self.showing.view is View.SURFACES:
            self.scenes.compute()
            return
        self.computation.start()
        if self.showing.view is View.DRAW:
            self.showing.show_view(View.PATHS)

    def export(self) -> None:
        """Export what the view at the front has made: the job's program, or of a scene a program, plot or table."""
        (self.scene_export if self.showing.view is View.SURFACES else self.files.exporting).start()

    def _show_worst(self) -> None:
        """Show the worst place of the job's cut where it is; what has none there is listed."""
        self.cutting.back()
        worst = next(
            (entry for entry in self.window_.cut_panel.entries if entry.counts and entry.place is not None), None
        )
        if worst is None:
            self.showing.open_findings()
            return
        self.showing.show_view(View.CUT)
        self.window_.cut_panel.choose(worst)

    def _show_cut(self, shown: Shown | None) -> None:
        """Show the cut of another program, or the job's own."""
        self.showing.show_view(View.CUT)
        if shown is None:
            self.cutting.back()
        else:
            self.cutting.show_program(shown.source, shown.dialect)

    def _cut_scene(self, program: SceneProgram) -> None:
        """Show what a scene's program leaves of its stock, beside the scene's surfaces."""
        self.showing.show_view(View.CUT)
        self.cutting.show_program(program.source, program.dialect, program.part)

    def _go_to_motion(self, motion: int) -> None:
        """Show the line of a motion of the cut program, if that is the one which the NC view shows, or can."""
        cut, nc = self.cutting.cut, self.nc
        if cut is None or motion < 0:
            return
        name = cut.names[cut.file_of(motion)]
        if cut.given is None and nc.foreign:
            nc.back()
        if cut.given is None or (nc.source is not None and nc.source.name == name):
            self.showing.show_view(View.NC)
            nc.pick_motion(cut.file_of(motion), cut.row_in_file(motion))

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
            answer = verdict(made.findings, made.report.data)
            self.log.note(
                "compute", f"{counted(len(made.program.moves), 'move')}. {answer.text}", error=answer.level is Level.BAD
            )

    def _say(self, text: str) -> None:
        self.window_.status.show_message(text)

    def _say_error(self, text: str) -> None:
        self.window_.status.show_message(text, error=True)
        self.window_.notice.ask(text, error=True)
