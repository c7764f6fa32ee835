"""A rectangle of cells that has changed since a picture of a cut was shown. No Qt, no OpenGL."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from .cut_picture import CutPicture, Heights
from .relief import REACH, Bytes, relief_part


@dataclass(frozen=True, eq=False)
class CellPatch:
    """New cells in the place of old ones.

    Attributes:
        row, col: of the lowest left one.
        heights: (h, w) float32 mm. values: (h, w) places in the palette. relief: (h, w, 8) as `app.ui.views.cut.relief`
            makes it.
    """

    row: int
    col: int
    heights: Heights
    values: Bytes
    relief: Bytes

    @property
    def rows(self) -> slice:
        """Which rows of the whole it is."""
        return slice(self.row, self.row + self.heights.shape[0])

    @property
    def columns(self) -> slice:
        """Which columns of the whole it is."""
        return slice(self.col, self.col + self.heights.shape[1])

    def write_to(self, picture: CutPicture, colour: Enum) -> None:
        """Make a picture of the whole the same, in its own arrays, so that picking and another theme see it too.

        What other colours would tell is forgotten; it is worked out anew when somebody asks for it.

        Args:
            picture: the whole; nobody else may rely on its arrays. colour: what `values` tell.
        """
        picture.heights[self.rows, self.columns] = self.heights
        picture.forget_extent()
        if "relief" in vars(picture):
            picture.relief[self.rows, self.columns] = self.relief
        for told in list(picture.values):
            if told is colour:
                picture.values[told][self.rows, self.columns] = self.values
            else:
                del picture.values[told]


def patch_of(heights: Heights, values: Bytes, pitch: float, changed: tuple[slice, slice]) -> CellPatch:
    """Return what has to be shown anew when cells have changed: they, and those round them that the light falls on
    otherwise.

    Args:
        heights: (rows, columns) all of them, as they are now, mm. values: (rows, columns) places in the palette.
        pitch: mm. changed: rows and columns that have other heights or values than before.
    """
    rows, columns = (
        slice(max(part.start - REACH, 0), min(part.stop + REACH, count))
        for part, count in zip(changed, heights.shape, strict=True)
    )
    light = relief_part(heights, pitch, rows, columns)
    return CellPatch(rows.start, columns.start, heights[rows, columns].copy(), values[rows, columns].copy(), light)
