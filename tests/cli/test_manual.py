"""Every command that the pages of the manual show runs, in the order in which it stands there, on files so named."""

from __future__ import annotations

import shlex
import shutil
from pathlib import Path

import cv2
import ezdxf
import numpy as np
import pytest

from app.cli.main import main
from app.drafting.document import HistoryState
from app.formats.project.project import Project, write_project
from app.formats.readers import read_drawing
from app.model.job import Job
from tests.generated_drawings import write_drawings

ROOT = Path(__file__).parents[2]
PAGES = (
    ROOT / "README.md",
    *(page for page in sorted((ROOT / "resources/docs").glob("*.md")) if not page.stem.endswith("_ja")),
)
"""Pages in Japanese show no other commands: tests/usecases/test_static_manual.py."""
OTHER = """G21 G90 G17 G94
T1 M6
S9000 M3
G0 X10 Y10 Z5
G1 Z-2 F100
G1 X60 F400
G1 Y40
G0 Z5
T2 M6
G0 X20 Y30
G1 Z-1 F100
G1 X50 F300
G0 Z5
M30
"""


def commands(page: Path) -> list[list[str]]:
    """The arguments of the lines of a page that call the launcher, but for the window and the tests."""
    lines = (line.partition("  #")[0] for line in page.read_text(encoding="utf-8").splitlines())
    calls = [shlex.split(line)[1:] for line in lines if line.startswith("    ./hitofude ")]
    return [call for call in calls if call and call[0] != "test"]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with what the pages name: a plate with a pocket, two holes and a clamp, a project, a program, a scan."""
    document = ezdxf.new(units=ezdxf.units.MM)
    page = document.modelspace()
    for x0, y0, x1, y1, layer in ((0, 0, 80, 50, "0"), (20, 15, 60, 35, "pocket 4mm"), (90, 10, 95, 30, "clamps")):
        page.add_lwpolyline([(x0, y0), (x1, y0), (x1, y1), (x0, y1)], close=True, dxfattribs={"layer": layer})
    page.query("LWPOLYLINE")[1].dxf.elevation = -4  # a depth that `--depths drawing` reads
    for x in (8, 72):
        page.add_circle((x, 8), 2.5)
    document.saveas(tmp_path / "part.dxf")
    job = Job(read_drawing("part.dxf", (tmp_path / "part.dxf").read_bytes()).part)
    (tmp_path / "part.hito").write_bytes(write_project(Project(HistoryState(job))))
    for name in ("other.nc", "program.nc"):
        (tmp_path / name).write_text(OTHER)
    scan = np.full((300, 400), 255, np.uint8)
    cv2.rectangle(scan, (40, 40), (360, 260), 0, 3)
    cv2.imwrite(str(tmp_path / "scan.png"), scan)
    (tmp_path / "resources").symlink_to(ROOT / "resources")
    shutil.copy(ROOT / "resources/samples/plate.draw", tmp_path)
    write_drawings(tmp_path / "parts", 2)
    (tmp_path / "list.toml").write_text(
        '[[part]]\nfile = "part.dxf"\n[[part]]\nfile = "part.dxf"\noutput = "a/b.ngc"\n'
    )
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_the_manual_shows_commands() -> None:
    shown = {call[0] for page in PAGES for call in commands(page)}
    words = {"make", "tools", "check", "cut", "smooth", "better", "surface", "batch", "stages", "figure11"}
    assert words <= shown


@pytest.mark.exhaustive
@pytest.mark.parametrize("page", [page for page in PAGES if commands(page)], ids=lambda page: page.stem)
def test_the_commands_of_a_page_run(page: Path, folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """With findings or without: what is shown may cut too deep for a tool, but nothing in it is refused.

    `figure11` alone takes longer than all others together; test_figure11.py runs it.
    """
    for call in commands(page):
        if call == ["figure11"]:
            continue
        status = main(call)
        told = capsys.readouterr()
        assert status in (0, 1), (call, told.err)
        for option in ("-o", "--report", "--plot", "--points", "--image", "--heights"):
            if option in call:
                assert list(folder.glob(f"{call[call.index(option) + 1]}*")), (
                    call
                )  # an inlay's are two, told apart behind
