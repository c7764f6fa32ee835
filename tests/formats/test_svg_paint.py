"""What an SVG paints and how: borders of filled paths, outlines that are areas, what moves a shape by a style."""

import pytest

from app.formats.drawing import Drawing
from app.formats.svg.svg import read_svg
from app.model.curves import Line

PAGE = 'width="100mm" height="50mm" viewBox="0 0 100 50" xmlns="http://www.w3.org/2000/svg"'
OUTER, INNER, REVERSED = "M0 0h30v30h-30z", "M5 5h20v20h-20z", "M5 5v20h20v-20z"


def read(body: str, page: str = PAGE) -> Drawing:
    return read_svg(f"<svg {page}>{body}</svg>".encode(), "a.svg")


def count(body: str) -> int:
    return len(read(body).part.entities)


def test_a_ring_that_both_sides_of_are_painted_bounds_nothing() -> None:
    drawing = read(f'<path d="{OUTER}{INNER}"/>')
    assert len(drawing.part.entities) == 4
    assert [each.text for each in drawing.findings] == [
        "1 outline lies within the area that the path paints (fill-rule: nonzero) and cannot be seen; left out."
    ]


@pytest.mark.parametrize(
    "body",
    [
        f'<path d="{OUTER}{REVERSED}"/>',
        f'<path fill-rule="evenodd" d="{OUTER}{INNER}"/>',
        f'<g style="fill-rule:evenodd"><path d="{OUTER}{INNER}"/></g>',
        f'<path d="{OUTER}{INNER}" stroke="red"/>',
        f'<path d="{OUTER}"/><path d="{INNER}"/>',
        f'<path d="{OUTER}M20 20h20v20h-20z"/>',
    ],
)
def test_rings_that_can_be_seen_are_read(body: str) -> None:
    assert count(body) == 8


def test_an_island_within_a_hole_is_a_border() -> None:
    assert count(f'<path d="{OUTER}{REVERSED}M10 10h9v9h-9z M12 12h2v2h-2z"/>') == 12


def test_squares_edge_to_edge_are_all_read() -> None:
    """As codes of squares are written; the one in the middle lies within what is painted, and its edges are others'."""
    squares = "".join(f"M{x} {y}h1v1h-1z" for x in range(3) for y in range(3))
    assert count(f'<path d="{squares}"/>') == 36


def test_outlines_that_are_areas_are_told_with_their_widths() -> None:
    body = (
        '<g fill="none" stroke="red" stroke-width="2"><path d="M10 10h9"/><path d="M10 20h9" transform="scale(2)"/>'
        '<path d="M10 30h9" stroke-width="1"/><path d="M9 9h9" vector-effect="non-scaling-stroke"/></g>'
    )
    (found,) = read(body).findings
    assert found.text.startswith(
        "2 outlines on layer 0, the first at (10.000, 40.000), are drawn 2 to 4 mm wide; their middle lines are read."
    )
    assert not found.counts
    assert not read('<path d="M10 10h9" stroke="red"/>').findings  # no width is said


@pytest.mark.parametrize(
    ("body", "count"),
    [
        ('<rect width="9" height="9" filter="url(#f)"/>', 1),
        ('<g style="filter:blur(2px)"><rect width="9" height="9"/><path d="M10 10h9" stroke="red"/></g>', 2),
        ('<rect width="9" height="9" filter="none"/>', 0),
        ('<rect width="9" height="9" filter="initial"/>', 0),
        ('<rect width="9" height="9" filter="url(#f)" style="filter:unset"/>', 0),
        ('<g filter="url(#f)"><rect width="9" height="9" filter="initial"/></g>', 1),
    ],
)
def test_filters_are_told_and_what_they_are_laid_on_is_read(body: str, count: int) -> None:
    drawing = read(body)
    shapes = "1 shape has" if count == 1 else f"{count} shapes have"
    expected = [f"{shapes} a filter such as a blur or a shadow, which is not read."] * bool(count)
    assert drawing.part.entities and [each.text for each in drawing.findings] == expected


@pytest.mark.parametrize("word", ["initial", "unset", "UNSET", "revert"])
@pytest.mark.parametrize("name", ["filter", "clip-path", "mask", "opacity", "offset-path", "marker"])
def test_words_that_take_back_what_is_said_of_a_shape_are_told_as_nothing(name: str, word: str) -> None:
    drawing = read(f'<rect width="9" height="9" style="{name}:{word}"/>')
    assert drawing.part.entities and not drawing.findings


@pytest.mark.parametrize("tag", ["animate", "animateTransform", "animateMotion", "set", "script"])
@pytest.mark.parametrize("way", ['<rect width="9" height="9">{}</rect>', '<rect width="9" height="9"/>{}'])
def test_what_would_change_the_picture_while_it_is_looked_at_is_told(tag: str, way: str) -> None:
    (found,) = read(way.format(f"<{tag}/>")).findings
    assert found.text == f"Left out: 1 {tag}." and not found.counts


