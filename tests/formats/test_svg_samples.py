"""The SVGs of tests/data, and what Qt's own reader makes of the same files."""

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PySide6.QtCore import QByteArray
from PySide6.QtGui import QImage, QPainter
from PySide6.QtSvg import QSvgRenderer

from app.core.errors import GeometryError
from app.formats.drawing import Drawing
from app.formats.readers import read_drawing
from app.formats.svg.write import svg_bytes
from app.geometry.arcs.arcs import lines_and_arcs
from app.geometry.chaining.chain import chain
from app.geometry.primitives import curve_rows, lengths, points_at
from app.model.curves import Arc, Curve, Ellipse, Line, Spline
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import make

DOTS = 8
"""Dots to the millimetre."""


def read(data: Path, name: str) -> Drawing:
    return read_drawing(name, (data / "svg" / name).read_bytes())


COUNTS = {
    # name: lines, arcs, splines; closed contours, open contours; names units
    "arc_with_rotate.svg": ((0, 6, 0), (0, 6), False),
    "e_line.svg": ((83, 13, 28), (28, 0), True),
    "gear.svg": ((68, 0, 0), (2, 0), True),
}


@pytest.mark.parametrize("name", COUNTS)
def test_curves_and_contours(data: Path, name: str) -> None:
    """The commands of the files counted apart from any reader: 83 L, 13 A, 28 runs of 200 Q; 70 L and two z, of
    which one run is the page's white ground; six A.
    """
    drawing = read(data, name)
    kinds = tuple(sum(isinstance(e.curve, kind) for e in drawing.part.entities) for kind in (Line, Arc, Spline))
    made = chain(drawing.part.entities).contours
    closed = sum(contour.closed for contour in made)
    assert (kinds, (closed, len(made) - closed), drawing.units_named) == COUNTS[name]


def test_every_shared_drawing_is_here(shared: Path, data: Path) -> None:
    for path in shared.glob("data/svg/*.svg"):
        assert (data / "svg" / path.name).read_bytes() == path.read_bytes()


def test_sizes(data: Path) -> None:
    """The gear's page is 345.6 points, 121.92 mm; the outline of the other is 80 and, with its half circle, 110 units
    of 0.96311 mm.
    """
    lines = [e.curve for e in read(data, "gear.svg").part.entities[:2]]
    assert lines == [Line((0, 0), (121.92, 0)), Line((121.92, 0), (121.92, 121.92))]
    outline = [e.curve for e in read(data, "e_line.svg").part.entities[:4]]
    arc = outline[1]
    assert isinstance(arc, Arc) and arc.radius == pytest.approx(50 * 100.09 / 103.923452)
    assert abs(outline[3].end[1] - outline[3].start[1]) == pytest.approx(80 * 100.09 / 103.923452)


RICH = """<svg xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink"
width="100mm" height="80mm" viewBox="-10 -20 200 160"><style>.a { fill: none; stroke: #f00; stroke-width: 0.2 }</style>
<defs><rect id="r" x="1" y="1" width="8" height="6" rx="2" ry="1"/></defs>
<g transform="translate(5,5) rotate(30)" class="a">
<path d="M1 2c3 4 5 6 17 8s11-21 12-2q5 25 16 7t13 13a25 14 30 0 1 6 26a9 9 0 1 0 5 9l-40 2zm3 3h5v-4.5z"/>
<use xlink:href="#r" x="20" y="50" transform="skewX(20) scale(2 1.5)"/></g>
<g class="a" transform="matrix(1 .2 -.3 1 60 5)"><circle cx="50" cy="50" r="20"/>
<ellipse cx="20" cy="20" rx="20" ry="9" transform="rotate(20)"/>
<polygon points="1,1 20,3 4,40"/><polyline points="10 100 20 120 30 110"/><line x1="90" y1="5" x2="80" y2="40"/></g>
<path transform="scale(-1,1) translate(-170 0)" d="M0 0A30 20 -40 1 1 10 10"/>
<path fill="#00f" d="M150 100h20v20h-20zm5 5v10h10v-10z"/></svg>"""


