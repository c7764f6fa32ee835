"""`hitofude feeds`: speed and feeds of tools in a material on a machine, each number with its reason."""

from __future__ import annotations

import argparse
import json
from dataclasses import replace

from ...formats.tools.files import write_tools
from ...toolpath.feeds.proposal import FeedProposal, proposed_feeds
from ...usecases.job.feeds import feeds_report
from ..command import CliCommand
from ..feeds_options import (
    EPILOG,
    add_feeds_options,
    check_feeds_options,
    feeds_options,
    requested_engagement,
    requested_tools,
)
from ..files import check_outputs, named_files, shown_progress
from ..outcome import CommandOutcome
from ..signals import StopFlag


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 where chips are too thin."""
    outputs = named_files(arguments, "write", "report")
    check_outputs(outputs, [*named_files(arguments, "tools").values()])
    library, options = requested_tools(arguments), feeds_options(arguments)
    engagement = requested_engagement(arguments)
    made = tuple(proposed_feeds(tool, arguments.material, engagement, options.machine) for tool in library.tools)
    files = {}
    if "write" in outputs:
        kept = replace(library, tools=tuple(each.tool for each in made))
        files[outputs["write"]] = write_tools(outputs["write"].name, kept)
    if "report" in outputs:
        files[outputs["report"]] = (json.dumps(feeds_report(made, options), indent=2, allow_nan=False) + "\n").encode()
    lines = [line for each in made for line in _lines(each)]
    progress = shown_progress(arguments.quiet, stopped)
    return CommandOutcome(files, lines, any(each.rubs for each in made)).delivered(arguments, progress)


def _lines(made: FeedProposal) -> list[str]:
    return [made.summary(), *(f"  {'! ' if why.held else ''}{why.text}" for why in made.reasons)]


COMMAND = CliCommand(
    "feeds",
    needs="the material of the stock, and a tool or a file of tools",
    about="Tell how fast tools may turn and feed in a material, and why.",
    epilog=EPILOG,
    add_options=add_feeds_options,
    run=_run,
    check=check_feeds_options,
    examples=("hitofude feeds --material aluminium --tool flat:6 --flutes 2",),
)
