"""How much memory a job of the window may take: a share of the machine's, chosen in the menu Compute and remembered."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from ...core.memory import allow, machine_memory
from ...core.settings import JobMemory
from .main_window import MainWindow

SHARES = {JobMemory.QUARTER: 0.25, JobMemory.HALF: 0.5, JobMemory.MOST: 0.75}
"""Of the machine's memory."""


class MemoryChoice:
    """Lets the user choose what a job may take. Jobs that begin afterwards go by it: a worker hands its own context on
    to them.
    """

    def __init__(self, window: MainWindow) -> None:
        """Allow what was chosen the last time."""
        self._preferences = window.preferences
        self._window = window
        for choice in JobMemory:
            window.actions_[f"memory_{choice.value}"].triggered.connect(partial(self._choose, choice))
        self._show(window.preferences.settings.memory)

    def _choose(self, choice: JobMemory, *_: object) -> None:
        self._preferences.keep(replace(self._preferences.settings, memory=choice))
        self._show(choice)

    def _show(self, choice: JobMemory) -> None:
        self._window.actions_[f"memory_{choice.value}"].setChecked(True)
        allow(int(SHARES[choice] * machine_memory()))
