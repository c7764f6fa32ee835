"""The check on machines that stand elsewhere: what comes out right by chance on a fresh control is found there."""

from __future__ import annotations

from dataclasses import replace

import pytest

from app.gcode.posts import load_post
from tests.gcode.test_check import Written, problems

SAFE = "G17 G21 G90 G94 G40 G49 G80"
FIRST_XY = "X10.0000 Y10.0000\n"


@pytest.mark.parametrize(
    ("name", "old", "new"),
    [
        ("haas", "G53 G0 Z0.", "G0 Z0."),
        ("haas", "G53 G0 Z0.", "M53 G0 Z0."),
        ("haas", "G53 G0 Z0.", "G53 G0 Y0."),
        ("haas", "G53 G0 Z0.", "G53 G0 X0. Y0."),
        ("haas", "G53 G0 Z0.", "G53 G0 X0. Z0."),
        ("haas", "G53 G0 Z0.", "G53 G0 Z-1."),
        ("haas", "G53 G0 Z0.", "G53 G1 Z0. F500."),
        ("haas", "G53 G0 Z0.", "G28 Z0."),
        ("haas", "G54", "N54"),
        ("fanuc", "G91 G28 Z0.", "G28 Z0."),
        ("fanuc", "G91 G28 Z0.", "G0 Z0."),
        ("fanuc", "G91 G28 Z0.", "G91 G0 Z0."),
        ("fanuc", "G91 G28 Z0.", "G91 G28 X0. Z0."),
        ("fanuc", "G91 G28 Z0.", "G91 G30 Z0."),
        ("linuxcnc", FIRST_XY, f"G28\n{FIRST_XY}"),
        ("linuxcnc", FIRST_XY, f"G30\n{FIRST_XY}"),
        ("linuxcnc", FIRST_XY, f"G53 G0 X0\n{FIRST_XY}"),
        ("linuxcnc", FIRST_XY, f"G53 G0 Z0\nG0 Z5\n{FIRST_XY}"),
        ("linuxcnc", FIRST_XY, f"G10 L20 P1 X0\n{FIRST_XY}"),
        ("linuxcnc", FIRST_XY, f"G92 X0\n{FIRST_XY}"),
        ("linuxcnc", "G91.1\n", "\n"),
        ("grbl", "G54\n", "\n"),
        *(
            ("haas", SAFE, safe)
            for safe in ("G17", f"({SAFE})", "", *(SAFE.replace(word, "") for word in SAFE.split() if word != "G80"))
        ),
    ],
)
@pytest.mark.parametrize("where", [0, -1], ids=["first", "last"])
def test_what_depends_on_where_the_machine_stands_is_told(name: str, old: str, new: str, where: int) -> None:
    written = Written(load_post(name))
    text = written.files[0].nc.text
    parts = text.split(old)
    assert len(parts) > 1
    at = where % (len(parts) - 1) + 1
    assert problems(old.join(parts[:at]) + new + old.join(parts[at:]), written)


@pytest.mark.parametrize(
    ("key", "blocks"),
    [
        ("start", ("G17 {units} G90 G94 G40 G49 G80", "G91.1", "G54", "{blending}", "G92 X0 Y0 Z0")),
        ("start", ("G17 G90 G94 G40 G49 G80", "G91.1", "G54", "{blending}")),
        ("start", ("G17 {units} G90 G94 G40 G49 G80", "G91.1", "{blending}")),
        ("tool", ("T{tool} M6", "G43", "G53 G0 X0 Y0", "S{speed} M3", "G4 P{dwell_s}")),
        ("tool", ("T{tool} M6", "G43", "G28", "S{speed} M3", "G4 P{dwell_s}")),
        ("home", ("G53 G0 X0 Y0",)),
        ("home", ("G0 Z0",)),
        ("home", ("G28",)),
    ],
)
def test_a_post_that_trusts_in_where_the_machine_stands_is_refused(key: str, blocks: tuple[str, ...]) -> None:
    post = load_post("linuxcnc")
    written = Written(replace(post, program=replace(post.program, **{key: blocks})))  # type: ignore[arg-type]
    assert written.check(written.files[0]).problems


def test_a_difference_that_a_fresh_control_hides_is_told_as_one() -> None:
    written = Written(load_post("linuxcnc"))
    (file,) = written.files
    found = problems(file.nc.text.replace("G91.1\n", "\n"), written)
    assert found
    assert any("the program has to say itself what it needs" in text for _, text in found)


@pytest.mark.parametrize("home", [("G53 G0 Z0",), ("G91 G28 Z0", "G90"), ("G91 G30 Z0", "G90"), ("G53 G0 Z-2.5",)])
def test_homes_of_ones_own_along_z_are_taken(home: tuple[str, ...]) -> None:
    post = load_post("linuxcnc")
    written = Written(replace(post, program=replace(post.program, home=home)))
    assert written.check(written.files[0]).problems == ()
