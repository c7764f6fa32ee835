"""`make` for every control and on a machine, and `check` of what it wrote, as their user sees them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main
from app.core.settings import config_folder
from app.gcode.posts import load_post, post_names

FIG2 = Path(__file__).resolve().parents[2] / "resources/samples/fig2.dxf"


def made(folder: Path, *options: str) -> int:
    return main(["make", str(FIG2), "-o", str(folder / "part.nc"), *options])


@pytest.mark.parametrize("name", post_names())
@pytest.mark.parametrize("units", ["mm", "in"])
def test_every_control_gets_files_that_its_reader_takes(
    name: str, units: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert made(tmp_path, "--post", name, "--out-units", units, "--report", str(tmp_path / "r.json")) == 0
    shown = capsys.readouterr().out
    written = sorted(path.name for path in tmp_path.glob("*.nc"))
    assert written == (["part_1_T1.nc", "part_2_T2.nc"] if load_post(name).file_per_tool else ["part.nc"])
    assert all(str(tmp_path / file) in shown for file in written)
    assert "read back within 0.00" in shown
    report = json.loads((tmp_path / "r.json").read_text())
    cut, boxes = 0.0, []
    for file in written:
        assert (
            main(["check", str(tmp_path / file), "--dialect", name, "--report", str(tmp_path / "c.json"), "--quiet"])
            == 0
        )
        found = json.loads((tmp_path / "c.json").read_text())
        cut += found["length_mm"]["cut"]
        boxes.append(found["extent_mm"]["cut"])
    lengths = report["length_mm"]
    assert cut == pytest.approx(sum(length for way, length in lengths.items() if way != "rapid"), abs=1e-6)
    assert report["extent_mm"]["cut"]["low"] == pytest.approx([min(box["low"][k] for box in boxes) for k in range(3)])
    assert report["extent_mm"]["cut"]["high"] == pytest.approx([max(box["high"][k] for box in boxes) for k in range(3)])


def test_of_several_files_all_are_written_or_none(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "part_1_T1.nc").write_text("old")
    (tmp_path / "part_2_T2.nc").mkdir()
    assert made(tmp_path, "--post", "grbl", "--report", str(tmp_path / "r.json")) == 2
    assert "part_2_T2.nc: it is a folder" in capsys.readouterr().err
    assert (tmp_path / "part_1_T1.nc").read_text() == "old"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["part_1_T1.nc", "part_2_T2.nc"]


def test_a_file_of_a_tool_is_no_other_output(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert made(tmp_path, "--post", "grbl", "--report", str(tmp_path / "part_2_T2.nc")) == 2
    assert "one of these is another output" in capsys.readouterr().err
    assert not list(tmp_path.iterdir())


def test_a_machine_times_the_job_and_tells_what_it_cannot_do(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    reports = []
    for options in ((), ("--machine", "router"), ("--machine", "bench_mill"), ("--machine", "vmc", "--speed", "9000")):
        status = made(tmp_path, *options, "--report", str(tmp_path / "r.json"))
        reports.append(json.loads((tmp_path / "r.json").read_text()))
        assert status == (1 if "bench_mill" in options else 0)
    assert "Small router" in reports[0]["time_method"]
    assert reports[0]["time_s"] == reports[1]["time_s"] > reports[2]["time_s"] > reports[3]["time_s"]
    told = [finding["text"] for finding in reports[2]["findings"] if finding["kind"] == "machine"]
    assert [text.split(": ")[1][:32] for text in told] == [
        "the spindle is to turn at 12000 ",
        "the spindle is to turn at 18000 ",
    ]
    capsys.readouterr()
    assert made(tmp_path, "--machine", "lathe") == 2
    assert (
        "--machine is wrong: There is no machine 'lathe'; choose one of bench_mill, router, vmc"
        in capsys.readouterr().err
    )


def test_a_post_of_the_users_own_is_checked_as_strictly(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A post whose words move the tool otherwise than the path: nothing is kept."""
    folder = config_folder() / "posts"
    folder.mkdir(parents=True)
    start = 'start = ["G17 {units} G91 G94 G40 G49 G80", "G91.1", "G54", "{blending}"]'
    (folder / "mine.toml").write_text(f'extends = "linuxcnc"\n[program]\n{start}\n')
    assert made(tmp_path, "--post", "mine") == 2
    assert "LinuxCNC program:" in (told := capsys.readouterr().err)
    assert "not kept" in told
    assert not list(tmp_path.glob("*.nc"))
    (folder / "mine.toml").write_text(
        'extends = "linuxcnc"\n[program]\ntool = ["T{tool} M6", "G43 H7", "S{speed} M3", "G4 P{dwell_s}"]\n'
    )
    assert made(tmp_path, "--post", "mine") == 2
    assert "tool 7 is not in the tool table" in capsys.readouterr().err
