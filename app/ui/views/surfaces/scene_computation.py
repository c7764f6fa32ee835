"""The open scene's text made into what is shown: read at every change, computed and proven in the background."""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from enum import Enum
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, QTimer, Signal

from ....core.errors import HitofudeError
from ....core.progress import Progress
from ....formats.scene.toml import read_scene
from ....model.finding import Finding
from ....model.scene import Scene
from ...framework.figures import clock, counted
from ...framework.verdict import VerdictLevel, VerdictSummary
from ...framework.worker import JobOutcome
from ..nc.program_reader import ProgramReader
from .scene_document import UNTITLED, SceneDocument
from .shown_scene import ShownScene, shown_scene

if TYPE_CHECKING:
    from ....usecases.scene_program.nc import WrittenScene

REST_MS = 250
"""So long nothing changes before a text is read and computed."""
_AT_ONCE_S = 10.0
"""Scenes that took longer are computed when they are asked for, not at every change."""


class SceneState(Enum):
    """Where a scene stands."""

    NONE = "none"
    WRONG = "wrong"
    CHANGED = "changed"
    COMPUTING = "computing"
    PROVING = "proving"
    PROVEN = "proven"
    FAILED = "failed"


@dataclass(frozen=True, eq=False)
class ProvenScene:
    """What a computed scene came to as NC: the text, and how long it takes, s."""

    written: WrittenScene
    time_s: float


