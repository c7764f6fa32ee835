"""What is wrong with a scene is found, with its place: holes, size, place in the stock, tips in the table, plunges at
full feed.
"""

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.main import main
from app.model.finding import FindingKind
from app.model.moves import Moves
from app.model.scene import Passes
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.parallel.surface_moves import SurfaceMoves
from app.surfaces.meshes.holes import holes
from app.usecases.scene.findings import floor_findings
from tests.surfaces.solids import FLOOR, WALL, pocketed_block, stl

SCENE = """
name = "part"
stock = {{ {stock} }}
[[tool]]
number = 1
kind = "ball"
diameter = 6.0
feed_rate = 900
plunge_rate = 300
{tool}
[[surface]]
name = "part"
shape = {shape}
{place}
[[passes]]
tool = 1
{apart} = {pitch}
{passes}
"""
MESH = '{ kind = "mesh", file = "part.stl" }'
DOME = '{ kind = "sphere", centre = [0, 0, 0], radius = 12 }'
BLOCK = "box = [-1, -1, -10, 41, 31, 1]"


def told(folder: Path, triangles: np.ndarray | None = None, **given: object) -> tuple[int, dict[str, Any]]:
    """Return the exit status and the report of `surface` on a scene."""
    if triangles is not None:
        (folder / "part.stl").write_bytes(stl(triangles))
    words = {"stock": BLOCK, "shape": MESH, "place": "", "apart": "pitch", "pitch": 4, "passes": "", "tool": ""} | given
    (folder / "s.toml").write_text(SCENE.format(**words))
    status = main(
        ["surface", str(folder / "s.toml"), "-o", str(folder / "s.ngc"), "--report", str(folder / "r.json"), "--quiet"]
    )
    return status, json.loads((folder / "r.json").read_text()) if (folder / "r.json").exists() else {}


def kinds(report: dict[str, Any]) -> list[str]:
    return [finding["kind"] for finding in report["findings"] if finding["counts"]]


def with_hole(size: float) -> np.ndarray:
    """A block of 40 x 30 x 10 whose top has a square hole, 10 deep to its underside."""
    low, high, x, y = (
        pocketed_block()[:2],
        pocketed_block()[10:18],
        (20 - size / 2, 20 + size / 2),
        (15 - size / 2, 15 + size / 2),
    )
    outer, inner = [(0, 0), (40, 0), (40, 30), (0, 30)], [(x[0], y[0]), (x[1], y[0]), (x[1], y[1]), (x[0], y[1])]
    rings = [(outer[k], outer[(k + 1) % 4], inner[(k + 1) % 4], inner[k]) for k in range(4)]
    top = [t for a, b, c, d in rings for t in ((a, b, c), (a, c, d))]
    return np.concatenate([low, high, [[(*place, 0.0) for place in each] for each in top]])


def test_a_closed_mesh_and_a_sheet_have_no_holes() -> None:
    sheet = pocketed_block()[2:10]
    assert holes(pocketed_block()) == ()
    (inner,) = holes(sheet)  # the ring round the pocket alone: the rim outside is none
    assert (inner.x, inner.y, inner.radius) == pytest.approx((20, 15, 8), abs=2.1) and (inner.wide, inner.long) == (
        20,
        16,
    )
    cup = np.concatenate([pocketed_block()[18:]])
    assert holes(cup) == ()
    (bottomless,) = holes(np.delete(pocketed_block(), FLOOR, axis=0))
    assert (bottomless.z, bottomless.edges) == (-4.0, 4)


def test_a_hole_in_the_top_is_told_with_its_place(tmp_path: Path) -> None:
    status, report = told(tmp_path, with_hole(10))
    assert status == 1 and kinds(report)[0] == "hole"
    finding = report["findings"][0]
    assert (finding["x"], finding["y"], finding["amount"]) == pytest.approx((20, 15, 10), abs=0.1)
    assert "10.000 x 10.000 mm" in finding["text"] and "close it" in finding["text"]
    _, report = told(tmp_path, with_hole(0.2))
    assert "hole" not in kinds(report)


