"""Figures of the texts are drawn by one script from what the program computes, and stand on both pages."""

from __future__ import annotations

import re

import cv2
import numpy as np
import pytest

from app.core.resources import resource
from app.exhibits.figure_eleven import FigureOptions, figure_eleven
from tests.exhibits.redrawn import FIGURES, redrawn


@pytest.mark.parametrize("page", ["texts.md", "texts_ja.md"])
def test_every_figure_stands_on_the_page(page: str) -> None:
    text = resource("docs", page).read_text(encoding="utf-8")
    assert tuple(re.findall(r"\(figures/(\w+)\.png\)", text)) == FIGURES
    for name in FIGURES:
        assert resource("docs", "figures", f"{name}.png").stat().st_size < 400_000


@pytest.mark.exhaustive
def test_figures_are_those_that_the_script_draws() -> None:
    """All but figure 11, whose seconds are of a machine."""
    made = redrawn(figure_eleven(FigureOptions(("A", "B"), 64, 1)))
    assert tuple(made) == FIGURES
    for name, data in made.items():
        image = cv2.imdecode(np.frombuffer(data, np.uint8), cv2.IMREAD_COLOR)
        assert len(np.unique(image.reshape(-1, 3), axis=0)) >= 2, name
        if name != "b11":
            kept = resource("docs", "figures", f"{name}.png").read_bytes()
            assert np.array_equal(image, cv2.imdecode(np.frombuffer(kept, np.uint8), cv2.IMREAD_COLOR)), name
