"""`hitofude smooth` on real programs: proven as written, never more blocks, everything else as it was."""

import json
import math
import re
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.main import main
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.dialect_guess import guess_dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.program import EventKind, NcProgram
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind
from app.model.motion_path import arc_paths
from app.model.part import Units
from tests.fitting.test_tube import off_chords

HEAD = "G21 G90 G17 G94 G40 G49 G80\nT1 M6\nS8000 M3\nG0 X50 Y0\nG0 Z2\nG1 Z-1 F200\n"
TAIL = "G0 Z5\nM5\nM2\n"


def ring(count: int = 720, radius: float = 50.0) -> str:
    angle = np.linspace(0, 2 * np.pi, count + 1)[1:]
    lines = [f"X{radius * math.cos(a):.4f} Y{radius * math.sin(a):.4f}" for a in angle]
    return "\n".join(["G1 " + lines[0] + " F600", *lines[1:], ""])


def smoothed(folder: Path, text: str, *options: str, status: int = 0) -> tuple[str, dict[str, Any]]:
    source, out, report = folder / "in.ngc", folder / "out.ngc", folder / "r.json"
    source.write_text(text)
    assert main(["smooth", str(source), "-o", str(out), "--report", str(report), "--quiet", *options]) == status
    return out.read_text(), json.loads(report.read_text())


def assert_paths_near(before: NcProgram, after: NcProgram, limit: float) -> None:
    """By samples, on whatever the reader makes of both: no place of either is farther from the other's path."""
    places, old = [], np.vstack([before.motions.start[1:2], before.motions.end[1:]])
    arcs = arc_paths(after.motions)
    inner = arcs.points(np.linspace(0, 1, 65))
    row_of = {int(row): k for k, row in enumerate(arcs.rows)}
    for row in range(1, len(after.motions)):
        assert after.motions.kind[row] != MotionKind.SPLINE
        places.append(inner[row_of[row]] if row in row_of else after.motions.end[[row]])
    new = np.vstack([old[:1], *places])
    assert off_chords(new, old).max() <= limit + 1e-9
    assert off_chords(old, new).max() <= limit + 50 * (1 - math.cos(2 * math.pi / 64 / 2))


def test_a_program_that_names_no_units_is_in_inches_as_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    unnamed = (HEAD + ring(radius=2.0)).replace("G21 ", "").replace("X50", "X2") + TAIL
    text, report = smoothed(tmp_path, unnamed, "--tolerance", "0.01", "--units", "in")
    assert report["tolerance"]["proven_mm"] <= 0.01
    after = read_program(text.encode(), ReadOptions(units=Units.INCH))
    inch = read_program(("G20\n" + unnamed).encode())
    assert_paths_near(inch, after, 0.01)
    assert main(["smooth", str(tmp_path / "in.ngc"), "-o", str(tmp_path / "out.ngc")]) == 0
    assert "the program names none (G20, G21) and is read in mm; say --units in" in capsys.readouterr().out


def test_a_ring_of_chords_becomes_two_arcs_and_all_else_stays(tmp_path: Path) -> None:
    text, report = smoothed(tmp_path, HEAD + ring() + TAIL, "--tolerance", "0.01")
    lines = text.splitlines()
    for line in (HEAD + TAIL).splitlines():
        assert line in lines
    assert report["blocks"]["before"] == 720 and report["blocks"]["after"] <= 5
    assert report["tolerance"]["proven_mm"] <= 0.01
    before, after = (read_program(part.encode()) for part in (HEAD + ring() + TAIL, text))
    assert after.error is None
    assert np.sum(after.motions.kind >= MotionKind.ARC_CW) == 2
    assert_paths_near(before, after, 0.01)
    assert np.nanmax(np.abs(after.motions.feed[after.motions.kind >= MotionKind.ARC_CW] - 600)) == 0


@pytest.mark.parametrize("form", ["lines", "arcs", "nurbs"])
def test_a_real_engraving_takes_fewer_blocks_and_is_proven(tmp_path: Path, data: Path, form: str) -> None:
    source = (data / "nc" / "jsdc.gcode").read_text()
    text, report = smoothed(tmp_path, source, "--tolerance", "0.05", "--as", form)
    most = {"lines": 190, "arcs": 81, "nurbs": 520}[form]
    assert report["blocks"]["after"] <= most < report["blocks"]["before"]
    assert report["tolerance"]["proven_mm"] <= 0.05
    again, _ = smoothed(tmp_path, text, "--tolerance", "0.05", "--as", form)
    assert len(again.splitlines()) <= len(text.splitlines()) + 8, "smoothing twice never adds motions"
    if form != "nurbs":
        assert_paths_near(read_program(source.encode()), read_program(text.encode()), 0.05)


