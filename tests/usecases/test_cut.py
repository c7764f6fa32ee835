"""What a made program leaves of its stock: the bytes that are written, cut."""

from functools import cache

import numpy as np
import pytest

from app.core.resources import resource
from app.usecases.cutting.cut import CutProgram
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make


@cache
def made(post: str) -> MakeResult:
    return make("fig2.dxf", resource("samples", "fig2.dxf").read_bytes(), MakeOptions(post=post))


def cut(post: str) -> CutProgram:
    result = made(post).cut
    assert result is not None
    return result


def test_the_floor_is_flat_at_its_depth_and_the_rest_is_untouched() -> None:
    result = cut("linuxcnc")
    assert set(np.unique(result.cut.heights).tolist()) == {-2.0, 0.0}
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
    cutting = np.unique(result.setup.lines()[owner[owner >= 0]])
    text = made("linuxcnc").nc.text.splitlines()
    assert not [line for line in cutting.tolist() if "G0" in text[line - 1]]
    assert set(np.unique(result.setup.numbers()[owner[owner >= 0]]).tolist()) == {1, 2}


def test_a_file_for_each_tool_leaves_the_same() -> None:
    one, several = cut("linuxcnc"), cut("grbl")
    assert len(made("grbl").files) == 2
    assert np.array_equal(one.cut.heights, several.cut.heights)
    assert set(np.unique(several.setup.numbers()).tolist()) == {1, 2}


def test_the_cut_agrees_with_the_closed_forms() -> None:
    report, judgement = made("linuxcnc").report.data, cut("linuxcnc").judgement
    assert judgement is not None and judgement.certificate is not None
    assert judgement.gouge.count == 0
    assert judgement.unreachable_mm2 == pytest.approx(report["left"]["unreachable_mm2"])
    cells = np.count_nonzero(judgement.unreachable) * cut("linuxcnc").cut.before.grid.pitch ** 2
    assert cells == pytest.approx(judgement.unreachable_mm2, rel=0.15)
    assert report["cut"]["gouged_places"] == 0
    assert judgement.certificate.gouge_mm < 3 * judgement.certificate.pitch_mm
