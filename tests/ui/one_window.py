"""One window for many tests: made new after a test that left something behind, used again after one that did
not.
"""

from __future__ import annotations

from collections.abc import Iterable

from PySide6.QtCore import QCoreApplication, QEvent, Qt
from PySide6.QtGui import QAction
from PySide6.QtWidgets import QApplication, QMenu, QMessageBox, QToolButton, QWidget
from pytestqt.qtbot import QtBot

from app.core.settings import Settings, ThemeChoice
from app.drafting.commands.command import DraftingSession
from app.drafting.difference import DrawingDifference
from app.drafting.document import Document
from app.ui.framework.fade import FADE_MS
from app.ui.framework.fields import ChoiceField, NumberField
from app.ui.framework.view import View
from app.ui.framework.worker import Worker
from app.ui.panels.changes import Subject, SubjectKind
from app.ui.panels.reading_section import MODEL_SPACE
from app.ui.shell.bars.shortcuts import changed_keys
from app.ui.shell.drawing.inlay_controller import InlayForm
from app.ui.shell.new_job import MATERIALS
from app.ui.shell.start import build
from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.modes import CanvasTool, PathColourBy
from app.ui.views.canvas.view_transform import ViewTransform as CanvasView
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.cut_player import USUAL
from app.ui.views.nc.motion_shapes import ViewSide
from app.ui.views.nc.painting.motion_layer import MotionColourBy
from app.ui.views.nc.program_text import program_text
from app.ui.views.surfaces.panel import THE_SCENE
from app.ui.views.surfaces.scene_computation import SceneState
from app.ui.views.surfaces.scene_tabs import SCENE
from app.ui.views.surfaces.view import ViewDirection
from app.usecases.smoothing.result import SmoothOptions
from tests.ui.traces import fixed_values, left_in, traces
from tests.ui.words import Words, words_in

SIZE = (1280, 800)
CHILDREN = Qt.FindChildOption.FindDirectChildrenOnly
_COLOURS = [(colour, colour.value) for colour in CutColourBy]


class OneWindow:
    """Lends a window that is as new.

    Attributes:
        made: how many windows were made.
        left: what the last test that needed a new window after it had left behind, a line each.
    """

    def __init__(self) -> None:
        self.made = 0
        self.left: list[str] = []
        self._wiring: WindowController | None = None
        self._new: dict[str, object] | None = None
        self._view = CanvasView()
        self._kept: list[tuple[object, dict[str, object]]] = []
        self._kinds: list[tuple[QToolButton, QAction]] = []
        self._words: list[Words] = []

    def lend(self, qtbot: QtBot) -> WindowController:
        """Return a window as it is when the program starts, shown and active."""
        if self._wiring is None:
            _undress()
            window, self._wiring = build()
            self.made += 1
            window.resize(*SIZE)
            _activate(qtbot, self._wiring)
            if self._new is None:
                self._view = window.canvas.view
            reset(self._wiring, self._view)
            self._kinds = [(each, each.defaultAction()) for each in window.tool_strip.findChildren(QToolButton)]
            self._words = words_in(window)
            self._kept = [(owner, fixed_values(owner)) for owner in _prepared_when_shown(self._wiring)]
            if self._new is None:  # all new windows are alike
                self._new = traces(self._wiring)
        else:
            _activate(qtbot, self._wiring)
        return self._wiring

    def take_back(self) -> None:
        """Make the window as new for the next test, or else let go of it."""
        wiring = self._wiring
        if wiring is None or self._new is None:
            return
        reset(wiring, self._view)
        self._put_back()
        self.left = left_in(wiring, self._new)
        if self.left:
            self.close()

    def _put_back(self) -> None:
        """Let what is prepared anew whenever it is shown hold what it did in the beginning."""
        for button, action in self._kinds:
            if button.defaultAction() is not action:
                button.setDefaultAction(action)
        for owner, values in self._kept:
            for name, value in values.items():
                if getattr(owner, name) is not value:
                    setattr(owner, name, value)
        for words in self._words:
            words.put_back()

    def hide(self) -> None:
        """Take the window out of the way of tests that have none, or one of their own."""
        if self._wiring is not None:
            self._wiring.window_.hide()

    def close(self) -> None:
        """Let go of the window."""
        wiring, self._wiring = self._wiring, None
        if wiring is not None:
            end(wiring)


