"""Drawings on paper: true to the stated scale in every format, on as many sheets as it takes, told what they are."""

from __future__ import annotations

import math
import re
from dataclasses import replace
from itertools import pairwise
from xml.etree import ElementTree

import numpy as np
import pytest

from app.core.errors import InputError
from app.formats.plot.content import DrawingContent
from app.formats.plot.hpgl import hpgl_bytes
from app.formats.plot.layout import MARGIN, OVERLAP, PlotOptions, lay_out, scale_words
from app.formats.plot.page import Paper, segments
from app.formats.plot.page_svg import page_svg
from app.model.curves import Arc, Circle, Ellipse, Line, Spline
from app.model.moves import MoveKind, Moves, Purpose
from app.model.notes import Dimension, DimensionKind, Guide, Mark
from app.model.part import Layer, Part
from tests.formats.hpgl_player import Plotter

SVG = "{http://www.w3.org/2000/svg}"
LINE = Part(name="rule").with_curves((Line((0.0, 0.0), (100.0, 0.0)),), "0")
TRUE = PlotOptions(scale=1.0)


def a_plate() -> Part:
    part = Part(name="plate", layers=(Layer("0"), Layer("holes", "#CC79A7"), Layer("hidden", visible=False)))
    outline = (
        Line((0.0, 0.0), (60.0, 0.0)),
        Arc((60.0, 0.0), (60.0, 40.0), (60.0, 20.0)),
        Line((60.0, 40.0), (0.0, 40.0)),
        Line((0.0, 40.0), (0.0, 0.0)),
    )
    part = part.with_curves(outline, "0").with_curves((Circle((20.0, 20.0), 7.5),), "holes")
    part = part.with_curves((Line((-500.0, 0.0), (500.0, 0.0)),), "hidden")
    part = part.with_note(Dimension(DimensionKind.ACROSS, ((0.0, 0.0), (60.0, 0.0)), (30.0, -10.0)), "0")
    return part.with_note(Guide((0.0, 20.0), 0.0), "0").with_note(Mark((20.0, 20.0)), "0")


def some_moves() -> Moves:
    ends = np.array([[0, 0, 5], [10, 0, -1], [20, 0, -1], [20, 10, -1], [20, 10, 5], [20, 10, -1]], float)
    kind = np.array(
        [MoveKind.RAPID, MoveKind.LINE, MoveKind.LINE, MoveKind.ARC_CCW, MoveKind.RAPID, MoveKind.LINE], np.uint8
    )
    centre = np.full((6, 2), np.nan)
    centre[3] = (20, 5)
    purpose = np.array(
        [Purpose.RAPID, Purpose.LINK, Purpose.POCKET, Purpose.CONTOUR, Purpose.RAPID, Purpose.PLUNGE], np.uint8
    )
    tool = np.array([1, 1, 1, 2, 2, 2], np.int16)
    zeros = np.zeros(6, np.int16)
    return Moves(ends, centre, kind, purpose, zeros, tool, zeros, np.zeros(6), np.zeros(6, np.int32))


@pytest.mark.parametrize(("scale", "length"), [(1.0, 100.0), (0.5, 50.0), (2.0, 200.0)])
def test_a_line_of_100_mm_is_as_long_as_the_scale_says_in_svg_and_hpgl(scale: float, length: float) -> None:
    (page,) = lay_out(DrawingContent(LINE), PlotOptions(scale=scale)).pages
    root = ElementTree.fromstring(page_svg(page, "rule"))
    assert (root.get("width"), root.get("height"), root.get("viewBox")) == ("297mm", "210mm", "0 0 297 210")
    path = root.find(f"{SVG}g[@id='drawing']/{SVG}path")
    assert path is not None
    x0, y0, x1, y1 = map(float, re.findall(r"-?[\d.]+", path.get("d", "")))
    assert (x1 - x0, y1 - y0) == pytest.approx((length, 0.0), abs=1e-6)
    (sheet,) = Plotter(hpgl_bytes((page,))).sheets
    assert sheet.size == (297.0, 210.0)
    assert sheet.strokes[0].length == pytest.approx(length, abs=0.005)


