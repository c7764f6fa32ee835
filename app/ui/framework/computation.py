"""Computing in the background: from the document's job to moves, NC text and verdict, and whether they are up to
date.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ...core.progress import Progress
from ...drafting.document import Document, DocumentChange
from ...model.finding import Finding
from ...model.job import Job
from ...model.moves import Program
from ...model.part import Part
from .worker import JobOutcome, Worker

if TYPE_CHECKING:
    from ...usecases.making.make import MakeResult
    from ...usecases.pixels.part import BitmapPart


class ComputationState(Enum):
    """What the window knows about the tool paths of the job as it is now."""

    NONE = "Not computed"
    RUNNING = "Computing"
    CURRENT = "Paths up to date"
    STALE = "Paths out of date"
    FAILED = "Could not be computed"


@dataclass(frozen=True)
class ComputationResult:
    """What a run gives: the result, and its moves prepared for painting, so that showing them costs the window
    nothing.
    """

    made: MakeResult
    picture: object


def _make(job: Job, pixels: BitmapPart | None, drawing_findings: tuple[Finding, ...], progress: Progress) -> MakeResult:
    from ...usecases.making.make import export, finish  # imports the engines: never on the window's thread

    if pixels is None:
        return export(job, progress.part(0.0, 0.95), drawing_findings)
    from ...usecases.pixels.way import compute_on_bitmap

    program = compute_on_bitmap(job, pixels, progress.part(0.0, 0.5)).program
    return finish(program, job, progress.part(0.5, 0.95), drawing_findings)


@dataclass(frozen=True, slots=True)
class WaitingTimes:
    """What takes time beside the operations, s; with theirs it is the program's whole time.

    Attributes:
        changes: how many tools are taken. changing: for these.
        dwelling: until the spindle runs, and whatever else the control waits for.
        travelling: on moves that are no operation's.
    """

    changes: int
    changing: float
    dwelling: float
    travelling: float


class Computation(QObject):
    """The document's tool paths.

    Signals:
        changed(): state or result changed. failed(sentence).

    Attributes:
        made: the last result of this document, also when it is out of date; None before the first.
        picture: its moves as `prepare` has made them ready for painting.
        error: why the last run failed, or "". may_retry: whether the same run may do better another time.
        drawing_findings: what reading the drawing had to say.
        pixels: a part that came from a picture, and its pixels: it is computed on these; None = there was no picture.
    """

    changed = Signal()
    finished = Signal()
    failed = Signal(str)

    def __init__(self, document: Document, worker: Worker, prepare: Callable[[MakeResult], object]) -> None:
        """Make one; `prepare` makes a result ready for painting, on the worker's thread."""
        super().__init__()
        self._document, self._worker, self._prepare = document, worker, prepare
        self._job_id: int | None = None
        self._snapshot: Job | None = None
        self._made_for: Job | None = None
        self._compared: tuple[Job, Job, bool] | None = None
        self.made: MakeResult | None = None
        self.picture: object = None
        self.error, self.may_retry = "", False
        self.drawing_findings: tuple[Finding, ...] = ()
        self.pixels: tuple[Part, BitmapPart] | None = None
        worker.done.connect(self._on_done)
        worker.failed.connect(self._on_failed)
        worker.cancelled.connect(self._on_cancelled)
        document.subscribe(self._on_change)

    @property
    def state(self) -> ComputationState:
        """Where the tool paths stand."""
        if self._job_id is not None:
            return ComputationState.RUNNING
        if self.error:
            return ComputationState.FAILED
        if self.made is None:
            return ComputationState.NONE
        return ComputationState.STALE if self.outdated else ComputationState.CURRENT

    @property
    def outdated(self) -> bool:
        """Whether there is a result, of a job that has changed since."""
        return self.made is not None and not self._holds_for(self._made_for)

    @property
    def possible(self) -> bool:
        """Whether anything is drawn that paths could be computed of."""
        return bool(self._document.part.entities)

    @property
    def program(self) -> Program | None:
        """Moves of the last result."""
        return self.made.program if self.made is not None else None

    def start(self) -> None:
        """Compute the job as it is now; a run that is on its way is left."""
        job, findings = self._document.job, self.drawing_findings
        pixels = self.pixels_of(job.part)
        self.error = ""
        self._job_id = self._worker.start(
            lambda progress: self._compute(job, pixels, findings, progress), self._document.revision
        )
        self._snapshot = job  # after the start, which lets go of the run before with its snapshot
        self.changed.emit()

    def _compute(
        self, job: Job, pixels: BitmapPart | None, findings: tuple[Finding, ...], progress: Progress
    ) -> ComputationResult:
        made = _make(job, pixels, findings, progress)
        progress.step(0.95, "Preparing the picture")
        return ComputationResult(made, self._prepare(made))

    def making(self, job: Job) -> Callable[[Progress], MakeResult]:
        """Return what makes another job of the same drawing, for a worker to run; what is computed stays as it is."""
        pixels, findings = self.pixels_of(job.part), self.drawing_findings
        return lambda progress: _make(job, pixels, findings, progress)

    def pixels_of(self, part: Part) -> BitmapPart | None:
        """Return the pixels of a part that is a picture's and was not drawn in since, else None."""
        if self.pixels is None:
            return None
        drawn, pixels = self.pixels
        return pixels if drawn.entities is part.entities and drawn.layers is part.layers else None

    def forget(self, drawing_findings: tuple[Finding, ...] = ()) -> None:
        """Drop the result: another document was opened, and reading it had this to say."""
        self.made, self.picture, self._made_for, self._compared, self.error = None, None, None, None, ""
        self.drawing_findings = drawing_findings
        self.changed.emit()

    def know_drawing(self, findings: tuple[Finding, ...]) -> None:
        """Take over what reading the drawing had to say, when it was read again or that was undone."""
        if findings != self.drawing_findings:
            self.drawing_findings = findings
            self.changed.emit()

    def _holds_for(self, job: Job | None) -> bool:
        """Return whether what was computed for a job is right for the one of now; asked often, compared once."""
        now = self._document.job
        if job is None or job is now:
            return job is now
        if self._compared is None or self._compared[0] is not job or self._compared[1] is not now:
            self._compared = (job, now, job.same_paths(now))
        return self._compared[2]

    def waiting_times(self) -> WaitingTimes | None:
        """Return what takes time beside the operations; None while the result is out of date."""
        if self.made is None or self.state is not ComputationState.CURRENT:
            return None
        data = self.made.report.data
        waited, changes = data["time_parts_s"]["wait"], data["tool_changes"]
        moved = data["time_s"] - waited - sum(self.operation_times().values())
        return WaitingTimes(changes["count"], changes["time_s"], waited - changes["time_s"], moved)

    def operation_times(self) -> dict[int, float]:
        """Return the time of each operation, seconds, by its index, with that of what it asks to come before it;
        nothing while the result is out of date.
        """
        if self.made is None or self.state is not ComputationState.CURRENT:
            return {}
        job, count, times = self.made.job, len(self._document.job.operations), dict[int, float]()
        for index, each in enumerate(self.made.report.data["operations"]):
            if each["enabled"]:
                owner = index if index < count else job.prepares(index)
                times[owner or 0] = times.get(owner or 0, 0.0) + each["time_s"]
        return times

    def _on_change(self, change: DocumentChange) -> None:
        if not change & (DocumentChange.PART | DocumentChange.JOB):
            return
        if self._job_id is not None and not self._holds_for(self._snapshot):
            self._worker.cancel()
        self.error = ""
        self.changed.emit()

    def _on_done(self, answer: JobOutcome) -> None:
        if answer.job_id != self._job_id:
            return
        job = self._end()
        if answer.revision == self._document.revision or self._holds_for(job):
            assert isinstance(answer.value, ComputationResult)
            self.made, self.picture, self._made_for = answer.value.made, answer.value.picture, job
            self.changed.emit()
            self.finished.emit()
        else:
            self.changed.emit()

    def _end(self) -> Job | None:
        """Let go of the job that was computed, and return it."""
        job, self._job_id, self._snapshot = self._snapshot, None, None
        return job

    def _on_failed(self, answer: JobOutcome) -> None:
        if answer.job_id == self._job_id:
            self._end()
            self.error, self.may_retry = answer.error or "", answer.again
            self.changed.emit()
            self.failed.emit(self.error)

    def _on_cancelled(self, job_id: int) -> None:
        if job_id == self._job_id:
            self._end()
            self.changed.emit()
