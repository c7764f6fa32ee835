"""Path data of SVG: how numbers are parted, and that many Béziers are moved as each alone."""

import pytest

from app.formats.svg.joined import beziers_joined, joined
from app.formats.svg.path import read_path
from app.geometry.affine import Affine, transformed


@pytest.mark.parametrize(
    ("data", "ends"),
    [
        ("M0 0l1 23", [(1, 23)]),
        ("M0 0l123", []),
        ("M0 0L12.5.5", [(12.5, 0.5)]),
        ("M0 0l1-2-3 4", [(1, -2), (-2, 2)]),
        ("M0 0h5v12", [(5, 0), (5, 12)]),
        ("M0 0h", []),
        ("M0 0L1e1,2e0 3", [(10, 2)]),
        ("M0 0q1 1 2 2 3", [(2, 2)]),
    ],
)
def test_numbers_without_blanks_are_parted_as_svg_says_and_never_otherwise(
    data: str, ends: list[tuple[float, float]]
) -> None:
    """123 is no 1 and 23 although two numbers are expected."""
    path = read_path(data, 1000)
    assert [curve.end for run in path.runs for curve in run] == ends


def test_beziers_that_are_moved_together_are_moved_as_each_alone() -> None:
    to = Affine(0.7, -0.2, 0.31, 1.1, 5.5, -3.3)
    (run,) = read_path("M0 0" + "".join(f"c{k} .1 .3 .7 {k % 3}.1 {k % 7}" for k in range(90)), 1000).runs
    moved = [transformed(curve, to) for curve in run]
    assert joined(moved) == [transformed(curve, to) for curve in beziers_joined(run)]
