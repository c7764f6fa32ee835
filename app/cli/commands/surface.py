"""`hitofude surface`: tool paths over the surfaces of a scene, told apart by surface: NC, plot, table of points,
report.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from ...core.input_file import read_input
from ...usecases.surface_files import SceneOutputs, scene_files
from ..command import CliCommand
from ..files import shown_progress
from ..outcome import CommandOutcome
from ..output import finding_lines
from ..signals import StopFlag
from ..surface_options import EPILOG, add_surface_options, curves_over, facets_of, plot_scene, surface_files


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 done and proven, 1 with findings."""
    outputs = surface_files(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    path: Path = arguments.scene
    requested = SceneOutputs(
        **outputs,
        plotted=plot_scene(arguments),
        loop=arguments.loop,
        curves=curves_over(arguments),
        facets=facets_of(arguments),
    )
    made = scene_files(path.name, read_input(path), lambda name: read_input(path.parent / name), requested, progress)
    lines = [*made.lines, *finding_lines(made.findings)]
    return CommandOutcome(made.files, lines, made.counts).delivered(arguments, progress)


COMMAND = CliCommand(
    "surface",
    reads="scene",
    needs="the scene and -o OUT.ngc",
    about=(
        "Compute tool paths over the surfaces of a scene, told apart by surface, and prove that they go into none of "
        "them."
    ),
    epilog=EPILOG,
    add_options=add_surface_options,
    run=_run,
    examples=(
        "hitofude surface compound.toml -o compound.ngc --plot compound.svg",
        "hitofude surface compound.toml -o curves.ngc --smooth 0.03",
    ),
)
