"""`cut --against`: what `make` writes comes out right, what was spoiled by hand is found where it is, solids and
foreign programs too.
"""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from app.cli.main import main
from tests.cli.test_cut import cut, report_of, solid

FRAME = """\
G21 G90 G17
T1 M6
G0 Z5
X3 Y3
G1 Z-2 F200
X37
Y27
X3
Y3
{rings}
G0 Z5
M2
"""


def made(drawing: Path, tmp_path: Path, *options: object) -> list[Path]:
    """Make a drawing's program; return its files."""
    out = tmp_path / f"{drawing.stem}.ngc"
    assert main(
        ["make", str(drawing), "-o", str(out), "--quiet", "--report", str(tmp_path / "make.json"), *map(str, options)]
    ) in (0, 1)
    return sorted(tmp_path.glob(f"{drawing.stem}*.ngc"))


def of_make(tmp_path: Path) -> dict[str, Any]:
    return dict(json.loads((tmp_path / "make.json").read_text()))


def plate(
    path: Path, x: float = 0.0, y: float = 0.0, layer: str = "0", size: tuple[float, float] = (40.0, 30.0)
) -> Path:
    """Draw a rectangle."""
    document = ezdxf.readfile(path) if path.exists() else ezdxf.new()
    document.header["$INSUNITS"] = 4
    corners = [(x, y), (x + size[0], y), (x + size[0], y + size[1]), (x, y + size[1])]
    document.modelspace().add_lwpolyline(corners, close=True, dxfattribs={"layer": layer})
    document.saveas(path)
    return path


def cleared() -> str:
    """A program that clears a pocket of 40 x 30 mm with T1."""
    rings = []
    for inset in range(6, 16, 2):
        rings += [f"G1 X{inset} Y{inset}", f"X{40 - inset}", f"Y{30 - inset}", f"X{inset}", f"Y{inset}"]
    return FRAME.format(rings="\n".join(rings))


@pytest.mark.parametrize(
    "options",
    [
        [],
        ["--origin", "centre,bottom", "--stock-to-leave", "0.3"],
        ["--depth", "4", "--stepdown", "1.5", "--out-units", "in"],
        ["--post", "haas", "--origin", "lower-left"],
        ["--contour-tool", "2", "--pocket-tool", "5", "--order", "1986"],
    ],
    ids=str,
)
def test_what_make_writes_cuts_the_drawing(options: list[str], tmp_path: Path, samples: Path) -> None:
    (program,) = made(samples / "fig2.dxf", tmp_path, *options)
    data = report_of(tmp_path, program, "--against", samples / "fig2.dxf", status=0)
    left = of_make(tmp_path)["left"]
    assert data["gouge"]["count"] == 0
    assert (data["left"]["reachable_mm2"], data["rapids_in_material"]) == (0, [])
    assert data["left"]["unreachable_mm2"] == pytest.approx(left["unreachable_mm2"], abs=0.02)
    assert data["left"]["largest_disc_mm"] == pytest.approx(left["largest_disc_mm"], abs=1e-3)
    assert data["retracts"] == of_make(tmp_path)["retracts"]
    assert data["time_s"] == pytest.approx(of_make(tmp_path)["time_s"], rel=0.02)
    assert data["assumed"] == []
    assert {tool["from"].split(" in line")[0] for tool in data["tools"]} == {"the comment"}
    assert data["certificate"]["gouge_mm"] < 4 * data["grid"]["pitch_mm"]


@pytest.mark.parametrize("name", ["gear", "genshi", "apu-mount"])
def test_findings_are_those_of_make(name: str, tmp_path: Path, data: Path) -> None:
    (program,) = made(data / f"dxf/{name}.dxf", tmp_path, "--pocket-tool=3", "--contour-tool=2")
    expected = of_make(tmp_path)["left"]
    found = report_of(
        tmp_path, program, "--against", data / f"dxf/{name}.dxf", status=1 if expected["reachable_mm2"] else 0
    )
    assert found["left"]["reachable_mm2"] == pytest.approx(expected["reachable_mm2"], abs=0.02)
    assert found["left"]["unreachable_mm2"] == pytest.approx(expected["unreachable_mm2"], abs=0.05)
    assert found["gouge"]["count"] == 0


@pytest.mark.exhaustive
def test_a_file_for_each_tool_needs_them_all(tmp_path: Path, samples: Path) -> None:
    first, second = made(samples / "fig2.dxf", tmp_path, "--post", "grbl")
    against = ("--against", samples / "fig2.dxf")
    both = report_of(tmp_path, first, second, *against)
    assert [(tool["number"], tool["diameter_mm"]) for tool in both["tools"]] == [(1, 6), (2, 3)]
    alone = report_of(tmp_path, first, *against, status=1)
    assert alone["left"]["reachable_mm2"] > 50


