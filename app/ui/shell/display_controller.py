"""Keeps what the window shows in step with the document and the computation: views, badge, titles, enabled actions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ...drafting.document import DocumentChange
from ...drafting.expressions.words import name_text
from ...geometry.sample import Box, bounds, union
from ...model.finding import Finding
from ...model.job import Job
from ...model.part import Part
from ...model.stock_box import StockBox, drawn_stock, stock_box
from ..framework.catalogue import active_language
from ..framework.computation import ComputationState
from ..framework.controller import Controller, OfferedMend, ShownDocument
from ..framework.missing import NOTHING
from ..framework.samples import PathLineKind
from ..framework.verdict import VerdictLevel, VerdictSummary, verdict_summary
from ..framework.view import View, ViewPage
from ..panels.lists import OperationTimes
from ..views.canvas.modes import PathColourBy, PathLayers
from ..views.canvas.painting.program_layer import ProgramLayer
from .files.open_controller import extent_of, size_of
from .main_window import MainWindow
from .view_pages import pages_of

if TYPE_CHECKING:
    from ...usecases.mending import Mend

_LAYERS = {
    PathLineKind.PART: PathLayers.PART,
    PathLineKind.POCKET: PathLayers.POCKET,
    PathLineKind.REST: PathLayers.REST,
    PathLineKind.CONTOUR: PathLayers.CONTOUR,
    PathLineKind.TAB: PathLayers.TAB,
    PathLineKind.LINK: PathLayers.LINK,
    PathLineKind.RAPID: PathLayers.RAPID,
    PathLineKind.PLUNGE: PathLayers.PLUNGE,
    PathLineKind.LEFT: PathLayers.LEFT,
    PathLineKind.UNREACHABLE: PathLayers.UNREACHABLE,
    PathLineKind.CLAMP: PathLayers.CLAMP,
}


@dataclass(frozen=True, eq=False, repr=False)
class _Teller:
    """Who tells what a view shows."""

    view: View
    controller: Controller


def _within(name: str) -> str:
    """Return the name of a change as it stands behind a verb: small in English, elsewhere as it is looked up."""
    return name[0].lower() + name[1:] if active_language() == "en" else name


def _same_curves(one: Job, other: Job) -> bool:
    """Tell whether two jobs lay the same drawing and the same copies into their stock, however they machine it."""
    laid = ("copies", "keep_out_layers", "layer_names")
    return one.part is other.part and all(getattr(one, name) == getattr(other, name) for name in laid)


START_PROMPT = "Choose a file or a sample, begin a part, or type a line such as  rect 0,0 80,50"


class DisplayController(QObject):
    """Reads the state and shows it; changes nothing but the window, and what the list of findings is asked to mend.

    Signals:
        view_changed(View): another view came to the front.

    Attributes:
        view: the one at the front. stages_missing, film_missing: what the stages lack.
        pages: of every view. on_scene: tells whether a scene is worked on at the front rather than the drawing.
        on_picture: tells whether a picture is looked at that is no part yet.
        writing: the drawing is being written as a text, so that nothing need be said of an empty one.
        opening: name of the file that is being read, "" = none is.
    """

    view_changed = Signal(View)

    def __init__(self, window: MainWindow) -> None:
        super().__init__(window)
        self._window = window
        self._document, self._computation = window.document, window.computation
        self.view = View.DRAW
        self.on_scene: Callable[[], bool] = lambda: False
        self.on_picture: Callable[[], bool] = lambda: False
        self.stages_missing, self.film_missing, self.writing, self.opening = NOTHING, NOTHING, False, ""
        self.pages = pages_of(window, self)
        window.take_pages(self.pages)
        self._layers = PathLayers.ALL
        self._tellers: list[_Teller] = []
        self._shown_program: object = None
        self._empty_action = "open"
        self._extent: tuple[Part, tuple[str, ...], Box | None] | None = None
        self._computation.changed.connect(self._on_computation)
        window.activity.progress.connect(window.status.show_progress)
        window.activity.busy_changed.connect(window.actions_["cancel"].setEnabled)
        window.actions_["cancel"].setEnabled(False)
        window.status.badge.clicked.connect(self.open_findings)
        window.findings_list.picked.connect(self.go_to)
        window.findings_list.left_out.connect(self.leave_out)
        window.canvas.tool_changed.connect(lambda _: self.show_missing())
        window.views.empty.pressed.connect(lambda: window.actions_[self._empty_action].trigger())
        log = window.command_line.log.model()
        for change in (log.rowsInserted, log.modelReset):
            change.connect(lambda *_: self.show_log())
        window.views.legend.layer_switched.connect(self._on_layer)
        window.views.legend.colour_chosen.connect(lambda by: window.canvas.set_colour_by(PathColourBy(by)))

    @property
    def page(self) -> ViewPage:
        """What the view at the front puts into the window."""
        return self.pages[self.view]

    def ask(self, controller: Controller, view: View) -> None:
        """Have a controller say what its view shows in place of the drawing."""
        self._tellers.append(_Teller(view, controller))

    @property
    def shown_document(self) -> ShownDocument | None:
        """What is at the front in place of the drawing and its job: the view's own, or the scene that its program is to
        come of; None = these.
        """
        told = self._told_of(self.view)
        return self._told_of(View.SURFACES) if told is None and self.on_scene() else told

    def _told_of(self, view: View) -> ShownDocument | None:
        """Return what the controllers say that a view shows in place of the drawing."""
        told = (each.controller.shown_document for each in self._tellers if each.view is view)
        return next((document for document in told if document is not None), None)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Everything there is to say about the drawing and, once computed, its paths."""
        made = self._computation.made
        return made.findings if made is not None else self._computation.drawing_findings

    def _marked(self) -> tuple[Finding, ...]:
        """Return the findings that are marked on the canvas: those that count; a remark only when it is picked."""
        return tuple(finding for finding in self.findings if finding.counts)

    def part_size(self) -> tuple[float, float] | None:
        """Return width and height of the drawing without its keep-out layers, mm; None when it is empty."""
        drawn = self._drawn()
        return None if drawn is None else size_of(drawn)

    def _drawn(self) -> Box | None:
        """Return the extent of the drawing without its keep-out layers, mm; None when it is empty."""
        part, apart = self._document.part, self._document.job.keep_out_layers
        if self._extent is None or self._extent[0] is not part or self._extent[1] != apart:
            self._extent = (part, apart, extent_of(part, apart))
        return self._extent[2]

    def know_extent(self, part: Part, extent: Box | None) -> None:
        """Take over the extent of a part that was measured on another thread."""
        self._extent = (part, (), extent)

    def stock(self) -> StockBox | None:
        """Return the stock: once computed, round what is machined; before, round all that is drawn; None when nothing
        is.
        """
        job, made, drawn = self._document.job, self._computation.made, self._drawn()
        if made is not None and len(made.program.moves) and _same_curves(made.job, job):
            return stock_box(job, made.program.regions, made.program.lines)
        return None if drawn is None else drawn_stock(job, drawn)

    def _show_stock(self) -> None:
        """Show where the stock is, and how large."""
        stock = self.stock()
        self._window.panel.show_size(self.part_size(), None if stock is None else stock.size)
        self._window.canvas.set_stock(stock)

    def show_view(self, view: View) -> None:
        """Bring a view to the front."""
        self.view = view
        self._window.actions_[view.value].setChecked(True)
        self._window.views.show_view(view)
        self.show_prompt()
        self._show_standing()
        self._show_badge()
        self.view_changed.emit(view)
        self.show_missing()

    def show_start(self) -> None:
        """Bring the page that the window begins with to the front, until a view is shown again."""
        self.view = View.DRAW
        self._window.actions_[View.DRAW.value].setChecked(True)
        self._window.views.show_view(View.DRAW)
        self._window.views.show_start()
        self.show_state()

    def show_prompt(self) -> None:
        """Say what the command line takes: on the canvas what the tool in hand wants, beside a program what it is
        for.
        """
        starting = self._window.views.starting
        self._window.command_line.set_prompt(START_PROMPT if starting else self.page.prompt())

    def refresh(self, change: DocumentChange) -> None:
        """Show what changed in the document."""
        if change & (DocumentChange.PART | DocumentChange.JOB):
            self._show_stock()
            self._window.views.legend.show_job(self._document.job)
            self.show_missing()
        self.show_titles()

    def show_titles(self) -> None:
        """Name what is looked at, and what can be undone: in the drawing, or in the scene in its view."""
        document, scene, actions = self._document, self._window.scene, self._window.actions_
        on_scene, other = self.on_scene(), self.shown_document
        drawing = document.path.name if document.path else document.part.name
        name, modified = (other.name, other.modified) if other is not None else (drawing, document.modified)
        if self._window.views.starting:
            name, modified = "Start here", False
        self._window.file_label.setText(f"{name}{' *' if modified else ''}")
        self._window.menuBar().setCornerWidget(self._window.file_label)
        self._window.setWindowTitle(f"{name}{' *' if modified else ''} - Hitofude")
        undo = ("" if scene.document.isUndoAvailable() else None) if on_scene else document.undo_name
        redo = ("" if scene.document.isRedoAvailable() else None) if on_scene else document.redo_name
        for action, what, verb in (("undo", undo, "&Undo"), ("redo", redo, "&Redo")):
            text = f"{verb} {_within(what)}" if what else verb
            actions[action].setText(text)
            actions[action].setToolTip(f"{text.replace('&', '')} ({actions[action].shortcut().toString()})")
            actions[action].setEnabled(what is not None)
        actions["delete"].setEnabled(bool(document.selection))
        drawn = bool(document.part.entities)
        actions["select_all"].setEnabled(drawn)
        surfaces, open_now = self._window.views.surfaces, not self._window.views.starting
        waits = bool(self.opening)  # both wait for the file that is being read
        actions["export"].setEnabled(waits or (open_now and (surfaces.shown is not None if on_scene else drawn)))
        actions["compute"].setEnabled(waits or (open_now and (on_scene or drawn or self.on_picture())))

    def show_opening(self, name: str) -> None:
        """Say that a file is being read, or no longer, "": what is to be done with it can be asked for already."""
        if name != self.opening:
            self.opening = name
            self.show_missing()

    def show_state(self) -> None:
        """Show where the view at the front stands."""
        self.show_prompt()
        self._show_badge()
        self._show_standing()
        self.show_missing()

    def show_missing(self) -> None:
        """Say what the view lacks, if it lacks anything."""
        made = self._computation.made
        missing = self.page.missing()
        self._empty_action = missing.action
        self.show_titles()
        self._window.views.show_missing(missing.sentence, missing.button, made is not None)
        self._show_side()

    def _show_side(self) -> None:
        """Have what belongs to the view at its right: the job, or what is known of the cut, or what is asked of it."""
        window, views = self._window, self._window.views
        window.tool_strip.setVisible(self.page.widget is window.canvas and not views.covered)
        beside = window.plot_panel if views.plotting else None if views.starting else self.page.side()
        for widget in window.sides:
            if widget is not beside:
                widget.hide()
        window.side_line.setVisible(beside is not None)
        if beside is not None:
            beside.show()
        self.show_log()

    def show_log(self) -> None:
        """Show the log where that is wanted; the page that the window begins with has its room while it is empty."""
        log, wanted = self._window.command_line.log, self._window.actions_["log"].isChecked()
        log.setVisible(wanted and (bool(log.lines) or not self._window.views.starting))

    def show_hovered(self, text: str) -> None:
        """Show what the mouse is over, or else where the paths stand."""
        if text:
            self._window.status.show_message(text)
        else:
            self._show_standing()

    def _show_standing(self) -> None:
        """Show what the status bar says when nothing else is to be said; why a run failed is said above the view."""
        state = self._computation.state
        own = self.shown_document is None and state is not ComputationState.NONE  # that is what the badge says already
        standing = self.page.summary() or (state.value if own else "")
        self._window.status.show_message("" if self._window.views.starting else standing)

    def _on_computation(self) -> None:
        made, state = self._computation.made, self._computation.state
        if made is not self._shown_program:
            self._shown_program = made
            picture = self._computation.picture
            assert picture is None or isinstance(picture, ProgramLayer)
            self._window.canvas.set_program(picture)
            if picture is not None:
                self._window.views.legend.show_remainders(picture.remainders)
            self._window.canvas.set_findings(self._marked())
        self._show_stock()
        self._window.canvas.set_stale(self._computation.outdated)
        strokes = made.program.strokes if made is not None and state is ComputationState.CURRENT else None
        self._window.panel.show_results(
            OperationTimes(self._computation.operation_times(), self._computation.waiting_times()), strokes
        )
        self._show_badge()
        self.show_missing()
        self._show_standing()

    def _show_badge(self) -> None:
        badge, state, made = self._window.status.badge, self._computation.state, self._computation.made
        other = self.shown_document
        if self._window.views.starting:
            badge.show_verdict(VerdictSummary(VerdictLevel.NONE, "Nothing open"))
        elif other is not None:
            if other.verdict is None:
                badge.show_running()
            else:
                badge.show_verdict(other.verdict)
        elif state is ComputationState.RUNNING:
            badge.show_running()
        elif state is ComputationState.CURRENT and made is not None:
            badge.show_verdict(verdict_summary(made.findings, made.report.data))
        elif state is ComputationState.FAILED:
            badge.show_verdict(VerdictSummary(VerdictLevel.REMARK, "Could not be computed"))
        else:
            badge.show_verdict(
                VerdictSummary(VerdictLevel.NONE, "Not computed" if state is ComputationState.NONE else "Out of date")
            )

    def _on_layer(self, sample: PathLineKind, on: bool) -> None:
        flag = _LAYERS[sample]
        self._layers = self._layers | flag if on else self._layers & ~flag
        self._window.canvas.set_visible_layers(self._layers)

    def open_findings(self) -> None:
        """List every finding above the badge."""
        empty = self._without_findings()
        other = self.shown_document
        if other is not None:
            said = "It is being computed." if other.verdict is None else other.verdict.tip or other.verdict.text
            self._window.findings_list.show_findings(other.findings, self._window.status.badge, said, mends=other.mends)
            return
        shown = frozenset(layer.name for layer in self._document.part.layers if layer.visible)
        if self._computation.state is ComputationState.FAILED:
            self._window.findings_list.show_failure(
                self._computation.error, self.findings, self._window.status.badge, shown
            )
            return
        mends = self._mends if self._computation.state is ComputationState.CURRENT else None
        self._window.findings_list.show_findings(self.findings, self._window.status.badge, empty, shown, mends)

    def _without_findings(self) -> str:
        """Return what stands in the list of findings when there is none."""
        computing = self._computation
        if not computing.possible and computing.state in (ComputationState.NONE, ComputationState.STALE):
            return "Nothing is drawn; draw a part or open a drawing."
        sentences = {
            ComputationState.NONE: "Nothing was computed yet. Press F5.",
            ComputationState.STALE: "The paths are out of date. Press F5.",
            ComputationState.RUNNING: "The paths are being computed.",
        }
        return sentences.get(computing.state, "No gouge, nothing left that a tool could reach, no rapid in material.")

    def _mends(self, finding: Finding) -> tuple[OfferedMend, ...]:
        """Return what mends a finding on the job's program."""
        from ...formats.tools.library import load_libraries
        from ...usecases.making.program_lines import operation_of_line
        from ...usecases.mending import Fault, mends

        made = self._computation.made
        if made is None:
            return ()
        index = operation_of_line(made, 0, finding.line) if len(made.files) == 1 else None
        library = [tool for each in load_libraries().libraries.values() for tool in each.tools]
        found = mends(made.job, Fault.of(finding, index), library)
        return tuple(OfferedMend(mend.words, mend.change, partial(self._mend, mend)) for mend in found)

    def _mend(self, mend: Mend) -> None:
        """Change the job so that a finding is mended; one undoable step, and computed again."""
        self._document.change_job(mend.words, mend.job)
        self._computation.start()

    def go_to(self, finding: Finding) -> None:
        """Show the place of a finding on the canvas, with the whole of the curves that it is about, and select
        these; of another document at the front, there.
        """
        other = self.shown_document
        if other is not None:
            if other.look_at is not None:
                other.look_at(finding)
            return
        ids = set(finding.entity_ids)
        box = union([bounds(entity.curve) for entity in self._document.part.entities if entity.id in ids])
        if finding.x is not None and finding.y is not None:
            place = (finding.x, finding.y)
        elif box is not None:
            place = ((box[0] + box[2]) / 2, (box[1] + box[3]) / 2)
        else:
            return
        self._window.canvas.set_findings((*self._marked(), finding))
        if self.view not in (View.DRAW, View.PATHS):
            self.show_view(View.PATHS)
        self._window.canvas.go_to(*place, closely=True, around=box)
        self._window.canvas.setFocus()
        self._document.select(finding.entity_ids)

    def leave_out(self, layer: str) -> None:
        """Hide a layer, so that what is on it is not machined; one undoable line."""
        self._document.run(f"hide {name_text(layer)}")
