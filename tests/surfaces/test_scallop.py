"""Passes from the height of their ridges: on slopes the distance along the slope counts."""

from __future__ import annotations

import math

import numpy as np
import pytest

from app.core.errors import ParameterError
from app.formats.scene.toml import sources_of
from app.model.scene import Passes, Scene, Surface
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.passes.scallop import stepover_for_scallop
from app.surfaces.sections.compound import NO_SURFACE
from app.usecases.scene.compute import compute
from tests.surfaces.scenes import plane
from tests.surfaces.surface_places import no_data

RADIUS, HEIGHT = 3.0, 0.02


def ridges(slope_deg: float, tool: Tool) -> np.ndarray:
    """How high the ridges between neighbouring passes stand on a plane that is tilted across them, mm, square to it."""
    tilted = Surface("slope", plane(0, 0, 30, 20), rotate_deg=(slope_deg, 0.0, 0.0))
    scene = Scene("one", (tilted,), tools=(tool,), passes=(Passes(1, scallop=HEIGHT, overrun=0.0),))
    made = compute(scene, sources_of(no_data))
    moves = made.moves.moves
    ends = moves.end[made.moves.surface != NO_SURFACE]
    y = np.unique(np.round(ends[:, 1], 6))
    z = np.array([ends[np.abs(ends[:, 1] - each) < 1e-5, 2].min() for each in y])
    apart = np.hypot(np.diff(y), np.diff(z))
    return RADIUS - np.sqrt(RADIUS**2 - apart**2 / 4)


@pytest.mark.parametrize("slope_deg", [0.0, 30.0, 60.0])
def test_ridges_on_a_slope_are_as_high_as_asked(slope_deg: float) -> None:
    found = ridges(slope_deg, Tool(1, 2 * RADIUS, ToolKind.BALL))
    assert found.max() <= HEIGHT + 2e-5, "but for what the digits of the path add"
    assert np.median(found) == pytest.approx(HEIGHT, rel=0.02), "no nearer than they have to be, but for the last"


def test_the_step_on_a_flat_is_that_of_two_circles() -> None:
    step = stepover_for_scallop(RADIUS, HEIGHT)
    assert RADIUS - math.sqrt(RADIUS**2 - (step / 2) ** 2) == pytest.approx(HEIGHT)
    with pytest.raises(ParameterError, match="not more than the radius"):
        stepover_for_scallop(RADIUS, RADIUS + 0.1)
