"""SVG in: every kind of element, transforms, units, viewports, layers, and what is left out."""

import math

import pytest

from app.core.errors import InputError
from app.formats.drawing import Drawing
from app.formats.readers import read_drawing
from app.formats.svg.svg import read_svg
from app.model.curves import Arc, Circle, Curve, Ellipse, Line, Point, Spline
from app.model.finding import FindingKind
from app.model.part import Layer, Units
from app.model.read_options import DrawingOptions

PIXEL = 25.4 / 96
NAMESPACES = (
    'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
    'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape" '
    'xmlns:sodipodi="http://sodipodi.sourceforge.net/DTD/sodipodi-0.dtd"'
)
PAGE = 'width="100mm" height="100mm" viewBox="0 0 100 100"'


def read(body: str, page: str = PAGE, units: Units | None = None, layers: tuple[str, ...] = ()) -> Drawing:
    return read_svg(f"<svg {NAMESPACES} {page}>{body}</svg>".encode(), "part.svg", units, layers)


def curves(body: str, page: str = PAGE) -> list[Curve]:
    return [entity.curve for entity in read(body, page).part.entities]


def one(body: str, page: str = PAGE) -> Curve:
    (curve,) = curves(body, page)
    return curve


def path(d: str) -> list[Curve]:
    """Curves of path data, y downwards as in the file."""
    return curves(f'<path d="{d}" stroke="red" transform="matrix(1 0 0 -1 0 100)"/>')


def near(p: Point) -> object:
    return pytest.approx(p, abs=1e-12)


def test_the_lower_edge_of_the_page_is_zero_and_y_points_up() -> None:
    assert one('<line x1="10" y1="90" x2="30" y2="80" stroke="red"/>') == Line((10, 10), (30, 20))


@pytest.mark.parametrize(
    ("width", "mm", "shown"),
    [
        ("254mm", 254, Units.MM),
        ("25.4cm", 254, Units.CM),
        ("10in", 254, Units.INCH),
        ("720pt", 254, Units.MM),
        ("60pc", 254, Units.MM),
        ("1016Q", 254, Units.MM),
    ],
)
def test_a_page_with_units_has_its_real_size(width: str, mm: float, shown: Units) -> None:
    drawing = read(
        '<line x2="500" y1="1000" y2="1000" stroke="red"/>', f'width="{width}" height="{width}" viewBox="0 0 1000 1000"'
    )
    assert drawing.units_named and drawing.part.units is shown and not drawing.findings
    assert drawing.part.entities[0].curve.end == pytest.approx((mm / 2, 0))


@pytest.mark.parametrize(
    "page",
    [
        'width="96" height="96"',
        'width="96px" height="96px" viewBox="0 0 48 48"',
        'viewBox="0 0 96 96"',
        'width="100%" height="100%" viewBox="0 0 96 96"',
        'width="96" viewBox="0 0 48 48"',
    ],
)
def test_pixels_are_96_to_the_inch_and_that_is_said(page: str) -> None:
    drawing = read('<line x2="48" y1="48" y2="48" stroke="red"/>', page)
    scale = 2 if "48 48" in page else 1
    assert not drawing.units_named and drawing.part.entities[0].curve.end == pytest.approx(
        (12.7 * scale, 12.7 if scale == 1 else 0)
    )
    assert [f.kind for f in drawing.findings] == [FindingKind.UNITS_ASSUMED] and not drawing.findings[0].counts


@pytest.mark.parametrize("page", ['width="96" height="96"', 'width="200" height="200" viewBox="0 0 96 96"'])
def test_units_given_are_those_of_a_user_unit(page: str) -> None:
    drawing = read('<line x2="48" y1="96" y2="96" stroke="red"/>', page, Units.INCH)
    assert drawing.part.entities[0].curve.end == pytest.approx((48 * 25.4, 0))
    assert drawing.part.units is Units.INCH and not drawing.units_named and not drawing.findings


def test_a_page_without_viewbox_is_in_pixels() -> None:
    assert one('<line x2="96" stroke="red"/>', 'width="100mm" height="50mm"') == Line((0, 50), (25.4, 50))


