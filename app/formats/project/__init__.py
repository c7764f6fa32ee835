"""Projects, `.hito` files: a drawing with its job."""

from __future__ import annotations

from ...model.job import Job
from ...model.reading import ReadingOptions
from ..drawing import Drawing
from ..registry import DrawingFormat

SUFFIXES = (".hito", ".hito~")
"""A project, and the backup of one."""


def _read(name: str, data: bytes, reading: ReadingOptions) -> Drawing:
    from .project import project_drawing

    return project_drawing(data, name, reading.units, reading.layers)


def _job(name: str, data: bytes) -> Job:
    from .project import read_project

    return read_project(name, data).state.job


PROJECT = DrawingFormat(SUFFIXES, _read, job=_job, hidden=SUFFIXES[1:])
