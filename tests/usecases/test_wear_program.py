"""Contours that the control offsets, by wear or by the tool's radius: their words on every control, the path at 0 and
at both ends of the range, read by our reader and by LinuxCNC's, and what is told where the control cannot follow.
"""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import shapely

from app.cli.main import main
from app.core.errors import GeometryError, InputError, ParameterError
from app.core.resources import resource
from app.formats.job.toml import read_job
from app.gcode.checks.check import CheckReference, check
from app.gcode.interpreter.options import ReadOptions, ToolOffset
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import load_post
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


def assert_linuxcnc_reads_the_same(text: str, radius: float, folder: Path) -> None:
    """Hold our reading against LinuxCNC's, with a radius in the register, mm."""
    needs_rs274()
    (folder / "in.ngc").write_text(text, "ascii")
    (folder / "tool.tbl").write_text(f"T3 P3 Z0 D{2 * radius / 25.4:.10f}\n")
    run = subprocess.run(
        [RS274, "-g", "-t", "tool.tbl", "-v", "scratch.var", "in.ngc"],
        cwd=folder,
        capture_output=True,
        text=True,
        env=own_home(str(folder)),
    )
    assert run.returncode == 0, run.stderr
    theirs = []
    for kind, words in re.findall(r"(STRAIGHT_FEED|STRAIGHT_TRAVERSE|ARC_FEED)\(([^)]*)\)", run.stdout):
        numbers = [float(word) for word in words.split(",")]
        theirs.append((*numbers[:2], numbers[5]) if kind == "ARC_FEED" else tuple(numbers[:3]))
    table = {3: ToolOffset(diameter=2 * radius, diameter_known=True)}
    ours = read_program(text.encode(), ReadOptions(tool_table=table)).motions.end
    assert len(theirs) == len(ours), radius
    assert np.abs(np.array(theirs) - ours).max() < 2e-4, radius


@pytest.mark.parametrize("draw", ["rectangle 0,0 40,30\n", "rectangle 0,0 40,30 round 6\n", "circle 20,20 14\n"])
@pytest.mark.parametrize("side", ["outside", "inside"])
def test_linuxcnc_makes_the_same_path_of_it(draw: str, side: str, tmp_path: Path) -> None:
    text = made(draw, JOB.replace('"outside"', f'"{side}"')).nc.text
    for wear in WEARS:
        assert_linuxcnc_reads_the_same(text, wear, tmp_path)