def test_a_gouge_made_by_hand_is_found_placed_and_sized(tmp_path: Path, samples: Path) -> None:
    (program,) = made(samples / "fig2.dxf", tmp_path)
    lines = program.read_text().splitlines()
    at = lines.index("G1 X24.0000", lines.index("T2 M6"))  # along the island's foot, to its left corner at 24, 20
    lines[at + 1 : at + 1] = ["Y18.5500", "Y18.5000"]
    program.write_text("\n".join(lines) + "\n")
    spoiled = report_of(tmp_path, program, "--against", samples / "fig2.dxf", status=1)
    assert spoiled["gouge"]["max_mm"] == pytest.approx(0.05, abs=1e-4)
    assert (spoiled["gouge"]["x"], spoiled["gouge"]["y"]) == (
        pytest.approx(24.0, abs=1e-3),
        pytest.approx(20.0, abs=1.5),
    )
    assert spoiled["gouge"]["line"] in (at + 2, at + 3)
    assert any(finding["kind"] == "gouge" and finding["counts"] for finding in spoiled["findings"])


def test_a_strip_that_is_left_is_found(tmp_path: Path, samples: Path) -> None:
    (program,) = made(samples / "fig2.dxf", tmp_path)
    whole = program.read_text()
    program.write_text(whole[: whole.index("T2 M6")] + "M2\n")
    found = report_of(tmp_path, program, "--against", samples / "fig2.dxf", "--image", tmp_path / "o.png", status=1)
    assert found["left"]["reachable_mm2"] > 100
    assert found["worst"][0]["kind"] == "left"
    assert found["worst"][0]["depth_mm"] == pytest.approx(2.0)


def test_a_foreign_program_against_a_drawing(tmp_path: Path) -> None:
    program, drawing = tmp_path / "foreign.ngc", plate(tmp_path / "plate.dxf")
    program.write_text(cleared())
    common = (program, "--tool=1=flat:6", "--stock=-5,-5,-8,45,35,0", "--against", drawing)
    right = report_of(tmp_path, *common, "--depth", "2")
    assert right["left"]["unreachable_mm2"] == pytest.approx(4 * (1 - math.pi / 4) * 9, abs=0.02)
    assert right["tolerance"]["part_mm"] == 0.01
    deeper = report_of(tmp_path, *common, "--depth", "2.5", status=1)
    assert deeper["left"]["reachable_mm2"] == pytest.approx(40 * 30 - 4 * (1 - math.pi / 4) * 9, rel=2e-3)
    shallower = report_of(tmp_path, *common, "--depth", "1.9", status=1)
    assert shallower["gouge"]["max_mm"] == pytest.approx(0.1, abs=1e-4)
    near = report_of(tmp_path, *common, "--depth", "1.9", "--tolerance", "0.11")
    assert near["gouge"]["count"] == 0
    leaving = report_of(tmp_path, *common, "--depth", "2", "--stock-to-leave", "0.2", status=1)
    assert leaving["gouge"]["max_mm"] == pytest.approx(0.2, abs=0.01)


def test_the_origin_is_as_asked(tmp_path: Path) -> None:
    program, drawing = tmp_path / "foreign.ngc", plate(tmp_path / "plate.dxf", x=100.0, y=-50.0)
    program.write_text(cleared())
    common = (program, "--tool=1=flat:6", "--stock=-5,-5,-8,45,35,0", "--against", drawing, "--depth=2")
    assert report_of(tmp_path, *common, "--origin", "lower-left")["gouge"]["count"] == 0
    elsewhere = report_of(tmp_path, *common, status=1)
    assert elsewhere["gouge"]["max_mm"] >= 2.0
    program.write_text(cleared().replace("G21", "G21 G10 L2 P1 X-20 Y-15 Z8"))
    moved = (
        program,
        "--tool=1=flat:6",
        "--stock=-25,-20,0,25,20,8",
        "--against",
        drawing,
        "--depth=2",
        "--origin",
        "centre,bottom",
    )
    assert report_of(tmp_path, *moved)["gouge"]["count"] == 0


