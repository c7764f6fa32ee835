"""Snapshots of the window: every state of the Draw view as a small picture, all of one theme and size on one sheet.

`python -m tests.ui.snapshots` takes them anew; what it writes is to be looked at before it is kept.
"""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator
from itertools import chain
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray
from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtGui import QFontMetrics, QImage, QPixmap
from PySide6.QtWidgets import QApplication

from app.core.settings import ThemeChoice
from app.ui.framework.theme import text_font
from app.ui.shell.start import build
from app.ui.shell.window_controller import WindowController
from tests.ui.drawing_states import DrawingStates
from tests.ui.scene_states import scene_states
from tests.ui.window_picture import seen

Picture = NDArray[np.uint8]

FOLDER = Path(__file__).resolve().parent / "snapshots"
KINDS = tuple((theme, size) for theme in (ThemeChoice.LIGHT, ThemeChoice.DARK) for size in ((1280, 800), (1920, 1080)))
WIDTH, ACROSS = 320, 8
BLOCK = 8
"""px of a small picture that are compared together: letters of other fonts come out alike."""


def wait(milliseconds: int) -> None:
    """Let the window live for a while."""
    loop = QEventLoop()
    QTimer.singleShot(milliseconds, loop.quit)
    loop.exec()


def small(picture: QPixmap) -> Picture:
    """Return a picture (h, WIDTH, 3), BGR."""
    image = picture.toImage().convertToFormat(QImage.Format.Format_RGB888)
    rows = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    colours = rows[:, : 3 * image.width()].reshape(image.height(), image.width(), 3)[..., ::-1]
    height = round(WIDTH * image.height() / image.width())
    return np.asarray(
        cv2.resize(np.ascontiguousarray(colours), (WIDTH, height), interpolation=cv2.INTER_AREA), np.uint8
    )


def states(wiring: WindowController, theme: ThemeChoice, size: tuple[int, int]) -> Iterator[tuple[str, Picture]]:
    """Put the window into every state and give its name and small picture."""
    wiring.window_.choose_theme(theme)
    wiring.window_.resize(*size)
    made = DrawingStates(wiring, wait)
    made.begin()
    for name in chain(made.tools(), made.pages(), made.over(), made.printing(), scene_states(wiring, wait)):
        yield name, at_rest(wiring)


def at_rest(wiring: WindowController) -> Picture:
    """Return the window's small picture once it stays the same for 150 ms: what is worked out beside comes late on a
    busy machine.
    """
    wait(150)
    picture = small(seen(wiring.window_))
    for _ in range(20):
        wait(150)
        before, picture = picture, small(seen(wiring.window_))
        if share_changed(before, picture) == 0.0:
            break
    return picture


def sheet(pictures: list[Picture]) -> Picture:
    """Return pictures of one size side by side, ACROSS a row."""
    height = pictures[0].shape[0]
    blank = np.zeros((height, WIDTH, 3), np.uint8)
    filled = pictures + [blank] * (-len(pictures) % ACROSS)
    return np.vstack([np.hstack(filled[k : k + ACROSS]) for k in range(0, len(filled), ACROSS)])


def kept(theme: ThemeChoice, size: tuple[int, int]) -> dict[str, Picture]:
    """Return the pictures that are kept, by name."""
    page = cv2.imread(str(sheet_path(theme, size)), cv2.IMREAD_COLOR)
    assert page is not None
    height = round(WIDTH * size[1] / size[0])
    names = (FOLDER / "names.txt").read_text().split()
    return {
        name: np.asarray(
            page[k // ACROSS * height : (k // ACROSS + 1) * height, k % ACROSS * WIDTH : (k % ACROSS + 1) * WIDTH],
            np.uint8,
        )
        for k, name in enumerate(names)
    }


def sheet_path(theme: ThemeChoice, size: tuple[int, int]) -> Path:
    """Return where a sheet is kept."""
    return FOLDER / f"draw-{theme.value}-{size[0]}.jpg"


def share_changed(one: Picture, other: Picture, most: float = 5.0) -> float:
    """Return the share of blocks whose mean colours differ by more than `most` of 255."""
    rows, columns = one.shape[0] // BLOCK * BLOCK, one.shape[1] // BLOCK * BLOCK

    def means(picture: Picture) -> NDArray[np.float64]:
        blocks = picture[:rows, :columns].astype(float).reshape(rows // BLOCK, BLOCK, columns // BLOCK, BLOCK, 3)
        return np.asarray(blocks.mean(axis=(1, 3)))

    return float(np.mean(np.abs(means(one) - means(other)).max(axis=2) > most))


def letters() -> str:
    """Return what tells the fonts of one machine from those of another: how wide some words are."""
    return str(QFontMetrics(text_font()).horizontalAdvance("Compute 400 x 400 Wgjq"))


def main(folder: Path = FOLDER) -> None:
    """Take all snapshots anew, each sheet from a window that nothing was done in."""
    application = QApplication.instance() or QApplication([])
    folder.mkdir(exist_ok=True)
    for theme, size in KINDS:
        os.environ["HITOFUDE_CONFIG"] = tempfile.mkdtemp()
        window, wiring = build()
        window.show()
        pictures = dict(states(wiring, theme, size))
        cv2.imwrite(
            str(folder / sheet_path(theme, size).name), sheet(list(pictures.values())), [cv2.IMWRITE_JPEG_QUALITY, 80]
        )
        (folder / "names.txt").write_text("\n".join(pictures) + "\n")
        (folder / "letters.txt").write_text(letters() + "\n")
        window.hide()
    application.quit()


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
