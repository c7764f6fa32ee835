"""A solid dropped on the window by the real mouse: `python -m … FOLDER` under a display; how long until it is seen
stands in counts.json.
"""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path

import trimesh
from PySide6.QtWidgets import QApplication

from app.ui.framework.view import View
from app.ui.shell.start import begin, build, warm_up
from tests.ui.measure_window import live_until
from tests.ui.real_mouse.drag_source import PLACE
from tests.ui.real_mouse.hand import Hand


def drop(hand: Hand, folder: Path) -> float:
    """Drag a file out of another program on to the window; return the seconds until its solid is seen."""
    path = folder / "ring.stl"
    path.write_bytes(trimesh.creation.torus(20.0, 6.0, 96, 48).export(file_type="stl"))
    source = subprocess.Popen(
        [sys.executable, "-m", "tests.ui.real_mouse.drag_source", str(path)], stdout=subprocess.PIPE, text=True
    )
    try:
        assert source.stdout is not None and source.stdout.readline() == "shown\n"
        middle = hand.ask(lambda: hand.window.mapToGlobal(hand.window.rect().center()))
        hand.drag(PLACE.center(), middle)
        begun = time.monotonic()
        hand.wait_until(lambda: _is_seen(hand), "the solid")
        return time.monotonic() - begun
    finally:
        source.terminate()
        source.wait()


def _is_seen(hand: Hand) -> bool:
    surfaces = hand.window.views.surfaces
    return hand.wiring.display_controller.view is View.SURFACES and surfaces.isVisible() and surfaces.shown is not None


def main(folder: Path) -> int:
    """Drop the file on the page that the window begins with; return the exit status."""
    application = QApplication([])
    window, wiring = build()
    window.resize(1280, 800)
    window.show()
    hand, warmer, seconds = Hand(wiring), warm_up(window), list[float]()
    begin(wiring, None)
    live_until(lambda: not warmer.busy)
    wrong = hand.play(lambda hand: seconds.append(drop(hand, folder)))
    triangles = len(window.views.surfaces.shown.space.triangles) if seconds and window.views.surfaces.shown else 0
    counts = {"seen_s": seconds, "triangles": triangles, "wrong": repr(wrong) if wrong else ""}
    (folder / "counts.json").write_text(json.dumps(counts), "utf-8")
    window.grab().save(str(folder / "end.png"))
    for worker in (wiring.scenes.work.reading.worker, wiring.start_controller.worker):
        worker.finish(20.0)
    del application
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1])))
