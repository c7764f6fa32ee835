"""Traces as Qt paints them: dots are there, dashes run on, nothing is lost where long ones are painted in pieces."""

from __future__ import annotations

import cv2
import numpy as np
import pytest

from app.formats.plot.flat import dashes
from app.formats.plot.layout import Plot
from app.formats.plot.page import PageContent, Pen, PlotPage, TracedPolyline
from app.formats.plot.surface_plot import DASHES
from app.geometry.transform import Similarity
from app.model.scene import LineType
from app.ui.views.plot.sheet_files import png_bytes
from app.ui.views.plot.sheet_painter import sheets

X = np.linspace(5.0, 95.0, 451)
FINE = np.column_stack([X, np.full_like(X, 10.0)])


@pytest.mark.parametrize("line", [LineType.SOLID, LineType.DOTTED, LineType.CHAIN])
def test_line_types_are_painted_along_many_short_chords(qapp: object, line: LineType) -> None:
    pen = Pen(1, "#000000", 0.3, DASHES[line])
    page = PlotPage(
        100.0, 20.0, (0.0, 0.0, 100.0, 20.0), Similarity(2 + 0j), PageContent(traces=(TracedPolyline(pen, FINE / 2),))
    )
    image = cv2.imdecode(np.frombuffer(png_bytes(sheets(Plot((page,), 1, 2.0))[0]), np.uint8), cv2.IMREAD_GRAYSCALE)
    assert image is not None
    per_mm = image.shape[1] / 100.0
    dark = image[round(10 * per_mm) - 2 : round(10 * per_mm) + 3].min(axis=0) < 128
    inked = np.zeros(len(dark), bool)
    for piece in dashes(FINE, pen.dash) if pen.dash else [FINE]:
        inked[round((piece[0, 0] - 0.15) * per_mm) : round((piece[-1, 0] + 0.15) * per_mm)] = True
    assert np.mean(dark != inked) < 0.1
    assert np.count_nonzero(np.diff(dark.astype(int)) == 1) == np.count_nonzero(np.diff(inked.astype(int)) == 1)
