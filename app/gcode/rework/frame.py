"""Frame the job: a program that goes round the box of another one at clearance, by rapids, with the spindle off.

The operator sees where the work will be, and that neither clamps nor the ends of the travel are in the way.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from ...core.errors import ParameterError
from ...model.job import Job
from ...model.moves import MoveKind
from ..posts import Post
from ..timing.extent import Extent
from ..writer.blocks import Blocks
from ..writer.header import safe_name
from ..writer.template_fields import Fields, Position, program_fields
from ..writer.write import blend_mm

SPINNING = ("{speed", "{dwell", "{coolant")
"""Fields of the blocks that a frame leaves out."""


@dataclass(frozen=True, slots=True)
class JobFrame:
    """What to go round.

    Attributes:
        box: of the cutting motions, mm, program coordinates; the tool's centre goes along its sides.
        clearance: height, mm, program coordinates.
        tool: T number of the one to do it with, whose length counts; 0 = whatever is in the spindle.
    """

    box: Extent
    clearance: float
    tool: int = 0


def frame_text(frame: JobFrame, job: Job, post: Post) -> str:
    """Return the program, for the same control, units and work offset.

    Args:
        frame: what to go round.
        job: units, and the part's name.
        post: the control's dialect; its blocks for the tool are written but for spindle, dwell and coolant.

    Raises:
        ParameterError: the box has no size along X or Y, as nothing is cut.
    """
    if not all(math.isfinite(value) for value in (*frame.box.low[:2], *frame.box.high[:2], frame.clearance)):
        raise ParameterError("Nothing is cut in this program, so there is no box to go round; compute a path first.")
    blocks, fields = Blocks(post, job.out_units), program_fields(job, post, blend_mm(job, post))
    digits, unit = post.digits(job.out_units), job.out_units.value
    z = round(frame.clearance / unit * 10**digits.Z)
    _write(blocks, post.program.top, fields)
    blocks.comment(f"Frame of {safe_name(job.part.name)}")
    blocks.comment("Round the box of the cuts at clearance height, by rapids, the spindle off")
    _write(blocks, post.program.start, fields)
    _home(blocks, post, fields)
    if frame.tool:
        known = fields | {"tool": frame.tool, "preselect": "", "clearance": blocks.number(z, digits.Z)}
        for template in post.program.tool:
            if "{clearance" in template:
                blocks.clearance(template.format(**known).strip(), z)
            elif not any(field in template for field in SPINNING):
                blocks.block(template.format(**known).strip())
    blocks.rapid_z(z)
    for x, y in _corners(frame.box):
        end: Position = (round(x / unit * 10**digits.X), round(y / unit * 10**digits.Y), z)
        blocks.straight(MoveKind.RAPID, end)
    _home(blocks, post, fields)
    _write(blocks, post.program.end, fields)
    return "\n".join(blocks.lines) + "\n"


def _corners(box: Extent) -> tuple[tuple[float, float], ...]:
    """Return the corners from the lower left one round to it again."""
    (x0, y0, _), (x1, y1, _) = box.low, box.high
    return ((x0, y0), (x1, y0), (x1, y1), (x0, y1), (x0, y0))


def _home(blocks: Blocks, post: Post, fields: Fields) -> None:
    for template in post.program.home:
        blocks.home(template.format(**fields).strip())


def _write(blocks: Blocks, templates: tuple[str, ...], fields: Fields) -> None:
    for template in templates:
        blocks.block(template.format(**fields).strip())
