"""How the tests are shared out among processes: a file's tests stay together, and so do all that want a screen of their own."""

from __future__ import annotations

from typing import Any

import pytest

ON_A_SCREEN = ("tests/ui/real_mouse/", "tests/ui/cut/test_on_screen.py")
"""Tests with a real mouse and focus: two at once would slow one another until somebody's patience ends."""


def group_of(nodeid: str) -> str:
    """Return what a test has to stay together with: its file, whose window and results it shares, or the screen."""
    file = nodeid.split("::")[0]
    return "screen" if file.startswith(ON_A_SCREEN) else file


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Hand out whole groups."""
    from xdist.scheduler import LoadScopeScheduling

    class ByGroup(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            return group_of(nodeid)

    return ByGroup(config, log)
