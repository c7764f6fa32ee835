"""Programs against a block with a pocket whose every depth is known: the same verdict however it is wound, and whatever
the cells are.
"""

import json
import time
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.main import main
from app.model.finding import FindingKind
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.cutter import cutter_of
from app.simulation.field.solid import SolidStock, read_solid
from app.simulation.field.triangle_tree import TriangleTree
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, CutProgram, CutSetup, cut
from app.verify.parts import SolidPart
from app.verify.solid_depth import CutColumns, DepthInSolid
from app.verify.solid_gouges import APART, apart
from tests.surfaces.solids import FLOOR, WALL, pocketed_block, stl
from tests.verify.test_judge import program

BLOCK = pocketed_block()


def pocketing(gouge: float, one_wall: float, floor: float = -4.0) -> str:
    """Clears the pocket with a flat tool of 6 mm, too wide by `gouge` all round, and by `one_wall` at X 30."""
    lines = ["G21 G90 G94 G17", "T1 M6", "S1000 M3", "G0 Z5", "X20 Y15", f"G1 Z{floor} F300"]
    x0, x1, y0, y1 = 13 - gouge, 27 + one_wall, 10 - gouge, 20 + gouge
    for share in np.linspace(0.2, 1.0, 5).tolist():
        (a, b), (c, d) = ([20 + (x - 20) * share for x in (x0, x1)], [15 + (y - 15) * share for y in (y0, y1)])
        lines += [f"X{a:.4f} Y{c:.4f}", f"X{b:.4f}", f"Y{d:.4f}", f"X{a:.4f}", f"Y{c:.4f}"]
    return "\n".join([*lines, "G0 Z5", "M2", ""])


def judged(text: str, cells: int, leave: float = 0.0) -> CutProgram:
    stock = BoxStock(StockBox(0, 0, -10, 40, 30, 0))
    return cut(
        CutSetup((program(text),), {1: Tool(1, 6.0)}, stock, SolidPart(SolidStock(BLOCK), leave)), CutOptions(cells)
    )


def report(tmp_path: Path, triangles: np.ndarray, text: str) -> tuple[int, dict[str, Any]]:
    (tmp_path / "part.stl").write_bytes(stl(triangles))
    (tmp_path / "a.ngc").write_text(text)
    status = main(
        [
            "cut",
            str(tmp_path / "a.ngc"),
            "--tool=1=flat:6",
            "--stock=0,0,-10,40,30,0",
            "--against",
            str(tmp_path / "part.stl"),
            "--grid=128",
            "--report",
            str(tmp_path / "r.json"),
            "--quiet",
        ]
    )
    return status, json.loads((tmp_path / "r.json").read_text())


def reversed_at(rows: slice) -> np.ndarray:
    found = BLOCK.copy()
    found[rows] = found[rows, ::-1]
    return found


@pytest.fixture(scope="module")
def right_side_out(tmp_path_factory: pytest.TempPathFactory) -> tuple[int, dict[str, Any]]:
    return report(tmp_path_factory.mktemp("block"), BLOCK, pocketing(0.3, 1.0))


@pytest.mark.parametrize(
    ("rows", "words"), [(slice(None), "inside out"), (WALL, "2 of 28 triangles"), (FLOOR, "2 of 28 triangles")]
)
def test_the_verdict_is_that_of_the_solid_right_side_out(
    tmp_path: Path, right_side_out: tuple[int, dict[str, Any]], rows: slice, words: str
) -> None:
    expected, found = right_side_out, report(tmp_path, reversed_at(rows), pocketing(0.3, 1.0))
    assert expected[0] == found[0] == 1
    for key in ("gouge", "left", "worst", "worst_count", "bands", "certificate"):
        assert found[1][key] == expected[1][key]
    assert found[1]["gouge"]["max_mm"] == pytest.approx(1.0, abs=1e-4)
    assert [said for said in found[1]["assumed"] if words in said] and not [
        said for said in expected[1]["assumed"] if "triangles" in said
    ]
    assert report(tmp_path, reversed_at(rows), pocketing(0.0, 0.0))[0] == 0


def test_a_solid_that_is_not_closed_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "part.stl").write_bytes(stl(np.delete(BLOCK, 3, axis=0)))
    (tmp_path / "a.ngc").write_text(pocketing(0.3, 1.0))
    assert main(["cut", str(tmp_path / "a.ngc"), "--tool=1=flat:6", "--against", str(tmp_path / "part.stl")]) == 2
    assert "part.stl: the solid's surface is not closed at (" in capsys.readouterr().err


