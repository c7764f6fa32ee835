"""How the tests are shared out among processes: a file's tests stay together, and so do all that want a screen of their
own.
"""

from __future__ import annotations

import tomllib
from collections import OrderedDict
from pathlib import Path
from typing import Any

import pytest

ON_A_SCREEN = ("tests/ui/real_mouse/", "tests/ui/cut/test_on_screen.py")
"""Tests with a real mouse and focus: two at once would slow one another until somebody's patience ends."""

OF_SENTENCES = ("tests/api/test_words.py", "tests/ui/test_sentences_in_japanese.py")
"""Tests of all that the program says, read out of its whole source: once for them all."""

SECONDS: dict[str, float] = tomllib.loads((Path(__file__).parent / "costs.toml").read_text("utf-8"))["seconds"]
"""Of the processor for a test, about, by what its name begins with."""

DEFAULT_S = 0.05


class DearestFirst(OrderedDict[str, dict[str, bool]]):
    """Groups of tests that are left, the dearest of which is taken first."""

    def __init__(self) -> None:
        super().__init__()
        self._costs: dict[str, float] = {}

    def popitem(self, last: bool = True) -> tuple[str, dict[str, bool]]:
        """Take one."""
        group = max(self, key=self._cost)
        return group, self.pop(group)

    def _cost(self, group: str) -> float:
        if group not in self._costs:  # all of a group are there before the first one is taken
            self._costs[group] = sum(map(seconds_of, self[group]))
        return self._costs[group]


def seconds_of(nodeid: str) -> float:
    """Return the processor seconds that a test takes, about."""
    begun = max((begin for begin in SECONDS if nodeid.startswith(begin)), key=len, default="")
    return SECONDS.get(begun, DEFAULT_S)


def group_of(nodeid: str) -> str:
    """Return what a test has to stay together with: its file, whose window and results it shares, the screen, or what
    the program says.
    """
    file = nodeid.split("::")[0]
    if file in OF_SENTENCES:
        return "sentences"
    return "screen" if file.startswith(ON_A_SCREEN) else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Hand out whole groups."""
    from xdist.scheduler import LoadScopeScheduling

    class ByGroup(LoadScopeScheduling):
        def __init__(self, config: pytest.Config, log: Any) -> None:
            super().__init__(config, log)
            self.workqueue = DearestFirst()

        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

    return ByGroup(config, log)
