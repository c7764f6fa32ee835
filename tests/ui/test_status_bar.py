"""The bottom line: one thing is waited for at a time."""

from itertools import pairwise

import pytest
from PySide6.QtWidgets import QApplication, QWidget

from app.ui.framework.verdict import VerdictLevel, VerdictSummary
from app.ui.shell.bars.badge import Badge
from app.ui.shell.bars.status_bar import StatusBar


@pytest.fixture
def bar(qtbot):
    made = StatusBar()
    qtbot.addWidget(made)
    made.show()
    return made


def test_what_goes_on_in_the_background_is_told_while_no_job_tells_of_itself(bar: StatusBar) -> None:
    assert not bar.waiting.isVisible()
    bar.show_waiting("Compiling: 3 of 9")
    assert bar.waiting.isVisible() and bar.waiting.text() == "Compiling: 3 of 9"
    bar.show_progress(0.2, "Pockets")
    bar.show_waiting("Compiling: 4 of 9")
    assert not bar.waiting.isVisible()
    bar.show_progress(None)
    assert bar.waiting.isVisible() and bar.waiting.text() == "Compiling: 4 of 9"
    bar.show_waiting("")
    assert not bar.waiting.isVisible()


@pytest.mark.parametrize("width", [1280, 880])
def test_nothing_lies_over_what_a_running_job_tells(qtbot, width: int) -> None:
    window = QWidget()
    qtbot.addWidget(window)
    bar = StatusBar()
    bar.setParent(window)
    bar.setGeometry(0, 0, width, 34)
    window.show()
    bar.show_grid(100.0)
    bar.show_message("Paths up to date")
    bar.show_progress(0.9, "Reading a-part-with-a-long-name.dxf")
    QApplication.processEvents()
    row = [bar.grid, bar.message, bar.step, bar.bar, bar.cancel, bar.badge]
    for left, right in pairwise(row):
        assert left.geometry().right() < right.geometry().left() or not left.width(), (left, right)
    assert bar.badge.geometry().right() <= bar.width()


@pytest.mark.parametrize(("room", "shown"), [(1.0, 5), (0.9, 3), (0.6, 2)])
def test_where_room_is_short_the_badge_leaves_out_whole_parts(qtbot, room, shown):
    badge = Badge()
    qtbot.addWidget(badge)
    parts = ["✓ 0 gouge", "0 left", "15 places out of reach", "2 strokes", "4:12"]
    badge.show_verdict(VerdictSummary(VerdictLevel.OK, " · ".join(parts)))
    fits = badge.fitting(round(room * badge.fontMetrics().horizontalAdvance(badge.text())))
    assert fits.removesuffix(" · …").split(" · ") == parts[:shown]
    assert fits.endswith("…") is (shown < 5)
    assert badge.text() == " · ".join(parts), "what is read aloud and told by the tip is all of it"
    assert badge.minimumSizeHint().width() < badge.sizeHint().width()


def test_a_place_far_out_is_not_cut_off(qtbot):
    bar = StatusBar()
    qtbot.addWidget(bar)
    bar.show_place(-123456.789, 0.0)
    assert bar.place_x.sizeHint().width() <= bar.place_x.maximumWidth()
    bar.resize(1280, 34)
    bar.show()
    assert bar.place_x.width() >= bar.place_x.fontMetrics().horizontalAdvance("X -123456.789")
