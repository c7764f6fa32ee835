"""Where the parts of a batch, the choices of a study and the tiles of a cut are done: in processes, or on a cluster."""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from ..core.errors import InputError
from ..usecases.batch.lanes import ExecutorLane, Lane, ProcessLane, Work, do_part
from .command import OptionParser, number


def jobs_given(text: str) -> int:
    """Return a number of processes, for argparse."""
    if not text.isdecimal() or not 1 <= int(text) <= 1024:
        raise argparse.ArgumentTypeError(f"is wrong: '{text}' is no number of jobs; write one from 1 to 1024")
    return int(text)


def add_lane_options(parser: OptionParser, what: str) -> None:
    """Add the options of what is done by many processes into one folder.

    Args:
        what: they do, in words, such as "parts".
    """
    parser.add_argument(
        "-o",
        "--output",
        metavar="OUT",
        type=Path,
        required=True,
        help="the folder to write to, made where there is none",
    )
    parser.add_argument(
        "--jobs", metavar="N", type=jobs_given, help=f"{what} at a time, each in its own process (default: one a core)"
    )
    parser.add_argument(
        "--limit",
        metavar="MIN",
        type=number("limit", unit="min"),
        default=60.0,
        help=f"of {what}, one that takes longer is ended (default 60)",
    )
    add_scheduler_option(parser)
    parser.add_argument("--again", action="store_true", help=f"do all {what}, whatever is done already")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def add_scheduler_option(parser: argparse._ActionsContainer) -> None:
    """Add the option that has a cluster do the work."""
    parser.add_argument(
        "--scheduler", metavar="tcp://HOST:PORT", help="work on the cluster of this Dask scheduler (hitofude[cluster])"
    )


@contextmanager
def lanes_of(arguments: argparse.Namespace, count: int, work: Work = do_part) -> Iterator[list[Lane]]:
    """Give the lanes that so many parts are done on: processes of this machine, or places on a cluster.

    Args:
        work: does a part.

    Raises:
        InputError: there is no cluster, or what talks to it is not installed.
    """
    most = max(count, 1)
    if arguments.scheduler is None:
        yield [ProcessLane(work) for _ in range(min(arguments.jobs or os.cpu_count() or 1, most))]
        return
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError("--scheduler: Dask is not installed; pip install 'hitofude[cluster]'") from error
    try:
        client = Client(arguments.scheduler, timeout="10s")
    except (OSError, ValueError) as error:
        raise InputError(
            f"--scheduler {arguments.scheduler}: no cluster answers there ({error}); check the address"
        ) from error
    with client:
        threads = sum(client.nthreads().values())
        executor = client.get_executor(pure=False)
        yield [ExecutorLane(executor, work) for _ in range(min(arguments.jobs or threads or 1, most))]
