"""Grids, boxes, solids and earlier heights; cutters from tools."""

import io
import math

import numpy as np
import pytest
import trimesh

from app.core.errors import InputError, ParameterError
from app.core.memory import MemoryShortError, within
from app.model.motion import Floats
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.simulation.cutter import Cutter, cutter_of
from app.simulation.field import workpiece
from app.simulation.field.solid import SolidStock, read_solid
from app.simulation.field.workpiece import BoxStock, Grid, HeightStock, ensure_memory
from app.simulation.heights_file import heights_files, read_heights
from tests.simulation.courses import CUTTERS


def test_cells_are_square_and_cover_the_box() -> None:
    grid = Grid.over((-5, 2, 15, 12), 40)
    assert (grid.pitch, grid.rows, grid.cols) == (0.5, 20, 40)
    assert grid.box == (-5, 2, 15, 12)
    assert (grid.xs()[0], grid.ys()[-1]) == (-4.75, 11.75)
    assert grid.place(40 * 3 + 2) == (-3.75, 3.75)
    uneven = Grid.over((0, 0, 3, 10), 33)
    assert uneven.rows == 33 and uneven.cols == 10 and uneven.box[2] >= 3 - 1e-9


NO_GRIDS = [
    ((0, 0, 0, 5), 10, "empty"),
    ((3, 0, 1, 5), 10, "empty"),
    ((0, 0, 1, 1), 0, "1 to 30000"),
    ((0, 0, 1, 1), 40_000, "1 to 30000"),
    ((0, 0, math.nan, 1), 10, "empty"),
]


@pytest.mark.parametrize(("box", "cells", "said"), NO_GRIDS)
def test_grids_that_are_none(box: tuple[float, float, float, float], cells: int, said: str) -> None:
    with pytest.raises(ParameterError, match=said):
        Grid.over(box, cells)


def test_cells_beside_a_box_have_no_metal() -> None:
    piece = BoxStock(StockBox(0, 0, -3, 4, 2)).over(Grid(-1, -1, 1, 4, 6))
    assert np.array_equal(piece.heights == 0, np.pad(np.ones((2, 4), bool), 1))
    assert piece.floor == -3 and piece.heights.min() == -3
    with pytest.raises(ParameterError, match="longer than 0"):
        BoxStock(StockBox(0, 0, 0, 4, 2))


def test_what_does_not_fit_into_memory_is_told_before() -> None:
    with (
        within(4_000_000),
        pytest.raises(MemoryShortError, match=r"2000 x 2000 cells would take 16 MB of memory.*--grid (\d+)") as told,
    ):
        BoxStock(StockBox(0, 0, -1, 1, 1)).over(Grid.over((0, 0, 1, 1), 2000))
    fits = int(str(told.value).rpartition("--grid ")[2].split(")")[0])
    assert 800 <= fits <= 1000  # 1000 x 1000 cells of 4 bytes are 4 MB
    with within(40_000_000):
        ensure_memory(Grid.over((0, 0, 1, 1), 2000), 4)


def test_heights_on_another_grid_are_those_of_the_cell_beneath() -> None:
    old = BoxStock(StockBox(0, 0, -3, 4, 4)).over(Grid(0, 0, 1, 4, 4))
    heights = np.arange(16, dtype=np.float32).reshape(4, 4)
    stock = HeightStock(workpiece.Workpiece(old.grid, heights, -3.0))
    fine = stock.over(Grid(1, 1, 0.5, 6, 8))
    assert np.array_equal(fine.heights[:, :6], np.kron(heights[1:4, 1:4], np.ones((2, 2))))
    assert np.all(fine.heights[:, 6:] == -3)


def top(triangles: Floats, x: float, y: float) -> float:
    """The highest place of triangles over a point, by barycentric coordinates of each."""
    first, edges = triangles[:, 0], triangles[:, 1:] - triangles[:, :1]
    level = np.abs(np.linalg.det(edges[:, :, :2])) > 1e-12
    sides = np.swapaxes(edges[level, :, :2], 1, 2)
    shares = np.linalg.solve(sides, (np.array([x, y]) - first[level][:, :2])[..., None])[..., 0]
    within = (shares >= 0).all(axis=1) & (shares.sum(axis=1) <= 1)
    return float((first[level][within, 2] + (shares[within] * edges[level][within, :, 2]).sum(axis=1)).max())


