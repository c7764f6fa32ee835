"""A picture of part and paths: what is drawn, how it looks, and where it comes to lie."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...geometry.primitives import Rows, boxes

Points = NDArray[np.float64]

WIDTH = 1600
"""Pixels across a whole picture."""

LEGEND = 220
"""Width of the legend, px."""
MARGIN = 40
"""Round the drawing, px."""
PAPER, INK, AREA, MUTED = "#FAFAF8", "#1E2227", "#F1F2EE", "#5C626A"
LEFT, UNREACHABLE, PLUNGE = "#2979FF", "#B0A8C8", "#D55E00"


@dataclass(frozen=True)
class PicturePathStyle:
    """How a kind of path is drawn: colour, width in pixels, dash and gap in pixels (none: solid)."""

    name: str
    colour: str
    width: float
    dash: tuple[float, ...] = ()


PART = PicturePathStyle("Part", INK, 1.6)
RAPID = PicturePathStyle("Rapid", "#8A8F98", 1.0, (1.5, 4.5))
LINK = PicturePathStyle("Link", "#66C5AB", 1.0)
POCKET = PicturePathStyle("Pocket", "#009E73", 1.6)
CONTOUR = PicturePathStyle("Contour", "#E69F00", 1.8, (9.0, 5.0))


class StyledPath(NamedTuple):
    """Connected rows (n, 8), mm, and how they are drawn."""

    style: PicturePathStyle
    rows: Rows


class PictureLegendRow(NamedTuple):
    """An entry of the legend; without a style a patch of the colour."""

    label: str
    colour: str
    style: PicturePathStyle | None = None


@dataclass(frozen=True)
class PathPicture:
    """What is drawn, in part coordinates, mm, y up.

    Attributes:
        title: shown above the legend.
        contours: rows (n, 8) of each contour of the part.
        paths: drawn in this order.
        plunges: (n, 2) where tools go down.
        left, unreachable: outlines (n, 2), holes among them, of floor that is left within and out of reach.
    """

    title: str
    contours: tuple[Rows, ...]
    paths: tuple[StyledPath, ...]
    plunges: Points
    left: tuple[Points, ...] = ()
    unreachable: tuple[Points, ...] = ()

    def styles(self) -> tuple[PicturePathStyle, ...]:
        """Return the styles that occur, the part first."""
        return (PART, *dict.fromkeys(style for style, _ in self.paths))


@dataclass(frozen=True)
class PictureLayout:
    """Where part coordinates come to lie: pixel = (left + scale x, top - scale y)."""

    scale: float
    left: float
    top: float
    height: int

    def pixels(self, points: Points) -> Points:
        """Return pixel positions (n, 2), y down, of points (n, 2) in mm, y up."""
        return np.stack([self.left + self.scale * points[:, 0], self.top - self.scale * points[:, 1]], axis=1)


def layout(picture: PathPicture) -> PictureLayout:
    """Return the layout that shows everything, as large as the width allows, no higher than 1.5 times as wide."""
    around = [boxes(rows) for rows in (*picture.contours, *(rows for _, rows in picture.paths)) if len(rows)]
    box = np.concatenate(around) if around else np.array([[0.0, 0.0, 1.0, 1.0]])
    (x0, y0), (x1, y1) = box[:, :2].min(axis=0), box[:, 2:].max(axis=0)
    room = WIDTH - LEGEND - 2 * MARGIN
    scale = float(min(room / max(x1 - x0, 1e-6), 1.5 * WIDTH / max(y1 - y0, 1e-6)))
    height = max(round(scale * (y1 - y0)) + 2 * MARGIN, 320)
    across = MARGIN + (room - scale * (x1 - x0)) / 2
    return PictureLayout(scale, float(across - scale * x0), float(MARGIN + scale * y1), height)


def legend_rows(picture: PathPicture) -> list[PictureLegendRow]:
    """Return the entries of the legend."""
    rows = [PictureLegendRow(style.name, style.colour, style) for style in picture.styles()]
    rows += [PictureLegendRow("Plunge", PLUNGE)] if len(picture.plunges) else []
    rows += [PictureLegendRow("Left, within reach", LEFT)] if picture.left else []
    rows += [PictureLegendRow("Out of reach", UNREACHABLE)] if picture.unreachable else []
    return rows
