"""`cut --tiles`: the heights of the whole, bit for bit, from tiles that separate processes cut."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from app.cli.cut_request import examined_programs, setup_request
from app.cli.main import main
from app.cli.program import load_command
from app.core.progress import NO_PROGRESS
from app.core.resources import resource
from app.simulation.field.workpiece import Grid
from app.simulation.heights_file import read_heights
from app.usecases.batch.cut_tiles import heights_on, tiled_grid, tiles_of
from app.usecases.cutting.ready_setup import setup_of
from app.usecases.cutting.setup import CutSetup

PLATE = (
    "G21 G90 G94\nT1 M6\nS9000 M3\nG0 X-5 Y3 Z5\nG1 Z-1.3 F100\nG1 X33.3 Y17.7 F300\nG3 X10 Y24 R15\n"
    "G2 X3 Y8 Z-2.1 R12\nG0 Z5\nM30\n"
)


def setup(*arguments: str) -> CutSetup:
    read = load_command("cut").arguments(list(arguments))
    return setup_of(examined_programs(read, NO_PROGRESS), setup_request(read), NO_PROGRESS).setup


def test_places_of_cells_are_the_same_from_any_tile() -> None:
    grid = tiled_grid((-13.7, 0.1, 86.21, 77.7), 5000)
    xs, ys = grid.xs(), grid.ys()
    assert grid.box[0] <= -13.7 and grid.box[2] >= 86.21 and grid.box[1] <= 0.1 and grid.box[3] >= 77.7
    assert grid.pitch == pytest.approx(99.91 / 5000, rel=2e-6) and 5000 <= grid.cols <= 5001
    seen = np.zeros((grid.rows, grid.cols), np.int8)
    for tile in tiles_of(grid, 1024):
        rows, cols = (
            slice(at, at + n) for at, n in ((tile.first_row, tile.grid.rows), (tile.first_col, tile.grid.cols))
        )
        assert np.array_equal(tile.grid.xs(), xs[cols]) and np.array_equal(tile.grid.ys(), ys[rows])
        seen[rows, cols] += 1
    assert np.all(seen == 1)
    plain = Grid(-13.7, 0.1, 99.91 / 5000, 4000, 5000)  # why it takes a grid of its own
    apart = Grid(plain.x0 + 1024 * plain.pitch, plain.y0, plain.pitch, 1024, 1024)
    assert not np.array_equal(apart.xs(), plain.xs()[1024:2048])


@pytest.mark.parametrize("name", ["plate", "raster"])
def test_tiles_are_the_whole_bit_for_bit(name: str, tmp_path: Path) -> None:
    program, tool = (tmp_path / "plate.nc", "1=flat:6") if name == "plate" else (resource("samples", "raster.ngc"), "")
    if tool:
        program.write_text(PLATE)
    made = setup(str(program), *(["--tool", tool, "--stock=0,0,-5,40,30,0"] if tool else []))
    grid = tiled_grid(made.stock.box, 700)
    whole, out = heights_on(made, grid), np.empty((grid.rows, grid.cols), np.float32)
    for tile in tiles_of(grid, 256):
        place = slice(tile.first_row, tile.first_row + tile.grid.rows), slice(tile.first_col, tile.first_col + 256)
        out[place] = heights_on(made, tile.grid)
    assert np.array_equal(out, whole) and np.ptp(whole) > 1


def test_processes_write_one_file_that_the_next_set_up_reads(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("app.cli.cut_tiles.tiles_of", lambda grid: tiles_of(grid, 512))
    program, out = tmp_path / "plate.nc", tmp_path / "left.npy"
    program.write_text(PLATE)
    command = ["cut", str(program), "--tool", "1=flat:6", "--stock=0,0,-5,40,30,0", "--heights", str(out)]
    assert main([*command, "--tiles", "--jobs", "2", "--grid", "700"]) == 0
    assert "in 4 tiles, -2.1000 to 0.0000 mm; nothing was judged" in capsys.readouterr().out
    stock = read_heights("left", out.read_bytes(), out.with_suffix(".json").read_bytes())
    made = setup(*command[1:-2])
    grid = tiled_grid(made.stock.box, 700)
    assert np.array_equal(np.load(out), heights_on(made, grid)) and stock.over(grid).grid == grid
    assert json.loads(out.with_suffix(".json").read_text())["floor"] == -5.0
    assert {path.name for path in tmp_path.iterdir()} == {"plate.nc", "left.npy", "left.json"}


@pytest.mark.exhaustive
def test_two_workers_of_a_cluster_cut_the_same_tiles(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Each worker may have 2 GB: the tiles lie bit for bit where one process puts them in the whole."""
    distributed = pytest.importorskip("distributed", reason="Dask is not installed here; the extra `test` brings it")
    monkeypatch.setattr("app.cli.cut_tiles.tiles_of", lambda grid: tiles_of(grid, 512))
    program, out = tmp_path / "plate.nc", tmp_path / "left.npy"
    program.write_text(PLATE)
    command = ["cut", str(program), "--tool", "1=flat:6", "--stock=0,0,-5,40,30,0", "--heights", str(out)]
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, memory_limit="2GB", dashboard_address=None
    ) as cluster:
        assert main([*command, "--tiles", "--grid", "1500", "--scheduler", cluster.scheduler_address]) == 0
    made = setup(*command[1:-2])
    assert np.array_equal(np.load(out), heights_on(made, tiled_grid(made.stock.box, 1500)))


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--tiles"], "--tiles writes heights; add --heights OUT.npy"),
        (["--tiles", "--heights", "a.npy", "--image", "a.png"], "--image does not go with --tiles"),
        (["--tiles", "--heights", "a.npy", "--engine", "patent"], "--engine does not go with --tiles"),
        (["--jobs", "2"], "--jobs has no effect without --tiles"),
        (["--scheduler", "tcp://x:1"], "--scheduler has no effect without --tiles"),
    ],
)
def test_what_does_not_go_with_tiles_is_one_line(
    arguments: list[str], told: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "plate.nc").write_text(PLATE)
    assert main(["cut", "plate.nc", "--tool", "1=flat:6", *arguments]) == 2
    shown = capsys.readouterr().err
    assert told in shown and shown.count("\n") == 1
