"""What `cut` refuses: one line that names the option or the file, what is wrong, what to do; no file touched."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.main import main
from tests.cli.test_cut import ROOT, SLOT, STOCK, cut, solid

OLD = b"(yesterday's)"


@pytest.fixture
def slot(tmp_path: Path) -> Path:
    path = tmp_path / "slot.ngc"
    path.write_text(SLOT)
    return path


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    """Run a command that must be refused; return its one line."""
    assert cut(*arguments) == 2
    shown = capsys.readouterr()
    assert shown.out == ""
    assert shown.err.startswith("hitofude: ")
    assert shown.err.count("\n") == 1
    assert "should not have happened" not in shown.err
    return shown.err


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("--engine fast", "--engine is 'fast'; choose one of"),
        ("--grid 0", "--grid is wrong: '0' is no number of cells; write a whole number from 1 to 30000"),
        ("--grid 30001", "'30001' is no number of cells"),
        ("--grid -5", "'-5' is no number of cells"),
        ("--grid 1e3", "'1e3' is no number of cells"),
        ("--window 0,0,5", "--window is wrong: '0,0,5' has 3 numbers; write 4: X0,Y0,X1,Y1"),
        ("--window 5,5,0,10", "'5,5,0,10' is empty; write the lower left corner first"),
        ("--window 0,0,wide,5", "--window is wrong: '0,0,wide,5'"),
        (
            "--window -20,-20,-1,-1",
            "--window -20,-20,-1,-1 is beside the stock, 0.000,0.000,50.000,20.000; choose a part of it",
        ),
        (
            "--stock 1,2,3",
            "--stock is wrong: '1,2,3' has 3 numbers; write 6: X0,Y0,Z0,X1,Y1,Z1; or name a solid, .stl, or heights, "
            ".npy",
        ),
        ("--stock 0,0,0,50,20,-10", "Write the lower corner first: X0,Y0,Z0,X1,Y1,Z1"),
        ("--stock block.obj", "'block.obj' has 1 number; write 6"),
        ("--stock nowhere.stl", "nowhere.stl does not exist"),
        ("--stock nowhere.npy", "nowhere.json does not exist"),
        (
            "--tool 1=flat",
            "--tool is wrong: '1=flat' is no tool; write NUMBER=KIND:DIAMETER, such as 1=ball:6: flat:D, ball:D",
        ),
        ("--tool ball:6", "'ball:6' is no tool"),
        ("--tool 1=cube:6", "'1=cube:6' is no tool"),
        ("--tool 12345=flat:6", "'12345=flat:6' is no tool"),
        ("--tool 1=flat:6:1", "'1=flat:6:1' has 2 numbers behind flat; write one of flat:D"),
        ("--tool 1=bull:6", "'1=bull:6' has 1 number behind bull"),
        ("--tool 1=bull:6:3", "'1=bull:6:3': T1: corner radius is 3 mm; it must be less than half the diameter, 3 mm"),
        ("--tool 1=v:6", "'1=v:6' has 1 number behind v"),
        ("--tool 1=v:6:180", "tip angle is 180 degrees; it must be less than 180"),
        ("--tool 1=taper:1:20", "has 2 numbers behind taper"),
        ("--tool 1=flat:wide", "--tool is wrong: '1=flat:wide'"),
        ("--tool 1=flat:0", "diameter is 0 mm"),
        ("--tool 1=flat:6 --tool 1=ball:6", "--tool 1=…: tool 1 is given twice"),
        ("--tool 1=drill:6:0.5", "needs one from 1 to 179 degrees"),
        ("--dialect basic", "--dialect is 'basic'; choose one of"),
        ("--job nowhere.toml", "nowhere.toml does not exist"),
        ("--tools nowhere.tbl", "nowhere.tbl does not exist"),
        ("--against nowhere.dxf", "nowhere.dxf does not exist"),
        ("--depth 2", "--depth is of a part to compare with; name it: --against PART"),
        ("--layer a", "--layer is of a part to compare with"),
        ("--tolerance 0.1", "--tolerance is of a part to compare with"),
        ("--origin centre", "--origin is of a part to compare with"),
        ("--origin middle", "'middle' is no origin"),
        ("--depth -2 --against x.dxf", "--depth is -2 mm; the depth must be 0.001 mm or more"),
        ("--tolerance 0 --against x.dxf", "--tolerance is 0 mm; the tolerance must be 0.001 mm or more"),
        ("--join-tolerance 11 --against x.dxf", "oin tolerance is 11 mm; use 0 to 10 mm"),
        ("--depth 2 --against x.stl", "--depth says nothing of a solid, x.stl; take it away"),
        ("--image o.jpg", "--image o.jpg: it is written as .png; change the name"),
        ("--heights o.txt", "--heights o.txt: it is written as .npy; change the name"),
        ("--heights nowhere/o.npy", "there is no folder nowhere; make it first"),
        ("--report nowhere/o.json", "there is no folder nowhere; make it first"),
        ("--gird 5", "--gird 5 is no option of cut; take it away; see hitofude cut --help"),
        ("--report", "--report has no value; write one behind it"),
        ("other.ngc", "other.ngc does not exist"),
    ],
)
def test_a_wrong_option_is_told_in_one_line(
    arguments: str, words: str, slot: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(slot.parent)
    given = arguments.split(" ")
    stock = [] if "--stock" in given else [STOCK]
    tool = [] if "--tool" in given else ["--tool=1=flat:6"]
    assert words in refused(capsys, slot, *stock, *tool, *given)
    assert [path.name for path in slot.parent.iterdir()] == ["slot.ngc"]


def test_missing_programs_and_help(capsys: pytest.CaptureFixture[str]) -> None:
    assert "PROGRAM.ngc is missing; name the NC program" in refused(capsys)
    assert main(["cut", "--help"]) == 0
    shown = capsys.readouterr().out
    options = """--stock --tool --job --tools --tool-units --dialect --block-delete --grid --window --engine --against
    --depth
        --stock-to-leave --layer --units --origin --join-tolerance --tolerance --heights --image --report --quiet"""
    assert all(option in shown for option in options.split())
    assert "taper:TIP:ANGLE:D" in shown
    assert main(["--help"]) == 0
    assert "hitofude cut PROGRAM.ngc" in capsys.readouterr().out


@pytest.mark.parametrize(
    "form", ["--stock -5,-5,-10,45,15,0", "--stock=-5,-5,-10,45,15,0", "--stock -5mm,-.5cm,-10,45,15,0in"]
)
def test_negative_values_with_and_without_equals(form: str, slot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert cut(slot, *form.split(" "), "--tool=1=flat:6", "--window", "-5,-5,45,15", "--grid", 100) == 0
    assert "mm3 removed" in capsys.readouterr().out


def test_files_that_are_inputs_or_named_twice(slot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    common = (slot, STOCK, "--tool=1=flat:6")
    assert "is also an input" in refused(capsys, *common, "--report", slot)
    assert "named twice" in refused(capsys, *common, "--heights", tmp_path / "o.npy", "--report", tmp_path / "o.json")
    assert cut(*common, "--heights", tmp_path / "h.npy", "--quiet") == 0
    again = (slot, "--tool=1=flat:6", "--stock", tmp_path / "h.npy")
    assert "is also an input" in refused(capsys, *again, "--heights", tmp_path / "h.npy")
    assert "is also an input" in refused(capsys, *again, "--report", tmp_path / "h.json")
    part = solid(tmp_path / "part.stl", [[0, 0, -10], [50, 20, 0]])
    assert "is also an input" in refused(capsys, *common, "--against", part, "--report", part)
    assert "is a folder" in refused(capsys, tmp_path, STOCK, "--tool=1=flat:6")
    assert slot.read_text() == SLOT


def test_damaged_stock_files(slot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    heights, beside = tmp_path / "h.npy", tmp_path / "h.json"
    heights.write_bytes(b"no heights")
    beside.write_text("{}")
    assert "h.npy: this is no field of heights" in refused(capsys, slot, "--tool=1=flat:6", "--stock", heights)
    torn = tmp_path / "torn.stl"
    torn.write_bytes(solid(tmp_path / "whole.stl", [[0, 0, -10], [50, 20, 0]]).read_bytes()[:300])
    assert "torn.stl: " in refused(capsys, slot, "--tool=1=flat:6", "--stock", torn)
    assert "torn.stl: " in refused(capsys, slot, STOCK, "--tool=1=flat:6", "--against", torn)


def test_a_scene_that_cannot_be_used_is_told(slot: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = slot.with_name("scene.toml")
    mesh = '[[surface]]\nname = "a"\nshape = { kind = "mesh", file = "gone.stl" }\n'
    for text, words in (
        ("[surface]\n", "scene.toml:1"),
        ('name = "a"\n', "no surface is machined"),
        (mesh, "gone.stl does not exist"),
    ):
        scene.write_text(text)
        assert words in refused(capsys, slot, STOCK, "--tool=1=flat:6", "--against", scene)


def test_old_files_survive_every_failure(slot: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "o.json"
    out.write_bytes(OLD)
    refused(capsys, slot, STOCK, "--report", out)
    if Path("/dev/full").exists():
        assert "/dev/full" in refused(capsys, slot, STOCK, "--tool=1=flat:6", "--report", out, "--image", "/dev/full")
    assert out.read_bytes() == OLD


@pytest.mark.parametrize("name", ["fig2.dxf", "gear.dxf"])
def test_a_drawing_as_program_and_a_program_as_drawing(
    name: str, slot: Path, data: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    refused(capsys, data / "dxf" / name, STOCK, "--tool=0=flat:6")
    assert "slot.ngc: drawings of type .ngc cannot be read" in refused(
        capsys, slot, STOCK, "--tool=1=flat:6", "--depth=2", "--against", slot
    )
    assert (ROOT / "tests/data/dxf" / name).is_file()
