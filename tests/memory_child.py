"""Runs commands in a process of its own and tells how much memory the last one took.

Usage: python -m tests.memory_child FIRST.json: a list of commands, each a list of arguments; all but the last are run
before, so that what libraries take once is not counted.
"""

from __future__ import annotations

import gc
import json
import sys
import threading

from app.cli.main import main
from app.core.memory import resident


def watched(command: list[str]) -> dict[str, float]:
    """Run a command; return its status, and by how much the process's data grew meanwhile, bytes."""
    over, most = threading.Event(), [0]
    gc.collect()
    before = resident()

    def look() -> None:
        while not over.wait(0.002):
            most[0] = max(most[0], resident())

    watching = threading.Thread(target=look, daemon=True)
    watching.start()
    try:
        status = main(command)
    finally:
        over.set()
        watching.join()
    return {"status": status, "grown": max(most[0], resident()) - before, "most": most[0]}


if __name__ == "__main__":
    *before, last = json.loads(sys.argv[1])
    for each in before:
        main(each)
    print(json.dumps(watched(last)))
