"""The least values: what would vanish in the digits of an NC program is refused by name, value, unit and limit."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from app.core.errors import ParameterError
from app.model.entry import Lead
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Part
from app.model.tool import Tool


@pytest.mark.parametrize(
    ("build", "words"),
    [
        (lambda: CutParameters(1, depth=0.0009), "Depth is 0.0009 mm; use 0.001 to 99999 mm"),
        (lambda: CutParameters(1, depth=math.nan), "Depth is nan mm; use 0.001 to 99999 mm"),
        (lambda: CutParameters(1, stepdown=1e-9), "Stepdown is 1e-09 mm; use 0.001 to 99999 mm"),
        (
            lambda: CutParameters(1, depth=20.0, stepdown=0.019),
            "Depth 20 mm in steps of 0.019 mm makes 1053 passes; 1000 are the most",
        ),
        (lambda: Lead(overlap=50.1), "Lead overlap is 50.1 mm; use 0 to 50 mm"),
        (lambda: PocketOperation(CutParameters(1), 0.0005), "Stepover is 0.0005 mm; use 0.001 to 9999 mm"),
        (lambda: Tool(3, 6.0, feed_rate=0.5), "T3: feed rate is 0.5 mm/min; it must be 1 mm/min or more"),
        (lambda: Tool(3, 6.0, plunge_rate=1e-6), "T3: plunge rate is 1e-06 mm/min; it must be 1 mm/min or more"),
        (lambda: Tool(3, 0.0), "T3: diameter is 0 mm; it must be 0.001 mm or more"),
        (lambda: Tool(3, 1e-300), "T3: diameter is 1e-300 mm; it must be 0.001 mm or more"),
        (
            lambda: Tool(3, 6.0, spindle_speed=2e6),
            "T3: spindle speed is 2e+06 rpm; it must be greater than 0 rpm and less than 1000000 rpm",
        ),
        (
            lambda: Job(Part(), safe_z=0.0005, retract_z=0.0005),
            "Safe Z is 0.0005 mm and retract Z 0.0005 mm; both must be 0.001 mm or more",
        ),
        (
            lambda: Job(Part(), retract_z=0.0005),
            "Safe Z is 5 mm and retract Z 0.0005 mm; both must be 0.001 mm or more",
        ),
        (lambda: Job(Part(), join_tolerance=1000.0), "Join tolerance is 1000 mm; use 0 to 10 mm"),
        (lambda: Job(Part(), join_tolerance=-1.0), "Join tolerance is -1 mm; use 0 to 10 mm"),
    ],
)
def test_what_nc_digits_cannot_hold_is_refused(build: Callable[[], object], words: str) -> None:
    with pytest.raises(ParameterError) as error:
        build()
    assert words in str(error.value)


def test_the_least_values_themselves_are_accepted() -> None:
    assert CutParameters(1, depth=0.001, stepdown=0.001).depth == 0.001
    assert CutParameters(1, depth=1.0, stepdown=0.001).stepdown == 0.001
    assert PocketOperation(CutParameters(1), 0.001).stepover == 0.001
    assert Tool(1, 6.0, feed_rate=1.0, plunge_rate=1.0).feed_rate == 1.0
    assert Job(Part(), safe_z=0.001, retract_z=0.001, join_tolerance=10.0).retract_z == 0.001
