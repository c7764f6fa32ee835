"""The command `cut` as its user sees it: what is removed, by closed forms; what is written; what is found."""

from __future__ import annotations

import json
import math
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import cv2
import numpy as np
import pytest
from scipy.integrate import quad

from app.cli.main import main
from app.simulation.heights_file import read_heights

ROOT = Path(__file__).resolve().parents[2]
SLOT = """\
G21 G90 G17 G54
T1 M6
G0 Z5
X10 Y10
G1 Z-2 F100
X40
G0 Z5
M2
"""
STOCK = "--stock=0,0,-10,50,20,0"
DEPTH, LENGTH = 2.0, 30.0


@pytest.fixture
def slot(tmp_path: Path) -> Path:
    path = tmp_path / "slot.ngc"
    path.write_text(SLOT)
    return path


def cut(*arguments: object) -> int:
    return main(["cut", *map(str, arguments)])


def solid(path: Path, bounds: list[list[float]]) -> Path:
    """Write a box as STL."""
    import trimesh

    trimesh.creation.box(bounds=bounds).export(path)
    return path


def report_of(tmp_path: Path, *arguments: object, status: int = 0) -> dict[str, Any]:
    path = tmp_path / "report.json"
    assert cut(*arguments, "--report", path, "--quiet") == status
    return dict(json.loads(path.read_text()))