def test_what_is_drawn_on_outlines_is_told() -> None:
    body = (
        '<pattern id="p"><circle r="1"/></pattern><g stroke="red" fill="none">'
        '<path d="M10 10h9" stroke-dasharray="2 1"/><path d="M10 12h9" style="marker:url(#m)"/>'
        '<path d="M10 14h9" stroke-dasharray="0"/><path d="M10 16h9v9z" fill="url(#p)" stroke-width="0"/></g>'
    )
    assert [each.text for each in read(body).findings] == [
        "1 shape has a dashed outline, which is read whole.",
        "1 shape has markers such as arrowheads, which are not read.",
        "1 shape has a pattern as its filling, which is not read.",
        "1 shape has an outline of width 0, which is read though nobody sees it.",
    ]


@pytest.mark.parametrize(
    ("body", "what"),
    [
        ('<rect width="9" height="9" style="offset-path:path(\'M0 0h9\')"/>', "offset-path"),
        ('<style>path{d:path("M0 0h1v1z")}</style><path d="M0 0h9v9z"/>', "d"),
    ],
)
def test_a_place_or_form_that_is_not_followed_is_a_finding(body: str, what: str) -> None:
    (found,) = read(body).findings
    assert found.counts and f"moved or formed by {what}, which is not followed" in found.text


def test_what_lies_in_another_file_is_missing_from_the_part() -> None:
    (found,) = read(f'<path d="{OUTER}"/><use href="other.svg#a"/>').findings
    assert found.counts and found.text.startswith("Missing from the part: 1 use of what is not in the file,")


def test_a_transform_of_the_page_is_a_finding() -> None:
    assert read(f'<path d="{OUTER}"/>', f'{PAGE} transform="rotate(90)"').findings[0].counts
    assert not read(f'<path d="{OUTER}"/>', f'{PAGE} transform="matrix(1,0,0,1,0,0)"').findings


@pytest.mark.parametrize("origin", ["20px 10px", "20% 20%", "20 10", "20px 20%"])
def test_transforms_about_a_place(origin: str) -> None:
    line = f'<line x1="20" y1="10" x2="30" y2="10" stroke="red" transform-origin="{origin}" transform="rotate(90)"/>'
    (entity,) = read(line).part.entities
    assert entity.curve == Line((20, 40), (20, 30))


@pytest.mark.parametrize(("origin", "x", "y"), [("center", 50, 25), ("top left", 0, 0), ("right", 100, 25)])
def test_transforms_about_a_named_place(origin: str, x: float, y: float) -> None:
    body = f'<line x2="9" y2="9" stroke="red" style="transform:scale(2);transform-origin:{origin}"/>'
    (entity,) = read(body).part.entities
    assert entity.curve == Line((-x, 50 + y), (18 - x, 32 + y))


MOVED = 'width="100mm" height="50mm" viewBox="-10 0 200 100" xmlns="http://www.w3.org/2000/svg"'
GROUND = '<rect x="-10" width="100%" height="100%" fill="{}"/>'


@pytest.mark.parametrize("fill", ["white", "#FFF", "rgb(255,255,255)"])
def test_the_white_ground_of_a_page_is_no_outline(fill: str) -> None:
    drawing = read(f'{GROUND.format(fill)}<circle cx="9" cy="9" r="4"/>', MOVED)
    assert len(drawing.part.entities) == 1
    assert dict(drawing.left_out) == {"shape (white ground of the page)": 1}


@pytest.mark.parametrize(
    "body",
    [
        GROUND.format("white"),
        GROUND.format("black") + "<g/>",
        GROUND.format('white" stroke="red'),
        GROUND.format('white" transform="scale(0.9)'),
    ],
)
def test_other_areas_as_large_as_the_page_are_read(body: str) -> None:
    more = '<circle cx="9" cy="9" r="4"/>' if body != GROUND.format("white") else ""
    drawing = read(body + more, MOVED)
    told = [each for each in drawing.findings if "as large as the page" in each.text]
    assert len(drawing.part.entities) == 4 + bool(more) and len(told) == ("black" in body)


@pytest.mark.parametrize(
    "disc", ['<circle cx="40" cy="50" r="50" {}/>', '<ellipse cx="90" cy="50" rx="100" ry="50" {}/>']
)
def test_a_white_disc_as_large_as_the_page_is_a_shape(disc: str) -> None:
    """It does not cover the page's corners: a coaster, a badge."""
    body = disc.format('fill="white"') + '<rect x="30" y="40" width="9" height="4"/>'
    square = 'width="50mm" height="50mm" viewBox="-10 0 100 100" xmlns="http://www.w3.org/2000/svg"'
    drawing = read(body, MOVED if "ellipse" in disc else square)
    assert len(drawing.part.entities) == 5 and not drawing.left_out


def test_shapes_beyond_the_page_are_told() -> None:
    body = '<circle cx="9" cy="9" r="4"/><circle cx="-15" cy="9" r="4"/><circle cx="9" cy="120" r="4"/>'
    drawing = read(body + '<circle cx="190" cy="99" r="4"/>', MOVED)
    (found,) = [each for each in drawing.findings if "beyond the page" in each.text]
    assert len(drawing.part.entities) == 4 and found.amount == 2 and not found.counts
