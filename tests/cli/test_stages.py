"""`hitofude stages` and the bitmap way of `make`, as a user runs them: files, exit status, one line for every
mistake.
"""

import json
import re
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.exhibits.stage_picture import PALETTE
from app.raster.frame import PixelCode
from tests.called import call
from tests.conftest import ROOT
from tests.said import without_how_far

FIG2 = ROOT / "tests" / "data" / "dxf" / "fig2.dxf"


@pytest.fixture
def picture(tmp_path: Path) -> Path:
    """A plate with a hole, inked lines 2 px wide, two of them meeting."""
    image = np.full((160, 200), 255, np.uint8)
    cv2.rectangle(image, (20, 20), (180, 140), 0, 2)
    cv2.circle(image, (70, 80), 20, 0, 2)
    cv2.line(image, (120, 20), (120, 140), 0, 2)
    path = tmp_path / "scan.png"
    cv2.imwrite(str(path), image)
    return path


def test_every_step_of_a_drawing_is_written(tmp_path: Path) -> None:
    folder, report = tmp_path / "steps", tmp_path / "r.json"
    done = call("stages", FIG2, "-o", folder, "--contour-tool", 2, "--pocket-tool", 4, "--report", report)
    assert done.returncode == 0, done.stderr
    assert "34 steps on 400 x 400 px" in done.stdout
    told = json.loads(report.read_text())
    assert [step["number"] for step in told["steps"]] == [
        110,
        120,
        201,
        202,
        203,
        204,
        205,
        206,
        207,
        208,
        130,
        301,
        302,
        303,
        304,
        305,
        306,
        307,
        141,
        142,
        143,
        144,
        145,
        146,
        147,
        148,
        140,
        401,
        402,
        403,
        404,
        405,
        406,
        407,
    ]
    for step in told["steps"]:
        codes = np.load(folder / f"{step['file']}.npy")
        assert codes.dtype == np.uint8
        assert codes.shape == (400, 400)
        assert {PixelCode(int(code)).name.lower() for code in np.unique(codes)} == set(step["pixels"])
        picture = cv2.imread(str(folder / f"{step['file']}.png"))
        if step["number"] not in (202, 404, 405, 406, 407, 140):  # rings about single pixels, dashes
            shown = np.array([told["colours"][name] for name in told["codes"]])[codes.repeat(2, 0).repeat(2, 1)]
            assert np.array_equal(picture[:800], bgr_of(shown)), step["number"]
        assert picture.shape[0] > 800 and picture.shape[1] == 800, "what the codes mean stands beneath"
        assert (folder / f"{step['file']}.txt").exists() == (step["chains"] > 0)
        assert step["sentence"].endswith(".")
    lines = (folder / "05_203.txt").read_text().splitlines()
    assert len(lines) == 3
    assert all(re.fullmatch(r"region 0 turn 1 start \d+ \d+: [0-7]*\.", line) for line in lines)
    assert told["wrong_pixels"] == 0
    assert 0 < told["given_up_mm"]["mean"] < told["given_up_mm"]["max"] < 1


def bgr_of(colours: np.ndarray) -> np.ndarray:
    """Blue, green and red of "#rrggbb"."""
    values = {each: [int(each[k : k + 2], 16) for k in (5, 3, 1)] for each in np.unique(colours).tolist()}
    names, where = np.unique(colours, return_inverse=True)
    return np.array([values[each] for each in names.tolist()], np.uint8)[where.reshape(colours.shape)]