@pytest.mark.parametrize(("bend", "most"), [("5", 61), ("15", 60)])
def test_a_real_engraving_takes_as_few_arcs_as_neighbours_may_bend(
    tmp_path: Path, data: Path, bend: str, most: int
) -> None:
    """Five stretches of 2,355 moves; ten blocks are plunges that nothing can be made of."""
    text, report = smoothed(tmp_path, (data / "nc" / "jsdc.gcode").read_text(), "--tolerance", "0.05", "--bend", bend)
    assert report["blocks"]["after"] <= most + 10
    assert report["tolerance"]["proven_mm"] <= 0.05
    assert report["largest_bend_deg"]["after"] <= float(bend) + 0.1
    assert f"where up to {bend} deg" in text


@pytest.mark.parametrize("post", ["linuxcnc", "fanuc"])
def test_splines_of_degree_5_go_out_as_cubics_that_are_proven(tmp_path: Path, post: str) -> None:
    t = np.linspace(0, 4 * math.pi, 1500)
    lines = "".join(f"X{10 * a:.4f} Y{8 * math.sin(a):.4f}\n" for a in t)
    options = ["--tolerance", "0.02", "--as", "nurbs", "--post", post, "--dialect", post]
    text, report = smoothed(tmp_path, HEAD + lines + TAIL, *options, "--degree", "5")
    plain, _ = smoothed(tmp_path, HEAD + lines + TAIL, *options)
    assert report["blocks"]["after"] < 400 and report["tolerance"]["proven_mm"] <= 0.02
    assert ("G5.2" if post == "linuxcnc" else "G6.2 P4") in text
    assert text != plain


@pytest.mark.parametrize("post", ["linuxcnc", "fanuc", "haas", "grbl", "mach3"])
@pytest.mark.parametrize("form", ["arcs", "nurbs"])
def test_every_control_reads_back_what_is_written_for_it(tmp_path: Path, post: str, form: str) -> None:
    head = HEAD.replace("T1 M6\n", "") if post == "grbl" else HEAD
    text, report = smoothed(tmp_path, head + ring() + TAIL, "--post", post, "--dialect", post, "--as", form)
    assert read_program(text.encode(), ReadOptions(Dialect(post))).error is None
    assert report["blocks"]["after"] < 70


def test_inches_and_a_work_offset_and_other_planes(tmp_path: Path) -> None:
    angle = np.linspace(0, np.pi, 181)[1:]
    lines = "\n".join(f"G1 X{1 - math.cos(a):.5f} Z{-0.2 + 0.5 * math.sin(a):.5f}" for a in angle)
    text = f"G20 G90 G17 G94\nG10 L2 P2 X1 Y2 Z0\nG55\nT1 M6\nS5000 M3\nG0 X0 Y0 Z1\nG1 Z-0.2 F20\n{lines}\nG0 Z1\nM2\n"
    out, report = smoothed(tmp_path, text, "--tolerance", "0.001in")
    assert "G18" in out and "G17" in out.split("G18", 1)[1], "the plane in force comes back"
    assert report["blocks"]["after"] < 20
    before, after = (read_program(part.encode()) for part in (text, out))
    assert np.allclose(before.motions.end[-1], after.motions.end[-1])


@pytest.mark.parametrize(
    ("stretch", "reason"),
    [
        ("G91\n" + "G1 X0.1 Y0.01\n" * 50 + "G90\n", "its line says more"),
        ("G93\n" + "".join(f"G1 X{50 + k} F2\n" for k in range(1, 50)) + "G94\n", "feed in inverse time"),
        ("".join(f"G1 X{50 + k} (note {k})\n" for k in range(1, 50)), "its line says more"),
        ("o1 repeat [3]\nG1 X51 F200\nX52\nX53\nX50\no1 endrepeat\n", "done more than once"),
        ("G41.1 D2\nG1 X60 Y0 F200\nX70\nX80\nX90 Y10\nX100\nG40\nG1 X110 Y30\n", "its line says more"),
    ],
)
def test_lines_that_nobody_can_vouch_for_stay(tmp_path: Path, stretch: str, reason: str) -> None:
    text = HEAD + stretch + TAIL
    out, report = smoothed(tmp_path, text, "--tolerance", "0.01")
    assert [line for line in out.splitlines() if not line.startswith("(hitofude")] == text.splitlines()
    assert any(reason in told for told in report["blocks"]["moves_left_alone"])