@pytest.mark.parametrize("cells", [64, 256, 512, pytest.param(1024, marks=pytest.mark.exhaustive)])
@pytest.mark.parametrize(("floor", "deep"), [(-4.0, 1.0), (-4.3, 1.09**0.5)])
def test_the_depth_is_the_same_at_every_grid(cells: int, floor: float, deep: float) -> None:
    done = judged(pocketing(0.3, 1.0, floor), cells)
    assert done.judgement is not None and done.judgement.certificate is not None
    gouge, pitch = done.judgement.gouge, done.cut.before.grid.pitch
    assert gouge.max_mm == pytest.approx(deep, abs=1e-4)
    assert (gouge.x, gouge.z) == (pytest.approx(31.0, abs=1e-3), pytest.approx(floor, abs=1e-6))
    assert deep <= done.judgement.certificate.gouge_mm <= deep + 2.5 * pitch


@pytest.mark.parametrize("deep", [2.5, 8.0])
def test_a_gouge_far_deeper_than_any_number_of_cells_is_told_as_it_is(deep: float) -> None:
    """From 4 mm on the way up to the block's top is the nearest."""
    gouge = judged(pocketing(0.0, deep), 600).judgement
    assert gouge is not None and gouge.gouge.max_mm == pytest.approx(min(deep, 4.0), abs=1e-3)


@pytest.mark.parametrize("cells", [256, pytest.param(1024, marks=pytest.mark.exhaustive)])
def test_a_floor_that_is_too_deep_is_told_in_seconds(cells: int) -> None:
    begin = time.process_time()
    done = judged(pocketing(0.0, 0.0, -4.3), cells)
    assert time.process_time() - begin < 20.0  # some 2 s; 97 s before
    assert done.judgement is not None and done.judgement.gouge.max_mm == pytest.approx(0.3, abs=1e-5)
    assert done.judgement.gouge.count == 1


@pytest.mark.parametrize("cells", [64, 512])
@pytest.mark.parametrize(("beyond", "deep"), [(0.4, 0.7), (-0.1, 0.2), (-0.29, 0.01), (-0.3, None)])
def test_stock_to_leave_counts_to_the_depth(cells: int, beyond: float, deep: float | None) -> None:
    done = judged(pocketing(-0.3, beyond, -3.7), cells, leave=0.3)
    assert done.judgement is not None and bool(done.judgement.gouge.count) == (deep is not None)
    if deep is not None:
        assert done.judgement.gouge.max_mm == pytest.approx(deep, abs=1e-3)


def test_walls_that_are_asked_too_far_apart_are_told(monkeypatch: pytest.MonkeyPatch) -> None:
    from app.verify import wall_probe

    monkeypatch.setattr(wall_probe, "MOST_POINTS", 100)
    said = [finding for finding in judged(pocketing(0.0, 0.0), 256).findings if finding.kind is FindingKind.TOLERANCE]
    assert len(said) == 1 and not said[0].counts and said[0].amount == pytest.approx(4 * (40 + 30 + 20 + 16) / 100)
    monkeypatch.undo()
    assert not [
        finding for finding in judged(pocketing(0.0, 0.0), 64).findings if finding.kind is FindingKind.TOLERANCE
    ]


def test_distances_are_those_of_every_triangle_asked_in_turn() -> None:
    from trimesh.triangles import closest_point

    rng = np.random.default_rng(1)
    triangles = rng.random((200, 3, 3)) * rng.choice([0.01, 1.0], (200, 1, 1)) + 3 * rng.random((200, 1, 3))
    places, tree = 5 * rng.random((60, 3)) - 1, TriangleTree.of(triangles)
    plain = [
        np.linalg.norm(closest_point(triangles, np.broadcast_to(place, (200, 3))) - place, axis=1).min()
        for place in places
    ]
    assert tree.distances(places) == pytest.approx(plain, abs=1e-12)
    segments = np.column_stack([places, places[:, 2] + 2 * rng.random(60)])
    along = np.linspace(0, 1, 400)
    dense = [
        tree.distances(np.column_stack([np.full((400, 2), (x, y)), low + along * (high - low)])).max()
        for x, y, low, high in segments
    ]
    deepest = tree.deepest(segments, np.zeros(60), 1e-6)
    assert np.all(deepest >= np.array(dense) - 1e-6) and np.all(deepest <= np.array(dense) + 2 / 399 / 2)


def test_columns_through_edges_and_corners_and_hollows_are_in_metal_where_it_is() -> None:
    depth_in = DepthInSolid(SolidStock(BLOCK))
    places = np.array([[20.0, 15.0], [5.0, 15.0], [10.0, 7.0], [0.0, 0.0], [-1.0, 5.0], [34.0, 15.0]])
    columns = CutColumns(places, np.array([-20.0, -7.0, -20.0, -20.0, -20.0, -1.5]), np.full(6, 5.0))
    assert depth_in.of(columns).tolist() == pytest.approx([3.0, 5.0, 3.0, 0.0, 0.0, 1.5], abs=1e-4)