def test_a_viewbox_is_moved_scaled_and_centred() -> None:
    body = '<line x1="10" y1="20" x2="20" y2="30" stroke="red"/>'
    assert one(body, 'width="10mm" height="10mm" viewBox="10 20 10 10"') == Line((0, 10), (10, 0))
    assert one(body, 'width="40mm" height="10mm" viewBox="10 20 10 10"') == Line((15, 10), (25, 0))
    assert one(body, 'width="40mm" height="10mm" viewBox="10 20 10 10" preserveAspectRatio="xMaxYMid meet"') == Line(
        (30, 10), (40, 0)
    )
    assert one(body, 'width="40mm" height="10mm" viewBox="10 20 10 10" preserveAspectRatio="xMinYMin slice"') == Line(
        (0, 10), (40, -30)
    )
    assert one(body, 'width="40mm" height="10mm" viewBox="10 20 10 10" preserveAspectRatio="none"') == Line(
        (0, 10), (40, 0)
    )


def test_lines_of_every_command() -> None:
    a, b, c, d = (10.0, 10.0), (20.0, 10.0), (20.0, 15.0), (10.0, 15.0)
    ring = [Line(a, b), Line(b, c), Line(c, d), Line(d, a)]
    for text in (
        "M10 10H20V15H10Z",
        "m10 10h10v5h-10z",
        "M10,10 20,10 20,15 10,15 10,10",
        "m10 10 10 0 0 5-10 0z",
        "M1e1+10L.2e2 10 20 15L10 15z",
    ):
        assert path(text) == ring, text


def test_numbers_in_every_spelling() -> None:
    """A full stop at the end, none before it, no blanks, flags run together."""
    assert path("M1.5.5.5.5") == [Line((1.5, 0.5), (0.5, 0.5))]
    assert path("M5. 6.L-7.-8.") == [Line((5, 6), (-7, -8))]
    (arc,) = path("M0 0a5 5 0 0110 0")
    assert isinstance(arc, Arc) and arc.end == near((10, 0))


def test_a_new_run_begins_where_the_last_was_closed() -> None:
    assert path("M1 1L5 1L5 5Zl-1 0")[-1] == Line((1, 1), (0, 1))
    assert path("m1 1l4 0 0 4zm10 10l1 0")[-1] == Line((11, 11), (12, 11))


def test_beziers_are_exact_and_one_spline_a_run() -> None:
    (cubic,) = path("M0 0C0 10 10 10 10 0S20-10 20 0s10 10 10 0")
    assert cubic == Spline(
        3,
        ((0, 0), (0, 10), (10, 10), (10, 0), (10, -10), (20, -10), (20, 0), (20, 10), (30, 10), (30, 0)),
        (0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3),
    )
    (quadratic,) = path("M0 0Q5 10 10 0T20 0t10 0")
    assert quadratic == Spline(
        2, ((0, 0), (5, 10), (10, 0), (15, -10), (20, 0), (25, 10), (30, 0)), (0, 0, 0, 1, 1, 2, 2, 3, 3, 3)
    )
    assert [type(c) for c in path("M0 0Q5 10 10 0L20 0C0 0 1 1 5 5")] == [Spline, Line, Spline]


def test_a_smooth_command_after_another_kind_has_no_handle() -> None:
    (curve,) = path("M0 0S5 5 10 0")
    assert isinstance(curve, Spline) and curve.control_points == ((0, 0), (0, 0), (5, 5), (10, 0))
    curve = path("M0 0Q5 10 10 0S15 5 20 0")[1]
    assert isinstance(curve, Spline) and curve.control_points[1] == (10, 0)


@pytest.mark.parametrize(("flags", "height"), [("0 1", 4), ("1 0", 4), ("0 0", -4), ("1 1", -4)])
def test_arcs_by_their_flags(flags: str, height: float) -> None:
    """Ends 6 apart on a radius of 5: the centre lies 4 off the chord. The first flag asks for the larger part; y is
    downwards.
    """
    (arc,) = path(f"M 0 0 A 5 5 0 {flags} 6 0")
    assert isinstance(arc, Arc) and (arc.start, arc.end) == ((0, 0), (6, 0)) and arc.centre == near((3, height))
    assert arc.ccw is (flags[-1] == "1") and (abs(arc.sweep) > math.pi) is (flags[0] == "1")


