"""A picture of part and paths as SVG or PNG: contour dashed, pocket solid, rapids dotted."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from html import escape

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import TURN, R, Rows, boxes, sweeps

Points = NDArray[np.float64]

WIDTH = 1600
"""Pixels across a whole picture."""

LEGEND = 220
MARGIN = 40
PAPER, INK, AREA, MUTED = "#FAFAF8", "#1E2227", "#F1F2EE", "#5C626A"
LEFT, UNREACHABLE, PLUNGE = "#2979FF", "#B0A8C8", "#D55E00"


@dataclass(frozen=True)
class Style:
    """How a kind of path is drawn: colour, width in pixels, dash and gap in pixels (none: solid)."""

    name: str
    colour: str
    width: float
    dash: tuple[float, ...] = ()


PART = Style("Part", INK, 1.6)
RAPID = Style("Rapid", "#8A8F98", 1.0, (1.5, 4.5))
LINK = Style("Link", "#66C5AB", 1.0)
POCKET = Style("Pocket", "#009E73", 1.6)
CONTOUR = Style("Contour", "#E69F00", 1.8, (9.0, 5.0))


@dataclass(frozen=True)
class Picture:
    """What is drawn, in part coordinates, mm, y up.

    Attributes:
        title: shown above the legend.
        contours: rows (n, 8) of each contour of the part.
        paths: style and connected rows, drawn in this order.
        plunges: (n, 2) where tools go down.
        left, unreachable: outlines (n, 2), holes among them, of floor that is left within and out of reach.
    """

    title: str
    contours: tuple[Rows, ...]
    paths: tuple[tuple[Style, Rows], ...]
    plunges: Points
    left: tuple[Points, ...] = ()
    unreachable: tuple[Points, ...] = ()

    def styles(self) -> tuple[Style, ...]:
        """Return the styles that occur, the part first."""
        return (PART, *dict.fromkeys(style for style, _ in self.paths))


@dataclass(frozen=True)
class Layout:
    """Where part coordinates come to lie: pixel = (left + scale x, top - scale y)."""

    scale: float
    left: float
    top: float
    height: int

    def pixels(self, points: Points) -> Points:
        """Return pixel positions (n, 2), y down, of points (n, 2) in mm, y up."""
        return np.stack([self.left + self.scale * points[:, 0], self.top - self.scale * points[:, 1]], axis=1)


def layout(picture: Picture) -> Layout:
    """Return the layout that shows everything, as large as the width allows, no higher than 1.5 times as wide."""
    around = [boxes(rows) for rows in (*picture.contours, *(rows for _, rows in picture.paths)) if len(rows)]
    box = np.concatenate(around) if around else np.array([[0.0, 0.0, 1.0, 1.0]])
    (x0, y0), (x1, y1) = box[:, :2].min(axis=0), box[:, 2:].max(axis=0)
    room = WIDTH - LEGEND - 2 * MARGIN
    scale = float(min(room / max(x1 - x0, 1e-6), 1.5 * WIDTH / max(y1 - y0, 1e-6)))
    height = max(round(scale * (y1 - y0)) + 2 * MARGIN, 320)
    across = MARGIN + (room - scale * (x1 - x0)) / 2
    return Layout(scale, float(across - scale * x0), float(MARGIN + scale * y1), height)


def plot(picture: Picture, suffix: str) -> bytes:
    """Return the picture as a file's bytes; `suffix` is .svg or .png."""
    if suffix == ".svg":
        return svg(picture).encode()
    from .png import png

    return png(picture)


def svg(picture: Picture) -> str:
    """Return the picture as SVG text: true arcs, in part coordinates under one transform that turns y up."""
    place = layout(picture)
    pixel = 1 / place.scale
    step = _n(6 * pixel)
    inner = "\n".join((*_areas(picture), *_strokes(picture, pixel), *_plunges(picture, pixel)))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{place.height}" viewBox="0 0 {WIDTH} {place.height}">\n'
        f"<title>{escape(picture.title)}</title>\n"
        f'<defs><pattern id="hatch" width="{step}" height="{step}" patternUnits="userSpaceOnUse" patternTransform="rotate(45)">'
        f'<path d="M0 0V{step}" stroke="{UNREACHABLE}" stroke-width="{_n(4 * pixel)}"/></pattern></defs>\n'
        f'<rect width="{WIDTH}" height="{place.height}" fill="{PAPER}"/>\n'
        f'<g transform="matrix({_n(place.scale)} 0 0 {_n(-place.scale)} {_n(place.left)} {_n(place.top)})" '
        f'fill="none" stroke-linecap="round" stroke-linejoin="round">\n{inner}\n</g>\n{_legend(picture)}</svg>\n'
    )


