"""Takes the pictures of the window: `python -m tests.ui.make_screenshots [FOLDER]`.

Without a folder it renews the manual's picture, resources/docs/window.png; with one it writes every view there, light
and dark, at 1280 x 800 and 1920 x 1080.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtWidgets import QApplication

from app.settings import ThemeChoice
from app.ui.computation import State
from app.ui.memory import choose_theme
from app.ui.start import build
from app.ui.views import View
from app.ui.wiring import Wiring

SIZES = ((1280, 800), (1920, 1080))
DOCUMENT = Path(__file__).resolve().parents[2] / "resources" / "docs" / "window.png"


def wait(milliseconds: int) -> None:
    """Let the window live for a while."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def computed_sample() -> Wiring:
    """Return a shown window with the sample part, computed."""
    window, wiring = build()
    window.resize(1440, 900)
    window.show()
    wiring.files.open_sample()
    end = time.monotonic() + 120
    while wiring.computation.state is not State.CURRENT:
        if time.monotonic() > end:
            raise SystemExit(f"the sample was not computed: {wiring.computation.state.value} {wiring.computation.error}")
        wait(20)
    return wiring


def take(wiring: Wiring, path: Path) -> None:
    """Save what the window looks like."""
    wait(400)
    wiring.window_.grab().save(str(path))
    print(path)


def main() -> None:
    """Take the pictures."""
    os.environ["HITOFUDE_CONFIG"] = tempfile.mkdtemp()
    application = QApplication.instance() or QApplication([])
    wiring = computed_sample()
    if len(sys.argv) < 2:
        choose_theme(wiring.window_, ThemeChoice.LIGHT)
        take(wiring, DOCUMENT)
        return
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for theme in (ThemeChoice.LIGHT, ThemeChoice.DARK):
        choose_theme(wiring.window_, theme)
        for width, height in SIZES:
            wiring.window_.resize(width, height)
            for view in View:
                wiring.showing.show_view(view)
                wait(50)
                wiring.window_.canvas.fit()
                take(wiring, folder / f"{view.name.lower()}-{theme.value}-{width}.png")
    application.quit()


if __name__ == "__main__":
    main()
