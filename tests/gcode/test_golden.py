"""The whole text of a small program with two tools, for every post: a pocket ring, then lines, arcs, a full circle, a
helix.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from app.gcode.posts import load_post, post_names
from app.gcode.writer.write import write_files
from app.model.job import OriginXY
from app.model.part import Units
from tests.gcode.programs import job, two_tools

GOLDEN = Path(__file__).parent / "golden"
TEXTS = [(name, units) for name in post_names() for units in (Units.MM, Units.INCH)]


@pytest.mark.parametrize(("name", "units"), TEXTS, ids=[f"{name} {units.name.lower()}" for name, units in TEXTS])
def test_golden(name: str, units: Units, tmp_path: Path) -> None:
    """What is written now is left beside the golden text's name when they differ."""
    post = load_post(name)
    for file in write_files(two_tools().program(), job(out_units=units, origin_xy=OriginXY.LOWER_LEFT), post):
        golden = GOLDEN / f"{name}_{units.name.lower()}{file.suffix}{post.extension}"
        (tmp_path / golden.name).write_text(file.nc.text, "ascii")
        assert golden.exists() and file.nc.text == golden.read_text("ascii"), f"see {tmp_path / golden.name}"