def _undress() -> None:
    """Take off the style sheet, as there is none yet when the program builds its window: every widget that is put into
    another one would have it worked out once more.
    """
    application = QApplication.instance()
    if isinstance(application, QApplication):
        application.setStyleSheet("")


def _activate(qtbot: QtBot, wiring: WindowController) -> None:
    window = wiring.window_

    if window.windowHandle() is not None and not window.isVisible():
        _take_activity(qtbot)
    with qtbot.waitActive(window):
        window.show()
        window.activateWindow()
    window.canvas.setFocus()
    QApplication.processEvents()
    assert window.isActiveWindow()


def _take_activity(qtbot: QtBot) -> None:
    """Have another window be active for a moment: to the platform one that was hidden still is, and so never becomes
    it.
    """
    other = QWidget()
    with qtbot.waitActive(other):
        other.show()
        other.activateWindow()
    other.close()
    other.deleteLater()


def reset(wiring: WindowController, view: CanvasView) -> None:
    """Leave everything that was opened, drawn, chosen, typed and computed, and look at the canvas as before."""
    window, empty = wiring.window_, Document()
    workers = window.findChildren(Worker)
    wiring.cancel()
    _end_jobs(workers)
    window.show()  # the test may have closed it
    _forget_texts(wiring)
    window.canvas.cancel()
    window.document.load(empty.job)
    wiring.computation.forget()
    wiring.computation.pixels = None
    window.may_close = True
    _forget_programs(wiring)
    wiring.cut_controller.back()
    window.notice.ask("")
    window.notice.hide()
    window.command_line.edit.clear()
    _forget_text(wiring)
    window.canvas.set_tool(CanvasTool.SELECT)
    window.actions_["tool_select"].setChecked(True)
    for name, on in (("snap", True), ("ortho", False), ("grid", False), ("log", True), ("backups", True)):
        window.actions_[name].setChecked(on)
    window.findings_list.hide()
    if not window.actions_["theme_system"].isChecked():
        window.set_theme_choice(ThemeChoice.SYSTEM)
    if window.preferences.settings.language is not Settings().language:
        wiring.translation_controller.choose(Settings().language)
    window.preferences.settings = Settings()
    window.status.show_place(0.0, 0.0)
    wiring.log.lines.clear()
    window.command_line.log.show_lines(wiring.log.lines)
    window.canvas.set_colour_by(PathColourBy.TOOL)
    wiring.display_controller.show_view(View.DRAW)
    _forget_start(wiring)
    _forget_scene(wiring)
    _forget_session(wiring)
    _close_what_stands_over(wiring)
    window.side.show_page("Drawing")  # it is filled while it is seen
    window.side.show_page("Job")
    window.panel.choose(Subject(SubjectKind.OPERATION, 0))
    window.views.fade._run.setCurrentTime(FADE_MS)
    window.resize(*SIZE)
    window.status.show_message("")
    _empty_what_is_hidden(wiring)
    _end_jobs(workers)
    _settle()
    window.canvas.set_view(view)
    wiring.focus_keeper._shown.stop()
    wiring.focus_keeper._give_back()  # now, and not in the next test
    _forget_habits(wiring)


def _end_jobs(workers: Iterable[Worker]) -> None:
    """Leave every job of the window, followed by its activity or not: an answer that comes later would be shown in the
    next test.
    """
    for worker in workers:
        worker.cancel()
        worker.finish(20.0)


def _forget_programs(wiring: WindowController) -> None:
    """Take away programs that are not the job's, and how the NC view was looked at."""
    view = wiring.window_.views.nc
    wiring.nc.stop_comparing()
    view.other.show_text("", program_text(b""))
    if wiring.nc.foreign:
        wiring.nc.back()
    for pane in (view.pane, view.other):
        pane.head._offer("as it looks")
    view.set_side(ViewSide.XY)
    view.path_head.colour.show_value(MotionColourBy.TOOL)
    view.set_colour(MotionColourBy.TOOL)


def _forget_text(wiring: WindowController) -> None:
    """Take away what was typed on the text page, tried, looked for and kept."""
    control, page = wiring.language.control, wiring.language.control.page
    if page.text or page.replaces:
        page.text = ""
        page.set_replaces(False)
    control.trial_runner.leave()
    control.trial_runner._session = DraftingSession()
    wiring.window_.canvas._stock_of = None
    if wiring.window_.canvas._trial != DrawingDifference():
        wiring.window_.canvas.show_trial(DrawingDifference())
    control._kept.clear()
    page.editor._found = ""
    page.finder.set_text(program_text(b""))