def test_faces_within_an_overlapping_body_are_no_surface(tmp_path: Path) -> None:
    from tests.simulation.test_target import box

    both = read_solid("a.stl", stl(np.concatenate([box((0, 0, 0), (20, 20, 20)), box((5, 5, 5), (35, 15, 15))])))
    inner = CutColumns(np.array([[18.0, 10.0]]), np.array([10.0]), np.array([10.5]))
    assert both.shells == 2
    assert DepthInSolid(both).of(inner)[0] == pytest.approx(29.0**0.5, abs=1e-4)  # to a rim of the larger side


def step() -> np.ndarray:
    """A block of 40 x 30 x 10 that is 4 lower left of X 20."""
    outline = [(0, -10), (40, -10), (40, 0), (20, 0), (20, -4), (0, -4)]
    front, back = [(x, 0, z) for x, z in outline], [(x, 30, z) for x, z in outline]
    caps = [(0, 1, 4), (0, 4, 5), (1, 2, 4), (2, 3, 4)]
    found = [[front[k] for k in cap] for cap in caps] + [[back[k] for k in cap[::-1]] for cap in caps]
    for k in range(6):
        a, b, c, d = front[k], back[k], back[(k + 1) % 6], front[(k + 1) % 6]
        found += [[a, b, c], [a, c, d]]
    return np.array(found, float)


def stepped(wall: float, floor: float, top: float) -> str:
    """Mills the step with a flat tool of 6 mm: its wall, floor, and top up to X 30, too deep by some mm."""
    lines = ["G21 G90 G94 G17", "T1 M6", "S1000 M3", "G0 Z5", "X-5 Y-5", f"G1 Z{-4 - floor} F300"]
    for x in (0.0, 5.0, 10.0, 15.0, 17.0 + wall):
        lines += [f"X{x:.4f} Y-5", "Y35", "Y-5"]
    lines += ["G0 Z5", "X23 Y-5", f"G1 Z{-top}"]
    for x in (23.0, 27.0):
        lines += [f"X{x:.4f} Y-5", "Y35", "Y-5"]
    return "\n".join([*lines, "G0 Z5", "M2", ""])


@pytest.mark.parametrize("cells", [64, 256, pytest.param(1024, marks=pytest.mark.exhaustive)])
def test_a_gouge_in_a_wall_is_not_told_with_the_height_of_another_place(cells: int) -> None:
    """Behind the wall the top is gouged, too, but not as deep down as the wall is: the two are no one deep place."""
    setup = CutSetup(
        (program(stepped(0.1, 0.3, 0.3)),),
        {1: Tool(1, 6.0)},
        BoxStock(StockBox(0, 0, -10, 40, 30, 0)),
        SolidPart(SolidStock(step())),
    )
    judgement = cut(setup, CutOptions(cells)).judgement
    assert judgement is not None and judgement.certificate is not None
    assert judgement.gouge.max_mm == pytest.approx(0.1**0.5, abs=1e-4)  # from the wall's foot
    assert judgement.gouge.x == pytest.approx(20.1, abs=1e-3) and judgement.gouge.z == pytest.approx(-4.3, abs=1e-6)
    assert judgement.certificate.gouge_mm >= judgement.gouge.max_mm


def test_a_rib_that_is_cut_through_is_half_its_width_deep() -> None:
    """Nowhere is it cut deeper than in its middle; the end of the gouge is the rib's other side."""
    rib = step() * [0.02, 1.0, 1.0] + [10.0, 0.0, 0.0]  # 0.8 mm wide, 0.4 of it 4 mm lower
    text = "\n".join(["G21 G90 G94 G17", "T1 M6", "G0 Z5", "X10.4 Y15", "G1 Z-6 F300", "Y17", "G0 Z5", "M2", ""])
    setup = CutSetup(
        (program(text),), {1: Tool(1, 3.0)}, BoxStock(StockBox(0, 0, -10, 20, 30, 0)), SolidPart(SolidStock(rib))
    )
    for cells in (24, 300):
        judgement = cut(setup, CutOptions(cells)).judgement
        assert judgement is not None and judgement.gouge.max_mm == pytest.approx(0.4, abs=2e-3)


def ball_of_triangles() -> np.ndarray:
    """80 triangles (80, 3, 3), convex."""
    from trimesh.creation import icosphere

    return np.array(icosphere(subdivisions=1, radius=8.0).triangles) + [10.0, 10.0, -8.0]


def random_places(seed: int) -> np.ndarray:
    """Tips (8, 3), also below the ball's middle."""
    rng = np.random.default_rng(seed)
    angles = rng.uniform(0, 2 * np.pi, 8)
    away, down = rng.uniform(4.0, 10.0, 8), rng.uniform(-14.0, -2.0, 8)
    return np.round(np.column_stack([10 + away * np.cos(angles), 10 + away * np.sin(angles), down]), 4)


