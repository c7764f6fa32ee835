"""`hitofude check`: reads any NC program, tells what is wrong with it, how far it reaches and how long it takes."""

from __future__ import annotations

import argparse
from collections.abc import Mapping
from pathlib import Path

from ...core.atomic import write_together
from ...core.errors import InputError
from ...core.progress import Progress
from ...gcode.interpreter.dialect import Dialect
from ...gcode.interpreter.options import ToolOffset
from ...gcode.interpreter.program import ProgramProblem, Severity
from ...gcode.rework.compare import ProgramDifferences
from ...model.part import Units
from ...usecases.examine import CONTROLS, ExaminedProgram, ExamineOptions, compared, examine
from ..command import CliCommand, OptionParser
from ..files import check_outputs, read_input, shown_progress
from ..output import tell
from ..signals import StopFlag, undisturbed
from ..values import MACHINE_HELP, machine_named, typed

TOLD = 20
"""Problems and differences that are printed; the report has all."""

EPILOG = """\
Prints each problem with its place, then extent, length and time. Exit status 0: nothing is wrong; 1: there are
problems, or --compare found other motion; 2: a file cannot be used. Coordinates are those of the program, tool lengths
taken off.
"""


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with problems or differences."""
    outputs = _outputs(arguments)
    progress = shown_progress(arguments.quiet, stopped)
    data = read_input(arguments.program)
    examined = examine(arguments.program.name, data, _options(arguments), progress.part(0.0, 0.5))
    differences = _differences(arguments, examined, progress.part(0.5, 0.8))
    texts = _texts(arguments, outputs, examined, (data, differences))
    progress.step(1.0)
    with undisturbed():
        write_together({outputs[name]: text for name, text in texts.items()})
    if not arguments.quiet:
        tell("\n".join([*_lines(examined), *_difference_lines(arguments.compare, differences)]))
    return 1 if examined.problems or (differences is not None and not differences.same_motion) else 0


def _add_options(parser: OptionParser) -> None:
    parser.add_argument("program", metavar="PROGRAM.ngc", type=Path, help="the NC program")
    parser.add_argument("--dialect", choices=list(CONTROLS), help="the control's language (default: as the text looks)")
    parser.add_argument("--tools", metavar="FILE", type=Path, help="tools: LinuxCNC's .tbl, or a library .toml or .csv")
    parser.add_argument(
        "--tool-units", choices=["mm", "in"], default="mm", help="of the lengths in a .tbl (default mm)"
    )
    parser.add_argument(
        "--block-delete",
        choices=["on", "off"],
        default="on",
        help="leave out the blocks that begin with a slash, or do them (default on)",
    )
    parser.add_argument("--machine", metavar="NAME|FILE", type=typed(machine_named), help=MACHINE_HELP)
    parser.add_argument("--compare", metavar="OTHER.ngc", type=Path, help="another program: where its motion differs")
    parser.add_argument(
        "--frame",
        metavar="OUT.ngc",
        type=Path,
        help="write a program round the box of the cuts, by rapids, spindle off",
    )
    parser.add_argument(
        "--restart-at",
        metavar="LINE",
        type=int,
        help="write, to -o, a program that leads in and goes on from this line",
    )
    parser.add_argument("-o", "--output", metavar="OUT.ngc", type=Path, help="of --restart-at")
    parser.add_argument("--report", metavar="R.json", type=Path, help="everything that was found, as JSON")
    parser.add_argument("--quiet", action="store_true", help="say nothing but errors")


def _outputs(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by their option, checked before any work is done."""
    if (arguments.restart_at is None) != (arguments.output is None):
        raise InputError("--restart-at LINE and -o OUT.ngc go together; give both or none")
    outputs = {name: path for name in ("frame", "output", "report") if (path := getattr(arguments, name)) is not None}
    check_outputs(
        outputs, [path for name in ("program", "tools", "compare") if (path := getattr(arguments, name)) is not None]
    )
    return outputs


def _options(arguments: argparse.Namespace) -> ExamineOptions:
    dialect = Dialect(arguments.dialect) if arguments.dialect else None
    return ExamineOptions(
        dialect, _tools(arguments.tools, arguments.tool_units), arguments.machine, arguments.block_delete == "on"
    )