def test_a_closed_part_in_its_stock_has_no_findings(tmp_path: Path) -> None:
    """Its passes come to the pocket's walls at y = 7 and 23, within 0.01 mm."""
    status, report = told(tmp_path, pocketed_block(), pitch=1.996, passes="through = [0, 10.01]")
    assert (status, report["findings"]) == (0, [])


def test_a_model_in_metres_is_told(tmp_path: Path) -> None:
    status, report = told(tmp_path, pocketed_block() / 1000, pitch=1)
    assert status == 1 and "size" in kinds(report)
    assert "only 0.04 mm wide" in report["findings"][0]["text"] and "scale = 1000" in report["findings"][0]["text"]
    assert sum("Nothing is cut" in finding["text"] for finding in report["findings"]) == 0


@pytest.mark.parametrize(
    ("move", "kind", "words"),
    [
        ([20, 0, 0], "beyond_stock", "19.000 mm beyond the stock towards +X"),
        ([0, -15, 0], "beyond_stock", "14.000 mm beyond the stock towards -Y"),
        ([0, 0, 5], "beyond_stock", "4.000 mm over the stock's top"),
        ([0, 0, -12], "beyond_stock", "wholly below the stock"),
        ([0, 0, -12], "below_table", "below the stock's underside"),
    ],
    ids=str,
)
def test_a_part_that_does_not_lie_in_its_stock_is_told(
    tmp_path: Path, move: list[float], kind: str, words: str
) -> None:
    status, report = told(tmp_path, pocketed_block(), place=f"move = {move}")
    assert status == 1
    assert [finding for finding in report["findings"] if finding["kind"] == kind and words in finding["text"]]


@pytest.mark.parametrize(
    ("top", "flutes", "counts"),
    [
        (15.0, "", False),
        (15.0, "flute_length = 9", True),
        (8.0, "", None),
        (15.0, "flute_length = 20", None),
    ],
)
def test_passes_through_metal_that_nothing_has_roughed_are_told(
    tmp_path: Path, top: float, flutes: str, counts: bool | None
) -> None:
    """A ball of 6, 4 mm beside its last pass, takes 59.04 mm2 below a top at 15, a slot of its width and 9.84 mm, less
    at the ends.
    """
    shape = '{ kind = "plane", corner = [0, 0, 0], along = [40, 0, 0], across = [0, 20, 0] }'
    status, report = told(tmp_path, shape=shape, stock=f"box = [0, 0, -5, 40, 20, {top}]", tool=flutes)
    found = [finding for finding in report["findings"] if finding["kind"] == "engagement"]
    assert status == int(bool(counts)) and [finding["counts"] for finding in found] == (
        [] if counts is None else [counts]
    )
    for finding in found:
        assert 9.2 < finding["amount"] <= 9.84 and 0 <= finding["x"] <= 40 and finding["y"] in (4.0, 8.0, 12.0, 16.0)
        assert ("its flutes are 9 mm long" if flutes else "it is 6 mm wide") in finding["text"]
        assert "rough the part first" in finding["text"]


def test_passes_that_touch_no_metal_are_told(tmp_path: Path) -> None:
    shape = '{ kind = "plane", corner = [0, 0, 0], along = [20, 0, 0], across = [0, 20, 0] }'
    status, report = told(tmp_path, shape=shape, stock="box = [0, 0, -5, 20, 20, 0]")
    assert status == 1 and "Nothing is cut" in report["findings"][0]["text"]


@pytest.mark.exhaustive
def test_a_tip_below_the_underside_is_told_with_the_floor_that_helps(tmp_path: Path) -> None:
    status, report = told(tmp_path, shape=DOME, stock="box = [-12, -12, 0, 12, 12, 12]", pitch=1)
    assert status == 1 and kinds(report) == ["below_table"] and "floor = 0" in report["findings"][0]["text"]
    assert 2.5 < report["findings"][0]["amount"] <= 3.0
    assert told(tmp_path, shape=DOME, stock="box = [-12, -12, 0, 12, 12, 12]", pitch=1, passes="floor = 0")[0] == 0


