"""Transforms of SVG elements as style sheets write them: units, the third dimension, properties of their own, and the
boxes that they turn about. What cannot be followed is missing and told, never read in a wrong place.
"""

import math

import pytest

from app.formats.drawing import Drawing
from app.formats.svg.svg import read_svg
from app.model.curves import Line, Point

SVG = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="50mm" viewBox="0 0 100 50">{}</svg>'
MM = 96 / 25.4
"""User units of a millimetre."""

PLACES: dict[str, Point] = {
    "transform:translate3d(5px,6px,7px)": (6, 8),
    "transform:translateX(5px)": (6, 2),
    "transform:TranslateY(5PX)": (1, 7),
    "transform:translateZ(5px)": (1, 2),
    "transform:translate(1mm,1cm)": (1 + MM, 2 + 10 * MM),
    "transform:translate(10%,10%)": (11, 7),
    "transform:translate(calc(1px + 10%))": (12, 2),
    "transform:scale3d(2,3,4)": (2, 6),
    "transform:scaleX(2)scaleY(3)": (2, 6),
    "transform:scale(200%)": (2, 4),
    "transform:rotate(0.25turn)": (-2, 1),
    "transform:rotate(100grad)": (-2, 1),
    f"transform:rotate({math.pi / 2}rad)": (-2, 1),
    "transform:rotateZ(90deg)": (-2, 1),
    "transform:rotate3d(0,0,-2,-90deg)": (-2, 1),
    "transform:matrix3d(1,2,0,0, 3,4,0,0, 0,0,1,0, 5,6,9,1)": (1 + 6 + 5, 2 + 8 + 6),
    "transform:matrix(1,0,0,1,5px,6px)": (6, 8),
    "transform:skew(45deg)": (3, 2),
    "transform:skew(0,45deg)": (1, 3),
    "transform:initial": (1, 2),
    "translate:5px": (6, 2),
    "translate:5px 10% 3px": (6, 7),
    "rotate:90deg": (-2, 1),
    "rotate:z 90deg": (-2, 1),
    "rotate:0 0 1 90deg": (-2, 1),
    "rotate:none": (1, 2),
    "scale:2": (2, 4),
    "scale:2 3": (2, 6),
    "translate:5px;rotate:90deg;scale:2;transform:translate(3px,0)": (5 - 4, 8),
    "transform:scale(2);transform-origin:center": (2 - 50, 4 - 25),
}
"""Where a style brings the point (1, 2), y downwards."""


def read(body: str) -> Drawing:
    return read_svg(SVG.format(body).encode(), "a.svg")


@pytest.mark.parametrize("style", PLACES)
def test_transforms_of_style_sheets(style: str) -> None:
    x, y = PLACES[style]
    (entity,) = read(f'<line x2="1" y2="2" stroke="red" style="{style}"/>').part.entities
    assert entity.curve.end == pytest.approx((x, 50 - y), abs=1e-9)


BOXES: dict[str, Point] = {
    "transform-box:fill-box;transform-origin:center": (30, 25),
    "transform-box:fill-box;transform-origin:100% 0": (40, 20),
    "transform-box:fill-box;transform-origin:2px 3px": (22, 23),
    "transform-box:fill-box": (20, 20),
    "transform-box:content-box;transform-origin:center": (30, 25),
    "transform-box:border-box;transform-origin:center": (30, 25),
    "transform-box:view-box;transform-origin:center": (50, 25),
    "": (0, 0),
}
"""About which point a rectangle from (20, 20) to (40, 30) is turned."""


@pytest.mark.parametrize("style", BOXES)
def test_boxes_that_transforms_turn_about(style: str) -> None:
    x, y = BOXES[style]
    drawing = read(f'<rect x="20" y="20" width="20" height="10" style="transform:rotate(180deg);{style}"/>')
    corner = drawing.part.entities[0].curve.start
    assert corner == pytest.approx((2 * x - 20, 50 - (2 * y - 20)), abs=1e-9)