def test_a_ball_of_triangles_has_its_top() -> None:
    ball = trimesh.creation.icosphere(subdivisions=4, radius=5.0)
    solid = read_solid("ball.stl", ball.export(file_type="stl"))
    grid = Grid.over(solid.box, 200)
    piece = solid.over(grid)
    x, y = np.meshgrid(grid.xs(), grid.ys())
    inside = np.hypot(x, y) < 4.5
    assert np.abs(piece.heights - np.sqrt(np.maximum(25 - x**2 - y**2, 0)))[inside].max() < 0.03
    for row, col in np.argwhere(inside)[::397]:
        assert piece.heights[row, col] == pytest.approx(top(ball.triangles, grid.xs()[col], grid.ys()[row]), abs=1e-6)
    assert piece.hidden == 0 and piece.floor == pytest.approx(-5)


def test_triangles_whose_edges_run_through_cells_leave_no_gap() -> None:
    """The centres of cells lie on edges and corners of this box's triangles."""
    box = trimesh.creation.box(bounds=[[-2, -2, -1], [2, 2, 0]]).subdivide().subdivide()
    piece = SolidStock(np.array(box.triangles)).over(Grid(-2.5, -2.5, 0.5, 10, 10))
    assert piece.heights[1:9, 1:9].tolist() == np.zeros((8, 8)).tolist()
    assert piece.hidden == 0


def test_a_hollow_is_counted_and_its_top_kept() -> None:
    parts = ([[0, 0, 0], [4, 4, 1]], [[0, 0, 3], [2, 4, 5]])
    table = trimesh.util.concatenate([trimesh.creation.box(bounds=part) for part in parts])
    piece = SolidStock(np.array(table.triangles)).over(Grid(0, 0, 0.4, 10, 10))
    assert piece.hidden == 50
    assert np.array_equal(piece.heights, np.tile([5.0] * 5 + [1.0] * 5, (10, 1)))


@pytest.mark.parametrize(("data", "said"), [(b"", "STL"), (b"solid x\nendsolid x\n", "STL"), (b"\x00" * 100, "STL")])
def test_files_that_hold_no_solid(data: bytes, said: str) -> None:
    with pytest.raises(InputError, match=said):
        read_solid("part.stl", data)


@pytest.mark.parametrize("name", ["Gehäuse".encode("latin-1"), "Gehäuse".encode(), bytes(range(128, 256)), b""])
def test_a_solid_in_letters_may_have_any_name(name: bytes) -> None:
    text = trimesh.creation.box(extents=(4, 6, 8)).export(file_type="stl_ascii").split("\n", 1)[1].encode("ascii")
    low, high = (
        getattr(read_solid("s.stl", b"solid " + name + b"\r\n" + text).triangles, side)(axis=(0, 1))
        for side in ("min", "max")
    )
    assert (low.tolist(), high.tolist()) == ([-2, -3, -4], [2, 3, 4])


def test_what_is_no_solid_is_told_without_the_innards_of_a_library() -> None:
    with pytest.raises(InputError) as told:
        read_solid("s.stl", bytes(range(256)) * 12)
    assert str(told.value) == "s.stl: this is no STL file, or it is damaged; export the solid again, as binary STL."


def test_an_open_surface_is_no_solid() -> None:
    mesh = trimesh.creation.box()
    mesh.update_faces(np.arange(len(mesh.faces)) > 1)
    out = io.BytesIO(mesh.export(file_type="stl"))
    with pytest.raises(InputError, match=r"part\.stl.*not closed"):
        read_solid("part.stl", out.getvalue())


def test_profiles() -> None:
    radii = np.array([0.0, 1.0, 2.5, 3.0, 3.0001])
    assert CUTTERS["ball"].heights(radii).tolist() == pytest.approx([0, 3 - 8**0.5, 3 - 2.75**0.5, 3, math.inf])
    assert CUTTERS["flat"].heights(radii).tolist() == [0, 0, 0, 0, math.inf]
    assert CUTTERS["bull"].heights(radii).tolist() == pytest.approx([0, 0, 1 - 0.75**0.5, 1, math.inf])
    assert CUTTERS["v"].heights(radii).tolist() == pytest.approx([0, 1, 2.5, 3, math.inf])
    assert CUTTERS["blunt v"].heights(radii).tolist() == pytest.approx(
        [0, 3**0.5 / 2, 2 * 3**0.5, 2.5 * 3**0.5, math.inf]
    )


