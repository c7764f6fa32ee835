"""Pictures: true arcs where they belong, y up, every kind of path in its own line style, and PNG pixels in their
colours.
"""

from __future__ import annotations

import math
import re
from xml.etree import ElementTree

import cv2
import numpy as np

from app.formats.plot.picture import CONTOUR, LINK, POCKET, RAPID, PathPicture, layout
from app.formats.plot.picture_svg import path_data, svg
from app.formats.plot.plot import plot
from app.geometry.primitives import contour_rows
from app.model.curves import Arc, Circle, Line
from app.model.part import Contour

SVG = "{http://www.w3.org/2000/svg}"
OUTLINE = Contour(
    (
        Line((0.0, 0.0), (40.0, 0.0)),
        Arc((40.0, 0.0), (40.0, 20.0), (40.0, 10.0)),
        Line((40.0, 20.0), (0.0, 20.0)),
        Line((0.0, 20.0), (0.0, 0.0)),
    )
)


def picture() -> PathPicture:
    return PathPicture(
        title="plate <1>",
        contours=(contour_rows(OUTLINE),),
        paths=(
            (RAPID, contour_rows(Contour((Line((0.0, 30.0), (20.0, 30.0)),)))),
            (LINK, contour_rows(Contour((Line((10.0, 5.0), (20.0, 5.0)),)))),
            (POCKET, contour_rows(Contour((Circle((20.0, 10.0), 4.0),)))),
            (CONTOUR, contour_rows(Contour((Line((3.0, 3.0), (37.0, 3.0)),)))),
        ),
        plunges=np.array([[10.0, 5.0]]),
        left=(np.array([[30.0, 14.0], [34.0, 14.0], [34.0, 17.0]]),),
        unreachable=(np.array([[0.0, 18.0], [2.0, 20.0], [0.0, 20.0]]),),
    )


def test_the_svg_is_well_formed_and_each_kind_has_its_line() -> None:
    root = ElementTree.fromstring(svg(picture()))
    group = root.find(f"{SVG}g")
    assert group is not None
    paths = {path.get("id"): path for path in group.iter(f"{SVG}path") if path.get("id")}
    assert {"part", "rapid", "link", "pocket", "contour", "left", "unreachable", "area"} == set(paths)
    assert paths["pocket"].get("stroke") == "#009E73"
    assert paths["contour"].get("stroke") == "#E69F00"
    assert [name for name, path in paths.items() if path.get("stroke-dasharray")] == ["rapid", "contour"]
    assert root.findtext(f"{SVG}title") == "plate <1>"
    assert {"Part", "Pocket", "Contour", "Rapid", "Link", "Plunge", "Left, within reach"} <= {
        text.text for text in root.iter(f"{SVG}text")
    }


def test_y_is_up_and_arcs_are_arcs() -> None:
    text = svg(picture())
    scale, minus = re.search(r"matrix\(([\d.]+) 0 0 (-[\d.]+)", text).groups()  # type: ignore[union-attr]
    assert float(scale) == -float(minus) > 0
    assert path_data(contour_rows(OUTLINE)) == "M0 0L40 0A10 10 0 0 1 50 10A10 10 0 0 1 40 20L0 20L0 0"
    clockwise = contour_rows(Contour((Arc((0.0, 1.0), (1.0, 0.0), (0.0, 0.0), ccw=False),)))
    assert path_data(clockwise) == "M0 1A1 1 0 0 0 1 0"


def test_path_data_keeps_full_circles_and_big_arcs_unambiguous() -> None:
    for data in (
        path_data(contour_rows(Contour((Circle((0.0, 0.0), 2.0),)))),
        path_data(np.array([[2, 0, 2, 0, 0, 0, 2, 1.0]])),
    ):
        ends = [tuple(map(float, end)) for end in re.findall(r"A\S+ \S+ 0 0 1 (\S+) ([\d.-]+)", data)]
        steps = [math.dist(a, b) for a, b in zip([(2.0, 0.0), *ends], ends, strict=False)]
        assert len(ends) >= 2
        assert all(0 < step <= 4 + 1e-9 for step in steps)
        assert math.dist(ends[-1], (2.0, 0.0)) < 1e-6


def test_png_shows_the_same_things_in_the_same_places() -> None:
    shown = picture()
    image = cv2.imdecode(np.frombuffer(plot(shown, ".png"), np.uint8), cv2.IMREAD_COLOR)
    place = layout(shown)
    assert image.shape == (place.height, 1600, 3)

    def colour(x: float, y: float) -> np.ndarray:
        column, row = place.pixels(np.array([[x, y]]))[0]
        around = image[round(row) - 1 : round(row) + 2, round(column) - 1 : round(column) + 2].reshape(-1, 3)
        return around[np.argmin(around.astype(int).sum(axis=1))][::-1].astype(int)

    assert np.abs(colour(24, 10) - (0, 0x9E, 0x73)).max() < 60
    assert np.abs(colour(33.5, 15) - (0x29, 0x79, 0xFF)).max() < 12
    assert np.abs(colour(50, 10) - (0x1E, 0x22, 0x27)).max() < 60
    assert np.abs(colour(20, 17) - (0xF1, 0xF2, 0xEE)).max() < 4
    assert np.abs(colour(45, 25) - (0xFA, 0xFA, 0xF8)).max() < 4


def test_a_picture_of_nothing_is_still_a_picture() -> None:
    empty = PathPicture("nothing", (), (), np.zeros((0, 2)))
    assert plot(empty, ".png").startswith(b"\x89PNG")
    ElementTree.fromstring(plot(empty, ".svg"))
