"""Measures how the window feels: `python -m tests.ui.measure_window [DRAWING]`.

Prints how long the window takes to be usable, and the longest time in which it did not listen while a drawing was
opened, computed and shown.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import replace
from pathlib import Path

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtCore import QEventLoop, QObject, Qt, QTimer

from tests.pace import slowed

TICK_MS = 5
DRAWING = Path(__file__).resolve().parents[1] / "data" / "dxf" / "complex.dxf"
USABLE = """
import time; t = time.perf_counter()
from PySide6.QtWidgets import QApplication
a = QApplication([])
from app.ui.shell.start import build
w, k = build(); w.show(); a.processEvents(); a.processEvents()
print(time.perf_counter() - t)
"""


class Gaps(QObject):
    """A clock of 5 ms on the window's thread: what it misses, the user feels.

    Attributes:
        longest: the longest gap so far, ms, by what was going on.
        busiest: the most that this thread has worked in a gap, ms of processor time: what others leave it to run on
            does not count.
        slowed: how many times longer than on two idle cores the same work took, at worst, when something new began:
            cores that others use too share caches and units, which processor time does not tell; 1 at least.
    """

    def __init__(self) -> None:
        super().__init__()
        self.longest: dict[str, float] = {}
        self.busiest: dict[str, float] = {}
        self.slowed = 1.0
        self.doing = "start"
        self._last, self._worked = time.perf_counter(), time.thread_time()
        self._timer = QTimer(self, interval=TICK_MS, timerType=Qt.TimerType.PreciseTimer)
        self._timer.timeout.connect(self._tick)
        self._timer.start()

    def now(self, doing: str) -> None:
        """Name what follows."""
        self._tick()
        self.doing = doing
        self.slowed = max(self.slowed, slowed())
        self._last, self._worked = time.perf_counter(), time.thread_time()

    def _tick(self) -> None:
        now, worked = time.perf_counter(), time.thread_time()
        for most, gap in ((self.longest, now - self._last), (self.busiest, worked - self._worked)):
            most[self.doing] = max(most.get(self.doing, 0.0), 1000 * gap)
        self._last, self._worked = now, worked


def live_until(done, limit_s: float = 180.0) -> float:
    """Run the event loop until `done()` or the limit; return the seconds it took."""
    begun = time.perf_counter()
    loop = QEventLoop()
    while not done() and time.perf_counter() - begun < limit_s:
        QTimer.singleShot(20, loop.quit)
        loop.exec()
    return time.perf_counter() - begun


def use_fine_tools(document) -> None:
    """Take tools of 2 and 1 mm, so that the largest sample gives its 25,000 moves."""
    pocket, contour = document.job.tools
    tools = (replace(pocket, diameter=2.0), replace(contour, diameter=1.0))
    document.change_job("Change diameter", replace(document.job, tools=tools))


def measure_gaps(drawing: Path) -> dict[str, float]:
    """Open a drawing in a window and compute it; return the longest gap in ms by what was going on."""
    from app.ui.framework.computation import ComputationState
    from app.ui.shell.start import build, warm_up

    window, wiring = build()
    window.show()
    live_until(lambda: False, 0.3)
    gaps = Gaps()
    warmer = warm_up(window)
    live_until(lambda: not warmer.busy)
    wiring.computation.finished.connect(lambda: gaps.now("after"))
    gaps.now("open")
    wiring.files.open_file(drawing)
    live_until(lambda: bool(wiring.document.part.entities))
    live_until(lambda: False, 0.3)
    use_fine_tools(wiring.document)
    gaps.now("compute")
    wiring.compute()
    took = live_until(lambda: wiring.computation.state in (ComputationState.CURRENT, ComputationState.FAILED))
    live_until(lambda: False, 0.5)
    window.worker.finish(30.0)
    print(
        f"{drawing.name}: computed in {took:.2f} s, {wiring.computation.state.value}, longest gaps in ms: "
        + ", ".join(f"{name} {gap:.0f}" for name, gap in gaps.longest.items())
    )
    return gaps.longest


def measure_usable() -> float:
    """Return the seconds from nothing to a window on the screen, in a process of its own."""
    done = subprocess.run([sys.executable, "-c", USABLE], capture_output=True, text=True, check=True)
    return float(done.stdout)


def main() -> None:
    """Measure and print."""
    from PySide6.QtWidgets import QApplication

    os.environ["HITOFUDE_CONFIG"] = tempfile.mkdtemp()
    print("window usable after " + ", ".join(f"{measure_usable():.2f}" for _ in range(3)) + " s")
    application = QApplication.instance() or QApplication([])
    measure_gaps(Path(sys.argv[1]) if len(sys.argv) > 1 else DRAWING)
    application.quit()


if __name__ == "__main__":
    main()
