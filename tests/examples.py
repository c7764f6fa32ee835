"""How many examples hypothesis tries: a few in every run, all of them with `--all`."""

from __future__ import annotations

import os

QUICK_SHARE, FEWEST = 6, 4
PROFILE = os.environ.get("HITOFUDE_HYPOTHESIS", "quick")
"""`quick`: a share of the examples, the same each time; `full`: all, the same each time; `default`: all, searched for
anew.
"""


def examples(count: int) -> int:
    """Return how many of `count` examples are tried in this run."""
    return max(min(count, FEWEST), count // QUICK_SHARE) if PROFILE == "quick" else count
