"""Contours that the control offsets by wear: their words on every control, the path at 0 and at both ends of the range,
read by our reader and by LinuxCNC's, and what is told where the control cannot follow.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import shapely

from app.cli.main import main
from app.core.errors import InputError, ParameterError
from app.core.resources import resource
from app.formats.job.toml import read_job
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.reader import read_program
from app.gcode.rework.restart import RestartOptions, restart
from app.model.contour_operation import ContourOperation
from app.model.entry import Lead, LeadKind
from app.model.finding import FindingKind
from app.model.motion import MotionKind
from app.model.operation import CutParameters, CutterCompensation, Side
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from tests.gcode.rs274_oracle import RS274, needs_rs274, own_home

PART = shapely.box(0, 0, 40, 30)
JOB = """
[stock]
thickness = 10.0
margin = 12.0
[[tool]]
number = 3
diameter = 6.0
[[operation]]
kind = "contour"
tool = 3
depth = 4
stepdown = 2
side = "outside"
lead = "line"
entry = "plunge"
compensation = "wear"
wear_range = 0.2
"""
WEARS = (-0.2, 0.0, 0.2)


def made(draw: str = "rectangle 0,0 40,30\n", job: str = JOB, post: str = "linuxcnc") -> MakeResult:
    return make("part.draw", draw.encode(), MakeOptions(job=read_job("j.toml", job.encode()).job, post=post))


def centre_path(text: str, wear: float) -> shapely.Geometry:
    """Where the tool's centre goes along the part, at the floor, as our reader has it with a wear in the register."""
    read = read_program(text.encode(), ReadOptions(tool_table={3: ToolOffset(diameter=2 * wear, diameter_known=True)}))
    assert not read.problems
    motions = read.motions
    floor = (motions.end[:, 2] == -4) & (motions.start[:, 2] == -4) & (motions.kind != MotionKind.RAPID)
    lines = []
    for row in np.flatnonzero(floor):
        start, end, centre = motions.start[row, :2], motions.end[row, :2], motions.centre[row, :2]
        if motions.kind[row] == MotionKind.LINE:
            lines.append(shapely.LineString([start, end]) if np.any(start != end) else shapely.Point(start))
            continue
        turn = 1 if motions.kind[row] == MotionKind.ARC_CCW else -1
        first, last = (np.arctan2(*(each - centre)[::-1]) for each in (start, end))
        angles = first + turn * np.linspace(0, (last - first) * turn % (2 * np.pi), 400)
        lines.append(shapely.LineString(centre + np.hypot(*(start - centre)) * np.c_[np.cos(angles), np.sin(angles)]))
    return shapely.union_all(lines)


@pytest.mark.parametrize("wear", WEARS)
def test_a_worn_tool_leaves_the_same_part(wear: float) -> None:
    """What a tool of the radius 3 + wear cuts round the rectangle, along the offset path, ends at the rectangle."""
    path = centre_path(made().nc.text, wear)
    assert path.distance(PART) == pytest.approx(3 + wear, abs=2e-4)
    left = PART.buffer(3.0).difference(path.buffer(3 + wear, quad_segs=256)).difference(PART)
    assert left.area < 0.05, "chords of the buffers alone"


def test_the_words_stand_at_the_straight_ways_and_the_proof_is_clean() -> None:
    result = made()
    text = result.nc.text
    words = re.findall(r"^(G4[012].*)\n(.*)$", text, re.MULTILINE)
    assert [word for word, _ in words] == ["G41 D3", "G40"] * 2, "one a depth"
    assert all(line.startswith(("G1", "X", "Y")) for _, line in words)
    assert "registers=wear" in text
    assert "wear range 0.2 mm" in text, "the operator is told"
    (proof,) = (each["worn"] for each in result.report.data["operations"])
    assert (proof["range_mm"], proof["motions_without"], proof["fault"]) == (0.2, 0, None)
    assert proof["gouge_mm"] <= 1e-3 and proof["left_mm"] <= 1e-3
    assert result.clean, [finding.text for finding in result.findings]


def test_conventional_milling_has_the_tool_at_the_right() -> None:
    result = made(job=JOB + 'direction = "conventional"\n')
    assert re.findall(r"G4[12] D3", result.nc.text) == ["G42 D3"] * 2
    assert result.clean
    assert centre_path(result.nc.text, 0.2).distance(PART) == pytest.approx(3.2, abs=2e-4)


@pytest.mark.parametrize("post", ["fanuc", "haas", "mach3"])
def test_other_controls_have_it(post: str) -> None:
    result = made(post=post)
    assert len(re.findall(r"G41 D0?3\b", result.nc.text)) == 2
    assert result.clean, [finding.text for finding in result.findings]


def test_grbl_refuses_it_by_name() -> None:
    with pytest.raises(ParameterError, match=r"grbl cannot offset a path by the wear .* compensation = \"computer\""):
        made(post="grbl")