def test_shares_of_a_move_are_of_the_box_that_is_meant() -> None:
    style = "transform:translate(50%,50%);transform-box:fill-box"
    (entity,) = read(f'<line x1="10" y1="10" x2="30" y2="20" stroke="red" style="{style}"/>').part.entities
    assert entity.curve == Line((20, 35), (40, 25))


@pytest.mark.parametrize(
    ("body", "end"),
    [
        ('<g transform="translate(10 20)"><text>A</text>{}</g>', (30, 30)),
        ('<g transform="scale(2)">{}</g>', (30, 20)),
        ('<g style="transform:translate(100%,0)">{}</g>', (30, 10)),
        ('<g transform="scale(2)"><g transform="translate(10 0)">{}</g></g>', (40, 20)),
        ('<g style="transform:scale(2);transform-origin:center"><a transform="scale(2)">{}</a></g>', (40, 30)),
        ('<defs><g id="a">{}</g></defs><use href="#a" x="5" transform="scale(2)"/>', (35, 20)),
        ('<g transform="scale(2)"><defs><circle r="99"/></defs>{}</g>', (30, 20)),
    ],
)
def test_groups_and_copies_turn_about_the_box_of_what_they_draw(body: str, end: Point) -> None:
    line = '<path d="M10 0L20 10" stroke="red"/>'
    drawing = read(f"<style>*{{transform-box:fill-box}}</style>{body.format(line)}")
    assert [each.curve.end for each in drawing.part.entities] == [pytest.approx((end[0], 50 - end[1]))]


@pytest.mark.parametrize(
    ("body", "what"),
    [
        ('<g transform="spin(3)"><circle r="9"/><circle r="8"/></g>', "spin(3)"),
        ('<circle r="9" style="transform:rotateX(30deg)"/>', "rotateX(30deg)"),
        ('<circle r="9" style="transform:perspective(9px)"/>', "perspective(9px)"),
        ('<circle r="9" style="rotate:x 30deg"/>', "rotateX(30deg)"),
        ('<circle r="9" transform="scale(2,2"/>', "scale(2,2"),
        ('<circle r="9" transform="rotate(5 5)"/>', "rotate(5 5)"),
        ('<circle r="9" style="transform:translate(5vw)"/>', "translate(5vw)"),
        (
            '<g style="transform:scale(2);transform-box:fill-box;transform-origin:center"><text>A</text></g>',
            "scale(2) about center",
        ),
        (
            '<g id="g" style="transform:scale(2);transform-box:fill-box"><use href="#g"/><use href="#g"/></g>',
            "scale(2)",
        ),
        (
            '<g style="transform:scale(2);transform-box:fill-box"><path d="M0 0L9 5" transform="rotate(30)"/></g>',
            "scale(2)",
        ),
    ],
)
def test_what_cannot_be_followed_is_missing_and_told(body: str, what: str) -> None:
    drawing = read(f'<line x2="9" stroke="red"/>{body}')
    counted = [each.text for each in drawing.findings if each.counts]
    assert len(drawing.part.entities) == 1 and len(counted) == 1
    assert counted[0].startswith("1 element is missing from the part") and what in counted[0]
    assert dict(drawing.left_out) == {"element of unreadable transform": 1}


def test_what_nobody_sees_may_be_anywhere() -> None:
    drawing = read('<line x2="9" stroke="red"/><g style="display:none" transform="spin(3)"><circle r="9"/></g>')
    assert not [each for each in drawing.findings if each.counts]


def test_a_symbol_that_is_nowhere_can_be_used_again() -> None:
    symbol = '<symbol id="s" transform="spin(3)"><circle r="9"/></symbol><use href="#s"/><use href="#s"/>'
    (found,) = [each for each in read(f'<line x2="9" stroke="red"/>{symbol}').findings if each.counts]
    assert found.amount == 2