def points_along(curve: Curve) -> NDArray[np.float64]:
    """Points (n, 2) along a curve, more than one to the dot."""
    primitives = lines_and_arcs(curve).primitives if isinstance(curve, Ellipse | Spline) else (curve,)
    rows = np.array([row for primitive in primitives for row in curve_rows(primitive)])
    counts = (lengths(rows) * DOTS * 2).astype(int) + 2
    return np.concatenate(
        [points_at(np.repeat(row[None], n, axis=0), np.linspace(0, 1, n)) for row, n in zip(rows, counts, strict=True)]
    )


def edges_by_qt(content: bytes, size: tuple[float, float]) -> NDArray[np.bool_]:
    """Dots of a picture by Qt beside which the colour changes."""
    image = QImage(round(size[0] * DOTS), round(size[1] * DOTS), QImage.Format.Format_RGB32)
    image.fill(0xFF00C0)
    painter = QPainter(image)
    QSvgRenderer(QByteArray(content)).render(painter)
    painter.end()
    dots = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.width(), 4)[..., :3].astype(int)
    change = np.zeros(dots.shape[:2], bool)
    change[:, 1:] |= np.abs(np.diff(dots, axis=1)).sum(axis=2) > 60
    change[1:] |= np.abs(np.diff(dots, axis=0)).sum(axis=2) > 60
    return change


@pytest.mark.parametrize(
    ("name", "size"),
    [
        ("arc_with_rotate.svg", (200 * 25.4 / 96, 200 * 25.4 / 96)),
        ("e_line.svg", (100.09, 95.919717)),
        ("gear.svg", (121.92, 121.92)),
        ("", (100, 80)),
    ],
)
def test_what_is_read_is_what_qt_draws(data: Path, qapp: object, name: str, size: tuple[float, float]) -> None:
    """Every edge in the picture lies on a curve, and every curve on an edge, within 3 dots."""
    content = (data / "svg" / name).read_bytes() if name else RICH.encode()
    edges = edges_by_qt(content, size)
    drawing = read_drawing("a.svg", content)
    points = np.concatenate([points_along(e.curve) for e in drawing.part.entities])
    columns, rows = (points[:, 0] * DOTS).astype(int), ((size[1] - points[:, 1]) * DOTS).astype(int)
    inside = (columns > 3) & (rows > 3) & (columns < edges.shape[1] - 3) & (rows < edges.shape[0] - 3)
    drawn = np.zeros_like(edges)
    drawn[rows[inside], columns[inside]] = True
    assert drawn.sum() > 100
    assert not (drawn & ~wider(edges)).any() and not (edges & ~wider(drawn))[4:-4, 4:-4].any()


def wider(dots: NDArray[np.bool_]) -> NDArray[np.bool_]:
    """The dots and all within 3 of them."""
    import cv2

    return cv2.dilate(dots.astype(np.uint8), np.ones((7, 7), np.uint8)).astype(bool)


def nc_of(name: str, content: bytes) -> list[str]:
    """The blocks of the program for a drawing, without comments, which hold its name."""
    made = make(name, content, MakeOptions(contour_diameter=2.0, pocket_diameter=4.0))
    return [line for line in made.files[0].nc.text.splitlines() if not line.startswith("(")]


def test_a_drawing_makes_the_same_program_from_svg_as_from_dxf(data: Path) -> None:
    content = (data / "dxf" / "fig2.dxf").read_bytes()
    blocks = nc_of("fig2.dxf", content)
    assert len(blocks) > 50 and nc_of("fig2.svg", svg_bytes(read_drawing("fig2.dxf", content).part).data) == blocks


def test_open_arcs_alone_are_refused(data: Path) -> None:
    why = (
        r"arc_with_rotate\.svg: there is no closed contour, so nothing can be cut\. Layer 0 has 6 lines that bound "
        r"nothing"
    )
    with pytest.raises(GeometryError, match=why):
        nc_of("arc_with_rotate.svg", (data / "svg" / "arc_with_rotate.svg").read_bytes())