def _forget_session(wiring: WindowController) -> None:
    """Take away the session of 1986."""
    owner = wiring.session_1986
    if owner.session is not None and owner.tube is not None:
        owner.leave()
        owner.session.finish()
        owner._workspace.activity.ended.disconnect(owner.session.finish)
        for each in (owner.tube, owner.session):
            each.deleteLater()
        owner.session, owner.tube = None, None


def _close_what_stands_over(wiring: WindowController) -> None:
    """Take the tour and the help from the window."""
    wiring.tour.callout.hide()
    wiring.tour._ring.hide()
    wiring.tour.number = 0
    wiring.language.help.hide()
    wiring.language.help.list.clear()  # its rows are numbers of pages, which are none again
    wiring.language.help._laid_out.clear()
    views = wiring.window_.views
    for row in (*views.legend.rows.values(), *views.cut.legend.rows.values()):
        row.setChecked(True)
    wiring.palette.hide()
    wiring.palette._entries.clear()
    wiring.palette.edit.clear()
    wiring.palette.list.clear()
    window = wiring.window_
    window.views.start.show_files((), ())
    boxes = window.findChildren(QMessageBox, options=CHILDREN)
    for made in (*boxes, *window.findChildren(InlayForm), *window.canvas.findChildren(QMenu, options=CHILDREN)):
        made.setParent(None)
        made.deleteLater()


def _forget_start(wiring: WindowController) -> None:
    """Take the files from the page that the window begins with, and what was asked of a new part."""
    page, control = wiring.window_.views.start, wiring.start_controller
    control.worker.finish(20.0)
    control._left, control._painting, control._theme = [], None, None
    control._pictures.clear()
    page.show_files([], [])
    page.new.machine.set_choices([])
    page.new.material.show_value(MATERIALS[0])
    for field, value in zip(page.new.lengths, (80.0, 50.0, 10.0), strict=True):
        field.show_value(value)


def _forget_scene(wiring: WindowController) -> None:
    """Take the scene away, with what its panel and its text show."""
    work, side, view = wiring.scenes.work, wiring.window_.scene_side, wiring.window_.views.surfaces
    work.cancel()
    work.reading.worker.finish(20.0)
    if work.document.open:
        work.document.load("", None)
        work.document.open = False
        work.scene = work.shown = work.proven = None
        view.colours.setCurrentIndex(0)
        for switch in view.switches.values():
            switch.setChecked(True)
        view.show_nothing()
        view.set_look(ViewDirection.SPACE)
        side.show_page(SCENE)
        side.points.show_points(())
        side.panel._rows = {THE_SCENE: side.panel._rows[THE_SCENE]}
        for section in (side.panel.surfaces, side.panel.passes, side.panel.tools):
            section.fill((), side.panel._theme)
        side.panel.form.show_asks("", (), False)
        work._stand(SceneState.NONE)
    work._resting.stop()


def _prepared_when_shown(wiring: WindowController) -> tuple[object, ...]:
    """Return what nobody sees in a new window, and what is filled with what is shown before anybody does."""
    window, views = wiring.window_, wiring.window_.views
    cut, curves, reading = views.cut, window.curves_panel, window.drawing_page.reading
    form = window.panel.operation_form
    tool = window.panel.tool_form
    forms = (tool, tool.hold, window.panel.job_form)
    numbers = [each for of_form in forms for each in vars(of_form).values() if isinstance(each, NumberField)]
    picture, scene, surfaces = window.import_panel, window.scene_side, views.surfaces
    return (
        *(*forms, tool.hold.picture, window.panel.job_form.copies_picture, *numbers),
        *(
            wiring.inlay_controller,
            views.cut.profile,
            wiring.import_controller,
            picture,
            picture.despeckle,
            picture.dpi,
            picture.apart,
        ),
        *(wiring.scenes, wiring.scenes.work, scene.panel, scene.text, scene.text.editor, surfaces, surfaces.canvas),
        *(views.nc.path, views.curves.path),
        *(cut, cut.model, cut.render_scheduler, cut.playback, cut.overlay, cut.legend.key, window.cut_panel.histogram),
        *(reading.per_inch, reading.only, reading.layers, reading.types),
        *(curves.tolerance, curves.middle, curves.corner, curves.bend, wiring.smoothing_controller),
        *(each.field for each in form.fields.values()),
        *(wiring.language.control.trial_runner, wiring.plot_controller, wiring.plot_controller._preview),
        *(window.plot_panel, window.plot_panel.factor, window.canvas._trial_picture, wiring.language.help),
        *(wiring.stages_controller, views.stages.pixels, views.stages.pixels._hand),
        *(*views.start.new.lengths, views.start.new.corners),
        *(wiring.cleanup_controller, wiring.cleanup_controller._section.tolerance, wiring.tab_controller),
        *(wiring.purpose_words, wiring.context_menu),
        window.canvas.turns,
        *(window.stages_panel, window.stages_panel.points, window.stages_panel.pitch),
        *(form.peck_picture, form.side_picture, *window.cut_form.stock),
        *(views.cut_page.player, views.cut_page.transport.plot, wiring.files, wiring.files.open_controller),
    )


