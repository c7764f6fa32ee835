"""Export NC: what is written is what was computed, read back and cut; the verdict is shown before the file is kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ...core.atomic import write_together
from ...core.errors import HitofudeError
from ...gcode.posts.posts import load_post
from ..framework.computation import Computation, ComputationState
from ..framework.notice import Notice
from .proof import proof, warning

if TYPE_CHECKING:
    from ...usecases.make import MakeResult

FILTER = "NC programs (*.ngc *.nc *.tap);;All files (*)"


class NcExportController(QObject):
    """Computes first when the paths are out of date, asks for the file, writes it whole or not at all.

    A control that changes no tools gets a file for each tool beside the chosen name: all of them, or none.

    Signals:
        written(paths, lines): every file, and the lines of all. failed(sentence). show_findings(): the user wants to
        see them first.

    Attributes:
        choose_file: asks the user for a path, given how its name may end; None = he changed his mind.
    """

    written = Signal(list, int)
    failed = Signal(str)
    show_findings = Signal()

    def __init__(self, computation: Computation, notice: Notice, choose_file: Callable[[str], Path | None]) -> None:
        super().__init__()
        self._computation, self._notice = computation, notice
        self.choose_file = choose_file
        self._waiting: Callable[[], None] | None = None
        computation.finished.connect(self._on_finished)
        computation.failed.connect(self._forget)

    def start(self) -> None:
        """Export the job as it is now."""
        self._when_computed(self._ask)

    def start_frame(self) -> None:
        """Write the program that goes round the box of the cuts at clearance height, spindle off."""
        self._when_computed(self._write_frame)

    def _when_computed(self, act: Callable[[], None]) -> None:
        if self._computation.state is ComputationState.CURRENT:
            act()
        else:
            self._waiting = act
            if self._computation.state is not ComputationState.RUNNING:
                self._computation.start()

    def _forget(self, _: str) -> None:
        self._waiting = None

    def _on_finished(self) -> None:
        act, self._waiting = self._waiting, None
        if act is not None:
            act()

    def _made(self) -> MakeResult | None:
        """Return the job's result if there is something to write, else say so."""
        made = self._computation.made
        if made is None or not len(made.program.moves):
            self.failed.emit("There is no path to write: the drawing has no closed contour that the tools fit into.")
            return None
        return made

    def _ask(self) -> None:
        made = self._made()
        if made is None:
            return
        if made.clean:
            self._notice.ask(proof(made), of_job=True)
            self._write()
            return
        self._notice.ask(
            warning(made.findings),
            [("Show", self.show_findings.emit), ("Write anyway", self._write)],
            error=True,
            of_job=True,
        )

    def _write(self) -> None:
        made = self._computation.made
        if made is None or self._computation.state is not ComputationState.CURRENT:
            self.failed.emit("The job has changed; export it again.")
            return
        path = self._chosen(made, "")
        if path is not None:
            self._keep({file.named(path): file.nc.text for file in made.files})

    def _write_frame(self) -> None:
        made = self._made()
        path = self._chosen(made, "_frame") if made is not None else None
        if made is not None and path is not None:
            self._keep({path: made.frame()})

    def _chosen(self, made: MakeResult, suffix: str) -> Path | None:
        """Ask for a file; a name without an extension gets that of the post."""
        extension = load_post(made.job.post).extension
        path = self.choose_file(f"{suffix}{extension}")
        return path if path is None or path.suffix else path.with_suffix(extension)

    def _keep(self, texts: dict[Path, str]) -> None:
        """Write all files or none."""
        try:
            write_together({path: text.encode("ascii") for path, text in texts.items()})
        except HitofudeError as error:
            self.failed.emit(str(error))
        else:
            self.written.emit(list(texts), sum(text.count("\n") for text in texts.values()))
