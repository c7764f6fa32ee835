"""The real window, drawing a circle ten times a second and telling when; `python -m tests.ui.drawing_window FILE` is
there to be killed.
"""

import sys
import time
from pathlib import Path

from PySide6.QtCore import QTimer

from app.ui.shell import start
from app.ui.shell.window_controller import WindowController


def main() -> None:
    path = Path(sys.argv[1])
    build = start.build

    def built() -> tuple[object, WindowController]:
        window, wiring = build()
        timer = QTimer(window, interval=100)

        def draw() -> None:
            wiring.document.run(f"circle {len(wiring.document.part.entities)},0 1.5")
            print(len(wiring.document.part.entities), time.monotonic(), flush=True)

        timer.timeout.connect(draw)
        wiring.files.open_controller.opened.connect(lambda _: timer.start())
        return window, wiring

    start.build = built
    start.start(path)


if __name__ == "__main__":
    main()
