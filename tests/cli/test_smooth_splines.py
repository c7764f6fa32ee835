"""Splines when splines are asked for: what was written is said, and who insists gets them all along."""

from __future__ import annotations

import math
import re
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import BSpline

from app.cli.main import main
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.motion import MotionKind, Nurbs
from tests.cli.test_smooth import HEAD, TAIL, smoothed
from tests.fitting.test_tube import off_chords

ELLIPSE = np.array([[40 * math.cos(t), 25 * math.sin(t), -1.0] for t in np.linspace(0, math.pi, 61)])
"""Half an ellipse as 60 facets."""
TOLERANCE = 0.01


def bent(sides: int = 9, turn: float = math.radians(20)) -> np.ndarray:
    """A polygon whose corners are none by the usual angle: no smooth curve has room at its points."""
    steps = 10 * np.column_stack([np.cos(turn * np.arange(sides)), np.sin(turn * np.arange(sides)), np.zeros(sides)])
    return np.vstack([np.zeros(3), np.cumsum(steps, axis=0)]) + [0, 0, -1]


def program(points: np.ndarray, head: str = HEAD) -> str:
    first, *rest = [f"X{x:.4f} Y{y:.4f} Z{z:.4f}" for x, y, z in points.tolist()]
    lines = [f"G0 {first.rpartition(' ')[0]}", f"G1 {first.rpartition(' ')[2]} F200", f"G1 {rest[0]} F600", *rest[1:]]
    return head.rpartition("G0 X50 Y0")[0] + "\n".join(lines) + "\n" + TAIL


def cutting(text: str, post: str) -> tuple[np.ndarray, list[Nurbs]]:
    """Kinds of the motions of the stretch, and its splines, as the control reads what was written."""
    motions = read_program(text.encode(), ReadOptions(Dialect(post))).motions
    rows = np.flatnonzero((motions.start[:, 2] < 0) & (motions.end[:, 2] < 0))
    return motions.kind[rows], [motions.splines[row] for row in rows.tolist() if row in motions.splines]


def options(post: str, *more: str) -> list[str]:
    return ["--tolerance", str(TOLERANCE), "--as", "nurbs", "--post", post, "--dialect", post, *more]


def test_what_was_written_is_said_where_a_spline_would_take_more(tmp_path: Path) -> None:
    text, report = smoothed(tmp_path, program(ELLIPSE), *options("fanuc"))
    assert "written anew as nurbs" not in text.lower() and "G6.2" not in text
    kinds, _ = cutting(text, "fanuc")
    arcs, lines = int(np.sum(kinds > MotionKind.LINE)), int(np.sum(kinds == MotionKind.LINE))
    assert arcs > 0 and report["written"] == {
        "lines": lines,
        "arcs": arcs,
        "splines": 0,
        "words": f"{arcs} arcs" + (f" and {lines} line{'s' if lines > 1 else ''}" if lines else ""),
    }
    assert f"written anew as {arcs} arcs".upper() in text.upper()
    refused = [each for each in report["not_splines"] if each["spline_blocks"]]
    would = int(re.search(r"AS MANY BLOCKS OR MORE. (\d+) BLOCKS", text.upper().replace("\n", " "))[1])  # type: ignore[index]
    assert would == sum(each["spline_blocks"] for each in refused) >= 60


@pytest.mark.parametrize("points", [ELLIPSE, bent(), bent(1), bent(2)], ids=["ellipse", "bent", "chord", "two chords"])
def test_who_insists_gets_splines_all_along_continuous_in_curvature(tmp_path: Path, points: np.ndarray) -> None:
    if len(points) == 2:
        points = np.vstack([points, points[-1] + [0, 10, 0]])  # a corner: two runs of one chord each
    text, report = smoothed(tmp_path, program(points), *options("fanuc", "--insist"))
    kinds, splines = cutting(text, "fanuc")
    assert np.all(kinds == MotionKind.SPLINE), report["written"]
    assert report["written"]["splines"] == len(splines)
    places = []
    for curve in splines:
        spline = BSpline(curve.knots, curve.points, curve.degree)
        inner = np.unique(curve.knots)[1:-1]
        step = np.diff(np.unique(curve.knots)).min(initial=1.0) * 1e-7
        jump = spline.derivative(2)(inner + step) - spline.derivative(2)(inner - step)
        third = np.abs(spline.derivative(3)(np.concatenate([inner + step, inner - step]))).max(initial=0.0)
        assert np.abs(jump).max(initial=0.0) <= 2.1 * step * third + 1e-9 * np.abs(spline.derivative(2)(inner)).max(
            initial=1.0
        )
        places.append(spline(np.linspace(curve.knots[0], curve.knots[-1], 20_000)))
    path = np.vstack(places)
    assert off_chords(path, points).max() <= TOLERANCE + 1e-6
    assert off_chords(points, path).max() <= TOLERANCE + 1e-6