def test_every_time_of_a_repeated_step_is_written(tmp_path: Path) -> None:
    folder, report = tmp_path / "steps", tmp_path / "r.json"
    assert (
        call(
            "stages", FIG2, "-o", folder, "--contour-tool", 2, "--pocket-tool", 4, "--bitmap", 200, "--report", report
        ).returncode
        == 0
    )
    steps = {step["number"]: step for step in json.loads(report.read_text())["steps"]}
    assert (folder / "film.json").read_bytes() == report.read_bytes()
    assert all(step["name"] and step["sentence"] and step["pixels"] for step in steps.values())
    chains = {
        number: (folder / f"{steps[number]['file']}.txt").read_text().splitlines()
        for number in (142, 144, 146, 301, 303, 306)
    }
    assert {number: steps[number]["chains"] for number in chains} == {
        number: len(lines) for number, lines in chains.items()
    }
    both = {"region 1 turn 1", "region 2 turn 1"}
    assert all({line.split(" start ")[0] for line in chains[number]} == both for number in (142, 303, 306))
    assert sorted(line.split(" start ")[1] for line in chains[144]) == sorted(
        line.split(" start ")[1] for line in chains[142]
    )
    assert {line.split(" start ")[0] for line in chains[146]} == {
        f"region 0 turn {k}" for k in range(1, steps[146]["times"] + 1)
    }
    assert len({line.split(" start ")[0] for line in chains[301]}) == steps[301]["times"] > 2
    for number, step in steps.items():
        turns = sorted((folder / "turns").glob(f"{step['file']}_*.png"))
        assert len(turns) == (step["times"] if step["times"] > 1 else 0), number
        if turns:
            codes = np.load(folder / f"{step['file']}.npy")
            assert np.array_equal(np.array([colour_of(code) for code in range(14)])[codes], cv2.imread(str(turns[-1])))
    first, second = (folder / "turns" / f"{steps[142]['file']}_r{region}_t001.png" for region in (1, 2))
    assert first.read_bytes() != second.read_bytes()


def colour_of(code: int) -> tuple[int, int, int]:
    colour = PALETTE[PixelCode(code)]
    return int(colour[5:7], 16), int(colour[3:5], 16), int(colour[1:3], 16)


@pytest.mark.parametrize("name", ["03_201.npy", "20_142.png", "05_203.txt", "turns/12_301_r1_t001.png"])
def test_the_report_takes_no_stage_s_place(tmp_path: Path, name: str) -> None:
    (tmp_path / "a" / "turns").mkdir(parents=True)
    done = call("stages", FIG2, "-o", tmp_path / "a", "--report", tmp_path / "a" / name)
    assert done.returncode == 2
    assert (
        "is the name of a stage's own file" in done.stderr
        and len(without_how_far(done.stderr).strip().splitlines()) == 1
    )
    assert [path.name for path in (tmp_path / "a").rglob("*")] == ["turns"]


def test_the_published_fill_shows_where_it_errs(tmp_path: Path, picture: Path) -> None:
    done = call(
        "stages",
        FIG2,
        "-o",
        tmp_path / "a",
        "--bitmap",
        40,
        "--contour-tool",
        5.5,
        "--pocket-tool",
        6,
        "--variant",
        "published",
        "--report",
        tmp_path / "r.json",
    )
    assert done.returncode in (0, 1), done.stderr
    assert "the fill as published is wrong in" in done.stdout
    assert json.loads((tmp_path / "r.json").read_text())["variant"] == "published"


def test_a_picture_is_a_part_and_its_doubts_are_told(tmp_path: Path, picture: Path) -> None:
    done = call("stages", picture, "-o", tmp_path / "steps", "--dpi", 127, "--contour-tool", 1, "--pocket-tool", 2)
    assert done.returncode == 0, done.stderr
    assert "202 x 162 px of 0.2 mm" in done.stdout
    assert "lines meet" in done.stdout


def test_make_computes_on_pixels_where_asked(tmp_path: Path) -> None:
    out, report = tmp_path / "o.ngc", tmp_path / "r.json"
    done = call("make", FIG2, "-o", out, "--bitmap", 600, "--report", report)
    assert done.returncode == 0, done.stdout
    told = json.loads(report.read_text())
    assert told["left"]["reachable_mm2"] == 0 < told["left"]["given_up_mm2"]
    assert "is left along the walls" in done.stdout
    assert told["engine"].startswith("pixels alone")
    assert told["gouge"]["max_mm"] <= 1e-6
    assert told["rapids_in_material"] == []
    assert told["strokes"] == 2
    assert told["moves"]["G2"] + told["moves"]["G3"] > 10
    assert told["tolerance"]["path_mm"] == pytest.approx(0.5, abs=0.4)
    assert out.read_text().count("M6") == 2