def test_words_on_the_wrong_side_are_found(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """A user's post that says left for right: the very fault that the proof is for."""
    (tmp_path / "posts").mkdir()
    (tmp_path / "posts" / "wrong.toml").write_text(
        'extends = "linuxcnc"\ntitle = "Wrong"\n[compensation]\nleft = "G42 D{tool}"\nright = "G41 D{tool}"\n'
    )
    monkeypatch.setattr("app.gcode.posts.config_folder", lambda: tmp_path)
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


CONTROL = JOB.replace('"wear"', '"control"').replace('lead = "line"', 'lead = "arc"')
"""The same part, its contour written for the control to offset by the whole radius."""


def words_under_compensation(text: str) -> list[tuple[float, float]]:
    """Where the blocks under compensation go, by a reading of our own: modal X and Y."""
    at, under, found = {"X": 0.0, "Y": 0.0}, False, []
    for line in text.splitlines():
        under = (under and not line.startswith("G40")) or line.startswith(("G41", "G42"))
        for letter, number in re.findall(r"([XY])(-?[\d.]+)", line if "(" not in line else ""):
            at[letter] = float(number)
        if under and re.search("[XY]", line):
            found.append((at["X"], at["Y"]))
    return found


def test_the_written_path_is_the_drawn_contour() -> None:
    """Its corners are words of the program; and all that is written lies on the part or on the arcs to and from it."""
    text = made(job=CONTROL).nc.text
    written = words_under_compensation(text)
    assert {(0, 0), (40, 0), (40, 30), (0, 30)} <= set(written)
    off = [place for place in written if shapely.Point(place).distance(PART.exterior) > 1e-4]
    assert len(off) == 2 * 2, "the ends of the arcs to the wall and away from it, at two depths"
    assert "Tool table: T3 has D 6 mm" in text
    assert "register_mm=3,6" in text


@pytest.mark.parametrize("wear", WEARS)
@pytest.mark.parametrize("left", [0.0, 0.5])
def test_whatever_radius_stands_in_the_register_leaves_the_part(wear: float, left: float) -> None:
    """What a tool of the radius 3 + wear cuts round the rectangle, with that radius in its register."""
    path = centre_path(made(job=CONTROL + f"stock_to_leave = {left}\n").nc.text, 3 + wear)
    assert path.distance(PART) == pytest.approx(3 + wear + left, abs=2e-4)
    whole = PART.buffer(left, quad_segs=256)
    uncut = whole.buffer(3.0).difference(path.buffer(3 + wear, quad_segs=256)).difference(whole)
    assert uncut.area < 0.05, "chords of the buffers alone"


@pytest.mark.parametrize("direction", ["climb", "conventional"])
@pytest.mark.parametrize("side", ["outside", "inside"])
@pytest.mark.parametrize("draw", ["rectangle 0,0 40,30 round 6\n", "polyline 0,0 40,0 40,30 20,14 0,30 close\n"])
def test_a_contour_for_the_control_is_clean(draw: str, side: str, direction: str) -> None:
    """Lines and arcs, inner and outer corners, either way round, proven at the radius and at both ends of the range."""
    result = made(draw, CONTROL.replace('"outside"', f'"{side}"') + f'direction = "{direction}"\n')
    assert result.clean, [finding.text for finding in result.findings]
    assert len(re.findall("^G4[12] D3$", result.nc.text, re.MULTILINE)) == 2
    (proof,) = (each["worn"] for each in result.report.data["operations"])
    assert (proof["motions_without"], proof["fault"]) == (0, None)
    assert proof["gouge_mm"] <= 1e-3 and proof["left_mm"] <= 1e-3


@pytest.mark.parametrize(
    ("post", "note"),
    [
        ("fanuc", "Offset D3: geometry radius 3 mm"),
        ("haas", "Offset D3: geometry diameter 6 mm"),
        ("mach3", "Tool table: T3 has diameter 6 mm"),
    ],
)
def test_other_controls_are_told_what_stands_in_the_register(post: str, note: str) -> None:
    result = made(job=CONTROL, post=post)
    assert note.upper() in result.nc.text.upper()
    assert result.clean, [finding.text for finding in result.findings]


def test_inches_finish_passes_tabs_and_springs_go_with_it() -> None:
    job = CONTROL.replace("depth = 4", "depth = 10") + "finish_width = 0.3\nspring_passes = 1\ntabs = 4\n"
    result = made("rectangle 0,0 60,50\n", job + '[output]\nunits = "inch"\n')
    assert result.clean, [finding.text for finding in result.findings]
    assert len(result.program.tabs) == 4


def test_grbl_cannot_offset_by_the_radius() -> None:
    with pytest.raises(ParameterError, match="grbl cannot offset a path by the wear or the radius"):
        made(job=CONTROL, post="grbl")


@pytest.mark.parametrize("draw", ["rectangle 0,0 40,30\n", "rectangle 0,0 40,30 round 6\n", "circle 20,20 14\n"])
@pytest.mark.parametrize("side", ["outside", "inside"])
def test_linuxcnc_makes_the_same_path_of_the_contour(draw: str, side: str, tmp_path: Path) -> None:
    text = made(draw, CONTROL.replace('"outside"', f'"{side}"')).nc.text
    for wear in WEARS:
        assert_linuxcnc_reads_the_same(text, 3 + wear, tmp_path)


@pytest.mark.parametrize("radius", [2.0, 3.0, 3.1])
def test_an_inner_arc_smaller_than_the_radius_and_the_range_is_refused(radius: float) -> None:
    with pytest.raises(ParameterError, match=rf"inner arc of radius {radius:g} mm at .* up to 3.2 mm"):
        made(f"rectangle 0,0 40,30 round {radius:g}\n", CONTROL.replace('"outside"', '"inside"'))


def test_a_place_too_narrow_for_the_tool_is_refused() -> None:
    """The tool's centre passes by a slot of 4 mm on two arcs; no offset of the drawn contour does that."""
    slot = "polyline 0,0 20,0 20,8 24,8 24,0 50,0 50,30 0,30 close\n"
    with pytest.raises(GeometryError, match="does not fit between the walls"):
        made(slot, CONTROL)


BENT = "polyline 30.392,5.603 -0.579,29.792 -14.838,4.751 -27.906,-19.19 13.659,-30.06 close\n"
"""Its third corner turns by one degree, which LinuxCNC takes for none."""


@pytest.mark.parametrize("direction", ["climb", "conventional"])
@pytest.mark.parametrize("left", [0.0, 0.4])
def test_a_gentle_bend_counts_by_what_the_path_is_off_across(direction: str, left: float) -> None:
    result = made(BENT, CONTROL + f'direction = "{direction}"\nstock_to_leave = {left}\n')
    assert result.clean, [finding.text for finding in result.findings]
    assert result.report.data["check"]["largest_distance_mm"] < 1e-3


@pytest.mark.parametrize(
    ("word", "instead"), [("Y30.0000", "Y30.0200"), ("X40.0000", "X39.9900"), ("G41 D3", "G42 D3")]
)
@pytest.mark.parametrize("draw", ["rectangle 0,0 40,30\n", "rectangle 0,0 40,30 round 0.3\n"])
def test_a_contour_that_is_off_is_found(word: str, instead: str, draw: str) -> None:
    """Across the path nothing is let through that is let through along it."""
    job = read_job("j.toml", CONTROL.encode()).job
    result = make("part.draw", draw.encode(), MakeOptions(job=job, post="linuxcnc"))
    (file,) = result.files
    assert word in file.nc.text
    reference = CheckReference(result.program, result.job, load_post("linuxcnc"))
    assert not check(file.nc.text.encode(), file, reference).problems
    assert check(file.nc.text.replace(word, instead).encode(), file, reference).problems


@pytest.mark.parametrize("seed", range(4))
def test_random_polygons_are_clean(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 8))
    angles = (np.arange(count) + rng.uniform(-0.3, 0.3, count)) * 2 * np.pi / count
    corners = (rng.uniform(15, 35, count) * np.array([np.cos(angles), np.sin(angles)])).T.round(3)
    draw = "polyline " + " ".join(f"{x},{y}" for x, y in corners.tolist()) + " close\n"
    for side in ("outside", "inside"):
        result = made(draw, CONTROL.replace('"outside"', f'"{side}"'))
        assert result.clean, [finding.text for finding in result.findings]


