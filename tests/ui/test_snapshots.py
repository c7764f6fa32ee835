"""Every tool, page, menu and window of the Draw view looks as it did when somebody last looked at it."""

from collections.abc import Iterator

import pytest
from PySide6.QtWidgets import QWidget
from pytestqt.qtbot import QtBot

from app.core.settings import ThemeChoice
from app.ui.shell.start import build
from app.ui.shell.window_controller import WindowController
from tests.ui.one_window import end
from tests.ui.snapshots import FOLDER, KINDS, kept, letters, share_changed, small, states, wait
from tests.ui.window_picture import seen

SAME, OTHER = 0.06, 0.30
"""Share of a picture that may differ: where the fonts are those of the pictures, and where they are not. A panel is a
tenth.
"""


@pytest.fixture
def wiring(qtbot: QtBot) -> Iterator[WindowController]:
    """A shown window of its own; with changes that nobody saves it would ask, and stay under every later pointer."""
    window, wiring = build()
    window.show()
    yield wiring
    end(wiring)


@pytest.mark.exhaustive
@pytest.mark.parametrize(("theme", "size"), KINDS, ids=[f"{theme.value}-{size[0]}" for theme, size in KINDS])
def test_every_state_looks_as_it_is_kept(wiring: WindowController, theme: ThemeChoice, size: tuple[int, int]) -> None:
    wanted, changed, names = kept(theme, size), {}, []
    for name, picture in states(wiring, theme, size):
        names.append(name)
        if name in wanted:
            changed[name] = share_changed(picture, wanted[name])
    assert names == list(wanted), (
        "a tool, page or menu is new or gone: take them anew, python -m tests.ui.snapshots, and look"
    )
    worst = sorted(changed.items(), key=lambda item: -item[1])[:5]
    most = SAME if letters() == (FOLDER / "letters.txt").read_text().strip() else OTHER
    assert worst[0][1] <= most, (
        f"these look different: {worst}; look, and if it is meant take them anew, python -m tests.ui.snapshots"
    )


@pytest.mark.parametrize("what", ["side", "tool_strip", "colours"])
def test_what_is_missing_would_be_seen(wiring: WindowController, what: str) -> None:
    (theme, size), window = KINDS[0], wiring.window_
    _, before = next(states(wiring, theme, size))
    if what == "colours":
        window.choose_theme(KINDS[-1][0])
    else:
        missing: QWidget = getattr(window, what)
        missing.hide()
    wait(200)
    assert share_changed(small(seen(window)), before) > SAME


def test_the_pictures_are_small() -> None:
    assert sum(path.stat().st_size for path in FOLDER.iterdir()) < 4_000_000
