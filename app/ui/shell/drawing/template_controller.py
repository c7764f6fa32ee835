"""What a drawing of one kind tells made into operations, as one step: its layers by a template's rules, its depths; on
a worker of its own.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from PySide6.QtWidgets import QFileDialog

from ....core.errors import InputError
from ....core.input_file import read_input
from ....core.progress import Progress
from ....model.finding import Finding
from ....model.job import Job
from ...framework.commands import Commands, on_trigger
from ...framework.figures import counted
from ...framework.workspace import Workspace
from ...panels.changes import Subject, SubjectKind
from ...panels.side_panel import SidePanel
from .operations_controller import OperationsController
from .proposal_controller import NOTHING_DRAWN

TEMPLATES = "Templates and job files (*.toml);;All files (*)"


@dataclass(frozen=True)
class AppliedTemplate:
    """A job with what a template says.

    Attributes:
        name: of its file. lines: what was made of each layer. findings: what was not.
    """

    name: str
    job: Job
    lines: tuple[str, ...]
    findings: tuple[Finding, ...]


def applied(path: Path, job: Job, progress: Progress) -> AppliedTemplate:
    """Return a job with the tools, the settings and the operations that a template says for its drawing; tables that
    the file does not have stay as they are.

    Raises:
        InputError: the file is no job file, has no rules, or none of them takes a layer.
    """
    from ....formats.job.toml import SETTINGS, read_job, settings_of
    from ....model.fields import with_values
    from ....usecases.job.drawn_depths import with_drawn_depths
    from ....usecases.job.layer_operations import with_layer_rules  # imports the engines: never on the window's thread
    from ....usecases.job.options import MakeOptions, with_feeds

    progress.step(0.0, f"Reading {path.name}")
    file = read_job(path.name, read_input(path))
    if not file.rules:
        raise InputError(f"{path.name} has no rules for layers, [[layer]]; choose a template that has some.")
    told = {
        placed.key: placed.of(file.job)
        for table in SETTINGS
        if table in file.tables
        for placed in settings_of(table).values()
    }
    base = replace(
        with_values(job, told),
        tools=file.job.tools if "tool" in file.tables else job.tools,
        operations=file.job.operations if "operation" in file.tables else (),
    )
    options = MakeOptions(job=base, rules=file.rules, propose_feeds=file.proposes_feeds)
    ruled = with_layer_rules(job.part, options)
    made = ruled.options.job
    assert made is not None
    lines, findings = ruled.lines, ruled.findings
    if file.drawn_depths:
        depths = with_drawn_depths(made)
        made, lines, findings = depths.job, (*lines, *depths.lines()), (*findings, *depths.findings)
    return AppliedTemplate(path.name, with_feeds(made, options).job, lines, findings)


@dataclass(frozen=True)
class TakenDepths:
    """A job cut to the depths of its drawing.

    Attributes:
        lines: what was read of each. findings: what was not understood.
    """

    job: Job
    lines: tuple[str, ...]
    findings: tuple[Finding, ...]


def to_drawn_depths(job: Job, progress: Progress) -> TakenDepths:
    """Return a job whose operations go as deep as its drawing tells.

    Raises:
        InputError: the drawing tells no depth.
    """
    from ....usecases.job.drawn_depths import with_drawn_depths  # imports the engines: never on the window's thread

    progress.step(0.0, "Reading depths")
    made = with_drawn_depths(job)
    return TakenDepths(made.job, tuple(made.lines()), made.findings)


class TemplateController(OperationsController):
    """Asks for a template and applies it, and takes the drawing's own depths."""

    def __init__(self, panel: SidePanel, workspace: Workspace, commands: Commands) -> None:
        super().__init__(panel, workspace, "Applying the template…")
        self._commands = commands
        on_trigger(commands, "apply_template", self.choose_file)
        on_trigger(commands, "drawn_depths", self.take_depths)

    def choose_file(self) -> None:
        """Ask for a file, and apply it."""
        folder = self._workspace.preferences.settings.last_folder
        name, _ = QFileDialog.getOpenFileName(self._panel, "Apply template", folder, TEMPLATES)
        if name:
            self.apply(Path(name))

    def apply(self, path: Path) -> None:
        """Have the rules of a file made into operations."""
        job = self._document.job
        if not job.part.entities:
            self.said.emit(NOTHING_DRAWN)
            return
        self._workspace.notice.dismiss()
        self._work_out(lambda progress: applied(path, job, progress), self._take_template)

    def take_depths(self) -> None:
        """Have the operations cut to the depths that the drawing tells."""
        job = self._document.job
        if not job.part.entities:
            self.said.emit(NOTHING_DRAWN)
            return
        self._workspace.notice.dismiss()
        self._work_out(lambda progress: to_drawn_depths(job, progress), self._take_depths)

    def _take_template(self, made: AppliedTemplate) -> None:
        self._panel.subject = Subject(SubjectKind.OPERATION, 0)
        self._document.change_job("Apply template", made.job)
        self._workspace.log.note(f"template {made.name}", "\n".join(line.strip() for line in made.lines))
        for finding in made.findings:
            self._workspace.log.note(f"template {made.name}", finding.text, error=finding.counts)
        count = counted(len(made.job.operations), "operation")
        self._workspace.notice.ask(
            f"{made.name}: {count} by the drawing's layers; the log says which.",
            [(text, self._commands[name].trigger) for text, name in (("Compute", "compute"), ("Undo", "undo"))],
        )
        self.said.emit(f"{made.name} is applied.")

    def _take_depths(self, made: TakenDepths) -> None:
        self._panel.subject = Subject(SubjectKind.OPERATION, 0)
        self._document.change_job("Depths from the drawing", made.job)
        self._workspace.log.note("depths", "\n".join(line.strip() for line in made.lines))
        for finding in made.findings:
            self._workspace.log.note("depths", finding.text, error=finding.counts)
        count = counted(len(made.job.operations), "operation")
        left = counted(sum(each.counts for each in made.findings), "depth")
        self._workspace.notice.ask(
            f"{count} by the drawing's depths, {left} not understood; the log says which.",
            [(text, self._commands[name].trigger) for text, name in (("Compute", "compute"), ("Undo", "undo"))],
        )
        self.said.emit("The drawing's depths are taken.")
