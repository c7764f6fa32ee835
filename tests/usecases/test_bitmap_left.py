"""Metal that pixels leave: a skin along walls is told apart, a passage that no path enters is metal left."""

from pathlib import Path

import ezdxf
import pytest
import shapely

from app.cli.main import main
from app.geometry.outlines import polygon_contour
from app.model.finding import FindingKind
from app.model.part import Contour
from app.usecases.making.make import MakeResult, finish
from tests.usecases.test_bitmap_way import job_of, made


def corners(corridor: float) -> list[tuple[float, float]]:
    """Two rooms of 30 mm, 30 mm apart, joined by a corridor."""
    a, b = 15 - corridor / 2, 15 + corridor / 2
    return [
        (0, 0),
        (30, 0),
        (30, a),
        (60, a),
        (60, 0),
        (90, 0),
        (90, 30),
        (60, 30),
        (60, b),
        (30, b),
        (30, 30),
        (0, 30),
    ]


def two_rooms(corridor: float) -> Contour:
    return polygon_contour(corners(corridor))


def cut_on_bitmap(contour: Contour, points: int) -> MakeResult:
    job = job_of([contour], 3.0, 6.0)
    return finish(made(job, points).program, job)


@pytest.mark.parametrize("corridor", [3.2, 3.7])
def test_a_corridor_that_no_path_enters_is_left(corridor: float) -> None:
    done = cut_on_bitmap(two_rooms(corridor), 400)
    assert done.coverage.reachable_left_mm2 == pytest.approx(30 * corridor, rel=0.1)
    (told,) = [finding for finding in done.findings if finding.kind is FindingKind.LEFT_REACHABLE]
    assert told.counts
    assert told.x is not None
    assert 30 < told.x < 60
    assert done.coverage.given_up_mm2 < 12


def test_the_same_corridor_on_finer_pixels_is_cut() -> None:
    done = cut_on_bitmap(two_rooms(3.7), 1600)
    assert done.coverage.reachable_left_mm2 == 0
    assert done.clean


def test_what_counts_as_skin_touches_the_cleared_floor_and_is_thin() -> None:
    done = cut_on_bitmap(two_rooms(8.0), 400)
    allowance = done.program.allowance_mm
    assert 0 < allowance <= 4 * done.program.pitch_mm + 1e-9
    for place in done.coverage.given_up:
        assert place.disc_mm <= 3 * allowance
        assert shapely.Polygon(place.outline).area < 30


def test_cut_knows_the_skin_from_the_header_and_agrees(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    drawing, program = tmp_path / "part.dxf", tmp_path / "part.ngc"
    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    document.modelspace().add_lwpolyline(corners(12.0), close=True)
    document.saveas(drawing)
    assert (
        main(["make", str(drawing), "-o", str(program), "--bitmap", "400", "--contour-tool", "3", "--pocket-tool", "6"])
        == 0
    )
    text = program.read_text()
    assert "Path made from pixels, nowhere nearer to the walls than asked by more than" in text
    assert "of the exact offset" not in text
    capsys.readouterr()
    assert main(["cut", str(program), "--against", str(drawing), "--grid", "200"]) == 0
    assert "the skin that paths made from pixels leave" in capsys.readouterr().out
    program.write_text("\n".join(line for line in text.splitlines() if "allowance_mm" not in line))
    assert main(["cut", str(program), "--against", str(drawing), "--grid", "200"]) == 1
