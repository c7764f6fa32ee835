"""What is looked at in portions, so that memory does not grow with the drawing, says what it says of all at once."""

from __future__ import annotations

import io

import ezdxf
import numpy as np
import pytest

from app.gcode.checks import path
from app.toolpath.coverage import areas
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from app.verify import parts


def rings() -> bytes:
    """Five holes of 8 mm and four rings of which each holds an island."""
    document = ezdxf.new("R2000", units=4)
    for k in range(9):
        middle = (12 * (k % 3) + 6, 12 * (k // 3) + 6)
        document.modelspace().add_circle(middle, 4 if k % 2 == 0 else 5.5)
        if k % 2:
            document.modelspace().add_circle(middle, 2)
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def made() -> MakeResult:
    return make("rings.dxf", rings(), MakeOptions(contour_diameter=2.0, pocket_diameter=3.0))


@pytest.mark.exhaustive
def test_a_job_in_portions_is_the_job_at_once(monkeypatch: pytest.MonkeyPatch) -> None:
    whole = made()
    assert whole.clean and whole.cut is not None
    for module, portion in ((path, 7), (areas, 2), (parts, 2)):
        monkeypatch.setattr(module, "_AT_A_TIME", portion)
    portions = made()
    assert portions.nc.text == whole.nc.text
    assert portions.findings == whole.findings
    assert portions.coverage.area_mm2 == pytest.approx(whole.coverage.area_mm2, rel=1e-12)
    assert portions.cut is not None and portions.cut.findings == whole.cut.findings
    deviations = [each.judgement.deviation for each in (whole.cut, portions.cut) if each.judgement is not None]
    assert np.array_equal(*deviations, equal_nan=True)
    assert portions.report.data["cut"] == whole.report.data["cut"]
    assert portions.report.data["check"] == whole.report.data["check"]
