"""Paths told apart by surface: the same strokes in the same order in every format, dashes and pens that survive, labels
that find room.
"""

from __future__ import annotations

import re
import zlib
from dataclasses import replace
from xml.etree import ElementTree

import cv2
import numpy as np
import pytest

from app.formats.plot.content import TOOL_COLOURS
from app.formats.plot.flat import dashes
from app.formats.plot.hpgl import hpgl_bytes
from app.formats.plot.layout import PlotOptions, lay_out
from app.formats.plot.page import PlotPage
from app.formats.plot.page_pdf import pages_pdf
from app.formats.plot.page_png import page_png
from app.formats.plot.page_svg import page_svg
from app.formats.plot.surface_plot import (
    DASHES,
    VIEWS,
    BySurface,
    PlotColouring,
    PlottedKind,
    Projection,
    RunPiece,
    colour_of,
    free_places,
    line_of,
)
from app.model.scene import LineType
from tests.formats.hpgl_player import Plotter

SVG = "{http://www.w3.org/2000/svg}"
RNG = np.random.default_rng(9)
CURVES = [np.column_stack([np.linspace(0, 80, 41), np.full(41, 10.0 * k), RNG.normal(size=41)]) for k in range(4)]
PARTS = ((0, 0, 15), (2, 14, 30), (1, 29, 41))
PIECES = tuple(RunPiece(owner, owner % 2, points[first:last]) for points in CURVES for owner, first, last in PARTS)
MARKS = np.array([points[at] for points in CURVES for at in (14, 29)])
SURFACES = (PlottedKind("left"), PlottedKind("dome", "#112233"), PlottedKind("right", line=LineType.CHAIN))
PLOT = BySurface(
    "part", SURFACES, (PlottedKind("T1"), PlottedKind("T2")), PIECES, MARKS, ("CR13", "CR32") * 4, VIEWS["isometric"]
)


def a_page(plot: BySurface) -> PlotPage:
    (page,) = lay_out(plot, PlotOptions()).pages
    return page


def on_paper(plot: BySurface, page: PlotPage) -> list[np.ndarray]:
    return [np.array([page.place((x, y)) for x, y in plot.view.seen(piece.points).tolist()]) for piece in plot.pieces]


@pytest.mark.parametrize("look", list(PlotColouring))
def test_a_plotter_draws_each_part_in_one_stroke_with_its_pen_in_the_order_of_generation(look: PlotColouring) -> None:
    plot = replace(PLOT, look=look)
    page = a_page(plot)
    (sheet,) = Plotter(hpgl_bytes((page,))).sheets
    strokes = sheet.strokes[: len(PIECES)]
    pens = {
        PlotColouring.COLOURS: [2 + p.surface for p in PIECES],
        PlotColouring.TOOLS: [2 + p.tool for p in PIECES],
        PlotColouring.LINES: [1 for _ in PIECES],
    }
    assert [stroke.pen for stroke in strokes] == pens[look]
    lines = [(0, 1, 4)[(0, 1, 2)[p.surface]] if look is PlotColouring.LINES else 0 for p in PIECES]
    assert [stroke.line for stroke in strokes] == lines
    assert {stroke.line: stroke.dashed for stroke in strokes if stroke.line} == (
        {1: 1.0, 4: 7.95} if look is PlotColouring.LINES else {}
    )
    for stroke, points in zip(strokes, on_paper(plot, page), strict=True):
        assert np.abs(np.array(stroke.points) - points).max() <= 0.5 / 40 + 1e-9
    assert len(sheet.circles) == len(MARKS) + 1
    kinds = {"T1", "T2"} if look is PlotColouring.TOOLS else {"1  left", "2  dome", "3  right"}
    assert {"CR13", "CR32", *kinds} <= {text for _, text, _ in sheet.labels}