def test_radii_too_small_grow() -> None:
    (arc,) = path("M 0 0 A 1 1 0 0 1 10 0")
    assert arc == Arc((0, 0), (10, 0), (5, 0), True)
    (part,) = path("M 0 0 A 1 2 90 0 1 10 0")
    assert isinstance(part, Ellipse) and part.centre == near((5, 0)) and math.hypot(*part.major) == pytest.approx(5)
    assert part.ratio == pytest.approx(0.5)


def test_an_arc_without_radius_is_a_line_and_one_without_length_is_nothing() -> None:
    assert path("M0 0A0 5 0 0 1 10 0") == [Line((0, 0), (10, 0))]
    assert path("M0 0A5 5 0 0 1 0 0L10 0") == [Line((0, 0), (10, 0))]


def test_a_circle_of_arcs_is_a_circle() -> None:
    for d in ("M10 5A5 5 0 0 1 0 5A5 5 0 0 1 10 5Z", "M10 5a5 5 0 0 1-5 5a5 5 0 0 1-5-5a5 5 0 0 1 5-5a5 5 0 0 1 5 5z"):
        (circle,) = path(d)
        assert (
            isinstance(circle, Circle)
            and circle.ccw
            and circle.centre == near((5, 5))
            and circle.radius == pytest.approx(5)
        )
    (ellipse,) = path("M10 5A5 3 0 0 0 0 5A5 3 0 0 0 10 5Z")
    assert isinstance(ellipse, Ellipse) and ellipse.end_parameter - ellipse.start_parameter == pytest.approx(math.tau)


def test_basic_shapes() -> None:
    assert one('<circle cx="50" cy="40" r="7"/>') == Circle((50, 60), 7)
    ellipse = one('<ellipse cx="50" cy="40" rx="7" ry="14"/>')
    assert isinstance(ellipse, Ellipse) and ellipse.centre == (50, 60) and ellipse.ratio == pytest.approx(0.5)
    assert abs(ellipse.major[1]) == pytest.approx(14)
    assert one('<ellipse cx="50" cy="40" rx="7"/>') == Circle((50, 60), 7)
    assert (
        len(curves('<polygon points="0,0 10,0 10,10"/>')) == 3
        and len(curves('<polyline points="0,0 10,0 10,10" stroke="red"/>')) == 2
    )
    assert curves('<rect x="10" y="20" width="30" height="40"/>') == [
        Line((10, 80), (40, 80)),
        Line((40, 80), (40, 40)),
        Line((40, 40), (10, 40)),
        Line((10, 40), (10, 80)),
    ]


def test_rounded_rectangles() -> None:
    made = curves('<rect x="10" y="20" width="30" height="40" rx="5"/>')
    assert [type(c) for c in made] == [Line, Arc] * 4
    assert made[1] == Arc((35, 80), (40, 75), (35, 75), False)
    assert all(a.end == near(b.start) for a, b in zip(made, [*made[1:], made[0]], strict=True))
    made = curves('<rect x="10" y="20" width="30" height="40" rx="5" ry="8"/>')
    assert [type(c) for c in made] == [Line, Ellipse] * 4
    assert all(a.end == near(b.start) for a, b in zip(made, [*made[1:], made[0]], strict=True))
    assert one('<rect width="30" height="30" rx="50"/>') == Circle((15, 85), 15, False)


def test_percentages_are_of_the_viewport() -> None:
    page = 'width="200mm" height="100mm" viewBox="0 0 200 100"'
    assert one('<line x1="10%" y1="10%" x2="50%" y2="100%" stroke="red"/>', page) == Line((20, 90), (100, 0))
    circle = one('<circle r="10%"/>', page)
    assert isinstance(circle, Circle) and circle.radius == pytest.approx(0.1 * math.hypot(200, 100) / math.sqrt(2))
    nested = one('<svg width="50%" height="50%" viewBox="0 0 10 5"><line x2="100%" stroke="red"/></svg>', page)
    assert nested == Line((0, 100), (100, 100))


