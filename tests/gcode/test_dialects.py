"""Another control is another data file: what Haas, Fanuc or grbl want needs no change of the writer."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from app.core.errors import ParameterError
from app.core.resources import resource
from app.gcode.posts import Post, read_post
from tests.gcode.one_file import write_program
from tests.gcode.programs import job, two_tools
from tests.gcode.rs274_oracle import assert_same_motion, canonical_calls

HAAS = {
    'motion = ["G0", "G1", "G2", "G3"]': 'motion = ["G00", "G01", "G02", "G03"]',
    "modal_motion = true": "modal_motion = false",
    "X = 4\nY = 4\nZ = 4\nI = 4\nJ = 4": "X = 3\nY = 3\nZ = 3\nI = 3\nJ = 3",
    "use = false": "use = true",
    "largest_sweep_deg = 355.0": "largest_sweep_deg = 90.0",
    'use = "none"': 'use = "flood"',
    'blend = "G64 P{blend} Q0"': 'blend = ""',
    "top = []": 'top = ["%"]',
    '["G17 {units} G90 G94 G40 G49 G80", "G91.1", "G54", "{blending}"]': (
        '["{units}", "G17 G40 G49 G80 G90 G94", "G54", "{blending}"]'
    ),
    '"G43"': '"G43 H{tool}"',
    'end = ["M2"]': 'end = ["M30", "%"]',
}


@pytest.fixture
def haas(tmp_path: Path) -> Post:
    text = resource("posts", "linuxcnc.toml").read_text("utf-8")
    for old, new in HAAS.items():
        assert old in text
        text = text.replace(old, new, 1)
    (tmp_path / "haas.toml").write_text(text, "utf-8")
    return read_post(tmp_path / "haas.toml")


def test_a_control_of_another_habit(haas: Post) -> None:
    text = write_program(two_tools().program(), job(), haas).text
    blocks = [line for line in text.splitlines() if line[0] != "("]
    assert text.startswith("%\n(Part plate)\n") and text.endswith(" M30\n%\n")
    assert "N10 G21" in blocks and "N20 G17 G40 G49 G80 G90 G94" in blocks
    assert re.search(r"^N\d+ G43 H2$", text, re.M) and text.count("M8") == 2
    assert re.search(r"^N\d+ G03 X35\.000 Y8\.000 I0\.000 J3\.000$", text, re.M)
    assert "G64" not in text and "the control may blend by its own setting, taken as 0.01 mm" in text
    assert sum(" G02 " in block for block in blocks) == 4, "a full circle in quarters"


def test_its_motion_is_the_same(haas: Post) -> None:
    program = two_tools().program()
    nc = write_program(program, job(), haas)
    assert_same_motion(program.moves, nc, job())


def test_an_exact_path_is_not_promised_without_a_word_for_it(haas: Post) -> None:
    post = replace(haas, blending=replace(haas.blending, exact=""))
    with pytest.raises(ParameterError, match="no word for an exact path; switch exact path off"):
        write_program(two_tools().program(), job(exact_path=True), post)


def test_semicolon_comments(tmp_path: Path) -> None:
    text = (
        resource("posts", "linuxcnc.toml")
        .read_text("utf-8")
        .replace('open = "("', 'open = "; "')
        .replace('close = ")"', 'close = ""')
    )
    (tmp_path / "mill.toml").write_text(text, "utf-8")
    written = write_program(two_tools().program(), job(), read_post(tmp_path / "mill.toml")).text
    assert written.startswith("; Part plate\n; Hitofude for LinuxCNC")
    canonical_calls(written)
