"""Takes the manual's pictures from the real window: `python -m tests.ui.make_manual_pictures [PAGE…]`.

They go into resources/docs/pictures, those of the Japanese manual into pictures/ja, with at most 128 colours, so that
all of them together stay small.
"""

from __future__ import annotations

import os
import sys
import tempfile
from functools import partial
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

import numpy as np
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage
from PySide6.QtWidgets import QApplication, QWidget

from app.core.settings import Language, ThemeChoice
from app.ui.shell.start import build
from tests.ui.make_screenshots import wait, wait_until
from tests.ui.manual_tour import DOCS, OPERATION_PAGES, ManualTour

SIZE = (1180, 740)
COLOURS = 128
FOLDERS = {Language.ENGLISH: DOCS / "pictures", Language.JAPANESE: DOCS / "pictures/ja"}


def with_few_colours(picture: QImage) -> QImage:
    """Return a picture in the colours that it has most of, each pixel in the nearest one."""
    plain = picture.convertToFormat(QImage.Format.Format_RGB32)
    values = np.frombuffer(plain.constBits(), np.uint32).reshape(plain.height(), -1)[:, : plain.width()]
    coarse, at, count = np.unique(values & 0xF8F8F8, return_index=True, return_counts=True)
    most = np.argsort(-count)[:COLOURS]
    assert coarse.size
    table = [int(values.reshape(-1)[each]) | 0xFF000000 for each in at[most]]
    no_dither = Qt.ImageConversionFlag.ThresholdDither | Qt.ImageConversionFlag.AvoidDither
    return plain.convertToFormat(QImage.Format.Format_Indexed8, table, no_dither)


def save(folder: Path, name: str, widget: QWidget) -> None:
    """Save what a widget looks like once it rests."""
    wait(500)
    path = folder / f"{name}.png"
    with_few_colours(widget.grab().toImage()).save(str(path), "PNG", 0)
    print(f"{path} {path.stat().st_size // 1000} kB", flush=True)


def take(tour: ManualTour, names: list[str]) -> None:
    """Take the pictures of the pages that are named, of all where none is."""
    pages = {each: getattr(tour, each) for each in ("first_part", "sign", "mould", "foreign_program", "five_texts")}
    pages |= {each[0]: partial(tour.operation, *each) for each in OPERATION_PAGES} | {"lettering": tour.lettering}
    for name in names or pages:
        pages[name]()


def main() -> None:
    """Take all pictures, or those of the pages that are named."""
    os.environ["HITOFUDE_CONFIG"] = tempfile.mkdtemp()
    application = QApplication.instance() or QApplication([])
    window, wiring = build()
    window.choose_theme(ThemeChoice.LIGHT)
    window.resize(*SIZE)
    window.show()
    for language, folder in FOLDERS.items():
        wiring.translation_controller.choose(language)
        folder.mkdir(exist_ok=True)
        take(ManualTour(wiring, wait_until, wait, partial(save, folder)), sys.argv[1:])
    wiring.document.mark_saved(Path("x"))
    window.close()
    application.quit()


if __name__ == "__main__":
    main()
