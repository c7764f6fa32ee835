"""How the tests are shared out among processes: a file's tests stay together, and so do all that want a screen of their
own.
"""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

import pytest

ON_A_SCREEN = ("tests/ui/real_mouse/", "tests/ui/cut/test_on_screen.py")
"""Tests with a real mouse and focus: two at once would slow one another until somebody's patience ends."""


COSTS = {"tests/ui/test_snapshots": 40, "tests/core/": 10, "tests/ui/": 6, "tests/test_cli": 6, "tests/workflow/": 3}
"""How much longer a test takes here than elsewhere, about: what takes long begins early, so that the processes end
together.
"""


class _DearestFirst(OrderedDict[str, dict[str, bool]]):
    """Groups of tests that are left, the dearest of which is taken first."""

    def popitem(self, last: bool = True) -> tuple[str, dict[str, bool]]:
        """Take one."""
        group = max(self, key=lambda name: len(self[name]) * cost_of(name))
        return group, self.pop(group)


def cost_of(group: str) -> int:
    """Return what a test of a group costs, about, in those of most rooms."""
    return next((cost for place, cost in COSTS.items() if group.startswith(place)), 6 if group == "screen" else 1)


def group_of(nodeid: str) -> str:
    """Return what a test has to stay together with: its file, whose window and results it shares, or the screen."""
    file = nodeid.split("::")[0]
    return "screen" if file.startswith(ON_A_SCREEN) else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Hand out whole groups."""
    from xdist.scheduler import LoadScopeScheduling

    class ByGroup(LoadScopeScheduling):
        def __init__(self, config: pytest.Config, log: Any) -> None:
            super().__init__(config, log)
            self.workqueue = _DearestFirst()

        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

    return ByGroup(config, log)