def test_every_curve_is_followed_within_a_micrometre() -> None:
    circle, ellipse = Circle((3.0, 4.0), 400.0), Ellipse((0.0, 0.0), (300.0, 100.0), 0.3, 0.5, 4.0, ccw=False)
    for curve, off in (
        (circle, lambda x, y: math.hypot(x - 3, y - 4) - 400),
        (ellipse, lambda x, y: off_ellipse(ellipse, x, y)),
    ):
        at, worst = curve.start, 0.0
        for a, b, c in segments(curve, 1e-3):
            for t in np.linspace(0, 1, 60):
                x, y = (
                    at[k] * (1 - t) ** 3 + 3 * a[k] * t * (1 - t) ** 2 + 3 * b[k] * t * t * (1 - t) + c[k] * t**3
                    for k in (0, 1)
                )
                worst = max(worst, abs(off(x, y)))
            at = c
        assert math.dist(at, curve.end) < 1e-9
        assert worst < 1e-3


def off_ellipse(ellipse: Ellipse, x: float, y: float) -> float:
    long = math.hypot(*ellipse.major)
    u = (x * ellipse.major[0] + y * ellipse.major[1]) / long
    v = (y * ellipse.major[0] - x * ellipse.major[1]) / long
    value = math.hypot(u / long, v / (long * ellipse.ratio))
    slope = math.hypot(u / long**2, v / (long * ellipse.ratio) ** 2) / value
    return (value - 1) / slope


def test_splines_are_kept_as_they_are() -> None:
    cubic = Spline(3, ((0.0, 0.0), (1.0, 2.0), (3.0, 2.0), (4.0, 0.0)), (0.0,) * 4 + (1.0,) * 4)
    assert list(segments(cubic, 1e-3)) == [((1.0, 2.0), (3.0, 2.0), (4.0, 0.0))]
    square = Spline(2, ((0.0, 0.0), (3.0, 3.0), (6.0, 0.0)), (0.0,) * 3 + (1.0,) * 3)
    assert list(segments(square, 1e-3)) == [((2.0, pytest.approx(2.0)), (4.0, pytest.approx(2.0)), (6.0, 0.0))]


def test_hpgl_plays_back_with_a_pen_a_layer_and_true_arcs() -> None:
    (page,) = lay_out(DrawingContent(a_plate(), notes=False), replace(TRUE, framed=False)).pages
    (sheet,) = Plotter(hpgl_bytes((page,))).sheets
    (outline,) = sheet.strokes
    assert (outline.pen, outline.dashed, outline.width) == (1, 0.0, 0.35)
    assert outline.length == pytest.approx(160 + 20 * math.pi, abs=0.05)
    assert [angle for _, angle in outline.arcs] == [pytest.approx(math.pi, abs=1e-3)]
    ((pen, _, radius),) = sheet.circles
    assert (pen, radius) == (2, 7.5)
    assert sheet.windows == [(10.0, 10.0, 287.0, 200.0), ()]


def test_what_is_hidden_or_construction_is_not_plotted_and_dimensions_keep_their_size_at_every_scale() -> None:
    for scale in (1.0, 0.2):
        (page,) = lay_out(DrawingContent(a_plate()), replace(TRUE, scale=scale)).pages
        assert [words.text for words in page.drawing.words] == ["60"]
        assert page.drawing.words[0].height == 3.5
        tip, corner, _ = page.drawing.patches[0].corners
        assert abs(corner[0] - tip[0]) * scale == pytest.approx(2.5)
        assert max(abs(page.place(curve.end)[0]) for stroke in page.drawing.strokes for curve in stroke.curves) < 297


def test_paths_are_drawn_by_tool_with_contours_dashed_and_without_rapids() -> None:
    (page,) = lay_out(DrawingContent(LINE, some_moves()), replace(TRUE, framed=False)).pages
    (sheet,) = Plotter(hpgl_bytes((page,))).sheets
    kinds = [(stroke.pen, stroke.dashed, stroke.width) for stroke in sheet.strokes]
    assert kinds == [(2, 0.0, 0.13), (2, 0.0, 0.25), (3, 4.5, 0.25), (1, 0.0, 0.35)]
    assert [round(stroke.length, 1) for stroke in sheet.strokes[:2]] == [10.0, 10.0]
    assert 'stroke-dasharray="3 1.5"' in page_svg(page, "x").decode()


