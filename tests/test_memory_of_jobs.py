"""What jobs take is what was asked for, within a factor of two; a budget is kept; what does not fit is refused before
it is taken.
"""

from __future__ import annotations

import json
import re
import subprocess
import sys
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.cli.main import main
from app.core.memory import MemoryShortError, read_size, resident, within
from app.gcode.interpreter.reader import read_program
from tests.conftest import ROOT

pytestmark = pytest.mark.skipif(not resident(), reason="this system does not tell what a process holds")

FIG2 = str(ROOT / "resources" / "samples" / "fig2.dxf")
LARGE = "rect 0,0 100,100\ncircle 50,50 6\n"
TOOLS = ("--contour-tool=6", "--pocket-tool=6")


def child(*commands: list[str]) -> dict[str, float]:
    """Run commands one after the other in a process of their own; return what the last one took."""
    done = subprocess.run(
        [sys.executable, "-m", "tests.memory_child", json.dumps(commands)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
    )
    told: dict[str, float] = json.loads(done.stdout.splitlines()[-1])
    return told


def refused(command: list[str], capsys: pytest.CaptureFixture[str]) -> str:
    """Return the one line in which a command is refused that may take next to nothing."""
    capsys.readouterr()
    assert main([*command, "--memory=1M"]) == 2
    said = capsys.readouterr().err
    assert said.startswith("hitofude: ") and said.count("\n") == 1
    return said


def asked(said: str) -> float:
    """Return the bytes that a refusal names."""
    found = re.search(r"would take (\S+ [MGT]B) of memory, and \S+ MB may be taken; (use|make|set|cut) ", said)
    assert found is not None, said
    return read_size(found[1])


@pytest.fixture(scope="module")
def program(tmp_path_factory: pytest.TempPathFactory) -> str:
    """A program of fig2, its stock and tools in its comments."""
    path = tmp_path_factory.mktemp("program") / "a.ngc"
    assert main(["make", FIG2, "-o", str(path), "--quiet"]) == 0
    return str(path)


@pytest.mark.exhaustive
@pytest.mark.parametrize("options", [[], ["--against", FIG2]], ids=["alone", "against"])
def test_what_a_cut_asks_for_is_what_it_takes(
    program: str, options: list[str], capsys: pytest.CaptureFixture[str]
) -> None:
    def command(cells: int) -> list[str]:
        return ["cut", program, *options, f"--grid={cells}", "--quiet", "--engine=cpu"]

    wanted = asked(refused(command(4000), capsys))
    assert wanted / 2 <= child(command(200), command(4000))["grown"] <= wanted


@pytest.mark.exhaustive
@pytest.mark.parametrize(("name", "size"), [("make", 3000), ("stages", 1500)])
def test_what_a_bitmap_asks_for_is_what_it_takes(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str, size: int
) -> None:
    drawing = tmp_path / "a.draw"
    drawing.write_text(LARGE)

    def command(pixels: int, out: str) -> list[str]:
        return [name, str(drawing), *TOOLS, f"--bitmap={pixels}", "-o", str(tmp_path / out), "--quiet"]

    if name == "stages":
        said = ""
        assert main([*command(size, "x"), "--memory=120M"]) == 2  # paths fit, stages do not
        said = capsys.readouterr().err
    else:
        said = refused(command(size, "x"), capsys)
    assert not (tmp_path / "x").exists()
    found = re.search(r"would take (\S+ [MGT]B)", said)
    assert found is not None, said
    wanted = read_size(found[1])
    # 1.3: stages hold the paths as well
    assert wanted / 2 <= child(command(150, "a"), command(size, "b"))["grown"] <= 1.3 * wanted


def test_a_program_of_many_lines_asks_before_it_is_read() -> None:
    text = b"G1 X1 Y2 F100\n" * 100_000
    with (
        within(10_000_000),
        pytest.raises(MemoryShortError, match=r"program of 100,001 lines would take 40 MB.*at most \d+ lines"),
    ):
        read_program(text)


@pytest.mark.exhaustive
def test_what_reading_a_program_asks_for_is_what_it_takes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "a.ngc"
    rows = (f"G1 X{20 + 15 * np.cos(k / 500):.4f} Y{20 + 15 * np.sin(k / 700):.4f}\n" for k in range(400_000))
    path.write_text("G21 G90\nF300\n" + "".join(rows) + "M2\n")
    short = tmp_path / "b.ngc"
    short.write_text("G21 G90\nF300\nG1 X1\nM2\n")
    wanted = asked(refused(["check", str(path)], capsys))
    assert wanted / 2 <= child(["check", str(short)], ["check", str(path)])["grown"] <= 1.1 * wanted


def test_a_picture_is_measured_by_its_header(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    cv2.imwrite(str(tmp_path / "a.png"), np.full((3000, 4000), 255, np.uint8))
    said = refused(["make", str(tmp_path / "a.png"), "--pitch=0.01", "-o", str(tmp_path / "a.ngc")], capsys)
    assert asked(said) == pytest.approx(4000 * 3000 * 26, rel=0.01)
    assert "a.png, a picture of 4000 x 3000 px, would take" in said and "px along its longer side" in said


@pytest.mark.exhaustive
def test_the_grid_that_is_told_stays_within_the_budget(program: str, capsys: pytest.CaptureFixture[str]) -> None:
    command = ["cut", program, "--against", FIG2, "--quiet", "--engine=cpu", "--memory=150M"]
    assert main([*command, "--grid=20000"]) == 2
    found = re.search(r"--grid (\d+)\)", capsys.readouterr().err)
    assert found is not None
    told = child(["cut", program, "--grid=100", "--quiet"], [*command, f"--grid={found[1]}"])
    assert told["status"] in (0, 1)
    assert told["grown"] <= 150e6


def test_more_planes_than_memory_holds_are_refused_while_they_are_followed(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    scene = tmp_path / "a.toml"
    scene.write_text("""
name = "a"
units = "mm"
[stock]
box = [0, 0, -9, 50, 50, 8]
[[tool]]
number = 1
diameter = 6.0
kind = "ball"
[[surface]]
name = "a"
[surface.shape]
kind = "sphere"
centre = [25, 25, -4]
radius = 10
[[passes]]
tool = 1
pitch = 0.001
""")
    assert main(["surface", str(scene), "-o", str(tmp_path / "a.ngc"), "--memory=60M", "--quiet"]) == 2
    said = capsys.readouterr().err
    assert re.search(
        r"Passes on [\d,]+ planes would take .*set them 0\.\d+ mm apart or more \(pitch = 0\.\d+ in the scene\)", said
    )
    assert said.count("\n") == 1 and not (tmp_path / "a.ngc").exists()


def test_a_pocket_of_more_rings_than_memory_holds_is_refused_before_they_are_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawing = tmp_path / "a.draw"
    drawing.write_text("rect 0,0 20000,20000\n")
    command = ["make", str(drawing), "--pocket-tool=0.05", "-o", str(tmp_path / "a.ngc"), "--quiet", "--memory=60M"]
    assert main(command) == 2
    said = capsys.readouterr().err
    assert re.search(r"A pocket of [\d,]+ rings, 0\.04 mm from one to the next, would take \S+ [MG]B of memory", said)
    assert said.count("\n") == 1 and not (tmp_path / "a.ngc").exists()


def test_rest_machining_with_a_needle_is_refused_before_its_cells_are_made(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    drawing = tmp_path / "a.draw"
    drawing.write_text("rect 0,0 20,12\n")
    command = ["make", str(drawing), "--pocket-tool=6", "--contour-tool=0.02", "-o", str(tmp_path / "a.ngc"), "--quiet"]
    assert main([*command, "--memory=50M"]) == 2
    said = capsys.readouterr().err
    assert re.search(
        r"Clearing what is left with a tool of 0\.02 mm would take \S+ [MG]B of memory.*\(--contour-tool 0\.\d+\)", said
    )
    assert said.count("\n") == 1 and not (tmp_path / "a.ngc").exists()