def test_a_part_as_small_as_a_plotter_unit_is_a_dot() -> None:
    plot = replace(PLOT, pieces=(*PIECES, RunPiece(0, 0, np.array([[1.0, 2.0, 3.0], [1.0, 2.0, 3.000001]]))))
    (sheet,) = Plotter(hpgl_bytes((a_page(plot),))).sheets
    dot = sheet.strokes[len(PIECES)]
    assert (dot.pen, dot.length, len(dot.points)) == (2, 0.0, 2)


def test_svg_has_the_same_strokes_in_the_same_order_with_dashes_in_mm_of_paper() -> None:
    plot = replace(PLOT, look=PlotColouring.LINES)
    page = a_page(plot)
    paths = ElementTree.fromstring(page_svg(page, "part")).findall(f"{SVG}g[@id='drawing']/{SVG}path")
    for path, piece, points in zip(paths, PIECES, on_paper(plot, page), strict=False):
        data = path.get("d", "")
        assert data.count("M") == 1
        read = np.array(re.findall(r"-?[\d.]+", data), float).reshape(-1, 2)
        np.testing.assert_allclose(read, points * (1, -1) + (0, page.height), atol=1e-6)
        assert path.get("stroke-dasharray") == (None, "0.05 0.95", "6 0.95 0.05 0.95")[piece.surface]
        assert path.get("stroke") == "#000000"
    assert len(paths) == len(PIECES) + 1


def test_pdf_has_the_same_strokes_in_the_same_order_with_the_same_dashes() -> None:
    plot = replace(PLOT, look=PlotColouring.LINES)
    page = a_page(plot)
    data = pages_pdf((page, page), "täst")
    assert int(re.findall(rb"startxref\n(\d+)", data)[0]) == data.index(b"xref\n0 8")
    assert data.count(b"/Type /Page /Parent") == 2
    for number, begin in enumerate(re.findall(rb"(\d{10}) 00000 n", data), 1):
        assert data[int(begin) :].startswith(b"%d 0 obj" % number)
    first = data.index(b"stream\n") + 7
    lines = zlib.decompress(data[first : data.index(b"\nendstream")]).decode().split("\n")
    strokes, dash = [], ""
    for line in lines:
        dash = re.findall(r"\[(.*)\] 0 d", line)[0] if line.endswith(" d") else dash
        if line.endswith(" S"):
            strokes.append((dash, np.array([each.split() for each in re.split(" [ml] ", line[:-4])], float)))
    assert len(strokes) > len(PIECES)
    for (dash, read), piece, points in zip(strokes, PIECES, on_paper(plot, page), strict=False):
        assert dash == ("", "0.05 0.95", "6 0.95 0.05 0.95")[piece.surface]
        np.testing.assert_allclose(read, points, atol=1e-5)


def test_png_shows_the_colours_on_paper_of_true_size() -> None:
    image = cv2.imdecode(np.frombuffer(page_png(a_page(PLOT)), np.uint8), cv2.IMREAD_COLOR)
    assert image is not None
    assert image.shape == (round(210 * 200 / 25.4), round(297 * 200 / 25.4), 3)
    for colour in (colour_of(0), "#112233", colour_of(2)):
        bgr = [int(colour[k : k + 2], 16) for k in (5, 3, 1)]
        assert np.any(np.abs(image.astype(int) - bgr).max(axis=2) < 12), colour


def test_dashes_run_on_along_the_whole_part() -> None:
    fine = np.column_stack([np.linspace(0, 20, 401), np.zeros(401)])
    for points in (fine, fine[[0, -1]]):
        drawn = [(piece[0, 0], piece[-1, 0]) for piece in dashes(points, DASHES[LineType.CHAIN])]
        np.testing.assert_allclose(drawn, [(0, 6), (6.95, 7.0), (7.95, 13.95), (14.9, 14.95), (15.9, 20)], atol=1e-9)


