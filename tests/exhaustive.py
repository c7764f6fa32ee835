"""Which tests run with `./hitofude test --all` only.

A test carries the mark `exhaustive` where it stands, or, where only some members of a family do, by the table of
families.
"""

from __future__ import annotations

import tomllib
from pathlib import Path

import pytest

FAMILIES = tomllib.loads((Path(__file__).parent / "families.toml").read_text("utf-8"))
"""Families of which only some members run each time: by "file::test" those that do, or else those that do not."""

COLLECTED = pytest.StashKey[dict[str, bool]]()
"""Every collected test, before any is left out: whether it is exhaustive. Benchmarks are in neither set."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark what the table names, before anything is chosen by marks."""
    for item in items:
        if is_left_to_all(item.nodeid):
            item.add_marker("exhaustive")
    config.stash[COLLECTED] = {
        item.nodeid: item.get_closest_marker("exhaustive") is not None
        for item in items
        if item.get_closest_marker("benchmark") is None
    }


def is_left_to_all(nodeid: str) -> bool:
    """Return whether the table of families leaves a test to `--all`."""
    family, member = nodeid.split("[")[0], parameters_of(nodeid)
    return member not in FAMILIES["run_each_time"].get(family, (member,)) or member in FAMILIES["exhaustive"].get(
        family, ()
    )


def parameters_of(nodeid: str) -> str:
    """Return what stands in the brackets behind a test's name."""
    return nodeid.partition("[")[2].removesuffix("]")
