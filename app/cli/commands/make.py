"""`hitofude make`: reads the files, runs the make workflow, writes the files."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path

from ...core.atomic import write_together
from ...core.errors import InputError
from ...usecases.make import MakeResult, make
from ...usecases.options import MakeOptions
from ..command import CliCommand
from ..files import check_outputs, identity, read_input, shown_progress
from ..make_options import EPILOG, add_make_options, make_options
from ..output import finding_lines, tell
from ..signals import StopFlag, undisturbed
from ..timings import StageTimes

_JOB_HEAD = "# A job file of Hitofude for {}: `hitofude make DRAWING -o OUT.ngc --job` this file."


def _run(arguments: argparse.Namespace, stopped: StopFlag) -> int:
    """Do the work and return the exit status: 0 clean, 1 with findings."""
    outputs = _check_outputs(arguments)
    options = _with_tools(_with_job(make_options(arguments), arguments.job), arguments.tools)
    times = StageTimes() if arguments.timings else None
    progress = shown_progress(arguments.quiet, stopped)
    made = make(
        arguments.drawing.name, read_input(arguments.drawing), options, times.watch(progress) if times else progress
    )
    if times:
        made = replace(made, report=made.report.with_timings(times.seconds()))
    names = [file.named(arguments.output) for file in made.files]
    _write(made, outputs, names)
    if not arguments.quiet:
        _summary(made, names)
        if times:
            tell("\n".join(times.lines()))
    return 0 if made.clean else 1


def _with_job(options: MakeOptions, path: Path | None) -> MakeOptions:
    """Return the options with the job file read, where there is one."""
    if path is None:
        return options
    from ...formats.job.toml import read_job

    file = read_job(path.name, read_input(path))
    return replace(options, job=file.job, units=options.units or file.units)


def _with_tools(options: MakeOptions, path: Path | None) -> MakeOptions:
    """Return the options with the tools that a proposal chooses from: of a library, else of the job file."""
    if options.propose is None or (path is None and options.job is None):
        return options
    from ...formats.tools.files import read_tools

    own = options.job.tools if options.job is not None else ()
    tools = own if path is None else read_tools(path.name, read_input(path))[0].tools
    return replace(options, propose=replace(options.propose, tools=tuple(tools)))


def _check_outputs(arguments: argparse.Namespace) -> dict[str, Path]:
    """Return the files to write by what they hold, checked before any work is done."""
    outputs = {
        name: path
        for name in ("output", "report", "image", "write_job")
        if (path := getattr(arguments, name)) is not None
    }
    if "image" in outputs and outputs["image"].suffix.lower() not in (".svg", ".png"):
        raise InputError(f"--image {outputs['image']}: a picture is .svg or .png; change the name")
    inputs = (arguments.drawing, arguments.job, arguments.tools)
    check_outputs(outputs, [path for path in inputs if path is not None])
    return outputs


def _write(made: MakeResult, outputs: dict[str, Path], names: list[Path]) -> None:
    """Make every picture and text first, then write all files together."""
    texts = {"report": made.report.text().encode()}
    if "write_job" in outputs:
        from ...formats.job.write import job_lines

        texts["write_job"] = ("\n".join([_JOB_HEAD.format(made.job.part.name), *job_lines(made.job)]) + "\n").encode()
    if "image" in outputs:
        from ...formats.plot.plot import plot
        from ...usecases.picture import picture_of

        texts["image"] = plot(
            picture_of(made.job.part.name, made.program, made.coverage), outputs["image"].suffix.lower()
        )
    others = {outputs[name]: text for name, text in texts.items() if name in outputs}
    if {identity(path) for path in names} & {identity(path) for path in others}:
        raise InputError(
            f"--output {outputs['output']} makes {', '.join(map(str, names))}, and one of these is another output; "
            "give every file its own name"
        )
    with undisturbed():
        write_together(
            others | {name: file.nc.text.encode("ascii") for name, file in zip(names, made.files, strict=True)}
        )


def _summary(made: MakeResult, names: list[Path]) -> None:
    """Say in a few lines what was made and what there is to know about it, the first few of each kind."""
    proposed = made.proposal.lines() if made.proposal is not None else []
    tell("\n".join([made.report.summary(", ".join(map(str, names))), *proposed, *finding_lines(made.findings)]))


COMMAND = CliCommand(
    "make",
    "drawing",
    "the drawing and the NC program to write",
    "Turn a drawing or a picture into tool paths for pockets, rests, contours and holes, and write them as an NC "
    "program, read back and proven the same.",
    EPILOG,
    add_make_options,
    _run,
)
