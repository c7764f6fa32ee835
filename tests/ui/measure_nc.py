"""Measures how the NC view feels: `python -m tests.ui.measure_nc [PROGRAM]`.

Prints how long a program takes from opening until its path is shown, the longest time in which the window did not
listen meanwhile, how long a frame of scrolling takes, and how much memory the program holds.
"""

from __future__ import annotations

import gc
import os
import statistics
import sys
import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from tests.ui.measure_window import Gaps, live_until

PYCAM = Path(__file__).resolve().parents[1] / "data" / "nc" / "test_pycam.ngc"
LONG_LINES = 200_000


@dataclass(frozen=True)
class Felt:
    """What was measured of one program.

    Attributes:
        shown_s: from opening to the path. gap_ms: longest while opening, by what went on.
        scroll_ms, worst_scroll_ms: a frame of the text, median and worst. path_ms: painting the whole path.
        pick_ms: worst time from a picked line to the painted answer. memory_mb: what the process holds more than
            before.
    """

    lines: int
    shown_s: float
    gap_ms: float
    scroll_ms: float
    worst_scroll_ms: float
    path_ms: float
    pick_ms: float
    memory_mb: float


def resident_mb() -> float:
    """Return the memory that this process holds, MB."""
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def timed(act) -> float:
    """Return how long something takes, ms."""
    begun = time.perf_counter()
    act()
    return 1000 * (time.perf_counter() - begun)


def measure_program(wiring, path: Path) -> Felt:
    """Open a program in the window and use it."""
    nc = wiring.window_.views.nc
    before = resident_mb()
    gaps = Gaps()
    wiring.files.open_file(path)
    shown = live_until(lambda: nc.shown is not None and nc.shown.source.path == path)
    live_until(lambda: False, 0.5)
    gap = max(gaps.longest.values())
    text, bar = nc.pane.text, nc.pane.text.verticalScrollBar()
    step = max(1, bar.maximum() // 200)
    frames = []
    for value in range(0, max(1, bar.maximum()), step):
        bar.setValue(value)
        frames.append(timed(text.viewport().repaint))
    count = max(1, len(text.text))
    picks = [timed(lambda row=row: (text.pick(row), nc.repaint())) for row in range(0, count, max(1, count // 20))]
    nc.path.fit_now()
    nc.path.repaint_scene()
    path_ms = timed(nc.path.repaint)
    return Felt(
        len(text.text), shown, gap, statistics.median(frames), max(frames), path_ms, max(picks), resident_mb() - before
    )


def long_file(folder: Path) -> Path:
    """Write a program of 200,000 lines."""
    from tests.ui.nc.hand_made import long_program

    path = folder / "long.ngc"
    path.write_bytes(long_program(LONG_LINES)[0])
    return path


def measure_all(paths: list[Path]) -> dict[str, Felt]:
    """Measure programs in one window."""
    from app.ui.shell.start import build, warm_up

    window, wiring = build()
    window.resize(1440, 900)
    window.show()
    warmer = warm_up(window)
    live_until(lambda: not warmer.busy)
    felt = {path.name: measure_program(wiring, path) for path in paths}
    window.close()
    return felt


def main() -> None:
    """Measure and print."""
    from PySide6.QtWidgets import QApplication

    folder = Path(tempfile.mkdtemp())
    os.environ["HITOFUDE_CONFIG"] = str(folder)
    application = QApplication.instance() or QApplication([])
    paths = [Path(sys.argv[1])] if len(sys.argv) > 1 else [PYCAM, long_file(folder)]
    for name, felt in measure_all(paths).items():
        print(f"{name}: {felt}")
    application.quit()


if __name__ == "__main__":
    main()
