"""Export NC: what is written is what was computed, read back and cut; the verdict is shown before the file is kept."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import QObject, Signal

from ....core.atomic import write_together
from ....core.errors import HitofudeError
from ....gcode.posts import load_post, post_names
from ...framework.computation import Computation, ComputationState
from ...framework.notice import Notice
from .proof import proof, warning

if TYPE_CHECKING:
    from ....usecases.making.make import MakeResult


def post_filters() -> dict[str, str]:
    """Return what the file dialog offers, and the post of each; posts that are damaged are left out."""
    found = {}
    for name in post_names():
        with suppress(HitofudeError):
            post = load_post(name)
            found[f"{post.title} (*{post.extension})"] = name
    return found


@dataclass(frozen=True, slots=True)
class ExportPlace:
    """Where a program goes, and for which control it is written: the name of its post."""

    path: Path
    post: str


ChooseFile = Callable[[str, str], ExportPlace | None]


class NcExportController(QObject):
    """Computes first when the paths are out of date, asks for the file and its control, writes it whole or not at all.

    A control that changes no tools gets a file for each tool beside the chosen name: all of them, or none.

    Signals:
        written(paths, lines): every file, and the lines of all. failed(sentence). show_findings(): the user wants to
        see them first. post_chosen(name): the job shall be written for another control.

    Attributes:
        choose_file: asks the user for a path and a control, given what goes between the name and its suffix, and the
            control that the job is for; None = he changed his mind.
    """

    written = Signal(list, int)
    failed = Signal(str)
    show_findings = Signal()
    post_chosen = Signal(str)

    def __init__(self, computation: Computation, notice: Notice, choose_file: ChooseFile) -> None:
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
        self._look_first(made, self._write)

    def _look_first(self, made: MakeResult, write: Callable[[], None]) -> None:
        """Say what is proven of a program and write it; or say what is wrong, and leave that to the user."""
        if made.clean:
            self._notice.ask(proof(made), of_job=True)
            write()
            return
        self._notice.ask(
            warning(made.findings),
            [("Show", self.show_findings.emit), ("Write anyway", write)],
            error=True,
            of_job=True,
        )

    def _write(self) -> None:
        made = self._computation.made
        if made is None or self._computation.state is not ComputationState.CURRENT:
            self.failed.emit("The job has changed; export it again.")
            return
        place = self._chosen(made, "")
        if place is None:
            return
        if place.post == made.job.post:
            self._write_to(place.path)
        else:
            self.post_chosen.emit(place.post)
            self._when_computed(lambda: self._write_for_another(place.path))

    def _write_for_another(self, path: Path) -> None:
        """Write the program that was computed for the control that was chosen with the file."""
        made = self._made()
        if made is not None:
            self._look_first(made, lambda: self._write_to(path))

    def _write_to(self, path: Path) -> None:
        made = self._computation.made
        if made is not None:
            self._keep({file.named(path): file.nc.text for file in made.files})

    def _write_frame(self) -> None:
        made = self._made()
        place = self._chosen(made, "_frame") if made is not None else None
        if made is not None and place is not None:
            self._keep({place.path: made.frame()})

    def _chosen(self, made: MakeResult, suffix: str) -> ExportPlace | None:
        """Ask for a file; a name without an extension gets that of its post."""
        place = self.choose_file(suffix, made.job.post)
        if place is None or place.path.suffix:
            return place
        return replace(place, path=place.path.with_suffix(load_post(place.post).extension))

    def _keep(self, texts: dict[Path, str]) -> None:
        """Write all files or none."""
        try:
            write_together({path: text.encode("ascii") for path, text in texts.items()})
        except HitofudeError as error:
            self.failed.emit(str(error))
        else:
            self.written.emit(list(texts), sum(text.count("\n") for text in texts.values()))