def _empty_what_is_hidden(wiring: WindowController) -> None:
    """Take away what forms and plots that are not seen any more were filled with."""
    window = wiring.window_
    window.canvas.set_findings(())
    wiring.cut_controller.player.speeds = dict(USUAL)
    tool, job = window.panel.tool_form, window.panel.job_form
    for choices in (tool.proposal.stock, tool.hold.holder, job.clamps):
        choices.set_choices([])
    window.drawing_page.reading.units.set_choices([])
    window.drawing_page.reading.to_zero.show_value(False)
    window.drawing_page.reading.layout_.set_choices([("", MODEL_SPACE)])
    window.views.cut.legend.colour.set_choices(_COLOURS)
    _choose_nothing(window.cut_form.heights)
    window.plot_panel.paths.switch.setChecked(False)
    window.curves_panel.show_options(SmoothOptions(), {})
    window.curves_panel.points._fill()
    window.views.curves.comb.setChecked(False)
    window.curves_panel.figures.clear()
    window.views.curves.deviation._cursor = None
    for field in (*(each.field for each in window.panel.operation_form.fields.values()), *vars(job).values()):
        if isinstance(field, ChoiceField):
            _choose_nothing(field)
    for holder in (window.cut_panel.histogram, window.views.curves.deviation):
        if holder._plot is not None:
            holder._plot.setParent(None)
            holder._plot.deleteLater()
            holder._plot = None
    window.findings_list._clear()
    window.findings_list._layers = frozenset()
    for field in (window.import_panel.see, window.import_panel.ink, window.import_panel.measure):
        _choose_nothing(field)
    card = window.card
    card.hide()
    card._clear()
    card.title.setText("")
    card.text.setText("")


def _choose_nothing(field: ChoiceField) -> None:
    field._group.setExclusive(False)
    for button in field.buttons.values():
        button.setChecked(False)
    field._group.setExclusive(True)


def _settle() -> None:
    """Let what is due happen, and what was thrown away go."""
    QApplication.processEvents()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
    QApplication.processEvents()


def _forget_habits(wiring: WindowController) -> None:
    """Let nobody remember what was typed and drawn last, its contours, and where the mouse was."""
    wiring._contours._kept = None
    legend = wiring.window_.views.legend
    legend.fold.setChecked(False)
    legend._folded_for_room, legend._fits = False, True
    wiring.window_.canvas.mouse = None
    line, runner = wiring.window_.command_line, wiring.window_.canvas.runner
    line._typed.clear()
    line._at = 0
    runner._last, runner.cursor = CanvasTool.LINE, (0.0, 0.0)
    runner._desk.numbers.clear()
    wiring.language.lines._line = ""
    if changed_keys(wiring.window_.actions_):
        wiring.shortcuts.reset_all()
        wiring.window_.preferences.settings = Settings()
    recovery = wiring.recovery_controller
    recovery._timer.stop()
    recovery._worker.finish(20.0)
    recovery._close()
    recovery._file, recovery._told = None, False
    recovery._left.clear()
    recovery._taken.clear()


def _forget_changes(wiring: WindowController) -> None:
    """Let nothing be asked about changes that are not saved."""
    wiring.document.load(wiring.document.job)
    _forget_texts(wiring)


def _forget_texts(wiring: WindowController) -> None:
    """Let nothing be asked about texts that are not saved."""
    wiring.language.control.text = ""
    wiring.window_.scene.document.setModified(False)


def end(wiring: WindowController) -> None:
    """Close a window as its user would, without being asked about changes."""
    window = wiring.window_
    window.worker.finish(20.0)
    _forget_changes(wiring)
    window.close()
    window.deleteLater()
    QCoreApplication.sendPostedEvents(None, QEvent.Type.DeferredDelete)
