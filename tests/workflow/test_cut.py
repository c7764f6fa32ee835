"""What a made program leaves of its stock: the bytes that are written, cut."""

from functools import cache

import numpy as np
import pytest

from app.resources import resource
from app.workflow.cut import CutProgram, cut_made
from app.workflow.make import Made, make
from app.workflow.options import MakeOptions

CELLS = 512


@cache
def made(post: str) -> Made:
    return make("fig2.dxf", resource("samples", "fig2.dxf").read_bytes(), MakeOptions(post=post))


@cache
def cut(post: str) -> CutProgram:
    return cut_made(made(post), CELLS)


def test_the_floor_is_flat_at_its_depth_and_the_rest_is_untouched() -> None:
    result = cut("linuxcnc")
    heights = result.cut.heights
    assert set(np.unique(heights).tolist()) == {-2.0, 0.0}
    assert (result.top, result.floor) == (0.0, -10.0)
    assert not result.cut.rapids


def test_as_much_is_cut_as_the_tools_reach() -> None:
    left = made("linuxcnc").report.data["left"]
    reached = left["floor_mm2"] - left["reachable_mm2"] - left["unreachable_mm2"]
    assert cut("linuxcnc").cut.removed_volume == pytest.approx(2.0 * reached, rel=2e-3)


def test_every_cell_knows_its_line() -> None:
    result = cut("linuxcnc")
    owner = result.cut.owner
    assert owner is not None
    assert np.array_equal(owner >= 0, result.cut.heights < 0)
    cutting = np.unique(result.lines()[owner[owner >= 0]])
    text = made("linuxcnc").nc.text.splitlines()
    assert not [line for line in cutting.tolist() if "G0" in text[line - 1]]
    assert set(np.unique(result.tools()[owner[owner >= 0]]).tolist()) == {1, 2}


def test_a_file_for_each_tool_leaves_the_same() -> None:
    one, several = cut("linuxcnc"), cut("grbl")
    assert len(made("grbl").files) == 2
    assert np.array_equal(one.cut.heights, several.cut.heights)
    assert set(np.unique(several.tools()).tolist()) == {1, 2}
