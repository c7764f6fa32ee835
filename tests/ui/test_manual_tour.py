"""The tutorials, followed in the real window: what a page has its reader do leads to what it shows and says."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

import pytest
from PySide6.QtWidgets import QWidget

from app.model.operation import Side
from app.ui.framework.catalogue import tr
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.shell.translation import translate_all
from app.ui.shell.window_controller import WindowController
from tests.ui.manual_tour import DOCS, ManualTour, typed_lines
from tests.ui.test_translation import left_english, seen_texts

WAIT_MS = 60_000


@dataclass
class Taken:
    """The pictures that a tour came to, in order."""

    names: list[str] = field(default_factory=list)

    def take(self, name: str, widget: QWidget) -> None:
        assert widget.window().isVisible()
        self.names.append(f"pictures/{name}.png")


@pytest.fixture
def taken() -> Taken:
    return Taken()


@pytest.fixture
def tour(qtbot, wiring, taken) -> ManualTour:
    return ManualTour(wiring, lambda done: qtbot.waitUntil(done, timeout=WAIT_MS), lambda _: None, taken.take)


def shown_on(page: str) -> list[str]:
    return re.findall(r"!\[[^]]+\]\(([^)]+)\)", (DOCS / f"{page}.md").read_text(encoding="utf-8"))


def kinds(wiring: WindowController) -> list[str]:
    return [operation.WORD for operation in wiring.document.job.operations]


def test_the_first_part(tour, taken, wiring) -> None:
    assert typed_lines("first_part") == typed_lines("first_part_ja") and len(typed_lines("first_part")) == 4
    tour.first_part()
    assert taken.names == shown_on("first_part")
    assert kinds(wiring) == ["drill", "pocket", "contour"]
    assert wiring.document.job.operations[-1].wall_side is Side.OUTSIDE
    assert wiring.computation.state is ComputationState.CURRENT
    assert "0 gouge" in wiring.window_.status.badge.text() and "0 left" in wiring.window_.status.badge.text()


@pytest.mark.exhaustive
def test_the_sign(tour, taken, wiring) -> None:
    tour.sign()
    assert taken.names == shown_on("sign")
    assert kinds(wiring) == ["bore", "contour", "contour"]
    assert [operation.wall_side for operation in wiring.document.job.operations[1:]] == [Side.ON, Side.OUTSIDE]


@pytest.mark.exhaustive
def test_the_mould(tour, taken, wiring) -> None:
    tour.mould()
    assert taken.names == shown_on("mould")


@pytest.mark.exhaustive
def test_the_foreign_program(tour, taken, wiring) -> None:
    tour.foreign_program()
    assert taken.names == shown_on("foreign_program")
    text = (DOCS / "foreign_program.md").read_text(encoding="utf-8")
    told = re.search(r"Here ([\d,]+) short moves become (\d+)", text)
    blocks = re.findall(r"\d+", wiring.window_.curves_panel.figures["Blocks"].text().replace("\u2009", ""))
    assert told is not None and [each.replace(",", "") for each in told.groups()] == blocks


@pytest.mark.exhaustive
def test_the_lesson(tour, taken) -> None:
    tour.five_texts()
    assert taken.names == shown_on("lesson")


NAMES = {"untitled", "fig2", "plate", "holes", "engraving", "nameplate", "slots", "guides", "ring", "scale"}
"""Of parts and layers: they stand as they are in both languages."""


@pytest.mark.exhaustive
def test_the_tour_leaves_nothing_in_english(qtbot, wiring) -> None:
    """What is shown and logged along the way, numbers' sentences too, is Japanese, but for names."""
    left = set[str]()

    def take(name: str, widget: QWidget) -> None:
        translate_all(wiring.window_)
        replies = {tr(line.reply) for line in wiring.log.lines}
        left.update(left_english(seen_texts(wiring.window_) | replies))

    tour = ManualTour(wiring, lambda done: qtbot.waitUntil(done, timeout=WAIT_MS), lambda _: None, take)
    wiring.window_.actions_["language_ja"].trigger()
    try:
        tour.first_part()
        tour.operation("slots", "slots.draw", "slots.toml", View.PATHS)
        tour.five_texts()
    finally:
        wiring.window_.actions_["language_en"].trigger()
    named = re.compile(r"\S+\.(draw|dxf|ngc|toml)\b|^(layer|circles):")
    assert sorted(text for text in left - NAMES if not named.search(text) and not TOOL.match(text)) == []


TOOL = re.compile(r"T\d+ +\w")