def _areas(picture: Picture) -> Iterator[str]:
    """Yield the machined area and what is left of it."""
    shape = "".join(path_data(rows) + "Z" for rows in picture.contours if _closed(rows))
    yield f'<path id="area" d="{shape}" fill="{AREA}" fill-rule="evenodd"/>'
    for name, fill, outlines in (("unreachable", "url(#hatch)", picture.unreachable), ("left", LEFT, picture.left)):
        shape = "".join("M" + "L".join(f"{_n(x)} {_n(y)}" for x, y in outline) + "Z" for outline in outlines)
        if shape:
            yield f'<path id="{name}" d="{shape}" fill="{fill}" fill-rule="evenodd"/>'


def _closed(rows: Rows) -> bool:
    return len(rows) > 0 and bool(np.all(rows[0, :2] == rows[-1, 2:4]))


def _strokes(picture: Picture, pixel: float) -> Iterator[str]:
    """Yield one path element a style."""
    for style in (*picture.styles()[1:], PART):
        pieces = picture.contours if style is PART else [rows for each, rows in picture.paths if each is style]
        dash = " ".join(_n(length * pixel) for length in style.dash)
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        data = "".join(path_data(rows) for rows in pieces)
        yield f'<path id="{style.name.lower()}" d="{data}" stroke="{style.colour}" stroke-width="{_n(style.width * pixel)}"{dashed}/>'


def _plunges(picture: Picture, pixel: float) -> Iterator[str]:
    for x, y in picture.plunges:
        yield f'<circle cx="{_n(x)}" cy="{_n(y)}" r="{_n(4 * pixel)}" stroke="{PLUNGE}" stroke-width="{_n(1.4 * pixel)}"/>'


def path_data(rows: Rows) -> str:
    """Return connected rows as SVG path data; arcs of more than half a turn become two."""
    if not len(rows):
        return ""
    parts = [f"M{_n(rows[0, 0])} {_n(rows[0, 1])}"]
    for row, sweep in zip(rows, sweeps(rows), strict=True):
        if row[TURN] == 0:
            parts.append(f"L{_n(row[2])} {_n(row[3])}")
            continue
        turn = 1 if sweep > 0 else 0
        if abs(sweep) > 3.1:
            half = np.arctan2(row[1] - row[5], row[0] - row[4]) + sweep / 2
            middle = (row[4] + row[R] * np.cos(half), row[5] + row[R] * np.sin(half))
            parts.append(f"A{_n(row[R])} {_n(row[R])} 0 0 {turn} {_n(middle[0])} {_n(middle[1])}")
        parts.append(f"A{_n(row[R])} {_n(row[R])} 0 0 {turn} {_n(row[2])} {_n(row[3])}")
    return "".join(parts)


def legend_rows(picture: Picture) -> list[tuple[str, str, Style | None]]:
    """Return (label, colour, line style or None for a patch) of each entry of the legend."""
    rows: list[tuple[str, str, Style | None]] = [(style.name, style.colour, style) for style in picture.styles()]
    rows += [("Plunge", PLUNGE, None)] if len(picture.plunges) else []
    rows += [("Left, within reach", LEFT, None)] if picture.left else []
    rows += [("Out of reach", UNREACHABLE, None)] if picture.unreachable else []
    return rows


def _legend(picture: Picture) -> str:
    x, y = WIDTH - LEGEND, MARGIN + 14
    font = 'font-family="system-ui, sans-serif"'
    lines = [f'<text x="{x}" y="{y}" {font} font-size="15" font-weight="600" fill="{INK}">{escape(picture.title)}</text>']
    for number, (label, colour, style) in enumerate(legend_rows(picture), 1):
        at = y + 26 * number
        if style is None:
            lines.append(f'<circle cx="{x + 17}" cy="{at - 4}" r="5" fill="{colour}"/>')
        else:
            dash = f' stroke-dasharray="{" ".join(_n(length) for length in style.dash)}"' if style.dash else ""
            lines.append(f'<path d="M{x} {at - 4}h34" stroke="{colour}" stroke-width="{_n(style.width + 0.4)}"{dash}/>')
        lines.append(f'<text x="{x + 46}" y="{at}" {font} font-size="13" fill="{MUTED}">{escape(label)}</text>')
    return "\n".join(lines) + "\n"


def _n(value: float) -> str:
    """Return a number as short as six decimals allow."""
    text = f"{value:.6f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text