SIDE = np.linspace(1.5, 18.5, 70)


@cache
def deepest_of_dense_columns(kind: ToolKind, seed: int) -> float:
    """How deep the cut from one random place to the next is in the ball; inside it the surface is as far away as the
    nearest of all planes.
    """
    ball, places, shape = ball_of_triangles(), random_places(seed), cutter_of(Tool(1, 3.0, kind))
    dense = np.stack(np.meshgrid(SIDE, SIDE), axis=-1).reshape(-1, 2)
    low = np.full(len(dense), np.inf)
    for a, b in zip(np.vstack([[*places[0, :2], 5.0], places[:-1]]), places, strict=True):
        for tip in a + np.linspace(0, 1, 150)[:, None] * (b - a):
            low = np.minimum(low, tip[2] + shape.heights(np.hypot(*(dense - tip[:2]).T)))
    dense, low = dense[low < 0], low[low < 0]
    normal = np.cross(ball[:, 1] - ball[:, 0], ball[:, 2] - ball[:, 0])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    heights = low[:, None] + np.linspace(0, 1, 80) * -low[:, None]
    columns = np.concatenate([np.repeat(dense[:, None], 80, axis=1), heights[..., None]], axis=2).reshape(-1, 3)
    return float(np.max(np.min(np.einsum("ij,ij->i", ball[:, 0], normal) - columns @ normal.T, axis=1)))


@pytest.mark.parametrize("cells", [40, 160])
@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in (1, 2, 3))])
@pytest.mark.parametrize("kind", [ToolKind.BALL, ToolKind.FLAT])
def test_the_depth_is_that_of_dense_columns_through_a_solid_with_undercut_faces(
    kind: ToolKind, seed: int, cells: int
) -> None:
    """A ball of 80 triangles, cut at random, also below its middle."""
    places = random_places(seed)
    moves = [f"G1 X{x:.4f} Y{y:.4f} Z{z:.4f} F300" for x, y, z in places.tolist()]
    x, y, _ = places[0].tolist()
    text = "\n".join(["G21 G90 G94 G17", "T1 M6", "G0 Z5", f"X{x:.4f} Y{y:.4f}", *moves, "G0 Z5", "M2", ""])
    stock, part = BoxStock(StockBox(0, 0, -16, 20, 20, 0)), SolidPart(SolidStock(ball_of_triangles()))
    judgement = cut(CutSetup((program(text),), {1: Tool(1, 3.0, kind)}, stock, part), CutOptions(cells)).judgement
    assert judgement is not None and judgement.certificate is not None
    deepest, apart = deepest_of_dense_columns(kind, seed), float(SIDE[1] - SIDE[0])
    assert deepest - 1e-3 <= judgement.gouge.max_mm <= max(deepest, 0.0) + apart
    assert judgement.gouge.max_mm <= judgement.certificate.gouge_mm


@pytest.mark.parametrize("turned", [False, True])
def test_the_side_that_two_bodies_touch_in_is_no_surface(turned: bool) -> None:
    """Of a hole in their seam, whose diagonals differ, no place is deeper than its floor: 5 mm below the top and above
    the underside.
    """
    from tests.simulation.test_target import box
    from tests.surfaces.test_winding import other_diagonal

    left, right = other_diagonal(box((0, 0, -10), (20, 30, 0)), 20.0), box((20, 0, -10), (40, 30, 0))
    solid = read_solid("a.stl", stl(np.concatenate([left, right[:, ::-1] if turned else right])))
    text = "\n".join(["G21 G90 G94 G17", "T1 M6", "G0 Z5", "X20 Y15", "G1 Z-5 F300", "G0 Z5", "M2", ""])
    setup = CutSetup((program(text),), {1: Tool(1, 6.0)}, BoxStock(StockBox(0, 0, -10, 40, 30, 0)), SolidPart(solid))
    judgement = cut(setup, CutOptions(128)).judgement
    assert solid.shells == 1 and judgement is not None and judgement.certificate is not None
    assert judgement.gouge.max_mm == pytest.approx(5.0, abs=1e-4)
    assert 5.0 - 1e-4 <= judgement.certificate.gouge_mm <= 5.5


@pytest.mark.parametrize("count", [0, 1, 800])
def test_places_are_told_apart_as_if_each_were_compared_with_all(count: int) -> None:
    places = np.random.default_rng(4).uniform(-9.0, 9.0, (count, 2))
    told: list[int] = []
    for k in range(count):
        if all(np.hypot(*(places[k] - places[other])) > APART for other in told):
            told.append(k)
    assert apart(places).tolist() == told
