"""Clips, masks and edges of viewports: what they hide is told, what they leave whole is not."""

from __future__ import annotations

import pytest

from app.formats.drawing import Drawing
from app.formats.readers import read_drawing

SQUARE = '<rect x="10" y="10" width="20" height="20"/>'
CUT = "cut by a clip, a mask or the edge of a symbol"


def read(body: str) -> Drawing:
    page = '<svg xmlns="http://www.w3.org/2000/svg" width="100mm" height="100mm" viewBox="0 0 100 100">'
    return read_drawing("x.svg", f"{page}{body}</svg>".encode())


def clip(inner: str, attributes: str = "") -> str:
    return f'<clipPath id="c" {attributes}>{inner}</clipPath><g clip-path="url(#c)">{SQUARE}</g>'


def mask(inner: str, attributes: str = "") -> str:
    return f'<mask id="m" {attributes}>{inner}</mask><g mask="url(#m)">{SQUARE}</g>'


WHOLE = {
    "page": clip('<rect width="100" height="100"/>'),
    "same": clip(SQUARE),
    "none of that name": f'<g clip-path="url(#nowhere)">{SQUARE}</g>',
    "moved": clip('<rect width="10" height="10" transform="scale(5)"/>'),
    "copied": '<defs><circle id="d" cx="20" cy="20" r="15"/></defs>' + clip('<use href="#d"/>'),
    "unseen itself": clip('<rect width="50" height="50" fill="none"/>'),
    "hole elsewhere": clip('<path clip-rule="evenodd" d="M0 0h90v90h-90z M50 50h9v9h-9z"/>'),
    "mask of white": mask('<rect width="100" height="100" fill="#fff"/>'),
    "mask that is white": mask(SQUARE, 'fill="white"'),
    "mask of what is opaque": mask('<rect width="90" height="90" fill="#D9D9D9"/>', 'style="mask-type:alpha"'),
    "viewport": f'<svg width="50" height="50">{SQUARE}</svg>',
    "viewport that hides nothing": f'<svg width="20" height="20" overflow="visible">{SQUARE}</svg>',
    "symbol": f'<symbol id="s" viewBox="0 0 40 40">{SQUARE}</symbol><use href="#s" width="80" height="80"/>',
}


@pytest.mark.parametrize("body", WHOLE.values(), ids=WHOLE)
def test_a_clip_that_hides_nothing_is_not_told(body: str) -> None:
    drawing = read(body)
    assert len(drawing.part.entities) == 4 and not drawing.findings and not drawing.left_out


PARTLY = {
    "half": clip('<rect width="20" height="100"/>'),
    "middle": clip('<circle cx="20" cy="20" r="4"/>'),
    "two": clip('<rect width="15" height="100"/><rect x="25" width="15" height="100"/>'),
    "hole": clip('<path clip-rule="evenodd" d="M0 0h90v90h-90z M15 5h9v9h-9z"/>'),
    "one of two": '<clipPath id="d"><rect width="20" height="90"/></clipPath><g clip-path="url(#d)">'
    + clip('<rect width="90" height="90"/>')
    + "</g>",
    "share of each": clip('<rect width="1" height="1"/>', 'clipPathUnits="objectBoundingBox"'),
    "letters": clip('<text x="10" y="20">O</text>'),
    "itself": clip(SQUARE, 'clip-path="url(#c)"'),
    "form": f'<g style="clip-path: circle(4px)">{SQUARE}</g>',
    "shade": mask('<rect width="100" height="100" fill="url(#g)"/>'),
    "place of a mask": mask(
        '<rect width="99" height="99" fill="#fff"/>', 'maskUnits="userSpaceOnUse" x="0" y="0" width="20" height="20"'
    ),
    "viewport": f'<svg width="20" height="50">{SQUARE}</svg>',
    "symbol": f'<symbol id="s" viewBox="0 0 25 25">{SQUARE}</symbol><use href="#s" width="80" height="80"/>',
}


@pytest.mark.parametrize("body", PARTLY.values(), ids=PARTLY)
def test_a_clip_that_hides_a_part_is_a_finding(body: str) -> None:
    """The shape is read whole, which is not what is seen."""
    drawing = read(body)
    (found,) = drawing.findings
    assert len(drawing.part.entities) == 4 and found.counts and found.amount == 1 and CUT in found.text


def test_what_a_clip_hides_is_left_out() -> None:
    drawing = read(clip('<rect width="5" height="5"/>') + '<circle cx="70" cy="70" r="5"/>')
    assert len(drawing.part.entities) == 1 and dict(drawing.left_out) == {"rect (clipped away)": 1}


def test_an_outline_round_a_clip_that_lies_in_it_is_not_seen_but_an_area_is() -> None:
    body = clip('<circle cx="20" cy="20" r="4"/>').replace("<g ", '<g fill="none" stroke="red" ')
    assert dict(read(body + SQUARE).left_out) == {"rect (clipped away)": 1}