@pytest.mark.parametrize(("angle", "lowest"), [(0.0, 0.0), (30.0, -2.0), (45.0, -2.0)])
def test_the_floor_holds_wherever_turned_passes_come(tmp_path: Path, angle: float, lowest: float) -> None:
    """It was as wide as surfaces and overrun: at the corners of a turned rectangle, beyond, tips fell past it."""
    shape = '{ kind = "plane", corner = [0, 0, 0], along = [20, 0, 0], across = [0, 20, 0] }'
    passes = f"angle_deg = {angle}\noverrun = 1\nfloor = -2"
    told(tmp_path, shape=shape, stock="box = [-9, -9, -8, 29, 29, 1]", pitch=1, passes=passes)
    heights = [float(z) for z in re.findall(r"Z(-?[\d.]+)", (tmp_path / "s.ngc").read_text())]
    assert min(heights) == lowest


def test_a_tip_below_the_floor_of_its_own_passes_is_told() -> None:
    """Asked of the moves alone, whatever made them."""
    ends = np.array([[0.0, 0.0, 5.0], [1.0, 2.0, -2.5], [3.0, 4.0, -6.0]])
    three = np.zeros(3)
    moves = Moves(
        ends, np.full((3, 2), np.nan), *(three.astype(np.uint8),) * 2, np.array([0, 1, 2], np.int16), *(three,) * 4
    )
    passes = [
        Passes(1, pitch=1.0, floor=5.0),
        Passes(1, "low", pitch=1.0, floor=-2.4),
        Passes(1, pitch=1.0, floor=-6.0005),
        Passes(1, pitch=1.0, floor=9.0),
    ]
    (found,) = floor_findings(SurfaceMoves(moves, three.astype(np.int64)), passes)
    assert (found.kind, found.x, found.y) == (FindingKind.GOUGE, 1.0, 2.0)
    assert "0.100 mm below the floor of passes low, Z -2.400" in found.text


def test_steep_descents_go_at_the_plunge_rate(tmp_path: Path) -> None:
    told(tmp_path, pocketed_block(), pitch=4)
    feed, at, down, rapid = 0.0, np.zeros(3), 0, True
    for line in (tmp_path / "s.ngc").read_text().splitlines():
        if line[:1] not in "GXYZF":
            continue
        words = {word[0]: float(word[1:]) for word in line.split()}
        rapid = words["G"] == 0 if words.get("G") in (0.0, 1.0) else rapid
        feed, to = (
            words.get("F", feed),
            np.array([words.get(axis, old) for axis, old in zip("XYZ", at.tolist(), strict=True)]),
        )
        if not rapid and at[2] - to[2] > max(0.2, math.tan(math.radians(60)) * math.hypot(*(to - at)[:2])):
            assert feed == 300.0
            down += 1
        at = to
    assert down >= 3  # into the pocket, one on most of the planes that cross it


@pytest.mark.exhaustive
def test_passes_overrun_to_the_foot_of_a_dome(tmp_path: Path) -> None:
    """Ball 6 at a foot of radius 12: with its tip at 0 its middle is sqrt(15² - 3²) from the dome's."""
    box = "box = [-12, -12, 0, 12, 12, 12]"
    foot = math.sqrt((12 + 3) ** 2 - 3**2)
    ends = {}
    for given in ("", "overrun = 0", "overrun = 1"):
        told(tmp_path, shape=DOME, stock=box, pitch=3, passes=given)
        ends[given] = max(
            float(word[1:])
            for line in (tmp_path / "s.ngc").read_text().splitlines()
            for word in line.split()
            if word[0] == "X" and line[0] in "GXYZ"
        )
    assert ends[""] == pytest.approx(foot, abs=0.02) and ends[""] <= foot + 1e-3
    assert (ends["overrun = 0"], ends["overrun = 1"]) == (pytest.approx(12, abs=1e-3), pytest.approx(13, abs=1e-3))


