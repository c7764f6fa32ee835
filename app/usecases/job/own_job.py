"""The job that lies in the file of a drawing."""

from __future__ import annotations

from dataclasses import replace

from ...formats.readers import known_format
from .options import MakeOptions


def with_own_job(name: str, data: bytes, options: MakeOptions) -> MakeOptions:
    """Return the options with the job of a file that holds one, a project, unless they bring another.

    Args:
        name: of the file; its suffix tells the kind.
        data: its bytes.

    Raises:
        InputError: the file cannot be read.
    """
    format_ = known_format(name)
    if options.job is not None or format_ is None or format_.job is None:
        return options
    return replace(options, job=format_.job(name, data))