def test_lengths_with_units_are_in_pixels_of_the_page() -> None:
    assert one('<line x2="1in" stroke="red"/>', 'width="96mm" height="1mm" viewBox="0 0 96 1"').end == near((96, 1))


TRANSFORMS = {
    "translate(10)": (11, 2),
    "translate(10 20)": (11, 22),
    "scale(2)": (2, 4),
    "scale(2,-3)": (2, -6),
    "rotate(90)": (-2, 1),
    "rotate(90,1,0)": (-1, 0),
    "skewX(45)": (3, 2),
    "skewY(45)": (1, 3),
    "matrix(1,2,3,4,5,6)": (1 + 6 + 5, 2 + 8 + 6),
    "translate(10) , scale(2)": (12, 4),
    " scale(2)translate(10)": (22, 4),
    "none": (1, 2),
    "": (1, 2),
}


@pytest.mark.parametrize("text", TRANSFORMS)
def test_transforms(text: str) -> None:
    line = one(f'<line x2="1" y2="2" stroke="red" transform="{text}"/>')
    x, y = TRANSFORMS[text]
    assert line.end == near((x, 100 - y))


@pytest.mark.parametrize(
    "style", ["transform: translate(10px, 20px) rotate(90deg)", "transform:matrix(0,1,-1,0,10,20);transform-origin:0 0"]
)
def test_transforms_in_a_style(style: str) -> None:
    assert one(f'<line x2="1" stroke="red" transform="scale(9)" style="{style}"/>') == Line((10, 80), (10, 79))
    assert one(f'<g style="{style}"><line x2="1" stroke="red"/></g>') == Line((10, 80), (10, 79))


def test_groups_nest() -> None:
    inner = '<line x1="1" x2="2" stroke="red" transform="translate(0,5)"/>'
    line = one(f'<g transform="translate(10,0)"><g transform="scale(2)">{inner}</g></g>')
    assert line == Line((12, 90), (14, 90))


def test_mirrored_and_stretched_arcs() -> None:
    turned = one('<path stroke="red" d="M5 0A5 5 0 0 1 0 5" transform="rotate(30)scale(2)"/>')
    assert isinstance(turned, Arc) and turned.radius == pytest.approx(10) and not turned.ccw
    mirrored = one('<path stroke="red" d="M5 0A5 5 0 0 1 0 5" transform="scale(-1,1)"/>')
    assert isinstance(mirrored, Arc) and mirrored.ccw and mirrored.end == near((0, 95))
    stretched = one('<path stroke="red" d="M5 0A5 5 0 0 1 0 5" transform="scale(2,1)"/>')
    assert isinstance(stretched, Ellipse) and stretched.start == near((10, 100)) and stretched.end == near((0, 95))
    skewed = one('<circle r="5" transform="skewX(30)"/>')
    assert isinstance(skewed, Ellipse)
    t = math.tan(math.radians(30))
    for k in range(12):
        x, y = skewed.at(k * math.tau / 12)
        assert math.hypot(x - t * (100 - y), 100 - y) == pytest.approx(5)


def test_use_copies_with_its_place_and_its_style() -> None:
    body = '<defs><line id="a" x2="5"/></defs><use {}="#a" x="10" y="20" stroke="red" transform="scale(2)"/>'
    for link in ("href", "xlink:href"):
        assert one(body.format(link)) == Line((20, 60), (30, 60))


def test_use_of_a_symbol_fits_its_viewbox() -> None:
    body = (
        '<symbol id="s" viewBox="0 0 10 10"><line x2="10" y2="10" stroke="red"/></symbol>'
        '<use href="#s" x="5" y="5" width="20" height="20"/>'
    )
    assert one(body) == Line((5, 95), (25, 75))


def test_use_of_groups_in_groups() -> None:
    body = (
        '<g id="a"><circle r="1"/></g><g id="b"><use href="#a" x="10"/><use href="#a" x="20"/></g><use href="#b" '
        'y="50"/>'
    )
    assert [c.centre for c in curves(body) if isinstance(c, Circle)] == [
        (0, 100),
        (10, 100),
        (20, 100),
        (10, 50),
        (20, 50),
    ]


