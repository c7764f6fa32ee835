"""How long smoothing will take, reckoned from counts before it is begun.

Seconds a point are measured on programs of 20,000 to 100,000 points.
"""

from __future__ import annotations

from collections.abc import Sequence

from ...core.effort import Reckoning
from ...core.options import option
from ...core.wording import counted
from ...fitting.point_curves.effective_method import EffectiveMethod
from ...gcode.rework.stretches import FeedStretch
from .result import OutputForm

_POINT_S = {OutputForm.LINES: 6e-6, OutputForm.ARCS: 6e-5, OutputForm.NURBS: 2e-4}
"""A point of a stretch that is fitted anew and proven."""


def smooth_effort(stretches: Sequence[FeedStretch], form: OutputForm, effective: EffectiveMethod | None) -> Reckoning:
    """Return what fitting a program's stretches takes."""
    points = sum(stretch.stop - stretch.first for stretch in stretches)
    as_lines = f"smooth it as lines ({option('as', 'lines')}), or in parts"
    return Reckoning(
        points * _POINT_S[form] * (1.0 if effective is None else 2.0),
        f"{points:,} moves in {counted(len(stretches), 'stretch', 'stretches', ',')}",
        "smooth it in parts" if form is OutputForm.LINES else as_lines,
    )
