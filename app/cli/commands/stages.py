"""`hitofude stages`: writes every numbered step of one of the five texts as a picture with its figures; of the text of
1986 what the workstation's display memory holds after it.
"""

from __future__ import annotations

import argparse

from ...exhibits.films.step import TEXTS, PublishedText
from ..command import CliCommand
from ..files import shown_progress
from ..signals import StopFlag
from ..stages_options import EPILOG, add_stages_options, ensure_of_text, stages_folder
from ..stages_outcome import film_outcome, stages_outcome


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    folder, text = stages_folder(arguments), TEXTS[arguments.text]
    progress = shown_progress(arguments.quiet, stopped)
    ensure_of_text(arguments, text)
    make = stages_outcome if text is PublishedText.A else film_outcome
    return make(arguments, folder, progress).delivered(arguments, progress)


COMMAND = CliCommand(
    "stages",
    needs="the folder to write to",
    about=(
        "Write every numbered step of one of the five texts, on a file or on its sample; of that of 1986 the display "
        "memory after every step."
    ),
    epilog=EPILOG,
    add_options=add_stages_options,
    run=_run,
    examples=(
        "hitofude stages part.dxf -o steps --contour-tool 2 --pocket-tool 4",
        "hitofude stages --text E -o steps",
    ),
)
