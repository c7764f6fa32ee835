"""Figures 2a to 2c and 5a to 5d of the text as the view draws them: the same as the stored ones, which were looked
at.
"""

import numpy as np
import pytest
from PySide6.QtGui import QImage

from tests.ui.stages.figures import FOLDER, figures, pixels_of

_DIFFERENT, _SHARE = 60, 0.015
"""How far a colour may be off before a pixel counts as another, and how many may be: letters look otherwise in another
font.
"""

ALL = figures()


@pytest.mark.parametrize("name", ALL)
def test_a_figure_is_drawn_as_it_was_looked_at(qapp, tmp_path, name):
    got = ALL[name]()
    stored = QImage(str(FOLDER / f"fig{name}.png"))
    assert (got.width(), got.height()) == (stored.width(), stored.height())
    difference = np.abs(pixels_of(got) - pixels_of(stored)).max(axis=2)
    wrong = float(np.mean(difference > _DIFFERENT))
    if wrong > _SHARE:
        got.save(str(tmp_path / f"fig{name}-got.png"))
        shades = np.ascontiguousarray(255 - np.minimum(difference, 255), np.uint8)
        QImage(shades.data, shades.shape[1], shades.shape[0], shades.shape[1], QImage.Format.Format_Grayscale8).save(
            str(tmp_path / f"fig{name}-difference.png")
        )
    assert wrong <= _SHARE, f"{wrong:.1%} of the picture differs: see {tmp_path} and {FOLDER}"
