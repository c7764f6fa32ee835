"""Inlay: the pocket of the job and the plug that fits into it, worked out, laid into one another, and written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from PySide6.QtCore import Signal
from PySide6.QtWidgets import QDialog, QDialogButtonBox, QFileDialog, QLabel, QWidget

from ....core.atomic import write_together
from ....core.progress import Progress
from ....model.job import Job
from ...framework.boxes import v_box
from ...framework.catalogue import tr
from ...framework.commands import Commands, on_trigger
from ...framework.controller import Controller
from ...framework.fields import NumberField, NumberSpec
from ...framework.worker import Worker
from ...framework.workspace import Workspace
from ..files.proof import warning

if TYPE_CHECKING:
    from ....usecases.inlay import InlayOptions, InlayPair

_SPECS = (
    NumberSpec("Glue", high=1000.0, tip="between the plug's face and the pocket's floor"),
    NumberSpec("Gap", high=1000.0, tip="between the walls, sideways; at least half of the cutter's flat tip"),
    NumberSpec("To saw off", high=1000.0, tip="how far the plug stands out of the pocket"),
)
_HOW = (
    "The job's V-carving, with its flat tool, is the pocket. The plug is made of it, mirrored, and both are laid into "
    "one another before they are written."
)


class InlayForm(QDialog):
    """Asks how plug and pocket fit.

    Attributes:
        glue, gap, saw: in this order, mm.
    """

    def __init__(self, over: QWidget, wished: InlayOptions) -> None:
        super().__init__(over)
        self.setWindowTitle(tr("Inlay"))
        fields = [NumberField(spec) for spec in _SPECS]
        self.glue, self.gap, self.saw = fields
        buttons = QDialogButtonBox(QDialogButtonBox.StandardButton.Ok | QDialogButtonBox.StandardButton.Cancel)
        buttons.button(QDialogButtonBox.StandardButton.Ok).setText(tr("Make both"))
        buttons.button(QDialogButtonBox.StandardButton.Cancel).setText(tr("Cancel"))
        buttons.accepted.connect(self.accept)
        buttons.rejected.connect(self.reject)
        how = QLabel(tr(_HOW))
        how.setWordWrap(True)
        how.setProperty("role", "muted")
        column = v_box(self, (16, 12, 16, 12))
        column.addWidget(how)
        for field, value in zip(fields, (wished.glue, wished.gap, wished.saw), strict=True):
            field.show_value(value)
            column.addWidget(field)
        column.addWidget(buttons)

    @property
    def wished(self) -> InlayOptions:
        """What was asked for."""
        from ....usecases.inlay import InlayOptions

        return InlayOptions(self.glue.number, self.gap.number, self.saw.number)


@dataclass(frozen=True, eq=False)
class _MadeInlay:
    pair: InlayPair
    path: Path


def _make(job: Job, wished: InlayOptions, path: Path, progress: Progress) -> _MadeInlay:
    from ....usecases.inlay import inlay_of  # imports the engines: never on the window's thread

    return _MadeInlay(inlay_of(job, wished, progress), path)


class InlayController(Controller):
    """Asks how they fit and where they go, has both made, and writes them; where something is wrong, only when told.

    Signals:
        written(paths).

    Attributes:
        ask: gives what is wished, given what was last; None = the user changed his mind.
        choose_file: gives what both programs begin with, given a first choice; None likewise.
    """

    written = Signal(list)

    def __init__(self, over: QWidget, workspace: Workspace, commands: Commands) -> None:
        """Make one; `over` is the widget over which it asks."""
        super().__init__(over)
        self._over, self._workspace = over, workspace
        self._wished: InlayOptions | None = None
        self.ask: Callable[[InlayOptions], InlayOptions | None] = self._ask
        self.choose_file: Callable[[Path], Path | None] = self._choose
        self.worker = Worker(self)
        workspace.activity.follow(self.worker, "Making pocket and plug…")
        self.worker.failed.connect(lambda answer: self.failed.emit(f"{answer.error} Nothing was written."))
        on_trigger(commands, "inlay", self.start)

    def start(self) -> None:
        """Make the inlay of the job as it is now."""
        from ....usecases.inlay import InlayOptions

        document = self._workspace.document
        wished = self.ask(self._wished or InlayOptions())
        if wished is None:
            return
        self._wished = wished
        stem = document.path.stem if document.path else document.part.name or "inlay"
        path = self.choose_file(self._workspace.preferences.last_folder / stem)
        if path is not None:
            self._workspace.notice.dismiss()
            self.worker.start(partial(_make, document.job, wished, path), document.revision, self._on_made)

    def _ask(self, first: InlayOptions) -> InlayOptions | None:
        form = InlayForm(self._over, first)
        return form.wished if form.exec() else None

    def _choose(self, first: Path) -> Path | None:
        name, _ = QFileDialog.getSaveFileName(self._over, tr("What both programs begin with"), str(first))
        return Path(name) if name else None

    def _on_made(self, made: _MadeInlay) -> None:
        pair, notice = made.pair, self._workspace.notice
        self._workspace.log.note(f"inlay {made.path.name}", pair.fit.summary())
        findings = tuple(each for each in (*pair.findings, *pair.pocket.findings, *pair.plug.findings) if each.counts)
        for each in findings:
            self._workspace.log.note(f"inlay {made.path.name}", each.text, error=True)
        if pair.clean:
            self._write(made)
        else:
            notice.ask(warning(findings), [("Write anyway", partial(self._write, made))], error=True)

    def _write(self, made: _MadeInlay) -> None:
        files = made.pair.files(made.path)
        write_together(files)
        if made.pair.clean:
            self._workspace.notice.ask(f"{made.pair.fit.summary()}.")
        self.said.emit(f"{', '.join(path.name for path in files)} are written.")
        self.written.emit(list(files))