@pytest.mark.parametrize("draw", ["rectangle 0,0 40,30\n", "rectangle 0,0 40,30 round 6\n", "circle 20,20 14\n"])
@pytest.mark.parametrize("side", ["outside", "inside"])
def test_linuxcnc_makes_the_same_path_of_it(draw: str, side: str, tmp_path: Path) -> None:
    needs_rs274()
    text = made(draw, JOB.replace('"outside"', f'"{side}"')).nc.text
    (tmp_path / "in.ngc").write_text(text, "ascii")
    for wear in WEARS:
        (tmp_path / "tool.tbl").write_text(f"T3 P3 Z0 D{2 * wear / 25.4:.10f}\n")
        run = subprocess.run(
            [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"],
            cwd=tmp_path,
            capture_output=True,
            text=True,
            env=own_home(str(tmp_path)),
        )
        assert run.returncode == 0, run.stderr
        theirs = []
        for kind, words in re.findall(r"(STRAIGHT_FEED|STRAIGHT_TRAVERSE|ARC_FEED)\(([^)]*)\)", run.stdout):
            numbers = [float(word) for word in words.split(",")]
            theirs.append((*numbers[:2], numbers[5]) if kind == "ARC_FEED" else tuple(numbers[:3]))
        table = {3: ToolOffset(diameter=2 * wear, diameter_known=True)}
        ours = read_program(text.encode(), ReadOptions(tool_table=table)).motions.end
        assert len(theirs) == len(ours), wear
        assert np.abs(np.array(theirs) - ours).max() < 2e-4, wear


def test_words_on_the_wrong_side_are_found(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A user's post that says left for right: the very fault that the proof is for."""
    (tmp_path / "posts").mkdir()
    (tmp_path / "posts" / "wrong.toml").write_text(
        'extends = "linuxcnc"\ntitle = "Wrong"\n[compensation]\nleft = "G42 D{tool}"\nright = "G41 D{tool}"\n'
    )
    monkeypatch.setattr("app.gcode.posts.posts.config_folder", lambda: tmp_path)
    result = made(post="wrong")
    found = [each for each in result.findings if each.kind is FindingKind.GOUGE]
    assert found and found[0].counts
    assert found[0].amount == pytest.approx(0.4, abs=2e-3), "0.2 mm to the wrong side of a tool 0.2 mm wider"


@pytest.mark.parametrize("entry", ["ramp", "helix", "plunge"])
@pytest.mark.parametrize("draw", ["rectangle 0,0 40,30\n", "circle 20,20 3.5\nrectangle 0,0 40,30\n"])
def test_nothing_that_is_not_offset_runs_along_a_wall(entry: str, draw: str) -> None:
    """No ramp on the path, and no way back along it to where the next depth begins: a wider tool would cut in there."""
    result = made(draw, JOB.replace('"outside"', '"inside"').replace('"plunge"', f'"{entry}"'))
    assert not [each.text for each in result.findings if "With a wear" in each.text]
    (proof,) = (each["worn"] for each in result.report.data["operations"])
    assert proof["motions_without"] == 0


def test_an_inner_arc_smaller_than_the_wear_is_told() -> None:
    """The path within corners of 3.1 mm has arcs of 0.1 mm, which a tool that is 0.2 mm wider cannot follow."""
    result = made("rectangle 0,0 40,30 round 3.1\n", JOB.replace('"outside"', '"inside"'))
    assert any("cannot follow the contour" in each.text and each.counts for each in result.findings)
    smaller = made(
        "rectangle 0,0 40,30 round 3.1\n",
        JOB.replace('"outside"', '"inside"').replace("wear_range = 0.2", "wear_range = 0.05"),
    )
    assert smaller.clean, [finding.text for finding in smaller.findings]


def test_a_path_without_room_for_its_lead_is_told() -> None:
    """In a hole of 6.3 mm the path has a radius of 0.15 mm, and no room for a lead of 0.2 mm."""
    result = made("circle 20,20 3.15\n", JOB.replace('"outside"', '"inside"'))
    (told,) = (each for each in result.findings if "not offset by the wear" in each.text)
    assert told.counts
    assert "G41" not in result.nc.text


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"side": Side.ON}, "on the line has no side"),
        ({"dog_bones": True}, "cannot offset dog-bones"),
        ({"lead": Lead()}, "lead must be straight"),
        ({"lead": Lead(LeadKind.LINE, overlap=0.05)}, "no less than the wear range"),
        ({"lead": Lead(LeadKind.LINE, radius=0.05)}, "no less than the wear range"),
        ({"wear_range": 0.0}, "Wear range is 0 mm"),
    ],
)
def test_what_a_control_cannot_offset_is_refused(values, words: str) -> None:
    whole = {"lead": Lead(LeadKind.LINE), "compensation": CutterCompensation.WEAR} | values
    with pytest.raises(ParameterError, match=words):
        ContourOperation(CutParameters(1), **whole)


def test_the_file_is_read_by_every_command_without_a_table(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "p.ngc"
    told = [
        "--side",
        "outside",
        "--lead",
        "line",
        "--entry",
        "plunge",
        "--compensation",
        "wear",
        "--wear-range",
        "0.05",
    ]
    plate = str(resource("samples", "plate.draw"))
    assert main(["make", plate, "-o", str(path), *told, "--contour-tool", "3", "--quiet"]) in (0, 1)
    assert "G41 D" in path.read_text()
    capsys.readouterr()
    assert main(["check", str(path)]) == 0, capsys.readouterr()
    assert main(["cut", str(path)]) in (0, 1)


def test_a_restart_within_the_compensation_is_refused() -> None:
    text = made().nc.text
    line = text.splitlines().index("G41 D3") + 3
    with pytest.raises(InputError, match="under cutter compensation"):
        restart(text.encode(), line, RestartOptions())
