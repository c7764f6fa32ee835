"""At every scale of the screen a line is painted with the screen's own px, never enlarged from coarser ones."""

import os
import subprocess
import sys

import pytest

GRAB = """
from PySide6.QtWidgets import QApplication
app = QApplication([])
from app.drafting.document import Document
from app.model.curves import Line
from app.model.job import Job
from app.model.part import Part
from app.ui.views.canvas.canvas import Canvas
from app.ui.views.canvas.view_transform import ViewTransform
from app.ui.framework.theme import LIGHT
canvas = Canvas(Document(Job(Part().with_curves([Line((20.0, 0.0), (20.0, 40.0))], "0"))), LIGHT)
canvas.resize(400, 300)
canvas.show()
app.processEvents()
canvas.set_view(ViewTransform(5.0, 100.0, 250.0))
image = canvas.grab().toImage()
ratio = image.devicePixelRatio()
row = [image.pixelColor(x, round(160 * ratio)).lightness() for x in range(round(195 * ratio), round(205 * ratio))]
print(image.width(), min(row), LIGHT.ink.lightness())
"""


@pytest.mark.parametrize("scale", ["1", "1.25", "1.5", "2"])
def test_a_line_is_as_sharp_as_the_screen(scale: str) -> None:
    env = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "QT_SCALE_FACTOR": scale}
    said = subprocess.run(
        [sys.executable, "-c", GRAB], env=env, capture_output=True, text=True, check=True, timeout=60
    ).stdout
    width, darkest, ink = map(int, said.split())
    covered = min(1.0, 1.25 * float(scale) / 2)
    assert width == 400 * float(scale)
    assert darkest == pytest.approx(255 - covered * (255 - ink), abs=15), (
        "the px beside the middle of a line of 1.25 px"
    )
