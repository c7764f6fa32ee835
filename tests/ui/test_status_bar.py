"""The bottom line: one thing is waited for at a time."""

import pytest

from app.ui.shell.status_bar import StatusBar


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
