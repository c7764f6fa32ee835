"""A whole job by the real mouse under a virtual display, in a process of its own: draw fig. 2 from nothing, compute,
look, export.
"""

import json
from collections import Counter
from pathlib import Path

import pytest

from app.drafting.language.write import curve_text
from app.formats.readers import read_drawing
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.curves import Circle, Curve
from app.model.part import Part
from tests.ui.real_mouse.display import run_on_display

MOST_CLICKS = 60


def _part(path: Path) -> Part:
    return read_drawing(path.name, path.read_bytes(), None, ()).part


def _shape(curve: Curve) -> object:
    """Return what a curve is, whichever way it runs."""
    if isinstance(curve, Circle):
        return (curve.centre, curve.radius)
    return frozenset({curve.start, curve.end}), getattr(curve, "centre", None), getattr(curve, "radius", None)


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Do the job once; return the folder of what came of it."""
    folder = tmp_path_factory.mktemp("job")
    run_on_display(folder, "tests.ui.real_mouse.fig2_job", str(folder))
    return folder


@pytest.mark.exhaustive
def test_few_clicks_and_typed_values_are_enough(job: Path) -> None:
    counts = json.loads((job / "counts.json").read_text("utf-8"))
    assert counts["wrong"] == "" and 0 < counts["clicks"] + counts["typed"] <= MOST_CLICKS


def test_the_drawing_is_fig_2(job: Path, samples: Path) -> None:
    drawn, wanted = _part(job / "part.draw"), _part(samples / "fig2.dxf")
    assert Counter(_shape(e.curve) for e in drawn.entities) == Counter(_shape(e.curve) for e in wanted.entities)


def test_the_log_draws_the_identical_part_again(job: Path) -> None:
    again, drawn = _part(job / "log.draw"), _part(job / "part.draw")
    assert [curve_text(e.curve) for e in again.entities] == [curve_text(e.curve) for e in drawn.entities]
    assert [e.layer for e in again.entities] == [e.layer for e in drawn.entities]


def test_the_program_that_was_exported_reads_well(job: Path) -> None:
    program = read_program((job / "fig2.ngc").read_bytes(), ReadOptions())
    assert program.error is None and not program.problems and len(program.motions) > 50
