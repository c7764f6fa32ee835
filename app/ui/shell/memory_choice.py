"""How much memory a job of the window may take: a share of the machine's, chosen in the menu Compute and remembered."""

from __future__ import annotations

from dataclasses import replace
from functools import partial

from ...core.memory import allow, machine_memory
from ...core.settings import JobMemory
from ..framework.commands import Commands, on_trigger
from ..framework.preferences import Preferences

SHARES = {JobMemory.QUARTER: 0.25, JobMemory.HALF: 0.5, JobMemory.MOST: 0.75}
"""Of the machine's memory."""


class MemoryChoice:
    """Lets the user choose what a job may take. Jobs that begin afterwards go by it: a worker hands its own context on
    to them.
    """

    def __init__(self, preferences: Preferences, commands: Commands) -> None:
        """Allow what was chosen the last time."""
        self._preferences, self._commands = preferences, commands
        for choice in JobMemory:
            on_trigger(commands, f"memory_{choice.value}", partial(self._choose, choice))
        self._show(preferences.settings.memory)

    def _choose(self, choice: JobMemory) -> None:
        self._preferences.keep(replace(self._preferences.settings, memory=choice))
        self._show(choice)

    def _show(self, choice: JobMemory) -> None:
        self._commands[f"memory_{choice.value}"].setChecked(True)
        allow(int(SHARES[choice] * machine_memory()))