def test_feeds_keep_their_places(tmp_path: Path) -> None:
    angle = np.linspace(0, 1, 200)
    words = [f"X{50 * math.cos(a):.4f} Y{50 * math.sin(a):.4f}" for a in angle]
    text = HEAD + "\n".join(f"G1 {word} F{300 if k < 100 else 900}" for k, word in enumerate(words)) + "\n" + TAIL
    out, _ = smoothed(tmp_path, text)
    before, after = (read_program(part.encode()) for part in (text, out))
    changes = [
        [
            (tuple(p.motions.end[k].round(3)), b)
            for k, (a, b) in enumerate(pairwise(p.motions.feed.tolist()))
            if a != b and b > 0
        ]
        for p in (before, after)
    ]
    assert changes[0] == changes[1]


def test_bad_input_is_told_in_a_line_and_nothing_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source, out = tmp_path / "in.ngc", tmp_path / "out.ngc"
    source.write_text(HEAD + "G1 X\n")
    for options, said in (
        ([], "in.ngc:7"),
        (["--tolerance", "0"], "tolerance"),
        (["--tolerance", "1e-4"], "too near to the last decimal"),
        (["--epsilon", "0.01"], "--method"),
        (["--method", "effective-points"], "--epsilon"),
        (["--nearness", "0.001"], "--method effective-points"),
        (["--method", "effective-points", "--epsilon", "0.002", "--nearness", "0.0001"], "last decimal"),
        (["--method", "effective-points", "--epsilon", "0.01", "--before", "2"], "--embodiment 2"),
        (["--region", "cone"], "no region"),
        (["--corner", "200"], "180"),
        (["--bend", "200"], "180"),
        (["--bend", "0"], "bend"),
        (["--degree", "4"], "degree"),
    ):
        if options == ["--tolerance", "1e-4"]:
            source.write_text(HEAD + ring() + TAIL)
        assert main(["smooth", str(source), "-o", str(out), *options]) == 2
        assert said in capsys.readouterr().err
        assert not out.exists()


@pytest.mark.parametrize(
    "embodiment",
    [
        ["--embodiment", "1", "--ends", "ratio:0.1", "--nearness", "0.03"],
        ["--embodiment", "2", "--before", "2", "--after", "3", "--nearness", "0.003"],
    ],
)
def test_points_within_facets_are_left_out_or_moved_within_the_tolerance(tmp_path: Path, embodiment: list[str]) -> None:
    corner = np.linspace(0, 2 * np.pi, 61)
    inner = np.linspace(0, 1, 12, endpoint=False)
    places = [
        50 * ((1 - t) * np.array([math.cos(a), math.sin(a)]) + t * np.array([math.cos(b), math.sin(b)]))
        for a, b in pairwise(corner)
        for t in inner
    ]
    lines = "G1 F600 " + "".join(f"X{x:.4f} Y{y:.4f}\n" for x, y in [*places[1:], places[0]])
    options = ["--method", "effective-points", "--epsilon", "0.005", "--tolerance", "0.2", *embodiment]
    text, report = smoothed(tmp_path, HEAD + lines + TAIL, *options)
    assert report["tolerance"]["proven_mm"] <= 0.2
    inner = 660 if embodiment[1] == "2" else 0
    effective = 61 if inner else 61 + 2 * 60
    told = {"effective": effective, "corrected": inner, "left_out": 721 - effective - inner, "all": 721}
    assert told.items() <= report["points"].items()
    nearness = 0.003 if inner else 0.03  # a cubic by six points, least squares, is 1.3 um off this circle
    assert report["points"]["farthest_mm"] <= report["points"]["nearness_mm"] == nearness
    assert f"effective points: {report['points']['effective']} of 721, {inner} corrected" in text
    after = read_program(text.encode()).motions
    cut = after.kind >= MotionKind.ARC_CW
    radius = np.hypot(*(after.end - after.centre)[cut, :2].T)
    assert np.sum(cut) <= 6 and np.abs(radius - 50).max() < 0.08, "a circle again, and not the polygon"