def _tools(path: Path | None, units: str) -> Mapping[int, ToolOffset]:
    """Return the control's tool table as a file tells it."""
    if path is None:
        return {}
    from ...formats.tools.files import read_rows
    from ...gcode.tool_offsets import tool_offsets

    return tool_offsets(read_rows(path.name, read_input(path), Units.INCH if units == "in" else Units.MM))


def _differences(
    arguments: argparse.Namespace, examined: ExaminedProgram, progress: Progress
) -> ProgramDifferences | None:
    if arguments.compare is None:
        return None
    return compared(examined, arguments.compare.name, read_input(arguments.compare), progress)


def _texts(
    arguments: argparse.Namespace,
    outputs: dict[str, Path],
    examined: ExaminedProgram,
    found: tuple[bytes, ProgramDifferences | None],
) -> dict[str, bytes]:
    """Return what to write, by option."""
    data, differences = found
    texts: dict[str, bytes] = {}
    if "report" in outputs:
        texts["report"] = examined.text(differences).encode()
    if "frame" in outputs:
        texts["frame"] = examined.frame().encode("ascii")
    if "output" in outputs:
        from ...gcode.rework.restart import RestartOptions, restart

        texts["output"] = restart(data, arguments.restart_at, RestartOptions(examined.read))
    return texts


def _lines(examined: ExaminedProgram) -> list[str]:
    """Return the problems, and what was measured, for people."""
    lines = [f"  ! {_problem_words(problem, examined.name)}" for problem in examined.problems[:TOLD]]
    if len(examined.problems) > TOLD:
        lines.append(f"  - {len(examined.problems) - TOLD} more; --report R.json lists them all")
    report = examined.report()
    length, parts = report["length_mm"], report["time_parts_s"]
    count = len(examined.problems)
    what = "no problem" if not count else "1 problem" if count == 1 else f"{count} problems"
    lines.insert(
        0,
        f"{examined.name}: {what} as {CONTROLS[report['control']]} reads it; {sum(report['moves'].values())} motions "
        f"in {report['lines']} lines, {length['cut']:.1f} mm cut, {length['rapid']:.1f} mm rapid",
    )
    for title, box in (("cuts", examined.cut_box), ("all", examined.box)):
        sides = (
            f"{axis} {low:.3f} to {high:.3f}"
            for axis, low, high in zip("XYZ", box.low, box.high, strict=True)
            if low == low
        )
        lines.append(f"  {title}: {', '.join(sides) or 'nothing'} mm")
    lines.append(
        f"  time: {_clock(report['time_s'])} min (cut {_clock(parts['cut'])}, rapid {_clock(parts['rapid'])}, dwells "
        f"and tool changes {_clock(parts['wait'])}), machine: {examined.machine.title}"
    )
    lines += [f"  {_tool_words(tool)}: {_clock(tool['time_s'])} min" for tool in report["tools"]]
    return lines


def _problem_words(problem: ProgramProblem, file: str) -> str:
    return f"{problem.message(file)}{' (a warning)' if problem.severity is Severity.WARNING else ''}"


def _tool_words(tool: dict[str, object]) -> str:
    if not tool["number"]:
        return "a tool without a number"
    diameter = f" {tool['diameter_mm']:g} mm" if tool["diameter_mm"] else ""
    return f"T{tool['number']}{' ' if tool['kind'] else ''}{tool['kind']}{diameter}"


def _clock(seconds: float) -> str:
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes}:{rest:02d}"


def _difference_lines(path: Path | None, differences: ProgramDifferences | None) -> list[str]:
    if path is None or differences is None:
        return []
    lines = [
        f"  {'-' if differences.same_motion else '!'} line {item.a.first_line} and {path.name}:{item.b.first_line}: "
        f"{item.kind.value}{': ' if item.text else ''}{item.text}"
        for item in differences.items[:TOLD]
    ]
    more = [f"  - {len(differences.items) - TOLD} more differences"] if len(differences.items) > TOLD else []
    return [f"{path.name}: {'the same motion' if differences.same_motion else 'other motion'}", *lines, *more]


COMMAND = CliCommand(
    "check",
    "program",
    "the NC program",
    "Read an NC program as its control would, and tell what there is to know of it.",
    EPILOG,
    _add_options,
    _run,
)
