"""The picture of part and paths as SVG: true arcs, contour dashed, pocket solid, rapids dotted."""

from __future__ import annotations

from collections.abc import Iterator
from html import escape

import numpy as np

from ...core.wording import trimmed
from ...geometry.primitives import TURN, R, Rows, sweeps
from .picture import (
    AREA,
    INK,
    LEFT,
    LEGEND,
    MARGIN,
    MUTED,
    PAPER,
    PART,
    PLUNGE,
    UNREACHABLE,
    WIDTH,
    PathPicture,
    layout,
    legend_rows,
)


def svg(picture: PathPicture) -> str:
    """Return the picture as SVG text: true arcs, in part coordinates under one transform that turns y up."""
    place = layout(picture)
    pixel = 1 / place.scale
    step = _n(6 * pixel)
    inner = "\n".join((*_areas(picture), *_strokes(picture, pixel), *_plunges(picture, pixel)))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{place.height}" viewBox="0 0 {WIDTH} '
        f'{place.height}">\n'
        f"<title>{escape(picture.title)}</title>\n"
        f'<defs><pattern id="hatch" width="{step}" height="{step}" patternUnits="userSpaceOnUse" '
        'patternTransform="rotate(45)">'
        f'<path d="M0 0V{step}" stroke="{UNREACHABLE}" stroke-width="{_n(4 * pixel)}"/></pattern></defs>\n'
        f'<rect width="{WIDTH}" height="{place.height}" fill="{PAPER}"/>\n'
        f'<g transform="matrix({_n(place.scale)} 0 0 {_n(-place.scale)} {_n(place.left)} {_n(place.top)})" '
        f'fill="none" stroke-linecap="round" stroke-linejoin="round">\n{inner}\n</g>\n{_legend(picture)}</svg>\n'
    )


def _areas(picture: PathPicture) -> Iterator[str]:
    """Yield the machined area and what is left of it."""
    shape = "".join(path_data(rows) + "Z" for rows in picture.contours if _closed(rows))
    yield f'<path id="area" d="{shape}" fill="{AREA}" fill-rule="evenodd"/>'
    for name, fill, outlines in (("unreachable", "url(#hatch)", picture.unreachable), ("left", LEFT, picture.left)):
        shape = "".join("M" + "L".join(f"{_n(x)} {_n(y)}" for x, y in outline) + "Z" for outline in outlines)
        if shape:
            yield f'<path id="{name}" d="{shape}" fill="{fill}" fill-rule="evenodd"/>'


def _closed(rows: Rows) -> bool:
    return len(rows) > 0 and bool(np.all(rows[0, :2] == rows[-1, 2:4]))


def _strokes(picture: PathPicture, pixel: float) -> Iterator[str]:
    """Yield one path element a style."""
    for style in (*picture.styles()[1:], PART):
        pieces = picture.contours if style is PART else [rows for each, rows in picture.paths if each is style]
        dash = " ".join(_n(length * pixel) for length in style.dash)
        dashed = f' stroke-dasharray="{dash}"' if dash else ""
        data = "".join(path_data(rows) for rows in pieces)
        yield (
            f'<path id="{style.name.lower()}" d="{data}" stroke="{style.colour}" '
            f'stroke-width="{_n(style.width * pixel)}"{dashed}/>'
        )


def _plunges(picture: PathPicture, pixel: float) -> Iterator[str]:
    for x, y in picture.plunges:
        yield (
            f'<circle cx="{_n(x)}" cy="{_n(y)}" r="{_n(4 * pixel)}" stroke="{PLUNGE}" '
            f'stroke-width="{_n(1.4 * pixel)}"/>'
        )


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


def _legend(picture: PathPicture) -> str:
    x, y = WIDTH - LEGEND, MARGIN + 14
    font = 'font-family="system-ui, sans-serif"'
    lines = [
        f'<text x="{x}" y="{y}" {font} font-size="15" font-weight="600" fill="{INK}">{escape(picture.title)}</text>'
    ]
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
    """Return a number to a nanometre."""
    return trimmed(value, 6)
