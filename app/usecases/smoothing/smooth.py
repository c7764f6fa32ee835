"""`hitofude smooth`: straight feed moves of any NC program become lines, arcs or splines within a proven tolerance.

What goes out is read back from its own bytes, and each stretch that was written anew is judged against the moves it
stands for. One that does not pass, or takes more blocks than it had, stays as it was.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...core.effort import Reckoning, announce
from ...core.errors import InputError
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...core.wording import counted
from ...fitting.point_curves.effective_method import EffectiveMethod
from ...fitting.point_curves.smoothness import of_curve, of_points
from ...gcode.interpreter.options import PATIENT, ReadOptions
from ...gcode.interpreter.program import NcProgram
from ...gcode.interpreter.reader import read_program
from ...gcode.rework.stretches import FeedStretch, RewrittenText, rewrite
from ...gcode.writer.blocks import Blocks
from .context import SmoothContext, resolved
from .fit import StretchFit, fit_all, fit_stretch
from .proof import JudgedStretch, judged, require_the_rest
from .report import certificate
from .result import OutputForm, SmoothedProgram, SmoothedStretch, SmoothOptions


def smooth(name: str, data: bytes, options: SmoothOptions, progress: Progress = NO_PROGRESS) -> SmoothedProgram:
    """Return a program whose stretches of straight feed moves are written anew.

    Args:
        name: of the file, for messages.
        data: its bytes.
        options: tolerance and form.
        progress: told of how much is done.

    Raises:
        InputError: the program cannot be read to its end, or has nothing that can be smoothed.
        Cancelled: the job was asked to stop.
    """
    context = resolved(name, data, options, progress.part(0.0, 0.2))
    announce(smooth_effort(context.found.stretches, options.form, options.effective), progress)
    fits = fit_all(context, progress.part(0.2, 0.7))
    written = _written_until_proven(name, context, fits, progress)
    require_the_rest(context, written.program, written.text)
    return _with_certificate(_smoothed(name, context, written), context, written)


@dataclass(frozen=True, eq=False)
class _WrittenStretches:
    """A new text in which every stretch either is proven or stays as it was.

    Attributes:
        fits: what became of each stretch. text: the new one. program: as its control reads it.
        judged: of the stretches that were written anew, by number.
    """

    fits: list[StretchFit]
    text: RewrittenText
    program: NcProgram
    judged: Mapping[int, JudgedStretch]

    @property
    def blocks(self) -> dict[int, tuple[str, ...]]:
        """The new blocks of the stretches that were written anew."""
        return _blocks(self.fits)


def _written_until_proven(
    name: str, context: SmoothContext, fits: list[StretchFit], progress: Progress
) -> _WrittenStretches:
    """Write, read back and judge; what does not pass is fitted in a narrower region, or stays, until all does."""
    post = context.post
    reading = ReadOptions(post.dialect, limits=PATIENT, units=context.options.units)
    while True:
        text = rewrite(context.source.data, context.found.stretches, _blocks(fits), ())
        program = read_program(text.data, reading, progress.part(0.7, 0.8))
        if program.error is not None:
            raise InputError(f"{post.title} does not read what is written for it: {program.error.message(name)}")
        answers = judged(context, fits, program, text, progress.part(0.8, 1.0))
        failed = {k: each.fault for k, each in answers.items() if each.fault}
        if not failed:
            return _WrittenStretches(fits, text, program, answers)
        fits = list(fits)
        for k, fault in failed.items():
            narrower = replace(fits[k], tube=fits[k].tube + 1)
            if narrower.tube < len(context.tubes):
                fits[k] = fit_stretch(context, k, narrower, progress.part(0.2, 0.7))
            else:
                fits[k] = replace(fits[k], blocks=(), kept=fault)


def _blocks(fits: list[StretchFit]) -> dict[int, tuple[str, ...]]:
    return {k: fit.blocks for k, fit in enumerate(fits) if not fit.kept}


def _smoothed(name: str, context: SmoothContext, written: _WrittenStretches) -> SmoothedProgram:
    """Return what was made of a program, before its certificate stands in it."""
    source = context.source
    return SmoothedProgram(
        name=name,
        options=context.options,
        source=source.source,
        before=source.program,
        after=written.program,
        data=written.text.data,
        pieces=tuple(_piece(context, written, k) for k in range(len(written.fits))),
        found=context.found,
        dialects=(source.dialect, source.post.dialect),
        off=source.off,
        nearness=context.nearness,
    )


def _piece(context: SmoothContext, written: _WrittenStretches, k: int) -> SmoothedStretch:
    """Return one stretch, before and after."""
    stretch, points, fit, answer = context.found.stretches[k], context.points[k], written.fits[k], written.judged.get(k)
    count = stretch.stop - stretch.first
    at = context.corners(points) if len(points) > 2 else np.array([0])
    before = of_points(points, points[at])
    kept = SmoothedStretch(
        stretch=stretch,
        points=points,
        blocks=(count, count),
        curve=None,
        judgement=None,
        kept=fit.kept,
        before=before,
        after=before,
        corners=at,
        classes=fit.classes,
        lines=context.source.lines(stretch),
    )
    if answer is None:
        return kept
    return replace(
        kept,
        blocks=(count, len(fit.blocks)),
        curve=answer.curve,
        judgement=answer.judgement,
        after=of_curve(answer.curve, points[at]),
        near=answer.near,
        rounded=answer.lost.rounded,
        kinds=answer.kinds,
        refusals=fit.refusals,
        rounds=fit.rounds,
    )


def _with_certificate(done: SmoothedProgram, context: SmoothContext, written: _WrittenStretches) -> SmoothedProgram:
    """Return the program with its certificate as comment lines in the text."""
    head = Blocks(context.post, context.program.states[0].units)
    for line in certificate(done):
        head.comment(line)
    text = rewrite(context.source.data, context.found.stretches, written.blocks, head.lines)
    return replace(done, data=text.data)


_POINT_S = {OutputForm.LINES: 6e-6, OutputForm.ARCS: 6e-5, OutputForm.NURBS: 2e-4}
"""A point of a stretch that is fitted anew and proven; measured on programs of 20,000 to 100,000 points."""


def smooth_effort(stretches: Sequence[FeedStretch], form: OutputForm, effective: EffectiveMethod | None) -> Reckoning:
    """Return what fitting a program's stretches takes."""
    points = sum(stretch.stop - stretch.first for stretch in stretches)
    as_lines = f"smooth it as lines ({option('as', 'lines')}), or in parts"
    return Reckoning(
        points * _POINT_S[form] * (1.0 if effective is None else 2.0),
        f"{points:,} moves in {counted(len(stretches), 'stretch', 'stretches', ',')}",
        "smooth it in parts" if form is OutputForm.LINES else as_lines,
    )
