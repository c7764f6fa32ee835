"""The plain way of figure 11, on a program over the die."""

from app.core.progress import NO_PROGRESS
from app.exhibits.die_programs import DieProgram, block
from app.exhibits.figure_eleven import plain_cut
from app.simulation.field.workpiece import Heights
from app.simulation.sweeps.chains import chains_of

CHORD = 1e-3
"""mm; how far chords may lie off the moves."""


def plain_heights(program: DieProgram, cells: int) -> Heights:
    """What a program over the die leaves, every cell of every move's box looked at."""
    [(_, chains)] = chains_of(program.course(), program.cutters, CHORD)
    return plain_cut(block(cells), chains, program.radius, NO_PROGRESS)