def test_effective_points_go_by_sides_between_corners(tmp_path: Path) -> None:
    """A rectangle, each side one chord from corner to corner, and then an arc of facets."""
    sides = "G1 X30 Y0 F600\nX30 Y20\nX0 Y20\nX0 Y0\n"
    arc = "".join(f"X{-5 * math.sin(a):.4f} Y{5 * math.cos(a) - 5:.4f}\n" for a in np.linspace(0, 3, 61)[1:])
    options = ["--method", "effective-points", "--epsilon", "0.01", "--tolerance", "0.02"]
    head = HEAD.replace("G0 X50 Y0", "G0 X0 Y0")
    text, report = smoothed(tmp_path, head + sides + arc + TAIL, *options)
    assert report["tolerance"]["proven_mm"] <= 0.02
    after = read_program(text.encode()).motions
    for corner in ((30, 0), (30, 20), (0, 20), (0, 0)):
        assert np.hypot(*(after.end[:, :2] - corner).T).min() < 1e-3


def test_a_ring_that_is_one_facet_has_no_points_to_go_by(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source, out = tmp_path / "in.ngc", tmp_path / "out.ngc"
    source.write_text(HEAD.replace("X50", "X1") + "G1 X1 Y0\n" + ring(60, 1.0) + TAIL)
    options = ["--method", "effective-points", "--epsilon", "3", "--tolerance", "9", "--corner", "180"]
    assert main(["smooth", str(source), "-o", str(out), *options]) == 2
    assert "one facet" in capsys.readouterr().err and not out.exists()


def test_points_that_are_one_in_the_other_control_s_digits_keep_no_stretch_from_being_smoothed(tmp_path: Path) -> None:
    """Of 720 points one has a neighbour 0.0003 mm beside it: for Fanuc, whose words have three decimals, no move."""
    first, *rest = ring().splitlines()
    x, y = (float(word[1:]) for word in rest[400].split()[:2])
    rest.insert(401, f"X{x + 0.0003:.4f} Y{y:.4f}")
    source = HEAD + "\n".join([first, *rest, ""]) + TAIL
    text, report = smoothed(tmp_path, source, "--tolerance", "0.02", "--post", "fanuc")
    assert report["blocks"]["after"] <= 5 and report["stretches"]["changed"] == 1
    after = read_program(text.encode(), ReadOptions(Dialect.FANUC))
    assert_paths_near(read_program(source.encode()), after, 0.02 + 1e-6)


def test_why_a_stretch_is_as_before_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "in.ngc"
    source.write_text(HEAD + "G1 X50 Y10 F600\nX40 Y10\nX40 Y30\nX0 Y30\n" + TAIL)
    assert main(["smooth", str(source), "-o", str(tmp_path / "out.ngc")]) == 0
    assert "- 1 stretch as before: it would not take fewer blocks" in capsys.readouterr().out


def test_for_another_control_every_number_is_in_its_words(tmp_path: Path) -> None:
    """`G0 X50` beside `G3 X-50.` would be 0.050 mm on a Fanuc."""
    source = HEAD + ring() + "G0 Z5\nG4 P1.5\nG83 X20 Y5 Z-3 R1 Q2 F80\nG80\n" + TAIL
    text, report = smoothed(tmp_path, source, "--post", "fanuc", "--as", "nurbs")
    assert "G6.2" in text and report["control"] == {
        "of_the_program": "linuxcnc",
        "written_for": "fanuc",
        "elsewhere_mm": 0.002,
    }
    assert not re.search(r"[XYZIJRFKQ]-?\d+(?![\d.])", re.sub(r"\(.*\)", "", text)), (
        "no length and no feed without its point"
    )
    assert "G4 P1500\n" in text and "G83" not in text
    before, after = read_program(source.encode()), read_program(text.encode(), ReadOptions(Dialect.FANUC))
    assert after.error is None and guess_dialect(text.encode()) is Dialect.FANUC
    assert np.allclose(before.motions.end[0], after.motions.end[0]) and np.allclose(
        before.motions.end[-1], after.motions.end[-1]
    )
    assert_ends_among(before, after, 0.003)


def assert_ends_among(before: NcProgram, after: NcProgram, limit: float) -> None:
    """Every rapid of one program ends where one of the other does, in the same order."""
    ends = [
        list(dict.fromkeys(map(tuple, p.motions.end[p.motions.kind == MotionKind.RAPID].round(2).tolist())))
        for p in (before, after)
    ]
    assert len(ends[0]) == len(ends[1]) and np.abs(np.array(ends[0]) - np.array(ends[1])).max() <= limit + 0.01


@pytest.mark.parametrize("post", ["linuxcnc", "haas", "mach3"])
def test_a_program_is_read_as_what_it_looks_like(tmp_path: Path, post: str, capsys: pytest.CaptureFixture[str]) -> None:
    """A Fanuc program with a length without a point: 0.050 mm, told as check tells it."""
    source, out = tmp_path / "in.nc", tmp_path / "out.nc"
    head = "%\nO0007 (PLATE)\nG21 G90 G17\nT1 M6\nG0 G43 H1 Z5.\nG0 X50. Y0\nZ50\nG1 Z-1. F200.\n"
    source.write_text(head + ring().replace("F600", "F600.") + "G0 Z5.\nG4 P500\nM5\nM30\n%\n")
    assert main(["smooth", str(source), "-o", str(out), "--post", post]) == 0
    told = capsys.readouterr().out
    assert (
        "read as Fanuc does" in told and "without a decimal point count in 0.001 mm" in told and "(a warning)" in told
    )
    after = read_program(out.read_bytes(), ReadOptions(Dialect(post)))
    assert after.error is None and after.motions.end[2].tolist() == [50.0, 0.0, pytest.approx(0.05)]
    assert [event.value for event in after.events if event.kind is EventKind.DWELL] == [0.5]
    assert np.sum(after.motions.kind >= MotionKind.ARC_CW) == 2


def test_what_the_other_control_has_not_is_refused_by_line_and_word(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source, out = tmp_path / "in.ngc", tmp_path / "out.ngc"
    source.write_text(HEAD + ring() + TAIL)
    assert main(["smooth", str(source), "-o", str(out), "--post", "grbl"]) == 2
    assert "in.ngc:2:4: M6: grbl changes no tools" in capsys.readouterr().err and not out.exists()


def bent(leg: float) -> tuple[str, np.ndarray]:
    """Long legs in pieces, each behind a short one, bent by 40 to 80 degrees by turns; and the places where it
    bends.
    """
    places, corners, angle = [np.zeros(2)], [], 0.0
    for k in range(40):
        corners.append(places[-1])
        angle += math.radians(40 + k) * (1 if k % 4 < 2 else -1)
        way = np.array([math.cos(angle), math.sin(angle)])
        places += [places[-1] + way * leg] if k % 2 else [places[-1] + way * s for s in (0.25, 0.5, 0.75, 1.0)]
    lines = "".join(f"G1 X{x:.4f} Y{y:.4f}\n" for x, y in places[1:])
    return "G21 G90\nG0 X0 Y0\nG1 Z-1 F100\n" + lines + "M2\n", np.array(corners[1:])


@pytest.mark.parametrize("post", ["linuxcnc", "fanuc"])
@pytest.mark.parametrize("leg", [0.005, 0.012, 0.0155, 0.0185, 0.0202, 0.03])
def test_every_corner_is_kept_that_the_head_speaks_of(tmp_path: Path, leg: float, post: str) -> None:
    source, corners = bent(leg)
    text, report = smoothed(tmp_path, source, "--tolerance", "0.01", "--post", post)
    ends = read_program(text.encode(), ReadOptions(Dialect(post))).motions.end[:, :2]
    step = 1e-3 if post == "fanuc" else 1e-4
    kept = np.array([np.hypot(*(ends - corner).T).min() <= 1.5 * step for corner in corners])
    assert report["corner_least_leg_mm"] == 0.02
    head = " ".join(text.lower().replace(")\n(", " ").split())
    assert "corners above 30 deg kept where both legs are 0.02 mm or longer" in head
    if leg >= 0.02:
        assert kept.all() and report["bends_rounded"] == 0
    assert report["bends_rounded"] == np.sum(~kept)
    assert (f"{np.sum(~kept)} bend" in head) == bool(np.sum(~kept))


def test_where_the_control_has_no_splines_in_space_arcs_of_the_other_planes_stand(tmp_path: Path) -> None:
    t = np.linspace(0, math.pi, 200)
    rows = [f"G1 X{30 * math.cos(a):.4f} Z{-10 - 30 * math.sin(a):.4f}" for a in t]
    text, report = smoothed(
        tmp_path, HEAD + "\n".join(rows) + "\n" + TAIL, "--post", "linuxcnc", "--as", "nurbs", "--tolerance", "0.02"
    )
    assert "G18" in text and "G5.2" not in text
    assert report["blocks"]["after"] <= 8
