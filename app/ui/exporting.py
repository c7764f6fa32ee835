"""Export NC: what is written is what was computed and measured; a finding is shown before the file is kept."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from PySide6.QtCore import QObject, Signal

from app.atomic import write_atomically
from app.errors import HitofudeError
from app.ui.computation import Computation, State
from app.ui.figures import counted
from app.ui.notice import Notice
from app.ui.verdict import short, worst_first

SUFFIX = ".ngc"
FILTER = "NC programs (*.ngc *.nc *.tap);;All files (*)"


class Exporting(QObject):
    """Computes first when the paths are out of date, asks for the file, writes it whole or not at all.

    Signals:
        written(path, lines). failed(sentence). show_findings(): the user wants to see them first.

    Attributes:
        choose_file: asks the user for a path; None = he changed his mind.
    """

    written = Signal(str, int)
    failed = Signal(str)
    show_findings = Signal()

    def __init__(self, computation: Computation, notice: Notice, choose_file: Callable[[], Path | None]) -> None:
        super().__init__()
        self._computation, self._notice = computation, notice
        self.choose_file = choose_file
        self._waiting = False
        computation.finished.connect(self._on_finished)
        computation.failed.connect(self._forget)

    def start(self) -> None:
        """Export the job as it is now."""
        if self._computation.state is State.CURRENT:
            self._ask()
        else:
            self._waiting = True
            if self._computation.state is not State.RUNNING:
                self._computation.start()

    def _forget(self, _: str) -> None:
        self._waiting = False

    def _on_finished(self) -> None:
        if self._waiting:
            self._waiting = False
            self._ask()

    def _ask(self) -> None:
        made = self._computation.made
        if made is None or not len(made.program.moves):
            self.failed.emit("There is no path to write: the drawing has no closed contour that the tools fit into.")
            return
        counting = [f for f in worst_first(made.findings) if f.counts]
        if not counting:
            self._write()
            return
        sentence = f"{counted(len(counting), 'finding')}; the worst: {short(counting[0])}. Look at it before the file is written."
        self._notice.ask(sentence, [("Show findings", self.show_findings.emit), ("Write anyway", self._write)], error=True)

    def _write(self) -> None:
        made = self._computation.made
        if made is None or self._computation.state is not State.CURRENT:
            self.failed.emit("The job has changed; export it again.")
            return
        path = self.choose_file()
        if path is None:
            return
        path = path if path.suffix else path.with_suffix(SUFFIX)
        try:
            write_atomically(path, made.nc.text.encode("ascii"))
        except HitofudeError as error:
            self.failed.emit(str(error))
        else:
            self.written.emit(str(path), made.nc.text.count("\n"))
