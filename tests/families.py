"""Of which families of tests only some members run each time."""

from __future__ import annotations

KEPT: dict[str, frozenset[str]] = {}
"""By the test's file and name, the parameters of those that run each time; all others are exhaustive."""
