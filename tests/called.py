"""A command called in this process: what it answers is what its user reads, half a second sooner than from a process of
its own. Where streams, signals or what is imported are the point, tests start one.
"""

from __future__ import annotations

import io
from contextlib import redirect_stderr, redirect_stdout
from typing import NamedTuple

from app.cli.main import main


class Called(NamedTuple):
    """What a command answered.

    Attributes:
        returncode: its exit status.
        stdout, stderr: what it printed.
    """

    returncode: int
    stdout: str
    stderr: str


def call(*arguments: object) -> Called:
    """Run `hitofude ARGUMENTS` here.

    Args:
        arguments: as they are typed, in any type that prints so.
    """
    with redirect_stdout(io.StringIO()) as out, redirect_stderr(io.StringIO()) as err:
        status = main([str(each) for each in arguments])
    return Called(status, out.getvalue(), err.getvalue())