def test_nested_viewports() -> None:
    body = '<svg x="10" y="20" width="40" height="20" viewBox="0 0 10 10"><line x2="10" y2="10" stroke="red"/></svg>'
    assert one(body) == Line((20, 80), (40, 60))
    assert one('<svg x="10" y="20"><line x2="10" stroke="red"/></svg>') == Line((10, 80), (20, 80))


def test_what_is_not_drawn_is_not_read() -> None:
    tags = ("defs", "symbol", "clipPath", "mask", "marker", "pattern", "metadata", "unknown")
    body = "".join(f'<{tag}><circle r="1"/></{tag}>' for tag in tags)
    drawing = read(body + '<circle r="2"/>')
    assert len(drawing.part.entities) == 1 and drawing.left_out == ()


def test_what_is_left_out_is_counted() -> None:
    body = (
        '<text>a</text><text>b<tspan>c</tspan></text><image/><g display="none"><rect width="1" height="1"/><circle '
        'r="1"/></g>'
        '<g visibility="hidden"><circle r="1"/><circle r="3" visibility="visible"/></g><circle r="1" fill="none"/>'
        '<use href="#nowhere"/><use href="other.svg#a"/><circle r="x"/><path d="M0 0L1e9 0"/>'
    )
    drawing = read(body)
    assert [e.curve for e in drawing.part.entities] == [Circle((0, 100), 3)]
    assert dict(drawing.left_out) == {
        "text": 2,
        "image": 1,
        "rect (invisible)": 1,
        "circle (invisible)": 2,
        "circle (without stroke and fill)": 1,
        "use of what is not in the file": 2,
        "shape of unreadable length": 1,
        "curve beyond 1 km or without a place": 1,
    }
    assert "1 image" in drawing.findings[-1].text and not drawing.findings[-1].counts


@pytest.mark.parametrize(
    ("body", "told"),
    [
        ("<text>Ab c</text>", 'The text "Ab c" in line 1 is missing from the part; turn it into a path in the editor.'),
        (
            '<g><text>A<tspan>b</tspan></text>\n<text><textPath href="#p">cde</textPath></text></g>',
            '2 texts of 5 letters in all, the first "A b" in line 1, are missing from the part; turn them into paths',
        ),
        (f"<text>{'x' * 50}</text>", f'The text "{"x" * 40}…" in line 1 is missing'),
    ],
)
def test_texts_that_are_seen_are_missing_from_the_part(body: str, told: str) -> None:
    (found,) = [each for each in read(body + '<circle r="2"/>').findings if "missing" in each.text]
    assert found.counts and found.text.startswith(told)


@pytest.mark.parametrize("text", ["<text> </text>", '<text display="none">A</text>', '<text fill="none">A</text>'])
def test_texts_that_nobody_sees_are_not_missing(text: str) -> None:
    assert not [each for each in read(text + '<circle r="2"/>').findings if each.counts]


def test_style_sheets_decide_what_is_seen() -> None:
    style = (
        "<style>/* c */ *{stroke:none} .cut, line.b { fill:none; stroke:#00F !important } #no{display:none} "
        "@media print{.cut{fill:red}}</style>"
    )
    drawing = read(
        style + '<g fill="none"><circle class="a cut" r="1"/><circle r="2"/><line class="b" x2="1"/>'
        '<circle id="no" r="4" class="cut"/><circle r="5" style="stroke: rgb(0,0,255)"/></g>'
    )
    assert len(drawing.part.entities) == 3 and drawing.part.layers == (Layer("0", "#0000ff"),)


def test_what_has_no_length_is_told() -> None:
    drawing = read(
        '<circle r="2"/><circle cx="7" cy="8" r="0"/><path d="M1 1"/><rect width="0" height="5"/><path d=""/>'
    )
    (finding,) = drawing.findings
    assert finding.kind is FindingKind.TINY_ENTITY and finding.amount == 4 and (finding.x, finding.y) == (7, 92)


