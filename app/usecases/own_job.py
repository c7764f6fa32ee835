"""The job that lies in the file of a drawing."""

from __future__ import annotations

from dataclasses import replace
from pathlib import PurePath

from ..formats.readers import PROJECTS
from .options import MakeOptions


def with_own_job(name: str, data: bytes, options: MakeOptions) -> MakeOptions:
    """Return the options with the job of a project file, unless they bring another.

    Args:
        name: of the file; its suffix tells the kind.
        data: its bytes.

    Raises:
        InputError: it is a project file that cannot be read.
    """
    if options.job is not None or PurePath(name).suffix.lower() not in PROJECTS:
        return options
    from ..formats.project.project import read_project

    return replace(options, job=read_project(name, data).state.job)
