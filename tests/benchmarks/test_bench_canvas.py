"""How a canvas of 10,000 arcs and lines, 1920 x 1000 px, answers: at once, and sharp; against the plain repaint of all
of it.

QT_SCALE_FACTOR=2 measures a screen of twice as many px each way.
"""

import math
import os
import random

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from app.drafting.document import Document
from app.model.curves import Arc, Curve, Line
from app.model.job import Job
from app.model.part import Part
from app.ui.framework.theme import LIGHT
from app.ui.views.canvas.canvas import Canvas
from tests.benchmarks.conftest import OURS, record

pytestmark = pytest.mark.benchmark
PLAIN = "plain repaint"
SCREEN = os.environ.get("QT_SCALE_FACTOR", "1")
TASK = "canvas, 10,000 curves: " if SCREEN == "1" else f"canvas at {SCREEN}x, 10,000 curves: "


@pytest.fixture
def canvas(qtbot) -> Canvas:
    rng = random.Random(1)
    curves: list[Curve] = []
    for number in range(10_000):
        x, y, a, r = rng.uniform(0, 400), rng.uniform(0, 200), rng.uniform(0, math.tau), rng.uniform(1, 8)
        start = (x + r * math.cos(a), y + r * math.sin(a))
        curves.append(
            Line((x, y), start)
            if number % 2
            else Arc(start, (x + r * math.cos(a + 2), y + r * math.sin(a + 2)), (x, y))
        )
    made = Canvas(Document(Job(Part().with_curves(curves, "0"))), LIGHT)
    qtbot.addWidget(made)
    made.resize(1920, 1000)
    made.show()
    made.fit_to((0, 0, 400, 200))
    made.repaint()
    qtbot.waitUntil(lambda: made.sharp and made._far.whole)
    return made


def all_of_it(canvas: Canvas) -> None:
    canvas.scene_ms = 0.0
    canvas.repaint_scene()
    canvas.repaint()
    while not canvas.sharp:
        canvas._grow()


def zoom(canvas: Canvas) -> None:
    canvas.scene_ms = 1000.0
    canvas.set_view(canvas.view.zoomed(1.1 if canvas.view.scale < 10 else 0.5, canvas.area.center()))
    canvas.repaint()


def zoom_out(canvas: Canvas) -> None:
    canvas.scene_ms = 1000.0
    canvas.set_view(canvas.view.zoomed(0.9 if canvas.view.scale > 1 else 4.0, canvas.area.center()))
    canvas.repaint()


def pan(canvas: Canvas) -> None:
    canvas.scene_ms = 1000.0
    canvas.set_view(canvas.view.panned(3, 2))
    canvas.repaint()


def select(canvas: Canvas) -> None:
    canvas.document.select({next(iter(canvas.document.selection), 0) % 9_000 + 1})
    canvas.repaint()


def draw(canvas: Canvas) -> None:
    canvas.document.run("line 30,30 60,60")
    canvas.repaint()


@pytest.mark.parametrize("act", [zoom, zoom_out, pan, select, draw], ids=lambda act: act.__name__)
@pytest.mark.parametrize("engine", [OURS, PLAIN])
def test_answer(benchmark: BenchmarkFixture, canvas: Canvas, act, engine: str) -> None:
    benchmark.pedantic(act if engine == OURS else all_of_it, (canvas,), rounds=20, warmup_rounds=2)
    record(benchmark, TASK + act.__name__, engine)
    assert canvas.heavy