def test_one_register_holds_one_thing() -> None:
    both = CONTROL + JOB[JOB.index("[[operation]]") :]
    with pytest.raises(ParameterError, match="one register D3 cannot hold its wear and its radius"):
        made(job=both)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"lead": Lead(LeadKind.LINE)}, "by an arc"),
        ({"most_engaged": 0.5}, "take most_engaged out"),
        ({"cut": CutParameters(1, stock_to_leave=0.05)}, "at least 0.1 mm"),
        ({"dog_bones": True}, "cannot offset dog-bones"),
    ],
)
def test_what_a_control_cannot_offset_by_the_radius_is_refused(values, words: str) -> None:
    whole = {"cut": CutParameters(1), "compensation": CutterCompensation.CONTROL} | values
    with pytest.raises(ParameterError, match=words):
        ContourOperation(**whole)


def test_a_contour_for_the_control_is_cut_as_its_header_says(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """`cut` and `check` read the file without a tool table: the header tells the diameter in the register."""
    path = tmp_path / "p.ngc"
    plate = str(resource("samples", "plate.draw"))
    told = ["--side", "outside", "--compensation", "control", "--contour-tool", "3", "--entry", "plunge", "--quiet"]
    assert main(["make", plate, "-o", str(path), *told]) in (0, 1)
    assert "G41 D" in path.read_text()
    capsys.readouterr()
    assert main(["check", str(path)]) == 0, capsys.readouterr()
    assert main(["cut", str(path), "--against", plate]) in (0, 1)
    (gouge,) = re.findall(r"([\d.]+) mm gouge", capsys.readouterr().out)
    assert float(gouge) <= 1e-3
