"""`hitofude surface` on scenes: what it writes, what the other commands make of that, and what it says of bad input."""

import csv
import io
import json
import re
from pathlib import Path

import numpy as np
import pytest

from app.cli.main import main
from app.gcode.interpreter.reader import read_program

SAMPLES = Path(__file__).parents[2] / "resources" / "samples"

BALLS = """
name = "balls"
stock = { box = [0, 0, -2, 40, 20, 9] }

[[tool]]
number = 3
kind = "ball"
diameter = 4.0
feed_rate = 900
plunge_rate = 300
spindle_speed = 9000

[[surface]]
name = "table"
shape = { kind = "plane", corner = [0, 0, 0], along = [40, 0, 0], across = [0, 20, 0] }

[[surface]]
name = "large"
shape = { kind = "sphere", centre = [14, 10, 0], radius = 8 }

[[surface]]
name = "small"
shape = { kind = "sphere", centre = [27, 10, 0], radius = 6 }

[[passes]]
tool = 3
pitch = 0.5
through = [0, 10]
"""


def written(folder: Path, text: str = BALLS, *options: str, status: int = 1) -> dict[str, Path]:
    """Return the files of a scene; status 1: passes along the feet of the balls miss them."""
    scene = folder / "scene.toml"
    scene.write_text(text)
    out = {name: folder / f"out.{name}" for name in ("ngc", "json", "csv", "svg", "hpgl")}
    assert (
        main(
            [
                "surface",
                str(scene),
                "-o",
                str(out["ngc"]),
                "--report",
                str(out["json"]),
                "--points",
                str(out["csv"]),
                "--plot",
                str(out["svg"]),
                "--quiet",
                *options,
            ]
        )
        == status
    )
    return {"scene": scene, **out}


