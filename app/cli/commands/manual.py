"""`hitofude manual`: the pages of the manual as a folder for browsers, with search, in all languages that it has."""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.errors import InputError
from ...core.resources import resource
from ...usecases.manual.site import static_manual
from ..command import CliCommand, OptionParser
from ..files import shown_progress
from ..outcome import CommandOutcome
from ..signals import StopFlag

EPILOG = """\
OUT/index.html is its first page, OUT/index_ja.html the Japanese one. The pages need no server and nothing from anywhere
else; put them on one as they are. Exit status 0: done; 2: the folder cannot be written.
"""


def _add_options(parser: OptionParser) -> None:
    words = "the folder to write to, made where there is none"
    parser.add_argument("-o", "--output", metavar="OUT", type=Path, required=True, help=words)
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Write the pages and return the exit status, 0."""
    out: Path = arguments.output
    if out.exists() and not out.is_dir():
        raise InputError(f"--output {out} is a file; name a folder")
    if not out.absolute().parent.is_dir():
        raise InputError(f"--output {out}: there is no folder {out.parent}; make it first")
    progress = shown_progress(arguments.quiet, stopped)
    docs = resource("docs")
    files = {path.relative_to(docs).as_posix(): path.read_bytes() for path in sorted(docs.rglob("*")) if path.is_file()}
    site = {out / name: data for name, data in static_manual(files).items()}
    folders = sorted({out, *(path.parent for path in site)})
    outcome = CommandOutcome(site, [str(out / "index.html")], folders=folders)
    return outcome.delivered(arguments, progress)


COMMAND = CliCommand(
    "manual",
    needs="-o and the folder to write to",
    about="Write the manual as a folder of pages for browsers, with a search, in all languages that it has.",
    epilog=EPILOG,
    add_options=_add_options,
    run=_run,
    examples=("hitofude manual -o site",),
)