def test_a_path_is_drawn_up_to_its_fault() -> None:
    for d in (
        "M0 0L10 0L20",
        "M0 0L10 0 foo 5 5",
        "M0 0L10 0zz5 5",
        "M0 0L10 0A5 5 0 2 1 3 3",
        "M0 0L10 0L20 0,",
        "M0 0L10 0;",
    ):
        drawing = read(f'<circle r="1"/>\n<path d="{d}"/>')
        assert drawing.part.entities[1].curve == Line((0, 100), (10, 100)), d
        faults = [f for f in drawing.findings if f.counts]
        assert [(f.amount, "line 2" in f.text) for f in faults] == ([] if d.endswith(",") else [(1, True)]), d
    assert len(read('<circle r="1"/><path d="L5 5"/>').part.entities) == 1
    assert len(read('<polyline stroke="red" points="0 0 1 0 2 0 3"/>').part.entities) == 2


def test_what_is_only_filled_is_a_closed_outline() -> None:
    """A fill closes what it paints; an outline stays as open as it is drawn."""
    assert (
        len(curves('<polyline points="0,0 10,0 10,10"/>')) == 3
        and len(curves('<path d="M0 0C0 9 9 9 9 0M20 0h5v5z"/>')) == 5
    )
    assert curves('<path d="M0 0h5"/>') == [Line((0, 100), (5, 100))]


def test_a_path_that_ends_where_it_began_but_for_rounding_is_closed_without_more() -> None:
    drawing = read('<path stroke="red" d="M0.1 0.2l0.1 0 0 0.1-0.1 0 0-0.1z"/>')
    assert len(drawing.part.entities) == 4 and not drawing.findings
    assert read('<circle r="1"/><path stroke="red" d="M5 5l1e-9 0 0 1e-9"/>').findings[0].amount == 1


def test_inkscapes_layers() -> None:
    body = (
        '<g inkscape:groupmode="layer" inkscape:label="Outline" id="g1" stroke="#ff0000"><circle r="1"/>'
        '<g inkscape:groupmode="layer" inkscape:label="Holes" style="display:none" sodipodi:insensitive="true">'
        '<circle r="2" stroke="blue"/></g></g>'
        '<g id="plain"><circle r="3"/></g><g inkscape:groupmode="layer" id="L"/>'
    )
    drawing = read(body)
    assert drawing.part.layers == (
        Layer("Outline", "#ff0000"),
        Layer("Holes", "#0000ff", False, True),
        Layer("0"),
        Layer("L"),
    )
    assert [e.layer for e in drawing.part.entities] == ["Outline", "Holes", "0"]
    assert "Layer Holes is switched off" in drawing.findings[-1].text
    assert [e.curve for e in read(body, layers=("holes",)).part.entities] == [Circle((0, 100), 2)]
    with pytest.raises(InputError, match="there is no layer X; the drawing has Outline, Holes"):
        read(body, layers=("X",))


def test_named_groups_at_the_top_are_layers_where_there_are_no_others() -> None:
    body = '<g id="a_x20_b" data-name="a b"><circle r="1"/><g id="inner"><circle r="2"/></g></g><g><circle r="3"/></g>'
    assert [e.layer for e in read(body).part.entities] == ["a b", "a b", "0"]


def test_a_layer_of_several_colours_or_of_black_has_none() -> None:
    assert read('<circle r="1" stroke="red"/><circle r="2" stroke="blue"/>').part.layers == (Layer("0"),)
    assert read('<circle r="1" stroke="black"/>').part.layers == (Layer("0"),)
    assert read('<g color="lime"><circle r="1" stroke="currentColor"/></g>').part.layers == (Layer("0", "#00ff00"),)


def test_a_switch_shows_its_first_choice() -> None:
    body = '<switch><foreignObject requiredExtensions="ai"/><g><circle r="1"/></g><g><circle r="2"/></g></switch>'
    assert one(body) == Circle((0, 100), 1)


def test_the_one_door_knows_svg() -> None:
    drawing = read_drawing("some/Part.SVG", f'<svg {NAMESPACES} {PAGE}><circle r="1"/></svg>'.encode())
    assert drawing.part.name == "Part"


def test_a_file_in_utf_16_is_read() -> None:
    text = f'<?xml version="1.0" encoding="UTF-16"?><svg {NAMESPACES} {PAGE}><g id="加工"><circle r="1"/></g></svg>'
    assert read_svg(text.encode("utf-16")).part.entities[0].layer == "加工"