def test_the_title_strip_says_name_scale_units_date_and_sheet() -> None:
    (page,) = lay_out(DrawingContent(a_plate()), PlotOptions(scale=0.5), "2026-11-22").pages
    assert {"plate", "1 : 2", "mm", "2026-11-22", "1 of 1"} <= {words.text for words in page.frame.words}
    assert not lay_out(DrawingContent(a_plate()), PlotOptions(scale=0.5, framed=False)).pages[0].frame.words
    long = replace(a_plate(), name="名" * 100)
    name = lay_out(DrawingContent(long), TRUE).pages[0].frame.words[1].text
    assert name.endswith("…") and len(name) < 40


@pytest.mark.parametrize("size", [0.37, 11.0, 123.456, 5000.0])
def test_fit_fills_the_sheet_at_a_scale_that_three_figures_state(size: float) -> None:
    plot = lay_out(DrawingContent(Part().with_curves((Line((0.0, 0.0), (size, 0.0)),), "0")), PlotOptions())
    on_paper = size * plot.scale
    assert 0.98 * (297 - 2 * MARGIN - 8) <= on_paper <= 297 - 2 * MARGIN - 8 + 1e-9
    first, second = scale_words(plot.scale).split(" : ")
    assert float(first) / float(second) == pytest.approx(plot.scale, rel=1e-9)
    assert max(len(text.replace(".", "").strip("0")) for text in (first, second)) <= 3


def test_what_is_too_large_goes_on_sheets_that_overlap_and_meet() -> None:
    part = Part().with_curves((Line((0.0, 0.0), (700.0, 300.0)),), "0")
    plot = lay_out(DrawingContent(part), TRUE)
    assert (len(plot.pages), plot.columns) == (6, 3)
    for row in (0, 1):
        places = [page.place(part.entities[0].curve.start) for page in plot.pages[3 * row : 3 * row + 3]]
        assert {round(a[0] - b[0], 9) for a, b in pairwise(places)} == {297 - 2 * MARGIN - OVERLAP}
    covered = 0.0
    for t in np.linspace(0, 1, 400):
        point = (700 * t, 300 * t)
        shown = [page for page in plot.pages if inside(page.place(point), page.window)]
        assert shown
        covered += len(shown)
        assert all(page.drawing.strokes for page in shown)
    assert covered > 400
    crosses = [
        {(curve.start, curve.end) for stroke in page.frame.strokes for curve in stroke.curves} for page in plot.pages
    ]
    assert any(start[1] == end[1] and start[0] == 279.0 for start, end in crosses[0])
    assert any(start[1] == end[1] and start[0] == 12.0 for start, end in crosses[1])
    assert len(Plotter(hpgl_bytes(plot.pages)).sheets) == 6


def inside(point: tuple[float, float], window: tuple[float, float, float, float]) -> bool:
    return window[0] - 1e-9 <= point[0] <= window[2] + 1e-9 and window[1] - 1e-9 <= point[1] <= window[3] + 1e-9


def test_nothing_and_far_too_much_are_refused() -> None:
    with pytest.raises(InputError, match="Nothing is drawn"):
        lay_out(DrawingContent(Part()), TRUE)
    with pytest.raises(InputError, match="sheets; choose larger paper"):
        lay_out(DrawingContent(LINE), PlotOptions(scale=5000.0))


@pytest.mark.parametrize("paper", list(Paper))
def test_paper_lies_and_stands(paper: Paper) -> None:
    lying = lay_out(DrawingContent(LINE), PlotOptions(paper, True)).pages[0]
    standing = lay_out(DrawingContent(LINE), PlotOptions(paper, False)).pages[0]
    assert lying.width > lying.height
    assert (standing.height, standing.width) == (lying.width, lying.height)
