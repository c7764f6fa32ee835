"""A sheet as SVG: one user unit to the millimetre, arcs as cubics within a micrometre."""

from __future__ import annotations

import math
from collections.abc import Iterator
from xml.sax.saxutils import escape

import numpy as np

from ...core import tolerances
from ...core.wording import trimmed
from ...geometry.transform import Similarity, transformed
from ...model.curves import Point
from .page import PageContent, Pen, PlotPage, TextLine, chains, segments

_ANCHORS = {0.0: "start", 0.5: "middle", 1.0: "end"}


def page_svg(page: PlotPage, title: str) -> bytes:
    """Return one sheet as an SVG file.

    Raises:
        GeometryError: a spline cannot be followed.
    """
    x0, y0, x1, y1 = page.window
    size = f"{_n(page.width)} {_n(page.height)}"
    parts = (
        '<?xml version="1.0" encoding="UTF-8"?>',
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{_n(page.width)}mm" height="{_n(page.height)}mm" viewBox="0 0 '
        f'{size}">',
        f"<title>{escape(title)}</title>",
        f'<clipPath id="window"><rect x="{_n(x0)}" y="{_n(page.height - y1)}" width="{_n(x1 - x0)}" '
        f'height="{_n(y1 - y0)}"/></clipPath>',
        '<g id="drawing" clip-path="url(#window)" fill="none" stroke-linecap="round" stroke-linejoin="round">',
        *_elements(page.drawing, page.place, page.height),
        '</g>\n<g id="frame" fill="none">',
        *_elements(page.frame, Similarity(), page.height),
        "</g>\n</svg>\n",
    )
    return "\n".join(parts).encode()


def _elements(ink: PageContent, place: Similarity, height: float) -> Iterator[str]:
    for trace in ink.traces:
        points = trace.placed(place)
        points[:, 1] = height - points[:, 1]
        rounded = np.round(points, 6).tolist()
        yield f'<path {_looks(trace.pen)} d="M{"L".join(f"{x:.9g} {y:.9g}" for x, y in rounded)}"/>'
    for stroke in ink.strokes:
        curves = [transformed(curve, place) for curve in stroke.curves]
        data = []
        for run in chains(curves):
            data.append(f"M{_place(run[0].start, height)}")
            for curve in run:
                data += [_segment(points, height) for points in segments(curve, tolerances.CURVE)]
        yield f'<path {_looks(stroke.pen)} d="{"".join(data)}"/>'
    for patch in ink.patches:
        corners = "L".join(_place(place(corner), height) for corner in patch.corners)
        yield f'<path fill="{patch.pen.colour}" d="M{corners}Z"/>'
    for words in ink.words:
        yield _text(words, place, height)


def _looks(pen: Pen) -> str:
    dash = f' stroke-dasharray="{" ".join(map(_n, pen.dash))}"' if pen.dash else ""
    return f'stroke="{pen.colour}" stroke-width="{_n(pen.width)}"{dash}'


def _segment(points: tuple[Point, ...], height: float) -> str:
    return ("C" if len(points) == 3 else "L") + " ".join(_place(point, height) for point in points)


def _text(words: TextLine, place: Similarity, height: float) -> str:
    at = place(words.at)
    foot = (at[0] - words.lift * math.sin(words.angle), at[1] + words.lift * math.cos(words.angle))
    turn = f' transform="rotate({_n(-math.degrees(words.angle))} {_place(foot, height)})"' if words.angle else ""
    x, y = _place(foot, height).split()
    weight = ' font-weight="bold"' if words.bold else ""
    return (
        f'<text x="{x}" y="{y}"{turn} font-family="sans-serif" font-size="{_n(words.height)}"{weight} '
        f'text-anchor="{_ANCHORS[words.anchor]}" fill="{words.pen.colour}">{escape(words.text)}</text>'
    )


def _place(point: Point, height: float) -> str:
    return f"{_n(point[0])} {_n(height - point[1])}"


def _n(value: float) -> str:
    """Return a number to a nanometre."""
    return trimmed(value, 6)