def test_the_whole_command(slot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    files = {name: tmp_path / f"o.{name}" for name in ("npy", "png", "json")}
    arguments = ["--heights", tmp_path / "h.npy", "--image", files["png"], "--report", files["json"]]
    assert cut(slot, STOCK, "--tool", "1=flat:6", *arguments) == 0
    shown = capsys.readouterr()
    assert shown.err == ""
    assert "slot.ngc: 416." in shown.out
    assert (
        "mm3 removed; compared with no part (--against); 0 rapids in material, 1 stroke, 1 retract, 44 mm, 1:23 min\n"
        in shown.out
    )
    assert "  T1 flat 6 mm (--tool): 416." in shown.out
    data = json.loads(files["json"].read_text())
    keys = """gouge left rapids_in_material strokes retracts length_mm time_s moves skipped open_contours engine
    tolerance
        removed_mm3 worst bands certificate stock grid tools findings assumed"""
    assert set(keys.split()) <= set(data)
    assert (data["gouge"], data["left"], data["certificate"]) == (None, None, None)
    assert data["length_mm"] == {"cut": 37.0, "link": 0.0, "rapid": 7.0}
    assert data["moves"] == {"G0": 3, "G1": 2, "G2": 0, "G3": 0, "spline": 0}
    assert data["stock"] == {"low": [0, 0, -10], "high": [50, 20, 0], "from": "as given"}
    assert data["grid"] == {"x0": 0, "y0": 0, "pitch_mm": 50 / 1024, "rows": 410, "cols": 1024}
    assert data["programs"] == [
        {"file": "slot.ngc", "control": "linuxcnc", "block_delete": True, "lines": 8, "problems": []}
    ]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["h.json", "h.npy", "o.json", "o.png", "slot.ngc"]


def tapered(r: float) -> float:
    """Profile of a ball of 1 mm that goes over into a cone of 20 degrees."""
    half = math.radians(10)
    rim = 0.5 * math.cos(half)
    return 0.5 - math.sqrt(0.25 - r * r) if r < rim else 0.5 - 0.5 * math.sin(half) + (r - rim) / math.tan(half)


PROFILES: dict[str, Callable[[float], float]] = {
    "flat:6": lambda r: 0.0,
    "ball:6": lambda r: 3 - math.sqrt(9 - r * r),
    "bull:6:1": lambda r: 0.0 if r < 2 else 1 - math.sqrt(max(1 - (r - 2) ** 2, 0.0)),
    "v:6:60": lambda r: r / math.tan(math.radians(30)),
    "drill:6": lambda r: r / math.tan(math.radians(59)),
    "drill:6:118": lambda r: r / math.tan(math.radians(59)),
    "taper:1:20:6": tapered,
    "flat:1/4in": lambda r: 0.0,
    "BALL:6mm": lambda r: 3 - math.sqrt(9 - r * r),
}


@pytest.mark.parametrize("shape", PROFILES)
def test_a_slot_has_the_volume_of_its_closed_form(shape: str, slot: Path, tmp_path: Path) -> None:
    profile, radius = PROFILES[shape], 3.175 if "in" in shape else 3.0

    def depth(r: float) -> float:
        return max(DEPTH - profile(min(r, radius - 1e-12)), 0.0)

    across, ends = (
        2 * quad(depth, 0, radius, limit=200)[0],
        2 * math.pi * quad(lambda r: r * depth(r), 0, radius, limit=200)[0],
    )
    data = report_of(tmp_path, slot, STOCK, f"--tool=1={shape}")
    assert data["removed_mm3"] == pytest.approx(across * LENGTH + ends, rel=3e-3)
    (tool,) = data["tools"]
    assert tool["removed_mm3"] == pytest.approx(data["removed_mm3"], rel=1e-6)
    assert tool["kind"] == shape.split(":")[0].lower()


def test_heights_are_as_they_are_told_and_can_be_cut_again(slot: Path, tmp_path: Path) -> None:
    out = tmp_path / "h.npy"
    assert cut(slot, STOCK, "--tool=1=flat:6", "--heights", out, "--grid", "500", "--quiet") == 0
    heights, where = np.load(out), json.loads((tmp_path / "h.json").read_text())
    assert (heights.dtype, heights.shape) == (np.float32, (200, 500))
    assert where == {"x0": 0, "y0": 0, "pitch": 0.1, "floor": -10, "engine": "cpu"}
    assert heights[100, 250] == -2
    assert heights[131, 250] == 0
    assert heights[100, 65] == 0
    second = tmp_path / "second.ngc"
    second.write_text(SLOT.replace("Z-2", "Z-3"))
    again = report_of(tmp_path, second, "--stock", out, "--tool=1=flat:6", "--grid", "500")
    assert again["removed_mm3"] == pytest.approx((LENGTH * 6 + 9 * math.pi) * 1.0, rel=3e-3)
    part = report_of(tmp_path, second, "--stock", out, "--tool=1=flat:6", "--window", "20,0,30,20", "--grid", "400")
    assert part["removed_mm3"] == pytest.approx(10 * 6 * 1.0, rel=1e-2)
    assert read_heights("h", out.read_bytes(), (tmp_path / "h.json").read_bytes()).workpiece.floor == -10


def test_a_solid_as_stock(slot: Path, tmp_path: Path) -> None:
    data = report_of(
        tmp_path, slot, "--stock", solid(tmp_path / "low.stl", [[0, 0, -10], [50, 20, -1]]), "--tool=1=flat:6"
    )
    assert data["removed_mm3"] == pytest.approx((LENGTH * 6 + 9 * math.pi) * 1.0, rel=3e-3)
    assert data["stock"]["high"][2] == -1


def test_a_window_is_cut_as_finely(slot: Path, tmp_path: Path) -> None:
    data = report_of(tmp_path, slot, STOCK, "--tool=1=flat:6", "--window", "5,5,15,15", "--grid", "200")
    assert data["grid"] == {"x0": 5, "y0": 5, "pitch_mm": 0.05, "rows": 200, "cols": 200}
    assert data["removed_mm3"] == pytest.approx(2 * (5 * 6 + 4.5 * math.pi), rel=5e-3)


def test_tools_of_a_job_file(slot: Path, tmp_path: Path) -> None:
    job = tmp_path / "j.toml"
    job.write_text(
        '[[tool]]\nnumber = 1\ndiameter = 6\nkind = "v"\ntip_angle = 90\n[[operation]]\nkind = "pocket"\ntool = 1\n'
    )
    data = report_of(tmp_path, slot, STOCK, "--job", job)
    assert data["removed_mm3"] == pytest.approx(4 * LENGTH + math.pi * 8 / 3, rel=3e-3)
    assert (data["tools"][0]["from"], data["tools"][0]["tip_angle_deg"]) == ("the job file", pytest.approx(90))
    assert report_of(tmp_path, slot, STOCK, "--job", job, "--tool=1=flat:6")["tools"][0]["from"] == "--tool"
    job.write_text("[stock]\nthickness = 5\n")
    assert cut(slot, STOCK, "--job", job) == 2


def test_a_job_file_may_be_a_list_of_tools(slot: Path, tmp_path: Path) -> None:
    job = tmp_path / "tools.toml"
    job.write_text("[[tool]]\nnumber = 1\ndiameter = 6\n[[tool]]\nnumber = 7\ndiameter = 3\n")
    assert report_of(tmp_path, slot, STOCK, "--job", job)["tools"][0]["from"] == "the job file"


def test_tools_and_their_lengths_of_a_tool_table(slot: Path, tmp_path: Path) -> None:
    table, library = tmp_path / "t.tbl", tmp_path / "t.toml"
    table.write_text("T1 P1 Z0.5 D0.25\nT2 P2 Z1\n")
    slot.write_text(SLOT.replace("G0 Z5\nX10", "G43\nG0 Z5\nX10"))
    data = report_of(tmp_path, slot, STOCK, "--tools", table, "--tool-units", "in")
    assert (data["tools"][0]["from"], data["tools"][0]["diameter_mm"]) == ("t.tbl", pytest.approx(6.35))
    assert data["removed_mm3"] == pytest.approx(2 * (LENGTH * 6.35 + math.pi * 6.35**2 / 4), rel=3e-3)
    assert data["assumed"] == ["T1: t.tbl tells no shapes, so it is taken to be flat, 6.35 mm; --tool says otherwise."]
    assert report_of(tmp_path, slot, STOCK, "--tools", table, "--tool-units", "in", "--tool=1=ball:6")["assumed"] == []
    library.write_text('format = 1\n[[tool]]\nnumber = 1\ndiameter = 6.0\nkind = "ball"\n')
    made = report_of(tmp_path, slot, STOCK, "--tools", library)
    assert (made["tools"][0]["kind"], made["tools"][0]["from"], made["assumed"]) == ("ball", "t.toml", [])


def test_the_picture_is_one(slot: Path, tmp_path: Path) -> None:
    assert cut(slot, STOCK, "--tool=1=flat:6", "--image", tmp_path / "o.png", "--quiet") == 0
    picture = cv2.imread(str(tmp_path / "o.png"))
    assert picture.shape[0] > 410
    assert picture.shape[1] > 1024


def test_a_rapid_through_metal_and_a_start_in_it_are_found(
    slot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    slot.write_text(SLOT.replace("X40\n", "X40\nG0 Y2\n"))
    data = report_of(tmp_path, slot, STOCK, "--tool=1=flat:6", status=1)
    hit, out_of_it = data["rapids_in_material"]
    assert (hit["line"], hit["z"], out_of_it["line"]) == (7, -2, 8)
    assert hit["depth_mm"] == pytest.approx(2.0)
    assert hit["cells"] > 100
    assert cut(slot, STOCK, "--tool=1=flat:6") == 1
    assert "  ! A rapid goes through metal, 2.000 mm deep at (" in capsys.readouterr().out


def test_several_programs_are_cut_one_after_the_other(slot: Path, tmp_path: Path) -> None:
    other = tmp_path / "deeper.ngc"
    other.write_text(SLOT.replace("T1", "T2").replace("Z-2", "Z-3").replace("X40\n", "X40\nG0 Y2\n"))
    data = report_of(tmp_path, slot, STOCK, "--tool=1=flat:6", other, "--tool", "2=flat:2", status=1)
    first, second = data["tools"]
    assert first["removed_mm3"] == pytest.approx(2 * (LENGTH * 6 + 9 * math.pi), rel=3e-3)
    assert second["removed_mm3"] == pytest.approx(LENGTH * 2 + math.pi, rel=1e-2)
    assert (data["strokes"], data["moves"]["G0"]) == (2, 7)
    assert [(hit["file"], hit["line"]) for hit in data["rapids_in_material"]] == [("deeper.ngc", 7), ("deeper.ngc", 8)]
    assert data["time_s"] == pytest.approx(first["time_s"] + second["time_s"])


def test_a_program_that_cannot_be_read_to_its_end(slot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    slot.write_text(SLOT.replace("X40", "X[4"))
    assert cut(slot, STOCK, "--tool=1=flat:6") == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("hitofude: slot.ngc:6:")
    assert shown.err.count("\n") == 1


def test_warnings_are_remarks(slot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    slot.write_text(SLOT.replace("M2\n", ""))
    assert cut(slot, STOCK, "--tool=1=flat:6") == 0
    assert "  - slot.ngc:7: the program has no end" in capsys.readouterr().out


def test_an_axis_that_is_not_followed_is_a_finding(
    slot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    slot.write_text(SLOT.replace("X40", "X40 A90"))
    assert cut(slot, STOCK, "--tool=1=flat:6") == 1
    assert "! slot.ngc:6" in (shown := capsys.readouterr().out) and "axis A is not followed" in shown


def test_a_program_that_begins_in_g91_is_cut_from_zero(slot: Path, tmp_path: Path) -> None:
    """As LinuxCNC moves it: plunge at the zero, then a slot along X."""
    slot.write_text("G91 G21 G17\nT1 M6\nG1 Z-2 F100\nX30\nG0 Z7\nM2\n")
    report = report_of(tmp_path, slot, "--stock=-10,-10,-10,50,20,0", "--tool=1=flat:6")
    assert report["removed_mm3"] == pytest.approx(DEPTH * (6 * LENGTH + math.pi * 9), rel=1e-2)
    assert report["length_mm"]["cut"] == 32.0


def test_the_control_and_slashed_blocks_are_as_asked(slot: Path, tmp_path: Path) -> None:
    slot.write_text(SLOT.replace("X40", "/X40"))
    common = (STOCK, "--tool=1=flat:6")
    assert report_of(tmp_path, slot, *common)["length_mm"]["cut"] == 7.0
    assert report_of(tmp_path, slot, *common, "--block-delete", "off")["length_mm"]["cut"] == 37.0
    assert report_of(tmp_path, slot, *common, "--dialect", "mach3")["programs"][0]["control"] == "mach3"


@pytest.mark.parametrize("engine", ["auto", "cpu"])
def test_the_engine_of_record(engine: str, slot: Path, tmp_path: Path) -> None:
    data = report_of(tmp_path, slot, STOCK, "--tool=1=flat:6", "--engine", engine)
    assert data["engine"].startswith("cpu: ") and data["apart_from_cpu"] is None
    assert data["tolerance"]["heights_mm"] == 5e-6


def test_the_graphics_system_computes_the_heights_that_are_written(slot: Path, tmp_path: Path) -> None:
    """On whatever OpenGL there is, software as well, as it was asked for."""
    common = (slot, STOCK, "--tool=1=ball:6", "--quiet", "--grid=500")
    assert cut(*common, "--engine=cpu", "--heights", tmp_path / "cpu.npy") == 0
    assert cut(*common, "--engine=gpu", "--heights", tmp_path / "gpu.npy", "--report", tmp_path / "gpu.json2") == 0
    data, where = json.loads((tmp_path / "gpu.json2").read_text()), json.loads((tmp_path / "gpu.json").read_text())
    assert data["engine"].startswith("gpu: ") and "by the cpu: which motion cut each cell" in data["engine"]
    assert where["engine"] == "gpu"
    assert data["apart_from_cpu"]["largest_mm"] < 1e-4 and data["apart_from_cpu"]["cells"] == 0
    assert data["tolerance"]["heights_mm"] == 1e-4
    assert [each["kind"] for each in data["findings"]] == ["spindle"] and data["assumed"] == []
    heights = [np.load(tmp_path / f"{name}.npy") for name in ("cpu", "gpu")]
    assert np.abs(np.subtract(*heights)).max() < 1e-4
    assert data["tools"][0]["removed_mm3"] == pytest.approx(data["removed_mm3"], rel=1e-5)


def test_the_published_method_states_its_error(slot: Path, tmp_path: Path) -> None:
    data = report_of(tmp_path, slot, STOCK, "--tool=1=ball:6", "--engine=patent", "--grid=500")
    assert data["engine"].startswith("patent: ")
    facet = 2 * 0.1
    assert 0.8 * facet**2 / 24 <= data["tolerance"]["heights_mm"] <= facet**2 / 24
    assert data["apart_from_cpu"]["largest_mm"] > 1e-4 and data["apart_from_cpu"]["cells"] > 1000
    assert data["removed_mm3"] == pytest.approx(data["tools"][0]["removed_mm3"], rel=0.01)


@pytest.mark.exhaustive
def test_more_cells_than_memory_holds_are_told_before(slot: Path, tmp_path: Path) -> None:
    """In processes of their own: what another command has left in memory would count as the job's."""
    part = solid(tmp_path / "part.stl", [[0, 0, -10], [50, 20, -1]])
    options = ["--stock=0,0,-10,50,50,0", "--tool=1=flat:6", "--against", str(part), "--memory=50M", "--quiet"]
    command = [sys.executable, "-P", "-m", "app", "cut", str(slot), *options]
    refused = subprocess.run([*command, "--grid=2000"], capture_output=True, text=True, cwd=ROOT, check=False)
    assert refused.returncode == 2
    told = re.fullmatch(
        r"hitofude: A grid of 2000 x 2000 cells would take \d+ MB of memory, and [45]\d(\.\d)? MB may be taken; use at "
        r"most (\d+) cells along its longer side \(--grid \2\), or allow more with --memory \S+\.\n",
        refused.stderr,
    )
    assert told is not None, refused.stderr
    assert subprocess.run([*command, f"--grid={told[2]}"], cwd=ROOT, check=False).returncode in (0, 1)


def test_no_window_library_is_needed(slot: Path, tmp_path: Path) -> None:
    code = (
        "import sys; from app.cli.main import main; assert main(sys.argv[1:]) == 0; print([name for name in "
        "sys.modules if name.split('.')[0] in ('PySide6', 'pyqtgraph', 'moderngl') or '.ui' in name])"
    )
    options = ["--tool=1=flat:6", "--engine=cpu", "--quiet", "--image", str(tmp_path / "o.png")]
    command = [sys.executable, "-c", code, "cut", str(slot), STOCK, *options]
    done = subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=True)
    assert done.stdout.strip() == "[]"


def test_ctrl_c_is_130_and_leaves_old_files(slot: Path, tmp_path: Path) -> None:
    out = tmp_path / "o.json"
    out.write_text("old")
    slot.write_text(SLOT.replace("X40\n", "".join(f"X{10 + k % 31} Y{10 + k % 7}\n" for k in range(400_000))))
    command = [
        sys.executable,
        "-m",
        "app",
        "cut",
        str(slot),
        STOCK,
        "--tool=1=ball:6",
        "--report",
        str(out),
        "--grid",
        "4096",
    ]
    running = subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    while "libllvmlite" not in Path(f"/proc/{running.pid}/maps").read_text() and running.poll() is None:
        os.sched_yield()
    running.send_signal(signal.SIGINT)
    _, told = running.communicate(timeout=60)
    assert (running.returncode, told) == (130, "hitofude: cancelled; no file was written\n")
    assert out.read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["o.json", "slot.ngc"]
