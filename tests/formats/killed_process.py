"""Draws, saves and keeps without end, as a window does; `python -m tests.formats.killed_process FILE` is there to be
killed.
"""

import sys
from pathlib import Path

from app.drafting.document import Document
from app.formats.project.files import load_project, save_project
from app.formats.project.project import Project
from app.formats.project.recovery import EditedFile, RecoveryFile


def main() -> None:
    path = Path(sys.argv[1])
    document, stamp = Document(), None
    if path.exists():
        project, stamp = load_project(path)
        document.load_state(project.state, path)
    recovery = RecoveryFile()
    while True:
        document.run(f"circle {len(document.part.entities)},0 1.5")
        drawn = len(document.part.entities)
        recovery.keep(Project(document.state), EditedFile(path, stamp))
        print("kept", drawn, flush=True)
        if drawn % 2 == 0:
            stamp = save_project(path, Project(document.state), stamp)
            print("saved", drawn, flush=True)


if __name__ == "__main__":
    main()
