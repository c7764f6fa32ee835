"""What the stock is made of, on which machine, and a button that proposes speed and feeds of the tool for it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from PySide6.QtWidgets import QPushButton

from ...core.errors import HitofudeError
from ...formats.machine_toml import load_machine, machine_files
from ...formats.tools.materials import stock_materials
from ...model.job import Job
from ...model.machine import Machine
from ...model.tool import Tool
from ...toolpath.feeds.proposal import FeedProposal
from ...usecases.job.feeds import feeds_of_job
from ..framework.catalogue import tr
from ..framework.fields import ListField
from ..framework.form import FormSection, JobEdit
from ..framework.labels import muted
from .changes import with_tool

ANY = "Any"
NO_MATERIAL = "Choose what the stock is made of."


class FeedProposalGroup:
    """Rows of a tool's form below its speed and feeds.

    Attributes:
        stock, machine: what feeds are proposed for. button: proposes them. limits: what held them down.
    """

    def __init__(self, form: FormSection, number: Callable[[], int]) -> None:
        """Add the rows to a form; `number` tells the T number of the form's tool."""
        self._form, self._number = form, number
        self._made: FeedProposal | None = None
        self.stock = ListField("Stock of", [])
        form.add_choice("Material", self.stock, lambda job, v: replace(job, stock=replace(job.stock, material=str(v))))
        self.machine = ListField("Machine", [("", ANY), *((name, _title(name)) for name in machine_files())])
        self.machine.show_value("")
        form.add(self.machine)
        self.button = QPushButton("Propose feeds")
        self.button.clicked.connect(lambda: form.edited.emit(JobEdit("Propose feeds", self._proposed)))
        form.add(self.button)
        self.limits = muted()
        self.limits.setWordWrap(True)
        form.add(self.limits)

    def _proposed(self, job: Job) -> Job:
        """Return the job with the speed and the feeds that are proposed for the form's tool.

        Raises:
            HitofudeError: nobody says what the stock is made of, or the machine cannot be read.
        """
        made = feeds_of_job(job, self._number(), self._chosen_machine())
        self._made = made
        return with_tool(job, made.tool.number, made.tool)

    def _chosen_machine(self) -> Machine | None:
        return load_machine(str(self.machine.value)) if self.machine.value else None

    def show(self, job: Job, tool: Tool) -> None:
        """Show what the stock is made of, and what held the tool's feeds down where they are those proposed."""
        word, wrong = job.stock.material, ""
        try:
            choices: list[tuple[object, str]] = [(each.word, each.title) for each in stock_materials()]
        except HitofudeError as error:
            choices, wrong = [], str(error)
        if word and word not in [value for value, _ in choices]:
            choices.append((word, word))
        self.stock.set_choices([("", "Unknown"), *choices])
        self.stock.show_value(word, wrong)
        self.button.setEnabled(bool(word))
        self.button.setToolTip("" if word else NO_MATERIAL)
        held = (
            []
            if self._made is None or not self._is_made(tool)
            else [tr(each.text) for each in self._made.reasons if each.held]
        )
        self.limits.setText("\n".join(held))
        self.limits.setVisible(bool(held))

    def _is_made(self, tool: Tool) -> bool:
        made = self._made.tool if self._made else None
        return made is not None and (made.number, made.spindle_speed, made.feed_rate, made.plunge_rate) == (
            tool.number,
            tool.spindle_speed,
            tool.feed_rate,
            tool.plunge_rate,
        )

    def reason(self, tool: Tool, key: str) -> str:
        """Return why a number of the tool is what it is, a line for each step; "" where it was not proposed.

        Args:
            key: spindle_speed, feed_rate or plunge_rate.
        """
        if self._made is None or not self._is_made(tool):
            return ""
        behind = _BEHIND[key]
        return "\n".join(tr(each.text) for each in self._made.reasons if each.key in behind)


def _title(name: str) -> str:
    """Return what a machine is called; its file's name where that cannot be read."""
    try:
        return load_machine(name).title
    except HitofudeError:
        return name


_BEHIND = {
    "spindle_speed": ("surface_speed", "spindle_speed"),
    "feed_rate": ("feed_per_tooth", "power", "deflection", "feed_rate"),
    "plunge_rate": ("plunge_rate",),
}
"""Keys of the reasons that a number rests on."""
