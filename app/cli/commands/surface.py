"""`hitofude surface`: tool paths over the surfaces of a scene, told apart by surface: NC, plot, table of points,
report.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path

from ...core.atomic import write_together
from ...core.errors import InputError
from ...formats.plot.surface_plot import VIEWS, PlotColouring
from ...formats.scene.toml import read_scene, sources_of
from ...usecases.surface import ComputedScene, compute
from ...usecases.surface_loop import closed_loop
from ...usecases.surface_nc import WrittenScene, write_scene_nc
from ...usecases.surface_plot import FORMATS, PlotScene, PlottedPart, plot_surface
from ...usecases.surface_points import scene_points_csv
from ...usecases.surface_report import surface_report
from ..command import CliCommand, OptionParser
from ..files import check_outputs, read_input, shown_progress
from ..output import finding_lines, tell
from ..signals import StopFlag, undisturbed
from ..values import number

EPILOG = """\
The scene tells surfaces, stock, tools and families of passes; resources/docs/scene.md explains every key. On each
cutting plane the topmost of all surfaces is followed; where the path passes from one to another, the boundary point is
solved for. Every move of the written program is read back and proven to go nowhere deeper into a surface than 0.0001
mm; it is cut out of the stock, and what the same tools reach and leave is told with its place. Files that the scene
names are looked for beside it. Exit status 0: done and proven; 1: with findings, or a move could not be proven; 2: bad
input; 130: cancelled.
"""


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 done and proven, 1 with findings."""
    outputs = _outputs(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    path: Path = arguments.scene
    scene = read_scene(path.name, read_input(path))
    sources = sources_of(lambda name: read_input(path.parent / name))
    computed = compute(scene, sources, progress.part(0.0, 0.5))
    written = (
        write_scene_nc(computed, progress.part(0.5, 0.7)) if "output" in outputs or arguments.loop is not None else None
    )
    report = surface_report(computed, written)
    if written is not None and arguments.loop is not None:
        report.data["loop"] = closed_loop(written, sources, arguments.loop, progress.part(0.7, 1.0))
    texts = dict(_texts(arguments, outputs, computed, written))
    if "report" in outputs:
        texts[outputs["report"]] = report.text().encode()
    progress.step(1.0)
    with undisturbed():
        write_together(texts)
    if not arguments.quiet:
        tell("\n".join([report.summary(), *finding_lines(report.findings)]))
    return 1 if any(finding.counts for finding in report.findings) else 0


def _add_options(parser: OptionParser) -> None:
    parser.add_argument("scene", metavar="SCENE.toml", type=Path, help="surfaces, stock, tools and passes")
    parser.add_argument(
        "-o", "--output", metavar="OUT.ngc", type=Path, help="the NC program; one a tool where the control changes none"
    )
    parser.add_argument(
        "--plot",
        metavar="OUT.svg|pdf|hpgl",
        type=Path,
        help="the paths drawn in the order of generation, by surface; also .plt and .png",
    )
    parser.add_argument(
        "--view", choices=list(VIEWS), default="isometric", help="from where the plot is seen (default isometric)"
    )
    parser.add_argument(
        "--look",
        choices=[look.value for look in PlotColouring],
        default=PlotColouring.COLOURS.value,
        help="what tells parts of the plot apart: colours of surfaces (default), line types of surfaces, or tools",
    )
    parser.add_argument(
        "--draw",
        choices=[drawn.value for drawn in PlottedPart],
        default=PlottedPart.PATHS.value,
        help="what is plotted: the cutters' paths (default), the compound surface, or both",
    )
    parser.add_argument(
        "--points", metavar="OUT.csv", type=Path, help="the compound surface and its boundary points as a table"
    )
    parser.add_argument(
        "--report", metavar="R.json", type=Path, help="everything that was computed and proven, as JSON"
    )
    parser.add_argument(
        "--loop",
        metavar="T",
        type=number("loop"),
        help="with --report: the program is cut, smoothed within T mm and cut again, all told in the report",
    )
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _outputs(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by their option, checked before any work is done."""
    outputs = {
        name: path for name in ("output", "plot", "points", "report") if (path := getattr(arguments, name)) is not None
    }
    if not outputs:
        raise InputError(
            "surface has nothing to write; add -o OUT.ngc, --plot OUT.svg, --points OUT.csv or --report R.json"
        )
    if "plot" in outputs and outputs["plot"].suffix.lower() not in FORMATS:
        raise InputError(f"--plot {outputs['plot']}: a plot is one of {', '.join(FORMATS)}; change the name")
    if arguments.loop is not None and "report" not in outputs:
        raise InputError("--loop tells what it finds in the report; add --report R.json")
    check_outputs(outputs, [arguments.scene])
    return outputs


def _texts(
    arguments: argparse.Namespace,
    outputs: dict[str, Path],
    computed: ComputedScene,
    written: WrittenScene | None,
) -> Iterator[tuple[Path, bytes]]:
    """Yield what to write, by file."""
    if "points" in outputs:
        yield outputs["points"], scene_points_csv(computed)
    if "plot" in outputs:
        path = outputs["plot"]
        what = PlotScene(VIEWS[arguments.view], PlotColouring(arguments.look), PlottedPart(arguments.draw))
        sheets = plot_surface(computed, path.suffix, what)
        for number, sheet in enumerate(sheets, 1):
            yield path if len(sheets) == 1 else path.with_name(f"{path.stem}_{number}{path.suffix}"), sheet
    if written is not None and "output" in outputs:
        for file in written.files:
            yield file.named(outputs["output"]), file.nc.text.encode()


COMMAND = CliCommand(
    "surface",
    "scene",
    "the scene and -o OUT.ngc",
    (
        "Compute tool paths over the surfaces of a scene, told apart by surface, and prove that they go into none of "
        "them."
    ),
    EPILOG,
    _add_options,
    _run,
)
