"""The tour: six steps beside the real things, by mouse or keys, never in the way, never offered twice."""

import pytest
from PySide6.QtCore import QPoint, QRect, Qt

from app.core.settings import load_settings
from app.ui.shell.help.tour import SEEN, STEPS


@pytest.fixture
def tour(qtbot, wiring):
    wiring.window_.actions_["tour"].trigger()
    qtbot.waitUntil(wiring.tour.callout.isVisible)
    return wiring.tour


def area(widget, window) -> QRect:
    return QRect(widget.mapTo(window, QPoint()), widget.size())


def test_every_step_stands_beside_its_thing_and_covers_none_of_it(tour, wiring) -> None:
    window = wiring.window_
    for number, step in enumerate(STEPS):
        assert tour.callout.title.text() == step.title
        assert tour.callout.count.text() == f"{number + 1} of 6"
        words, thing = area(tour.callout, window), area(step.at(tour.marks), window)
        assert window.rect().contains(words)
        assert not words.intersects(thing)
        tour.callout.next.click()
    assert not tour.callout.isVisible()


def test_keys_step_on_and_back_and_escape_skips_for_good(qtbot, tour, wiring) -> None:
    qtbot.keyClick(tour.callout.next, Qt.Key.Key_Right)
    qtbot.keyClick(tour.callout.next, Qt.Key.Key_Right)
    assert tour.number == 2
    qtbot.keyClick(tour.callout.next, Qt.Key.Key_Left)
    assert tour.number == 1
    qtbot.keyClick(tour.callout.next, Qt.Key.Key_Escape)
    assert not tour.callout.isVisible()
    assert load_settings().tour == SEEN


@pytest.mark.parametrize("key", [Qt.Key.Key_Return, Qt.Key.Key_Enter])
def test_enter_presses_the_button_that_has_the_keys(qtbot, tour, key) -> None:
    qtbot.keyClick(tour.callout.next, key)
    assert tour.number == 1
    qtbot.keyClick(tour.callout.back, key)
    assert tour.number == 0
    qtbot.keyClick(tour.callout.skip, key)
    assert not tour.callout.isVisible()


def test_the_work_goes_on_while_it_is_open(qtbot, tour, wiring) -> None:
    wiring.window_.actions_["tool_line"].trigger()
    wiring.document.run("line 0,0 10,0")
    assert tour.callout.isVisible()
    assert len(wiring.document.part.entities) == 1


def test_it_follows_the_window(qtbot, tour, wiring) -> None:
    tour.go(5)
    before = tour.callout.pos()
    wiring.window_.resize(1100, 700)
    qtbot.waitUntil(lambda: tour.callout.pos() != before)
    assert wiring.window_.rect().contains(area(tour.callout, wiring.window_))


def test_where_the_thing_is_not_shown_the_words_stand_over_the_view(tour, wiring) -> None:
    wiring.window_.actions_["view_cut"].trigger()
    tour.go(0)
    assert not wiring.window_.tool_strip.isVisible()
    assert wiring.window_.rect().contains(area(tour.callout, wiring.window_))


def test_the_first_start_offers_it_until_it_was_seen(computed) -> None:
    assert "Show me round" in [button.text() for button in computed.window_.notice.buttons]
    computed.tour.end()
    computed.files.open_sample()
    assert computed.window_.preferences.settings.tour == SEEN


def test_once_seen_it_is_not_offered(qtbot, wiring) -> None:
    wiring.tour.end()
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.window_.notice.isVisible(), timeout=20_000)
    assert [button.text() for button in wiring.window_.notice.buttons] == ["Draw your own"]