def test_layers_and_units_are_as_asked(tmp_path: Path) -> None:
    program, drawing = (
        tmp_path / "foreign.ngc",
        plate(plate(tmp_path / "two.dxf", layer="Pocket"), 10.0, 10.0, "island", (5.0, 5.0)),
    )
    program.write_text(cleared())
    common = (program, "--tool=1=flat:6", "--stock=-5,-5,-8,45,35,0", "--against", drawing, "--depth=2")
    assert report_of(tmp_path, *common, "--layer", "pocket")["gouge"]["count"] == 0
    assert report_of(tmp_path, *common, status=1)["gouge"]["count"] > 0
    small = ezdxf.readfile(plate(tmp_path / "inch.dxf", size=(40 / 25.4, 30 / 25.4)))
    small.header["$INSUNITS"] = 0
    small.saveas(tmp_path / "inch.dxf")
    inch = (
        program,
        "--tool=1=flat:6",
        "--stock=-5,-5,-8,45,35,0",
        "--against",
        tmp_path / "inch.dxf",
        "--depth=2",
        "--units",
        "in",
    )
    assert report_of(tmp_path, *inch)["gouge"]["count"] == 0


def test_a_depth_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, drawing = tmp_path / "foreign.ngc", plate(tmp_path / "plate.dxf")
    program.write_text(cleared())
    assert cut(program, "--tool=1=flat:6", "--against", drawing) == 2
    told = capsys.readouterr().err
    assert (
        "plate.dxf: nobody tells how deep the part is milled; give --depth, mm from the stock's top down to the floor"
        in told
    )


