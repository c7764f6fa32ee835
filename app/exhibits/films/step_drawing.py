"""Pictures of the films: lines, places and words in the part's mm, put on a sheet as large as they need."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from ...formats.plot.page import FilledPolygon, PageContent, Pen, PlotPage, TextLine, TracedPolyline
from ...geometry.transform import Similarity
from ...model.motion import Floats

WIDTH, MOST_HEIGHT, MARGIN = 200.0, 150.0, 9.0
"""mm of the sheets."""

INK, FAINT, GREEN, AMBER, BLUE, RED, PURPLE, AREA = (
    "#1E2227",
    "#A9AFB6",
    "#009E73",
    "#E69F00",
    "#2979FF",
    "#D32F2F",
    "#CC79A7",
    "#DDE7E2",
)
"""Colours that people tell apart, whatever their eyes; the same as those of the plots."""

LINE, BOLD, FINE = 0.35, 0.6, 0.18
"""Widths of lines, mm on the sheet."""
DOTTED, DASHED, CHAIN = (0.4, 1.2), (2.4, 1.4), (4.0, 1.2, 0.4, 1.2)
"""Dashes and what is between them, mm on the sheet."""
_TEXT = 3.0
"""Height of letters, mm on the sheet."""
_CORNERS = 48
"""Of a circle as it is drawn."""


class StepDrawing:
    """What is drawn, in the order in which it is asked for; filled areas lie below lines, words above.

    Of places in space two axes are seen, of those in the plane both.
    """

    def __init__(self, axes: tuple[int, int] = (0, 1)) -> None:
        """Begin an empty picture.

        Args:
            axes: of places in space, the one across the sheet and the one up it.
        """
        self._axes = list(axes)
        self._traces: list[TracedPolyline] = []
        self._patches: list[FilledPolygon] = []
        self._words: list[tuple[str, float, float, str, tuple[float, float]]] = []
        self._dots: list[tuple[float, float, float, str, bool]] = []
        self._reach: list[Floats] = []

    def line(self, points: Floats, colour: str = INK, width: float = LINE, dash: tuple[float, ...] = ()) -> None:
        """Draw a polyline (n, 2), n >= 2, mm; fewer points are nothing."""
        if len(points) >= 2:
            flat = self._flat(points)
            self._traces.append(TracedPolyline(Pen(colour=colour, width=width, dash=dash), flat))
            self._reach.append(flat)

    def ring(self, centre: Sequence[float], radius: float, colour: str = INK, width: float = LINE) -> None:
        """Draw a circle, mm."""
        angle = np.linspace(0.0, 2 * math.pi, _CORNERS + 1)
        self.line(self._flat(centre) + radius * np.column_stack([np.cos(angle), np.sin(angle)]), colour, width)

    def area(self, corners: Floats, colour: str = AREA) -> None:
        """Fill a polygon (n, 2), mm."""
        flat = self._flat(corners)
        self._patches.append(FilledPolygon(Pen(colour=colour), tuple((float(x), float(y)) for x, y in flat)))
        self._reach.append(flat)

    def dots(self, places: Floats, colour: str = INK, size: float = 0.7, hollow: bool = False) -> None:
        """Mark places (n, 2), mm; their size is mm on paper."""
        for x, y in self._flat(places).tolist():
            self._dots.append((x, y, size, colour, hollow))
        if len(places):
            self._reach.append(self._flat(places))

    def word(self, text: str, at: Sequence[float], colour: str = INK, shift: tuple[float, float] = (1.2, 1.2)) -> None:
        """Write beside a place, mm; shifted by mm on paper."""
        (place,) = self._flat(at)
        self._words.append((text, float(place[0]), float(place[1]), colour, shift))

    def _flat(self, places: Sequence[float] | Floats) -> Floats:
        """Return places (n, 2) or (n, 3), or one of them, as the sheet has them, (n, 2)."""
        rows = np.atleast_2d(np.asarray(places, np.float64))
        return rows[:, self._axes] if rows.shape[1] > 2 else rows

    def page(self, box: tuple[float, float, float, float] | None = None) -> PlotPage:
        """Return the sheet.

        Args:
            box: x0, y0, x1, y1 of what is seen, mm; all of it unless said otherwise.
        """
        places = np.concatenate(self._reach) if self._reach else np.zeros((1, 2))
        x0, y0, x1, y1 = box if box is not None else (*places.min(axis=0).tolist(), *places.max(axis=0).tolist())
        across, up = max(x1 - x0, 1e-6), max(y1 - y0, 1e-6)
        room = WIDTH - 2 * MARGIN
        scale = min(room / across, (MOST_HEIGHT - 2 * MARGIN) / up)
        height = max(scale * up, 20.0) + 2 * MARGIN
        left, foot = MARGIN + (room - scale * across) / 2 - scale * x0, height / 2 - scale * (y0 + y1) / 2
        place = Similarity(complex(scale), complex(left, foot))
        window = (MARGIN / 2, MARGIN / 2, WIDTH - MARGIN / 2, height - MARGIN / 2)
        return PlotPage(WIDTH, height, window, place, PageContent(patches=tuple(self._patches)), self._above(place))

    def _above(self, place: Similarity) -> PageContent:
        """Return lines, marks and words, mm of the sheet: a sheet's frame lies over its drawing, and so over areas."""
        traces = [TracedPolyline(trace.pen, trace.placed(place)) for trace in self._traces]
        discs = []
        for x, y, size, colour, hollow in self._dots:
            rim = _round(*place((x, y)), size)
            if hollow:
                traces.append(TracedPolyline(Pen(colour=colour, width=FINE * 1.5), rim))
            else:
                discs.append(FilledPolygon(Pen(colour=colour), tuple((float(a), float(b)) for a, b in rim)))
        words = []
        for text, x, y, colour, (dx, dy) in self._words:
            left, foot = place((x, y))
            words.append(TextLine(text, (left + dx, foot + dy), _TEXT, pen=Pen(colour=colour)))
        return PageContent(patches=tuple(discs), words=tuple(words), traces=tuple(traces))


def _round(x: float, y: float, radius: float, corners: int = 16) -> Floats:
    angle = np.linspace(0.0, 2 * math.pi, corners + 1)
    return np.column_stack([x + radius * np.cos(angle), y + radius * np.sin(angle)])


def broadest(points: Floats) -> tuple[int, int]:
    """Return the two axes along which places (n, 3) reach farthest: a pass over a surface bends along Z."""
    least = int(np.argmin(np.ptp(points, axis=0)[::-1]))  # of equal ones Z is not seen
    across, up = (axis for axis in range(3) if axis != 2 - least)
    return across, up


def seen(points: Floats, turn_deg: float = -35.0, tilt_deg: float = 35.0) -> Floats:
    """Return places (..., 3) as they are seen from the side and above, without perspective, (..., 2) mm."""
    turn, tilt = math.radians(turn_deg), math.radians(tilt_deg)
    x = points[..., 0] * math.cos(turn) - points[..., 1] * math.sin(turn)
    y = points[..., 0] * math.sin(turn) + points[..., 1] * math.cos(turn)
    return np.stack([x, y * math.sin(tilt) + points[..., 2] * math.cos(tilt)], axis=-1)