def test_a_tapered_mill_is_smooth_where_ball_and_cone_meet() -> None:
    cutter = CUTTERS["taper"]
    rim = cutter.rim_of_fillet
    assert rim == pytest.approx(math.cos(math.radians(15)))
    below, at, above = cutter.heights(np.array([rim - 1e-6, rim, rim + 1e-6]))
    assert (at - below) / 1e-6 == pytest.approx((above - at) / 1e-6, rel=1e-4) == pytest.approx(cutter.slope, rel=1e-4)


def test_drills_have_the_usual_angle_and_others_must_tell_theirs() -> None:
    assert cutter_of(Tool(1, 6.0, ToolKind.DRILL)).slope == pytest.approx(1 / math.tan(math.radians(59)))
    for kind in (ToolKind.V, ToolKind.TAPER):
        with pytest.raises(ParameterError, match=r"T7.*full angle.*1 to 179"):
            cutter_of(Tool(7, 6.0, kind))


def test_who_cuts_at_the_centre() -> None:
    assert all(cutter.centre_cutting for cutter in CUTTERS.values())
    assert not cutter_of(Tool(1, 6.0, flutes=4)).centre_cutting


@pytest.mark.parametrize(
    "numbers", [(0.0, 0.0, 0.0), (3.0, 4.0, 0.0), (3.0, 2.0, 2.0), (3.0, 1.0, 1.0), (math.nan, 0.0, 0.0)]
)
def test_numbers_that_make_no_cutter(numbers: tuple[float, float, float]) -> None:
    with pytest.raises(ParameterError, match=r"cutter|corner"):
        Cutter(*numbers)


def test_heights_come_back_from_their_files() -> None:
    piece = workpiece.Workpiece(
        Grid(-1.5, 2.25, 0.1, 3, 5), np.linspace(-2, 0, 15, dtype=np.float32).reshape(3, 5), -7.0
    )
    again = read_heights("left.npy", *heights_files(piece)).workpiece
    assert (again.grid, again.floor) == (piece.grid, piece.floor)
    assert np.array_equal(again.heights, piece.heights)


GOOD = heights_files(workpiece.Workpiece(Grid(0, 0, 1, 2, 2), np.zeros((2, 2), np.float32), -1.0))


BAD = [
    (b"", GOOD[1]),
    (GOOD[0], b"{}"),
    (GOOD[0], b"[1]"),
    (GOOD[0], b"no"),
    (GOOD[0][:-3], GOOD[1]),
    (GOOD[0], b'{"x0": 0, "y0": 0, "pitch": -1}'),
]


@pytest.mark.parametrize(("heights", "where"), BAD)
def test_files_that_hold_no_heights(heights: bytes, where: bytes) -> None:
    with pytest.raises(InputError, match=r"left\.npy.*--heights"):
        read_heights("left.npy", heights, where)


def test_metal_over_another_grid_is_that_of_the_cell_where_each_centre_lies() -> None:
    old = Grid(-3.0, 2.0, 0.5, 8, 12)
    rows, cols = np.indices((old.rows, old.cols))
    heights = (-0.1 * rows - 0.01 * cols).astype(np.float32)
    stock = HeightStock(workpiece.Workpiece(old, heights, -9.0))
    grid = Grid(-3.6, 1.3, 0.2, 30, 40)
    found = stock.over(grid)
    x, y = np.meshgrid(grid.xs(), grid.ys())
    col, row = np.floor((x + 3.0) / 0.5), np.floor((y - 2.0) / 0.5)
    within = (col >= 0) & (col < 12) & (row >= 0) & (row < 8)
    assert 100 < np.count_nonzero(within) < found.heights.size
    assert found.heights == pytest.approx(np.where(within, -0.1 * row - 0.01 * col, -9.0), abs=1e-6)