def test_a_file_without_namespaces_is_read() -> None:
    assert len(read_svg(b'<svg width="1mm" height="1mm"><circle r="1"/></svg>').part.entities) == 1


@pytest.mark.parametrize(
    ("before", "root", "per_inch", "who"),
    [
        ("", 'inkscape:version="0.48.4 r9939"', 90, "Inkscape 0.48"),
        ("", 'inkscape:version="0.91 r13725"', 90, "Inkscape 0.91"),
        ("", 'sodipodi:version="0.32"', 90, "Sodipodi"),
        (
            "<!-- Generator: Adobe Illustrator 24.0.1, SVG Export Plug-In . SVG Version: 6.00 Build 0)  -->",
            "",
            72,
            "Adobe Illustrator",
        ),
        ("", 'inkscape:version="0.92.3 (2405546, 2018-03-11)"', 96, ""),
        ("", 'inkscape:version="1.0.2" sodipodi:version="0.32"', 96, ""),
        ("<!-- Adobe is a name -->", "", 96, ""),
    ],
)
def test_a_file_without_units_is_as_the_editor_had_it_that_wrote_it(
    before: str, root: str, per_inch: float, who: str
) -> None:
    text = f'{before}<svg {NAMESPACES} {root} width="360" height="360"><line x2="360"/></svg>'
    drawing = read_svg(text.encode(), "x.svg")
    assert drawing.part.entities[0].curve.end[0] == pytest.approx(360 * 25.4 / per_inch)
    (found,) = drawing.findings
    assert f"{per_inch} units to the inch" in found.text and not found.counts
    assert (
        (f"written by {who}, so" in found.text and "--px-per-inch 96" in found.text)
        if who
        else "written by" not in found.text
    )
    asked = read_svg(text.encode(), "x.svg", None, (), DrawingOptions(pixels_per_inch=100.0))
    assert asked.part.entities[0].curve.end[0] == pytest.approx(91.44) and not asked.findings


def test_pixels_to_the_inch_change_nothing_of_a_real_size_and_exclude_units() -> None:
    text = f'<svg {NAMESPACES} width="50mm" height="50mm" viewBox="0 0 100 100"><line x2="100"/></svg>'.encode()
    drawing = read_svg(text, "x.svg", None, (), DrawingOptions(pixels_per_inch=72.0))
    assert (
        drawing.part.entities[0].curve.end[0] == pytest.approx(50) and "tells its real size" in drawing.findings[0].text
    )
    with pytest.raises(InputError, match="in two ways"):
        read_svg(text, "x.svg", Units.MM, (), DrawingOptions(pixels_per_inch=72.0))


@pytest.mark.parametrize(
    ("flags", "kind", "flag", "place"),
    [("2 1", "large-arc", "2", 13), ("0 -1", "sweep", "-1", 15), ("0 1.5", "", "", 0)],
)
def test_arc_flags_other_than_0_and_1_are_named_with_their_place(flags: str, kind: str, flag: str, place: int) -> None:
    text = f'<svg {NAMESPACES} width="50mm" height="50mm">\n<path d="M0,0 A5 5 0 {flags} 9 9"/><circle r="3"/></svg>'
    (found,) = [each for each in read_svg(text.encode(), "x.svg").findings if "read to the end" in each.text]
    assert found.counts and "line 2" in found.text
    assert (
        f"the {kind} flag {flag} at character {place} of its data is neither 0 nor 1" in found.text
        if kind
        else "flag" not in found.text
    )


def test_an_svg_is_moved_to_zero() -> None:
    text = (
        f'<svg {NAMESPACES} width="50mm" height="50mm" viewBox="0 0 50 50"><rect x="3e6" y="7e6" width="4" '
        'height="2"/></svg>'
    )
    with pytest.raises(InputError, match=r"beyond 1 km; move the drawing to zero .* --to-zero"):
        read_svg(text.encode(), "x.svg")
    part = read_svg(text.encode(), "x.svg", None, (), DrawingOptions(to_zero=True)).part
    assert {entity.curve.start for entity in part.entities} == {(0, 0), (4, 0), (4, 2), (0, 2)}