def test_a_level_sheet_is_followed_as_far_as_it_goes(tmp_path: Path) -> None:
    shape = '{ kind = "plane", corner = [0, 0, 0], along = [20, 0, 0], across = [0, 20, 0] }'
    reports = [
        told(tmp_path, shape=shape, stock="box = [-5, -5, -5, 25, 25, 1]", passes=given)[1]
        for given in ("", "overrun = 0")
    ]
    assert (
        reports[0]["length_mm"] == reports[1]["length_mm"]
        and reports[0]["passes"][0]["planes"] == reports[1]["passes"][0]["planes"]
    )


def test_a_mesh_that_was_cut_off_is_one_sentence(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "part.stl").write_bytes(stl(np.tile(pocketed_block(), (10, 1, 1)))[:2000])
    (tmp_path / "s.toml").write_text(
        SCENE.format(stock=BLOCK, shape=MESH, place="", apart="pitch", pitch=4, passes="", tool="")
    )
    assert main(["surface", str(tmp_path / "s.toml"), "-o", str(tmp_path / "s.ngc")]) == 2
    said = [line for line in capsys.readouterr().err.splitlines() if line.startswith("hitofude: ")]
    assert said == [
        "hitofude: part.stl: this STL file was cut off: it has 2,000 bytes of the 14,084 that its 280 triangles take; "
        "copy or export it again."
    ]


def test_walls_are_where_they_are_said_to_be() -> None:
    assert np.all(pocketed_block()[WALL][:, :, 0] == 30) and np.all(pocketed_block()[FLOOR][:, :, 2] == -4)


def test_a_way_that_ends_where_the_path_is_as_steep_as_upright_ends() -> None:
    """A link from the foot of a dome to where the ball touches its equator: the last chord was made again and again."""
    from app.surfaces.passes.path import Follower, FollowOptions
    from tests.surfaces.scenes import ball, facets_of

    follower = Follower(facets_of(ball(0, 0, 0, 12)), Tool(1, 6.0, ToolKind.BALL), FollowOptions(0.0, 0.01, 1e-4))
    assert math.hypot(8.9998, 12.0) == pytest.approx(12 + 3, abs=2e-4)
    way = follower.between((-6.8512, -13.0), (-8.9998, -12.0))
    assert way is None or way[-1, 2] < -2.9


@pytest.mark.parametrize(
    ("pitch", "status", "words"),
    [
        (0.3, 0, "0.000 mm2 left within reach"),
        (2.0, 1, "of metal within reach is left in"),
    ],
)
def test_what_the_chord_tolerance_leaves_is_no_metal_left_and_what_the_pitch_leaves_is(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], pitch: float, status: int, words: str
) -> None:
    """A wave that a ball of 6 reaches everywhere, as it bends by 1 / (6 (2 pi / 40)²) = 6.75 at most, and no place of
    it is out of reach.

    Chords lie up to 0.01 above it, square to it, ridges of a pitch of 2 are 0.17 high.
    """
    x = np.linspace(0.0, 60.0, 161)
    places = np.array([[(at, y, 6 * math.sin(2 * math.pi * at / 40) - 8) for y in (0.0, 20.0)] for at in x.tolist()])
    a, b, c, d = places[:-1, 0], places[1:, 0], places[1:, 1], places[:-1, 1]
    wave = np.concatenate([np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)])
    told(tmp_path, wave, stock="box = [0, 0, -20, 60, 20, 0]", pitch=pitch)
    capsys.readouterr()
    assert main(["cut", str(tmp_path / "s.ngc"), "--against", str(tmp_path / "s.toml"), "--grid", "512"]) == status
    said = capsys.readouterr().out
    assert words in said and "0.000 mm2 out of reach" in said