def test_make_takes_a_picture(tmp_path: Path, picture: Path) -> None:
    done = call(
        "make",
        picture,
        "-o",
        tmp_path / "o.ngc",
        "--pitch",
        0.2,
        "--contour-tool",
        1,
        "--pocket-tool",
        2,
        "--report",
        tmp_path / "r.json",
    )
    assert done.returncode == 0, done.stdout
    told = json.loads((tmp_path / "r.json").read_text())
    assert told["gouge"]["max_mm"] <= 1e-6
    assert [region["islands"] for region in told["regions"]] == [1, 0]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ("", "-o/--output is missing; name the folder to write to"),
        ("{fig2}", "-o/--output is missing"),
        ("{fig2} -o {tmp}/no/such", "there is no folder"),
        ("{fig2} -o {fig2}", "is no folder"),
        ("none.dxf -o {tmp}/a", "none.dxf does not exist"),
        ("{fig2} -o {tmp}/a --variant best", "choose one of"),
        ("{fig2} -o {tmp}/a --bitmap 9000", "use 16 to 8192 px"),
        ("{fig2} -o {tmp}/a --pitch 0.001", "8192 px are the most"),
        ("{fig2} -o {tmp}/a --contour-tool 0.1", "not wider than two pixels"),
        ("{fig2} -o {tmp}/a --stepover 0.01", "less than a pixel"),
        ("{fig2} -o {tmp}/a --threshold 3", "is no picture"),
        ("{picture} -o {tmp}/a", "does not say how large it is"),
        ("{picture} -o {tmp}/a --pitch 1 --dpi 100", "give one of them"),
        ("{picture} -o {tmp}/a --pitch 0.2 --bitmap 400", "a picture has its own pixels"),
        ("{picture} -o {tmp}/a --pitch 0.2 --threshold 300", "use 1 to 255"),
        ("{fig2} -o {tmp}/a --tool 1=flat:6", "--tool belongs to another text than A; give --text B"),
        ("--text D -o {tmp}/a --stock 0,0,-5,9,9,0", "--stock belongs to --text B; leave it out"),
        ("--text B -o {tmp}/a --tool 1=flat:6", "are those of a program of your own"),
        ("--text C {fig2} -o {tmp}/a", "fig2.dxf is no scene; text C is shown on one"),
        ("--text C -o {tmp}/a --units in", "a scene is in mm"),
        ("--text D {fig2} -o {tmp}/a", "fig2.dxf is a drawing, and an NC program is asked for"),
        ("--text B {picture} -o {tmp}/a", "is a picture, and an NC program is asked for"),
    ],
)
def test_mistakes_are_told_in_one_line(tmp_path: Path, picture: Path, arguments: str, words: str) -> None:
    done = call("stages", *arguments.format(fig2=FIG2, tmp=tmp_path, picture=picture).split())
    assert done.returncode == 2
    assert words in done.stderr
    assert len(without_how_far(done.stderr).strip().splitlines()) == 1
    assert not (tmp_path / "a").exists()


def test_a_program_that_does_not_tell_its_tool_is_shown_by_the_advice_it_gets(tmp_path: Path) -> None:
    (tmp_path / "own.ngc").write_text(
        "G21 G90 G94\nT1 M6\nS9000 M3\nG0 X0 Y0 Z5\nG1 Z-2 F100\nX20 Z-3 F400\nX40 Y10\nG0 Z5\nM30\n"
    )
    asked = ("stages", "--text", "B", tmp_path / "own.ngc", "-o", tmp_path / "film", "--quiet")
    refused = call(*asked)
    assert refused.returncode == 2 and "--tool 1=flat:6" in refused.stderr
    done = call(*asked, "--tool", "1=ball:6", "--stock", "-5,-5,-10,45,15,0")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "film" / "film.json").is_file()


def test_help_names_every_option_and_code() -> None:
    text = call("stages", "--help").stdout
    options = "--variant --bitmap --pitch --dpi --threshold --invert --despeckle --ink --report --quiet --overlap"
    assert all(option in text for option in options.split())
    assert "13 free curve" in text and "turns/NN_STEP_rR_tTTT.png" in text
    assert "stages [FILE] -o DIR" in call("--help").stdout
