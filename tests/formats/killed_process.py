"""Draws, saves and keeps without end, as a window does; the process that it runs in is there to be killed."""

import os
from multiprocessing.connection import Connection
from pathlib import Path

from app.drafting.document import Document
from app.formats.project.files import load_project, save_project
from app.formats.project.project import Project
from app.formats.project.recovery import EditedFile, RecoveryFile


def draw_without_end(path: Path, config: str, told: Connection) -> None:
    """Tell (word, how many are drawn) after each time that the work was kept or saved."""
    os.environ["HITOFUDE_CONFIG"] = config
    document, stamp = Document(), None
    if path.exists():
        project, stamp = load_project(path)
        document.load_state(project.state, path)
    recovery = RecoveryFile()
    while True:
        document.run(f"circle {len(document.part.entities)},0 1.5")
        drawn = len(document.part.entities)
        recovery.keep(Project(document.state), EditedFile(path, stamp))
        told.send(("kept", drawn))
        if drawn % 2 == 0:
            stamp = save_project(path, Project(document.state), stamp)
            told.send(("saved", drawn))
