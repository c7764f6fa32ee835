"""Shows the cut of the job's program as soon as it is computed, and of any other program when that is asked for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal

from ....core.progress import Progress
from ....model.finding import Finding
from ...framework.computation import ComputationState
from ...framework.controller import Controller, ShownDocument
from ...framework.verdict import VerdictLevel, VerdictSummary, verdict_summary
from ...framework.worker import JobOutcome, Worker
from ...framework.workspace import Workspace
from ...panels.changes import operation_name
from ..nc.program_reader import ProgramSource
from .cell_colours import CutColourBy, key_of
from .findings import CutFinding, FindingColour, level_of, sentences_of, title_of
from .foreign_program import ForeignProgram, MissingSetup, foreign_shown
from .overlay import PlacePin
from .page import CutPage
from .panel import CutPanel, colour_of
from .setup_form import SetupForm
from .shown_cut import ProgramFile, ShownCut, shown_cut
from .theme_colours import colormap_of
from .user_setup import UserSetup
from .zoom_controller import ZoomController, ZoomTarget

if TYPE_CHECKING:
    from ....gcode.interpreter.dialect import Dialect
    from ....usecases.cutting.timeline import TimelinePlace
    from ....usecases.making.make import MakeResult
    from ....usecases.mending import Mend
    from ....verify.parts import Part


def job_shown(made: MakeResult, name: str, colour: CutColourBy, progress: Progress) -> ShownCut | None:
    """Return the cut that came with the job's program, prepared; None where nothing was cut.

    Raises:
        Cancelled: the job was asked to stop.
    """
    if made.cut is None:
        return None
    files = tuple(ProgramFile(f"{name}{file.suffix}", file.nc.text.encode("ascii")) for file in made.files)
    return shown_cut(made.cut, files, colour, progress)


@dataclass(frozen=True, eq=False)
class MendTrial:
    """A mend, and what would come of it.

    Attributes:
        cut: as it would be; None where nothing would be cut. findings, told: on the whole program, the badge's verdict.
    """

    mend: Mend
    cut: ShownCut | None
    findings: tuple[Finding, ...]
    told: VerdictSummary


def trial_shown(
    mend: Mend, making: Callable[[Progress], MakeResult], colour: CutColourBy, progress: Progress
) -> MendTrial:
    """Make the job of a mend and prepare its cut.

    Raises:
        HitofudeError: the job cannot be made. Cancelled: it was asked to stop.
    """
    made = making(progress.part(0.0, 0.8))
    cut = job_shown(made, made.job.part.name, colour, progress.part(0.8, 1.0))
    return MendTrial(mend, cut, made.findings, verdict_summary(made.findings, made.report.data))


class CutController(Controller):
    """Follows the computation, and shows the cut of another program when it is asked to.

    Its own worker, so that it never holds up computing.

    Signals:
        changed(): the view shows another cut, or none, or something is asked for.
        operation_picked(index): the user points at what an operation of the job has cut.

    Attributes:
        cut: what is shown; None = nothing.
    """

    operation_picked = Signal(int)

    def __init__(self, page: CutPage, panel: CutPanel, form: SetupForm, workspace: Workspace) -> None:
        super().__init__(page)
        self._page, self._view, self._panel, self._form = page, page.view, panel, form
        self._document, self._computation, self._activity = (
            workspace.document,
            workspace.computation,
            workspace.activity,
        )
        self.cut: ShownCut | None = None
        self._own: ShownCut | None = None
        self._foreign: ForeignProgram | None = None
        self._shown_foreign: ForeignProgram | None = None
        self._made: MakeResult | None = None
        self._trial: MendTrial | None = None
        self._marked = False
        self._at: TimelinePlace | None = None
        self.worker, self.foreign_worker, self.trial_worker = Worker(self), Worker(self), Worker(self)
        self.zoom_controller = ZoomController(self._view.model, self._view.render_scheduler, self)
        self.zoom_controller.found.connect(self._view.show_detail)
        self.player = page.player
        self._connect()

    def _connect(self) -> None:
        activity = self._activity
        self.foreign_worker.busy_changed.connect(self._on_cutting)
        self.worker.busy_changed.connect(self._on_preparing)
        for worker in (self.worker, self.foreign_worker):
            worker.failed.connect(self._on_failed)
        self.trial_worker.failed.connect(lambda answer: self.failed.emit(answer.error or ""))
        activity.follow(self.foreign_worker)
        activity.follow(self.trial_worker, "Cutting a preview…")
        activity.cancelled.connect(self.worker.cancel)
        activity.ended.connect(self.player.pause)
        for worker in (
            self.worker,
            self.trial_worker,
            self.zoom_controller.worker,
            self._view.colours.worker,
            self.player.worker,
        ):
            activity.ended.connect(worker.finish)
        activity.ended.connect(self._leave)
        self.zoom_controller.failed.connect(self.failed)
        self.player.failed.connect(self.failed)
        self._view.surface_host.said.connect(self.failed)
        self.player.moved.connect(self._on_played)
        self.player.state_changed.connect(self._on_played)
        self._computation.changed.connect(self._follow)
        self._computation.changed.connect(self._tell)
        self._view.colours.known.connect(self._show_key)
        self._panel.picked.connect(self._go_to)
        self._panel.form_requested.connect(self._open_form)
        self._panel.left.connect(self.back)
        self._panel.mend_requested.connect(self._mend)
        self._panel.preview_requested.connect(self._preview)
        self._panel.nc.line_picked.connect(self._go_to_line)
        self._view.cell_picked.connect(lambda x, y, z, motion: self.mark_motion(motion))
        self._form.accepted.connect(self._cut_as)
        self._form.left.connect(self._leave_form)

    @property
    def shown_document(self) -> ShownDocument | None:
        """The cut of another program than the job's, or that it is being made, or what a mend would make; None = the
        job's.
        """
        foreign, cut, trial = self._foreign, self.cut, self._trial
        if trial is not None and cut is not None:
            title, level = title_of(cut, trial.told), level_of(cut, trial.told)
            told = VerdictSummary(level, f"Preview · {title}", sentences_of(cut))
            return ShownDocument(f"{trial.mend.words} · preview", False, told, trial.findings, self._look_at)
        if foreign is None:
            return None
        if cut is None or cut.given is None or self.foreign_worker.busy:
            waits = VerdictSummary(VerdictLevel.NONE, "Not cut yet")
            return ShownDocument(foreign.source.name, False, None if self.foreign_worker.busy else waits)
        verdict = VerdictSummary(level_of(cut), title_of(cut), sentences_of(cut))
        findings = tuple(dict.fromkeys((*cut.cut.findings, *cut.assumed)))
        return ShownDocument(foreign.source.name, False, verdict, findings, self._look_at)

    def _look_at(self, finding: Finding) -> None:
        """Show the place of a finding of the cut."""
        entry = next((entry for entry in self._panel.entries if entry.sentence == finding.text), None)
        if entry is not None:
            self._panel.choose(entry)

    def show_program(self, source: ProgramSource, dialect: Dialect, scene: Callable[[], Part] | None = None) -> None:
        """Cut a program that is none of the job's; what was there stays until it is cut, or until something is to
        be said of it.

        Args:
            source, dialect: what it is and how it is read. scene: makes what a scene's program is to come to; None: it
                is no scene's.
        """
        before = self._foreign
        given = before.given if before is not None and before.source.bytes() == source.bytes() else UserSetup()
        made, job = self._computation.made, self._document.job
        part = made.cut.setup.part if made is not None and made.cut is not None else None
        self._foreign = ForeignProgram(source, dialect, given, {tool.number: tool for tool in job.tools}, part, scene)
        self._cut_foreign()

    @property
    def source(self) -> ProgramSource | None:
        """The program that is cut in place of the job's, or is going to be; None = the job's own is."""
        return self._foreign.source if self._foreign is not None else None

    def known_of(self, source: ProgramSource) -> UserSetup:
        """Return what tools and stock a program is cut with; nothing of one that is not."""
        foreign = self._foreign
        if foreign is None or foreign.source.bytes() != source.bytes():
            return UserSetup()
        shown = self.cut if foreign is self._shown_foreign else None
        return foreign.given if shown is None or shown.given is None else shown.given

    @property
    def of_scene(self) -> bool:
        """Whether the program that is cut is a scene's."""
        return self._foreign is not None and self._foreign.scene is not None

    def back(self) -> None:
        """Show the job's own cut again."""
        self.foreign_worker.cancel()
        self._form.ask(None)
        if self._foreign is not None or self.cut is not self._own:
            self._foreign = self._shown_foreign = None
            self._show(self._own)

    def _leave(self) -> None:
        """Let go of what takes much memory; the window itself may be kept by somebody for longer."""
        self._foreign = self._shown_foreign = self._own = self._made = self._trial = None
        self._show(None)

    def _follow(self) -> None:
        made = self._computation.made
        if made is self._made or self._computation.state is ComputationState.RUNNING:
            return
        self._made = made
        if made is None or made.cut is None:
            self._show_own(None)
            return
        name, colour = made.job.part.name, self._view.colour
        self.worker.start(lambda progress: job_shown(made, name, colour, progress), 0, self._show_own)

    def _on_preparing(self, busy: bool) -> None:
        self._page.preparing = busy
        self.changed.emit()

    def _on_cutting(self, busy: bool) -> None:
        self._page.cutting = busy
        self.changed.emit()

    def _cut_foreign(self) -> None:
        foreign, colour = self._foreign, self._view.colour
        if foreign is not None:
            self.foreign_worker.start(lambda progress: foreign_shown(foreign, colour, progress), 0, self._show_foreign)

    def _cut_as(self, given: UserSetup) -> None:
        """Cut the foreign program with other tools and stock."""
        if self._foreign is not None:
            self._foreign = replace(self._foreign, given=given)
            self._cut_foreign()

    def _open_form(self) -> None:
        """Let the user say other tools and another stock."""
        if self._foreign is not None and self.cut is not None and self.cut.given is not None:
            self._form.ask(
                MissingSetup("Other tools, or another stock, give another cut.", self._foreign, self.cut.given)
            )
            self.changed.emit()

    def _leave_form(self) -> None:
        self._form.ask(None)
        if self.cut is None or self.cut.given is None:
            self.back()
        self.changed.emit()

    def _show_own(self, cut: ShownCut | None) -> None:
        self._own = cut
        self._panel.show_way_back(cut is not None)
        if self._foreign is None:
            self._show(cut)

    def _show(self, cut: ShownCut | None) -> None:
        self.cut, self._marked, self._at = cut, False, None
        if self._trial is not None and cut is not self._trial.cut:
            self._trial = None
        self._view.show_cut(cut.picture if cut is not None else None)
        self.zoom_controller.follow(ZoomTarget(cut.cut) if cut is not None else None)
        self._panel.show_cut(cut)
        self.player.follow(cut, self._panel.entries)
        self._tell()
        self._show_key()
        self.changed.emit()

    def _tell(self) -> None:
        """The job's own cut is headed by the badge's verdict, or by that it is out of date."""
        if self._trial is not None and self._computation.outdated:
            self._show(self._own)
            return
        made, own = self._computation.made, self.cut is not None and self.cut is self._own
        if not own or made is None:
            self._panel.show_told(None)
        elif self._computation.outdated:
            why = "compute again" if self._computation.possible else "nothing is drawn any more"
            self._panel.show_told(VerdictSummary(VerdictLevel.NONE, f"Out of date: {why}"))
        else:
            self._panel.show_told(verdict_summary(made.findings, made.report.data))
        self._offer_mends()

    def operation_of(self, motion: int) -> int | None:
        """Return the index of the job's operation that a motion of the cut belongs to; None where that is not known."""
        from ....usecases.making.program_lines import operation_of_line

        cut, made = self.cut, self._made
        if cut is None or cut is not self._own or made is None or motion < 0 or cut.picture.moves is None:
            return None
        return operation_of_line(made, cut.file_of(motion), int(cut.picture.moves.line[motion]))

    def mark_motion(self, motion: int, stays: bool = True) -> None:
        """Mark a motion: its line beside the cut, its way over it, and the operation that it belongs to.

        Args:
            motion: of all files; -1 = none. stays: until another is marked, or the cut is played.
        """
        cut = self.cut
        if cut is None or cut.picture.moves is None:
            return
        index = self.operation_of(motion)
        tool = f"T{cut.picture.moves.tool[motion]}" if motion >= 0 else ""
        name = operation_name(self._made.job.operations[index]) if self._made is not None and index is not None else ""
        self._panel.nc.mark(motion, " ".join(filter(None, (name, tool))))
        self._marked = stays and motion >= 0
        self._view.overlay.show_way(cut.way_of(motion) if self._marked else None)
        if stays and index is not None:
            self.operation_picked.emit(index)

    def _go_to_line(self, file: int, row: int) -> None:
        """Show the cut as it is behind a line of the text."""
        if self.cut is None:
            return
        motion = self.cut.motion_at(file, row)
        self.player.go(motion + 1)
        self.mark_motion(motion)

    def _offer_mends(self) -> None:
        """Offer what mends the chosen place, as long as the job is the one that was cut."""
        from ....formats.tools.library import load_libraries
        from ....usecases.mending import Fault, mends

        entry, made = self._panel.chosen, self._made
        if self._trial is not None:
            self._panel.show_trial(self._trial.mend, self._trial.told)
            return
        if entry is None or made is None or self.cut is not self._own or self._computation.outdated:
            self._panel.show_mends(())
            return
        fault = Fault(entry.kind, self.operation_of(entry.motion), entry.amount if entry.line else None, entry.disc)
        library = [tool for each in load_libraries().libraries.values() for tool in each.tools]
        self._panel.show_mends(mends(made.job, fault, library))

    def _mend(self, mend: Mend) -> None:
        """Change the job and compute it again."""
        self._document.change_job(mend.words, mend.job)
        self._computation.start()

    def _preview(self, mend: Mend) -> None:
        """Have the job of a mend cut, to be looked at before anything is changed."""
        making, colour = self._computation.making(mend.job), self._view.colour
        revision = self._document.revision
        self.trial_worker.start(
            lambda progress: trial_shown(mend, making, colour, progress),
            revision,
            lambda trial: self._show_trial(trial, revision),
        )

    def _show_trial(self, trial: MendTrial, revision: int) -> None:
        """Show it, unless the job is another one by now, or another program is looked at."""
        if revision != self._document.revision or self.cut is not self._own:
            return
        if trial.cut is None:
            self.failed.emit("Nothing would be cut then.")
            return
        self._trial = trial
        self._show(trial.cut)

    def _show_key(self) -> None:
        """The histogram has the colours of the deviation, whatever the metal's tell."""
        if self.cut is not None and self.cut.histogram is not None:
            picture = self.cut.picture
            self._panel.show_key(
                key_of(picture, CutColourBy.DEVIATION, colormap_of(self._view.colours.theme), picture.span)
            )

    def _go_to(self, entry: CutFinding) -> None:
        """Glide to a place; gouges and metal left are seen best by their deviation. On the way of the cut, go to when
        it was done.
        """
        if not self.player.at_end:
            self.player.go(entry.motion + 1 if entry.motion >= 0 else self.player.length)
        self.mark_motion(entry.motion)
        self._offer_mends()
        if entry.place is None:
            return
        if (
            entry.colour is not FindingColour.ACCIDENT
            and self._view.model.picture is not None
            and self._view.model.picture.deviation is not None
        ):
            self._view.set_colour(CutColourBy.DEVIATION)
        theme = self._view.colours.theme
        self._view.go_to(PlacePin(entry.place, entry.title, entry.words, colour_of(entry.colour, theme)), entry.field)

    def _show_foreign(self, result: ShownCut | MissingSetup) -> None:
        """Show the cut of another program, or ask for what is not known of it."""
        if isinstance(result, MissingSetup):
            self._form.ask(result)
            self._leave_other(result.foreign)
            self.changed.emit()
        else:
            self._form.ask(None)
            self._shown_foreign = self._foreign
            self._show(result)

    def _leave_other(self, foreign: ForeignProgram) -> None:
        """Show no cut of anything else while what is to be known of a program is asked for."""
        before = self._shown_foreign
        if before is None or before.source.bytes() != foreign.source.bytes():
            self._shown_foreign = None
            self._show(None)

    def _on_failed(self, answer: JobOutcome) -> None:
        self.failed.emit(answer.error or "")
        if self._form.asked is None:
            self._foreign = self._shown_foreign

    def _on_played(self) -> None:
        """A finer look shows the moment that the cut rests at; within a motion there is none."""
        at, cut = self.player.at, self.cut
        self._follow_player()
        if cut is None or self.player.playing or (at is not None and at.fraction > 0):
            self.zoom_controller.follow(None)
        else:
            self.zoom_controller.follow(ZoomTarget(cut.cut, None if at is None or self.player.at_end else at.motion))

    def _follow_player(self) -> None:
        """Mark the line that is being cut; at the end what was pointed at stays marked."""
        player = self.player
        if player.timeline is None or player.at is None or player.at == self._at:
            return
        self._at = player.at
        motion = -1 if player.at_end else player.timeline.current(player.at)
        if motion != self._panel.nc.motion and not (motion < 0 and self._marked):
            self.mark_motion(motion, stays=False)