def test_a_solid_is_compared_with(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    program, part = tmp_path / "face.ngc", solid(tmp_path / "part.stl", [[0, 0, -10], [20, 20, -2]])
    rows = "\n".join(f"X{-5 if k % 2 else 25}\nY{k + 1}" for k in range(-4, 25))
    program.write_text(f"G21 G90\nT1 M6\nG0 Z5\nX-5 Y-4\nG1 Z-2 F500\n{rows}\nG0 Z5\nM2\n")
    common = (program, "--tool=1=flat:6", "--stock=0,0,-10,20,20,0", "--grid=200")
    right = report_of(tmp_path, *common, "--against", part)
    assert (right["gouge"]["count"], right["left"]["reachable_mm2"]) == (0, 0)
    leaving = report_of(tmp_path, *common, "--against", part, "--stock-to-leave", "0.1", status=1)
    assert leaving["gouge"]["max_mm"] == pytest.approx(0.1, abs=1e-3)
    low = solid(tmp_path / "low.stl", [[100, 100, 0], [120, 120, 7]])
    wide = (program, "--tool=1=flat:6", "--stock=-2,-2,-10,22,22,0", "--grid=200")
    left = report_of(tmp_path, *wide, "--against", low, "--origin", "lower-left,top", status=1)
    assert left["gouge"]["max_mm"] >= 1.99
    inches = solid(tmp_path / "inch.stl", [[0, 0, -10 / 25.4], [20 / 25.4, 20 / 25.4, -2 / 25.4]])
    assert report_of(tmp_path, *common, "--against", inches, "--units", "in")["gouge"]["count"] == 0
    assert cut(*common, "--against", part) == 0
    assert "0.0000 mm gouge, 0.000 mm2 left within reach, 0.000 mm2 out of reach" in capsys.readouterr().out


def with_notes(path: Path, units: int = 4, layout: bool = False) -> Path:
    """Draw a plate away from zero, a centre line across it, an ellipse, and the same in paper space where `layout` is
    so.
    """
    document = ezdxf.new()
    document.header["$INSUNITS"] = units
    space = document.layouts.new("Blatt 2") if layout else document.modelspace()
    space.add_lwpolyline([(100, 50), (140, 50), (140, 80), (100, 80)], close=True)
    space.add_line((90, 65), (150, 65), dxfattribs={"layer": "Mitte (x)"})
    space.add_ellipse((120, 65), (8, 0), 0.5)
    document.saveas(path)
    return path


@pytest.mark.parametrize(
    ("options", "units", "layout"),
    [
        (["--to-zero", "--skip-layer", "mitte (x)"], 4, False),
        (["--skip-layer=Mitte (x)", "--skip-type=ellipse"], 4, False),
        (["--units", "in", "--skip-layer=Mitte (x)"], 0, False),
        (["--units", "mm", "--skip-layer=Mitte (x)", "--to-zero"], 6, False),
        (["--layout", "blatt 2", "--skip-layer=Mitte (x)"], 4, True),
    ],
)
def test_a_program_tells_how_its_drawing_was_read(options: list[str], units: int, layout: bool, tmp_path: Path) -> None:
    """What `make` was told need not be said again; without these words in the header the verdict is another one, as it
    ever was.
    """
    drawing = with_notes(tmp_path / "part.dxf", units, layout)
    size = 25 if "in" in options else 1  # tools as large beside the part in any unit
    tools = ["--contour-tool", f"{4 * size}", "--pocket-tool", f"{6 * size}"]
    (program,) = made(drawing, tmp_path, *options, *tools)
    assert main(["cut", str(program), "--against", str(drawing), "--quiet", "--grid", "128"]) == 0
    lines = program.read_text().splitlines(keepends=True)
    keys = ("skip_", "to_zero", "layout", "overrule", "drawing_units")
    program.write_text("".join(line for line in lines if not any(f"hitofude: {key}" in line for key in keys)))
    try:
        status = main(["cut", str(program), "--against", str(drawing), "--quiet", "--grid", "128"])
    except SystemExit as stopped:
        status = int(stopped.code or 0)
    assert status in (1, 2)
    assert main(["cut", str(program), "--against", str(drawing), "--quiet", "--grid", "128", *options]) == 0


@pytest.mark.parametrize(
    "options", [[], ["--px-per-inch", "90"], ["--px-per-inch", "50", "--to-zero"], ["--units", "mm"]]
)
def test_a_page_without_a_real_size_is_read_as_it_was(options: list[str], tmp_path: Path) -> None:
    drawing = tmp_path / "page.svg"
    drawing.write_text(
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 300 200"><rect x="10" y="20" width="180" '
        'height="120"/></svg>'
    )
    (program,) = made(drawing, tmp_path, *options, "--contour-tool", "4", "--pocket-tool", "6")
    assert main(["cut", str(program), "--against", str(drawing), "--quiet", "--grid", "128"]) == 0


def test_what_is_asked_stands_before_what_the_program_tells_and_is_said(tmp_path: Path) -> None:
    drawing = with_notes(tmp_path / "part.dxf")
    (program,) = made(
        drawing, tmp_path, "--skip-layer=Mitte (x)", "--skip-type=ellipse", "--contour-tool", "4", "--pocket-tool", "6"
    )
    findings = report_of(tmp_path, program, "--against", drawing, "--grid=128", "--skip-type=line", status=1)[
        "findings"
    ]
    assert "The program was made with --skip-type ellipse; here it is --skip-type line, as asked." in [
        each["text"] for each in findings if each["kind"] == "assumed"
    ]
    same = report_of(
        tmp_path, program, "--against", drawing, "--grid=128", "--skip-type=ELLIPSE", "--skip-layer=MITTE (X)"
    )["findings"]
    assert not [each for each in same if "as asked." in each["text"] and "made with" in each["text"]]


def test_what_a_program_tells_of_another_kind_of_drawing_is_passed_over(tmp_path: Path) -> None:
    """Also a layer to leave out that a later drawing has no more."""
    drawing = with_notes(tmp_path / "part.dxf")
    (program,) = made(
        drawing, tmp_path, "--skip-layer=Mitte (x)", "--skip-type=ellipse", "--contour-tool", "4", "--pocket-tool", "6"
    )
    (tmp_path / "part.draw").write_text("rect 100,50 140,80\n")
    assert main(["cut", str(program), "--against", str(tmp_path / "part.draw"), "--quiet", "--grid", "128"]) == 0
    assert (
        main(["cut", str(program), "--against", str(plate(tmp_path / "new.dxf", 100, 50)), "--quiet", "--grid", "128"])
        == 0
    )


@pytest.mark.parametrize(("size", "told"), [(25.4, True), (1.0, False)])
def test_a_solid_that_is_far_smaller_than_what_is_cut_is_told(tmp_path: Path, size: float, told: bool) -> None:
    """One in inches: a frame of 34 x 24 mm was cut beside it, and the verdict was clean."""
    part = solid(tmp_path / "part.stl", [[0, 0, -10 / size], [40 / size, 30 / size, -2 / size]])
    program = tmp_path / "frame.ngc"
    program.write_text(FRAME.format(rings=""))
    report = tmp_path / "r.json"
    given = (program, "--tool", "1=flat:6", "--stock=0,0,-10,40,30,0", "--against", part, "--report", report)
    status = cut(*given, "--grid", "200", "--quiet")
    found = [each for each in json.loads(report.read_text())["findings"] if each["kind"] == "size"]
    assert bool(found) == told
    if told:
        assert status == 1 and "1.575 x 1.181 mm, and the program cuts 34.000 x 24.000 mm" in found[0]["text"]
