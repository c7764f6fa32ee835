"""A program whose passes are lifted onto smooth surfaces: its text with other places in it, all else byte for byte."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ...core.errors import GeometryError
from ...core.progress import Progress
from ...fitting.fitted import lines_between
from ...gcode.interpreter.options import ReadOptions
from ...gcode.interpreter.reader import read_program
from ...gcode.interpreter.text import ProgramBuffer
from ...gcode.posts import load_post
from ...gcode.rework.stretches import find_stretches, rewrite
from ...gcode.writer.curve_blocks import BlockFormat, curve_blocks
from ...model.motion import Floats
from ..smoothing.source import usual_post
from .pieces import PassLifter, SmoothedPieces


@dataclass(frozen=True, eq=False)
class LiftedText:
    """A program with lifted passes.

    Attributes:
        data: its bytes. boundaries: (b, 3) places where passes go from one surface to the next, mm. apart: (b,) by how
            much the two differ in height there, mm.
        chord_mm: how far chords of the lifted passes are from the surfaces at most, proven.
    """

    data: bytes
    boundaries: Floats
    apart: Floats
    chord_mm: float


def lifted_text(
    data: bytes, reading: ReadOptions, smoothed: SmoothedPieces, chord: float, progress: Progress
) -> LiftedText:
    """Return a program whose passes lie on smooth surfaces.

    Args:
        data: of the program. reading: how it is read. smoothed: the surfaces of the tip.
        chord: how far chords may be from them, mm.
        progress: told of how much is done.

    Raises:
        GeometryError: what was written cannot be read. Cancelled: the job was asked to stop.
    """
    post = load_post(usual_post(reading.dialect))
    program = read_program(data, reading, progress.part(0.0, 0.2))
    found = find_stretches(program, ProgramBuffer(data), progress.part(0.2, 0.3))
    lifter, blocks, made = PassLifter(smoothed, chord), {}, []
    for k, stretch in enumerate(found.stretches):
        progress.step(0.3 + 0.5 * k / len(found.stretches), "Lifting passes")
        each = lifter.lifted(stretch.points)
        state = program.states[int(program.motions.state[stretch.first])]
        spelling = BlockFormat(post, state, stretch.feed, stretch.resumed)
        blocks[k] = curve_blocks(lines_between(each.points), spelling)
        made.append(each)
    text = rewrite(data, found.stretches, blocks, ()).data
    again = read_program(text, reading, progress.part(0.8, 1.0))
    if again.error is not None:
        raise GeometryError(f"the lifted passes cannot be read back: {again.error.text}")
    return LiftedText(
        text,
        np.concatenate([np.zeros((0, 3)), *(each.boundaries for each in made)]),
        np.concatenate([np.zeros(0), *(each.apart for each in made)]),
        max((each.chord_mm for each in made), default=0.0),
    )