def test_views_are_parallel_projections() -> None:
    point = np.array([[1.0, 2.0, 3.0]])
    seen = {name: view.seen(point)[0] for name, view in VIEWS.items()}
    np.testing.assert_allclose(seen["plan"], (1, 2), atol=1e-12)
    np.testing.assert_allclose(seen["front"], (1, 3), atol=1e-12)
    np.testing.assert_allclose(seen["side"], (2, 3), atol=1e-12)
    axes = VIEWS["isometric"].seen(np.eye(3))
    np.testing.assert_allclose(np.hypot(*axes.T), np.sqrt(2 / 3), atol=1e-12)
    np.testing.assert_allclose(Projection(90, 90).seen(point)[0], (2, -1), atol=1e-12)
    np.testing.assert_allclose(VIEWS["isometric"].seen(np.array([[1.0, -1.0, 1.0]])), 0, atol=1e-12)


def test_colours_and_line_types_go_round() -> None:
    assert [colour_of(k) for k in range(9)] == [*TOOL_COLOURS, TOOL_COLOURS[0]]
    assert len(set(TOOL_COLOURS)) == 8
    assert [line_of(k) for k in range(4)] == [LineType.SOLID, LineType.DOTTED, LineType.CHAIN, LineType.SOLID]


def test_labels_keep_off_lines_and_each_other_and_stand_nearest_to_their_point() -> None:
    lines = [np.array([[0.0, y], [60.0, y]]) for y in (0.0, 6.0, 12.0)]
    points = np.array([[x, y] for y in (0.0, 6.0, 12.0) for x in (10.0, 30.0, 31.0, 50.0)])
    places = free_places(lines, points, ["CR12"] * len(points), 2.2)
    wide, high = 4 * 2.2 * 0.62, 2.2 * 0.75
    boxes = [(x, y, x + wide, y + high) for x, y in (place for place in places if place is not None)]
    assert len(boxes) >= 9
    for _, y0, _, y1 in boxes:
        assert not any(y0 <= y <= y1 for y in (0.0, 6.0, 12.0))
    for at, a in enumerate(boxes):
        assert not any(a[0] < b[2] and b[0] < a[2] and a[1] < b[3] and b[1] < a[3] for b in boxes[:at])
    for number, place in enumerate(places):
        if place is not None:
            middle = np.array(place) + (wide / 2, high / 2)
            assert np.hypot(*(points - middle).T).argmin() == number


def test_no_room_no_label() -> None:
    lines = [np.array([[0.0, y], [60.0, y]]) for y in np.arange(0, 40, 0.5)]
    assert free_places(lines, np.array([[30.0, 20.0]]), ["CR12"], 2.2) == [None]


def test_the_legend_stands_under_the_drawing_and_costs_nothing_without() -> None:
    page, bare = a_page(PLOT), a_page(replace(PLOT, with_legend=False))
    assert page.window[1] - bare.window[1] == pytest.approx(PLOT.strip)
    samples = [trace.pen.colour for trace in page.frame.traces]
    assert samples == [colour_of(0), "#112233", colour_of(2)]
    for words in page.frame.words:
        assert words.at[1] < page.window[1]
    assert not bare.frame.traces


def test_a_hundred_thousand_points_are_all_there_and_joined() -> None:
    t = np.linspace(0, 60, 1001)
    pieces = tuple(RunPiece(k % 3, 0, np.column_stack([t, np.full_like(t, 0.6 * k), np.sin(t)])) for k in range(100))
    plot = BySurface("many", PLOT.surfaces, PLOT.tools, pieces, np.zeros((0, 3)))
    page = a_page(plot)
    assert page_svg(page, "many").count(b"L") >= 100_000
    (sheet,) = Plotter(hpgl_bytes((page,))).sheets
    assert [stroke.pen for stroke in sheet.strokes[:100]] == [2 + k % 3 for k in range(100)]
    for stroke, points in zip(sheet.strokes, on_paper(plot, page), strict=False):
        assert np.abs(np.array(stroke.points) - points).max() <= 0.5 / 40 + 1e-9