@pytest.fixture(scope="module")
def balls(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    """The files of the scene as it stands above, which nobody changes."""
    return written(tmp_path_factory.mktemp("balls"))


def test_the_table_of_points_has_the_crossings_in_closed_form(balls: dict[str, Path]) -> None:
    rows = list(csv.DictReader(io.StringIO(balls["csv"].read_text())))
    on_middle = [row for row in rows if row["kind"] == "crossing" and float(row["y"]) == 10.0]
    between = 14 + (13**2 + 8**2 - 6**2) / 26  # where the spheres' circles meet
    assert [float(row["x"]) for row in on_middle] == pytest.approx([6.0, between, 33.0], abs=1e-9)
    assert float(on_middle[1]["z"]) == pytest.approx(np.sqrt(64 - (between - 14) ** 2), abs=1e-9)
    assert [(row["name"], row["to_name"]) for row in on_middle] == [
        ("table", "large"),
        ("large", "small"),
        ("small", "table"),
    ]
    assert {row["kind"] for row in rows} <= {"point", "crossing", "edge", "jump", "tangent"}


def test_the_report_tells_what_the_cutter_met_in_closed_form(balls: dict[str, Path]) -> None:
    data = json.loads(balls["json"].read_text())
    assert data["gouge"]["count"] == 0 and data["gouge"]["max_mm"] <= 1e-4
    assert data["rapids_in_material"] == []
    assert [(finding["kind"], finding["counts"]) for finding in data["findings"]] == [
        ("left_reachable", True),
        ("engagement", False),
    ]
    (passes,) = data["passes"]
    middle = [mark for mark in passes["path"]["boundaries"] if mark["y"] == 10.0]
    reach = [np.sqrt((radius + 2) ** 2 - 4) for radius in (8, 6)]  # a ball of radius 2 on the table, touching a sphere
    between = (13**2 + 10**2 - 8**2) / 26  # along the offset spheres
    assert [mark["x"] for mark in middle] == pytest.approx([14 - reach[0], 14 + between, 27 + reach[1]], abs=1e-9)
    assert [(mark["i"], mark["j"]) for mark in middle] == [(1, 2), (2, 3), (3, 1)]
    assert sum(surface["moves"] for surface in data["surfaces"]) > 1000


def test_the_program_says_where_it_comes_to_another_surface(balls: dict[str, Path]) -> None:
    text = balls["ngc"].read_text()
    marks = re.findall(r"\(Surface (\d) (\w+), CR(\d)(\d) crossing at ([-\d.]+) ([-\d.]+) ([-\d.]+)\)", text)
    told = json.loads(balls["json"].read_text())["passes"][0]["path"]["boundary_points"]["crossing"]
    assert len(marks) == told
    for number, name, i, j, *_ in marks:
        assert name == {"1": "table", "2": "large", "3": "small"}[number] and number in (i, j)
    assert read_program(text.encode()).error is None


@pytest.mark.exhaustive
def test_surfaces_then_cut_then_smooth_then_cut_is_clean_and_keeps_the_boundaries(tmp_path: Path) -> None:
    files = written(tmp_path, BALLS.replace("pitch = 0.5", "scallop = 0.005"))
    smooth, first, second = (tmp_path / name for name in ("smooth.ngc", "first.json", "second.json"))
    compare = ["--against", str(files["scene"]), "--grid", "300", "--tolerance", "0.02", "--quiet"]
    main(["cut", str(files["ngc"]), *compare, "--report", str(first)])
    assert main(["smooth", str(files["ngc"]), "-o", str(smooth), "--tolerance", "0.005", "--quiet"]) == 0
    main(["cut", str(smooth), *compare, "--report", str(second)])
    for path in (first, second):
        cut = json.loads(path.read_text())
        assert cut["gouge"]["count"] == 0 and cut["rapids_in_material"] == []
        assert cut["removed_mm3"] > 1000
        # at the feet of the balls, where passes run along them: 7.8 and 8.5 on these cells, 24 on a quarter of them
        assert cut["left"]["reachable_mm2"] < 10.0
    before, after = files["ngc"].read_text(), smooth.read_text()
    marks = re.compile(r"\(Surface .*\)")
    assert marks.findall(after) == marks.findall(before)
    moves = [sum(not line.startswith("(") for line in text.splitlines()) for text in (after, before)]
    assert moves[0] < moves[1] / 2.5, (
        "boundaries are marked as often in both, and the passes were thinned when they were made"
    )


@pytest.mark.exhaustive
def test_one_report_tells_the_whole_way_from_surfaces_to_the_cut_of_the_smoothed_program(tmp_path: Path) -> None:
    scene, report = tmp_path / "scene.toml", tmp_path / "r.json"
    scene.write_text(BALLS.replace("pitch = 0.5", "scallop = 0.02"))
    # the feet of the balls
    assert main(["surface", str(scene), "--loop", "0.005", "--report", str(report), "--quiet"]) == 1
    told = json.loads(report.read_text())
    loop = told["loop"]
    assert told["gouge"]["count"] == 0
    assert loop["boundaries_kept"]
    assert loop["smooth"][0]["tolerance"]["proven_mm"] <= 0.005
    assert loop["smooth"][0]["blocks"]["after"] < loop["smooth"][0]["blocks"]["before"] / 3
    for name in ("cut", "cut_smoothed"):
        assert loop[name]["gouge"]["count"] == 0
        assert loop[name]["rapids_in_material"] == []
        assert loop[name]["removed_mm3"] > 1000
    assert loop["cut_smoothed"]["removed_mm3"] == pytest.approx(loop["cut"]["removed_mm3"], rel=1e-3)


def test_a_loop_without_a_report_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene = tmp_path / "scene.toml"
    scene.write_text(BALLS)
    assert main(["surface", str(scene), "--loop", "0.005", "-o", str(tmp_path / "a.ngc")]) == 2
    assert "add --report R.json" in capsys.readouterr().err
    assert not (tmp_path / "a.ngc").exists()


@pytest.mark.exhaustive
def test_a_cut_too_deep_into_a_surface_is_a_gouge_of_that_depth(balls: dict[str, Path], tmp_path: Path) -> None:
    lines = balls["ngc"].read_text().splitlines()
    deeper = tmp_path / "deeper.ngc"
    lowered = [
        re.sub(r"Z(-?[\d.]+)", lambda match: f"Z{float(match[1]) - 0.2:.4f}", line)
        if line.startswith(("G1", "X"))
        else line
        for line in lines
    ]
    deeper.write_text("\n".join(lowered) + "\n")
    report = tmp_path / "r.json"
    assert (
        main(
            ["cut", str(deeper), "--against", str(balls["scene"]), "--grid", "300", "--report", str(report), "--quiet"]
        )
        == 1
    )
    gouge = json.loads(report.read_text())["gouge"]
    assert gouge["count"] > 0 and gouge["max_mm"] == pytest.approx(0.2, abs=0.01)


@pytest.mark.exhaustive
def test_the_origin_moves_the_program_and_not_what_it_is_compared_with(tmp_path: Path) -> None:
    files = written(tmp_path, BALLS.replace("[[tool]]", '[origin]\nxy = "centre"\nz = "top"\n\n[[tool]]', 1))
    assert "origin_mm=20,10,9" in files["ngc"].read_text()
    report = tmp_path / "r.json"
    main(
        [
            "cut",
            str(files["ngc"]),
            "--against",
            str(files["scene"]),
            "--grid",
            "200",
            "--report",
            str(report),
            "--quiet",
        ]
    )
    data = json.loads(report.read_text())
    assert data["stock"]["low"] == [-20, -10, -11] and data["stock"]["high"] == [20, 10, 0]
    assert data["gouge"]["count"] == 0 and data["removed_mm3"] > 1000


@pytest.mark.parametrize("name", ["compound", "spheres", "torus"])
def test_the_samples_are_computed_and_proven(tmp_path: Path, name: str) -> None:
    out, report = tmp_path / "o.ngc", tmp_path / "r.json"
    left = name == "spheres"  # at the feet of its balls
    assert main(["surface", str(SAMPLES / f"{name}.toml"), "-o", str(out), "--report", str(report), "--quiet"]) == left
    assert json.loads(report.read_text())["gouge"]["count"] == 0
    assert read_program(out.read_bytes()).error is None


@pytest.mark.exhaustive
def test_the_same_scene_is_written_the_same_again(balls: dict[str, Path], tmp_path: Path) -> None:
    other = written(tmp_path)
    for name in ("ngc", "csv", "svg"):
        assert balls[name].read_bytes() == other[name].read_bytes()


def test_bad_input_is_told_in_a_line_and_nothing_is_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    scene, out = tmp_path / "s.toml", tmp_path / "o.ngc"
    for text, words in (
        (BALLS.replace("radius = 8", "radius = -8"), "s.toml:"),
        (BALLS.replace("tool = 3", "tool = 4"), "T4"),
        (BALLS.replace("pitch = 0.5", ""), "pitch or a scallop"),
        (BALLS.replace('kind = "plane"', 'kind = "saddle"'), "saddle"),
        (BALLS.partition("[[passes]]")[0], "no passes"),
        (BALLS.partition("[[surface]]")[0], "no surface"),
        (BALLS + "boundary = [{ rectangle = [90, 90, 99, 99] }]\n", "touch no surface"),
    ):
        scene.write_text(text)
        assert main(["surface", str(scene), "-o", str(out)]) == 2
        said = capsys.readouterr().err
        assert said.startswith("hitofude: ") and said.count("\n") == 1 and words in said
        assert not out.exists()
    scene.write_text(BALLS)
    for options, words in (
        ([], "nothing to write"),
        (["--plot", str(tmp_path / "a.gif")], ".svg"),
        (["-o", str(scene)], "also an input"),
    ):
        assert main(["surface", str(scene), *options]) == 2
        assert words in capsys.readouterr().err
