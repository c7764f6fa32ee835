"""However much there is to show, it does not take for ever."""

import numpy as np
import pytest
from PySide6.QtCore import QObject

from app.ui.views.session1986.players import LEAST_MS, LONGEST_S, ListingPlayer, StillPlayer
from app.ui.views.session1986.screen import TerminalScreen
from app.ui.views.session1986.stills import ScreenStill


def still(number: int) -> ScreenStill:
    return ScreenStill(number, "A step", np.zeros(400 * 50, np.uint8), 80)


def test_many_stills_go_by_quicker_few_as_slowly_as_they_should(qtbot) -> None:
    home = QObject()
    for count, interval in ((5, 80), (1000, 25), (10_000, LEAST_MS)):
        playing = StillPlayer(TerminalScreen(), home)
        playing.start([still(301)] * count)
        assert playing._clock.interval() == interval
        playing.stop()


def test_stills_are_shown_in_order_to_the_last(qtbot) -> None:
    home, screen = QObject(), TerminalScreen()
    playing, heads = StillPlayer(screen, home), []
    playing.changed.connect(lambda: heads.append(screen.head))
    with qtbot.waitSignal(playing.finished, timeout=3000):
        playing.start([still(301), still(302), still(307)])
    assert heads == [("301 A step", "1/3"), ("302 A step", "2/3"), ("307 A step", "3/3")]


@pytest.mark.exhaustive
def test_a_listing_of_any_length_scrolls_through_in_seconds(qtbot) -> None:
    home, screen = QObject(), TerminalScreen()
    listing = ListingPlayer(screen, home)
    lines = [f"G1 X{k}" for k in range(100_000)]
    with qtbot.waitSignal(listing.finished, timeout=round(1000 * LONGEST_S * 1.5)):
        listing.start(lines)
    assert screen.page == lines