class SceneComputation(QObject):
    """Reads, computes and proves the open scene, one job at a time; a newer text takes its place.

    Signals:
        began(): another scene was taken, and nothing is shown of it yet.
        read(Scene): the text is right. wrong(line, sentence): it is not; line 0: in no line.
        computed(ShownScene, again): shown from now on; again: the same scene in another state.
        failed(sentence): it could not be computed. stands(): `state` changed.

    Attributes:
        document: its text. scene: what the text says, as far as it was right last. shown: what was computed last.
        proven: of what is shown; None until it is. state, problem: where it stands, and what is wrong, a sentence.
        may_retry: whether what failed may do better another time.
    """

    began = Signal()
    read = Signal(object)
    wrong = Signal(int, str)
    computed = Signal(object, bool)
    failed = Signal(str)
    stands = Signal()

    def __init__(self, document: SceneDocument, parent: QObject | None = None) -> None:
        super().__init__(parent)
        self.document = document
        self.reading = ProgramReader(self)
        self.scene: Scene | None = None
        self.shown: ShownScene | None = None
        self.proven: ProvenScene | None = None
        self.state, self.problem, self.may_retry = SceneState.NONE, "", False
        self._took_s, self._began, self._again = 0.0, 0.0, False
        self._resting = QTimer(self)
        self._resting.setSingleShot(True)
        self._resting.setInterval(REST_MS)
        self._resting.timeout.connect(self._follow)
        self.reading.worker.failed.connect(self._on_failed)
        document.changed.connect(self._on_changed)

    def begin(self, text: str, path: Path | None, stem: str = UNTITLED) -> None:
        """Take another scene, show its surfaces as soon as they are made, then compute its passes.

        Args:
            text: of the scene. path: of its file; None = it is in none yet, and would be called `stem`.
        """
        self.reading.worker.cancel()
        self._again = False
        self.scene = self.shown = self.proven = None
        self.document.load(text, path, stem)
        self._resting.stop()
        self.began.emit()
        if self._read():
            self._stand(SceneState.COMPUTING)
            self.reading.start(partial(shown_scene, *self._source(), passes=False), self._on_surfaces)

    def _source(self) -> tuple[Path, bytes]:
        """Return where files of the scene are looked for, and its text."""
        document = self.document
        return document.path or Path.home() / document.name, document.text.encode()

    def _on_surfaces(self, shown: ShownScene) -> None:
        """Show the surfaces, and go on to the passes."""
        self.shown = shown
        self.computed.emit(shown, False)
        self._again = True
        self._start()

    def _start(self) -> None:
        """Compute what was read."""
        self._began = time.monotonic()
        self._stand(SceneState.COMPUTING)
        self.reading.start(partial(shown_scene, *self._source()), self._on_computed)

    def compute(self) -> None:
        """Compute the text as it is now."""
        self._resting.stop()
        if self._read():
            self._start()

    def cancel(self) -> None:
        """Leave the job on its way; what is shown stays."""
        if self.state in (SceneState.COMPUTING, SceneState.PROVING):
            self.reading.worker.cancel()
            self._stand(SceneState.CHANGED if self.scene is not None else SceneState.NONE)

    @property
    def at_once(self) -> bool:
        """Whether a change is computed at once; a scene that takes long is when that is asked for."""
        return self._took_s <= _AT_ONCE_S

    @property
    def busy(self) -> bool:
        """Whether a job is on its way."""
        return self.state in (SceneState.COMPUTING, SceneState.PROVING)

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What is wrong with the program, once it is proven; nothing where the last run failed, which says why."""
        if self.proven is None or self.state is SceneState.FAILED:
            return ()
        return self.proven.written.findings()

    @property
    def verdict(self) -> VerdictSummary:
        """Where the scene stands in a line."""
        if self.state is SceneState.PROVEN and self.proven is not None:
            unproven, wrong = len(self.proven.written.unproven), [each.text for each in self.findings if each.counts]
            if unproven:
                return VerdictSummary(VerdictLevel.BAD, f"{counted(unproven, 'move')} not proven", wrong[0])
            if wrong:
                return VerdictSummary(VerdictLevel.BAD, counted(len(wrong), "finding"), wrong[0])
            tip = "Every move of the program is proven to go no deeper into a surface than 0.00009 mm"
            return VerdictSummary(
                VerdictLevel.OK,
                f"✓ 0 gouge · {counted(len(self.proven.written.files), 'program')} · {clock(self.proven.time_s)}",
                tip,
            )
        words = {
            SceneState.WRONG: (VerdictLevel.REMARK, "The text is wrong"),
            SceneState.FAILED: (VerdictLevel.REMARK, "Could not be computed"),
            SceneState.CHANGED: (VerdictLevel.NONE, "Out of date"),
        }
        level, text = words.get(self.state, (VerdictLevel.NONE, "Not computed"))
        return VerdictSummary(level, text, self.problem)

    def _on_changed(self) -> None:
        """Wait until the text rests; what was proven, or is being, is of another text."""
        if self.state in (SceneState.COMPUTING, SceneState.PROVING, SceneState.PROVEN) and self.scene is not None:
            self.reading.worker.cancel()
            self._stand(SceneState.CHANGED)
        self._resting.start()

    def _follow(self) -> None:
        """Read a text that has rested; compute it if that is quick."""
        if not self._read():
            return
        if self.at_once:
            self.compute()
        else:
            self.reading.worker.cancel()
            self._stand(SceneState.CHANGED)

    def _read(self) -> bool:
        """Read the text and tell what it says, or what is wrong with it; return whether it is right."""
        name = self.document.name
        try:
            self.scene = read_scene(name, self.document.text.encode())
        except HitofudeError as error:
            self.reading.worker.cancel()
            line, sentence = problem_of(name, str(error))
            self._stand(SceneState.WRONG, str(error))
            self.wrong.emit(line, sentence)
            return False
        self.read.emit(self.scene)
        return True

    def _on_computed(self, shown: ShownScene) -> None:
        self._took_s = time.monotonic() - self._began
        self.shown, self.proven = shown, None
        self.computed.emit(shown, self._again)
        self._again = True
        if not len(shown.computed.moves.moves):
            self._stand(
                SceneState.FAILED, "No passes are switched on, so there is no path yet; add passes, or switch them on."
            )
            return
        self._stand(SceneState.PROVING)
        self.reading.start(partial(prove, shown), self._on_proven)

    def _on_proven(self, proven: ProvenScene) -> None:
        self.proven = proven
        self._stand(SceneState.PROVEN)

    def _on_failed(self, outcome: JobOutcome) -> None:
        sentence = outcome.error or ""
        self._stand(SceneState.FAILED, sentence, outcome.again)
        self.failed.emit(sentence)

    def _stand(self, state: SceneState, problem: str = "", may_retry: bool = False) -> None:
        self.state, self.problem, self.may_retry = state, problem, may_retry
        self.stands.emit()


def prove(shown: ShownScene, progress: Progress) -> ProvenScene:
    """Write a computed scene as NC and prove what was written.

    Raises:
        HitofudeError: the control cannot do what is asked. Cancelled: the job was asked to stop.
    """
    from ....usecases.scene_program.nc import write_scene_nc

    written = write_scene_nc(shown.computed, progress)
    return ProvenScene(written, written.time_s)


def problem_of(name: str, message: str) -> tuple[int, str]:
    """Return line and sentence of an error that names its file and, perhaps, a line; line 0: it names none."""
    told = re.match(re.escape(name) + r":(\d+): ?(.*)", message, re.DOTALL)
    if told is None:
        return 0, message
    sentence = told[2].strip()
    return int(told[1]), sentence[:1].upper() + sentence[1:]
