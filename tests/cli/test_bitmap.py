"""Options and findings of pictures, as a user of the command line meets them."""

import json
from pathlib import Path

import cv2
import numpy as np
import pytest

from tests.called import Called, call
from tests.conftest import ROOT
from tests.raster.test_doubts import plate
from tests.said import without_how_far

FIG2 = ROOT / "tests" / "data" / "dxf" / "fig2.dxf"


@pytest.mark.parametrize(
    "option",
    [("--invert",), ("--despeckle", 0), ("--despeckle", 4), ("--ink", "auto"), ("--dpi", 300), ("--threshold", 9)],
)
def test_options_of_pictures_are_refused_for_a_drawing(tmp_path: Path, option: tuple[object, ...]) -> None:
    done = call("make", FIG2, "-o", tmp_path / "o.ngc", *option)
    assert done.returncode == 2
    assert without_how_far(done.stderr) == f"hitofude: {option[0]}: fig2.dxf is no picture; leave the option away\n"


def made(tmp_path: Path, gray: np.ndarray) -> Called:
    path = tmp_path / "scan.png"
    cv2.imwrite(str(path), gray)
    return call(
        "make",
        path,
        "-o",
        tmp_path / "o.ngc",
        "--dpi",
        254,
        "--contour-tool",
        1,
        "--pocket-tool",
        2,
        "--report",
        tmp_path / "r.json",
    )


def test_a_gap_round_an_island_is_printed_first_and_counts(tmp_path: Path) -> None:
    done = made(tmp_path, plate(1, island=True))
    assert done.returncode == 1, done.stderr
    assert "  ! At column 150, row 50, (15.050, 24.950), a line ends short of another" in done.stdout


def test_an_open_line_round_an_island_is_among_the_open_contours(tmp_path: Path) -> None:
    done = made(tmp_path, plate(3, island=True))
    assert done.returncode == 1, done.stderr
    (told,) = json.loads((tmp_path / "r.json").read_text())["open_contours"]
    assert "its other end is at column 149, row 50" in told["text"]


def test_an_outline_with_a_gap_is_refused_with_its_place(tmp_path: Path) -> None:
    done = made(tmp_path, plate(1, island=False))
    assert done.returncode == 2
    assert "enclosed by lines. At column 150, row 50" in done.stderr
    assert len(without_how_far(done.stderr).splitlines()) == 1