def test_a_control_that_drives_splines_as_arcs_gets_lines_only_where_they_are_straight(tmp_path: Path) -> None:
    """LinuxCNC finds no arcs for a piece that is straight to the last digit, so that is a line, touching both sides."""
    text, report = smoothed(tmp_path, program(ELLIPSE), *options("linuxcnc", "--insist"))
    kinds, _ = cutting(text, "linuxcnc")
    assert np.all((kinds == MotionKind.SPLINE) | (kinds == MotionKind.LINE))
    assert np.sum(kinds == MotionKind.LINE) < 0.1 * len(kinds)
    assert report["largest_bend_deg"]["after"] < 0.3 < report["largest_bend_deg"]["before"]


def test_what_rises_is_told_where_the_control_has_splines_at_one_height_only(tmp_path: Path) -> None:
    rising = ELLIPSE + np.linspace(0, 0.9, len(ELLIPSE))[:, None] * [0, 0, 1]
    text, report = smoothed(tmp_path, program(rising), *options("linuxcnc", "--insist"), status=1)
    assert report["written"]["splines"] == 0 and "AT ONE HEIGHT ONLY" in text.upper()


def test_where_a_path_rises_on_its_way_the_rest_of_it_is_splines(tmp_path: Path) -> None:
    """A ramp into a level contour: what is at one height has its splines, what rises has arcs and lines, and both are
    told.
    """
    ramp = np.column_stack([np.full(11, 40.0), np.linspace(-20, 0, 11), np.linspace(0, -1, 11)])
    text, report = smoothed(
        tmp_path, program(np.vstack([ramp, ELLIPSE[1:]])), *options("linuxcnc", "--insist"), status=1
    )
    kinds, splines = cutting(text, "linuxcnc")
    assert len(splines) > 20 and np.sum(kinds == MotionKind.SPLINE) == len(splines)
    assert [each["reason"] for each in report["not_splines"]] == ["the control knows splines at one height only"]
    assert min(spline.points[0, 1] for spline in splines) >= 0


def test_lines_are_told_where_nothing_bends(tmp_path: Path) -> None:
    zigzag = np.column_stack([np.arange(9) * 4.0, np.arange(9) % 2 * 10.0, np.full(9, -1.0)])
    text, report = smoothed(tmp_path, program(zigzag), *options("linuxcnc", "--insist"))
    assert report["written"]["splines"] == 0
    assert "8 LINES WHERE A SPLINE IS STRAIGHT TO THE LAST DECIMAL" in text.upper()


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (["--as", "arcs", "--insist"], "--insist belongs to --as nurbs"),
        (["--as", "nurbs", "--insist", "--post", "haas", "--dialect", "haas"], "knows no splines"),
    ],
)
def test_insisting_where_it_cannot_be_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], more: list[str], told: str
) -> None:
    source = tmp_path / "in.ngc"
    source.write_text(program(ELLIPSE))
    assert main(["smooth", str(source), "-o", str(tmp_path / "out.ngc"), *more]) == 2
    assert told in capsys.readouterr().err and not (tmp_path / "out.ngc").exists()


@pytest.mark.parametrize("form", ["arcs", "nurbs"])
@pytest.mark.parametrize("outline", ["f:0.01+0.02*sin(pi*z)", "table:0=0.006,0.5=0.03,1=0.006"])
def test_any_outline_of_the_region_is_used_proven_and_told(tmp_path: Path, form: str, outline: str) -> None:
    more = ["--post", "fanuc", "--dialect", "fanuc", "--as", form, "--region"]
    text, report = smoothed(tmp_path, program(ELLIPSE), *more, outline)
    _, narrow = smoothed(tmp_path, program(ELLIPSE), *more, "cylinder", "--tolerance", "0.006")
    assert report["blocks"]["after"] < narrow["blocks"]["after"]
    assert "REGION BY ITS OUTLINE" in text.upper()
    [stretch] = report["stretches"]["listed"]
    assert report["tolerance"]["asked_mm"] < report["tolerance"]["proven_mm"] <= 0.03
    assert len(stretch["joints"]) == stretch["blocks"]["after"] - 1 if form == "arcs" else not stretch["joints"]
    assert (form == "arcs") == ("rounds" not in stretch)
    if form == "nurbs":
        counts = [each["control_points"] for each in stretch["rounds"] if not each["thinning"]]
        assert any(each["chords_unproven"] for each in stretch["rounds"]) and counts == sorted(counts)


def test_an_outline_tells_the_tolerance(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    source = tmp_path / "in.ngc"
    source.write_text(program(ELLIPSE))
    told = ["smooth", str(source), "-o", str(tmp_path / "out.ngc"), "--region", "f:0.01", "--tolerance", "0.01"]
    assert main(told) == 2 and "--tolerance" in capsys.readouterr().err
