"""What the blocks of a post may name: the fields of its templates, filled in for a job and for a tool."""

from __future__ import annotations

import re

import numpy as np
from numpy.typing import NDArray

from ...model.job import Job
from ...model.part import Units
from ..posts import Coolant, Post

Fields = dict[str, str | int]

LAST_NUMBER = 7999
"""Fanuc and Haas keep higher program numbers for protected ones."""


def program_fields(job: Job, post: Post, blend_mm: float) -> Fields:
    """Return what every template may name.

    Args:
        job: units, exact path, and the part whose name may hold the program's number.
        post: the control's words.
        blend_mm: how far the control may leave the path, mm.
    """
    decimals = post.digits(job.out_units).X
    blend = spelled(round(blend_mm / job.out_units.value * 10**decimals), decimals)
    return {
        "units": post.units.inch if job.out_units is Units.INCH else post.units.mm,
        "blending": post.blending.exact if job.exact_path else post.blending.blend.format(blend=blend),
        "program": program_number(job.part.name, post.program.number),
    }


def program_number(name: str, otherwise: int) -> int:
    """Return the number at the end of a part's name if it can be a program's, else the other one."""
    digits = re.search(r"([0-9]+)\s*$", name)
    number = int(digits[1][-9:]) if digits else 0
    return number if 1 <= number <= LAST_NUMBER else otherwise


def tool_fields(job: Job, number: int, post: Post, next_tool: int) -> Fields:
    """Return what the templates round a tool may name besides.

    Args:
        job, number: the tool is the job's, by its T number.
        post: the control's words.
        next_tool: T number of the tool that comes next, or of this one.
    """
    tool, coolant, dwell = job.tool(number), post.coolant, post.spindle.dwell_s
    on = {Coolant.NONE: "", Coolant.FLOOD: coolant.flood, Coolant.MIST: coolant.mist}[coolant.use]
    return {
        "tool": tool.number,
        "speed": round(tool.spindle_speed),
        "spindle_on": "M4" if job.turns_left(number) else "M3",
        "dwell_s": f"{dwell:g}",
        "dwell_ms": round(dwell * 1000),
        "coolant_on": on,
        "coolant_off": coolant.off if on else "",
        "preselect": f"T{next_tool}" if next_tool != tool.number else "",
    }


# Numbers as a control reads them: whole counts of the last decimal, so that nothing is rounded twice.


Position = tuple[int, int, int]
"""X, Y and Z as counts of their last decimal."""


def whole(values: NDArray[np.float64], decimals: int) -> NDArray[np.int64]:
    """Return values as counts of their last decimal, the nearest ones."""
    return np.rint(values * 10.0**decimals).astype(np.int64)


def counts(values: NDArray[np.float64], decimals: int) -> list[int]:
    """Return the same as a list."""
    rounded: list[int] = whole(values, decimals).tolist()
    return rounded


def spelled(count: int, decimals: int) -> str:
    """Return a count of the last decimal as text with all its decimals; zero has no sign."""
    return f"{count / 10**decimals:.{decimals}f}"


def numeral(count: int, decimals: int, zeros: bool) -> str:
    """Return a count of the last decimal as the number of an axis word; without `zeros` only with those that count."""
    text = spelled(count, decimals)
    return text if zeros or "." not in text else text.rstrip("0")
