"""Which tests run with `./hitofude test --all` only.

A test carries the mark `exhaustive` where it stands, or, where only some members of a family do, by the table of families.
"""

from __future__ import annotations

import pytest

from tests.families import KEPT

COLLECTED = pytest.StashKey[dict[str, bool]]()
"""Every collected test, before any is left out: whether it is exhaustive. Benchmarks are in neither set."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what the table names, before anything is chosen by marks."""
    for item in items:
        kept = KEPT.get(item.nodeid.split("[")[0])
        if kept is not None and parameters_of(item.nodeid) not in kept:
            item.add_marker("exhaustive")
    config.stash[COLLECTED] = {
        item.nodeid: item.get_closest_marker("exhaustive") is not None for item in items if item.get_closest_marker("benchmark") is None
    }


def parameters_of(nodeid: str) -> str:
    """Return what stands in the brackets behind a test's name."""
    return nodeid.partition("[")[2].removesuffix("]")
