"""A new user's whole job, by the real mouse: draws fig. 2, computes, looks, exports. `python -m … FOLDER` under an X
display.

What came of it stands in FOLDER: the NC program, the log and the part as .draw files, pictures, and counts.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from PySide6.QtWidgets import QApplication

from app.drafting.language.write import draw_text
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View
from app.ui.shell.start import build
from tests.ui.real_mouse.hand import Hand

OUTLINE = (
    "6,6",
    "60,6",
    "68,14",
    "68,30",
    "a",
    "76,38",
    "68,46",
    "68,60",
    "60,60",
    "60,70",
    "44,70",
    "a",
    "36,62",
    "28,70",
    "20,76",
    "6,76",
    "6,50",
    "14,44",
    "14,34",
    "6,28",
    "close",
)


def draw(hand: Hand) -> None:
    """Draw the outline by typed points, the triangle and the circle by mouse and points."""
    hand.click_button("tool_polyline")
    for word in OUTLINE:
        hand.type_line(word)
    hand.press("Escape")
    hand.type_line("pl")
    for word in ("24,20", "48,20", "36,44"):
        hand.type_line(word)
    hand.click_place((24.0, 20.0))
    hand.press("Escape")
    hand.click_button("tool_circle")
    hand.press("F9")
    hand.click_place((80.0, 80.0))
    hand.press("F9")
    hand.type_line("12")
    hand.press("Escape")
    hand.click_place((92.0, 80.0))
    hand.type_line("move @4,4")


def whole_job(hand: Hand, folder: Path) -> None:
    """Draw, compute, look, export."""
    hand.focus_window()
    draw(hand)
    hand.press("F5")
    computation = hand.wiring.computation
    hand.wait_until(lambda: computation.state in (ComputationState.CURRENT, ComputationState.FAILED), "the paths")
    assert hand.ask(lambda: computation.state) is ComputationState.CURRENT, hand.ask(lambda: computation.error)
    for view in (View.CUT, View.NC, View.PATHS):
        hand.click_button(view.value)
    hand.ask(lambda: hand.window.grab().save(str(folder / "paths.png")))
    hand.press("ctrl+e")
    hand.type_path(folder / "fig2.ngc")
    hand.wait_until(lambda: (folder / "fig2.ngc").exists(), "the NC file")
    lines = hand.ask(lambda: [line.command for line in hand.wiring.document.log if not line.error])
    (folder / "log.draw").write_text("\n".join(lines) + "\n", "utf-8")
    (folder / "part.draw").write_text(hand.ask(lambda: draw_text(hand.wiring.document.part).text), "utf-8")


def main(folder: Path) -> int:
    """Do the job; return the exit status."""
    application = QApplication([])
    window, wiring = build()
    window.resize(1280, 800)
    window.show()
    hand = Hand(wiring)
    wrong = hand.play(lambda hand: whole_job(hand, folder))
    counts = {"clicks": hand.clicks, "typed": hand.typed, "wrong": repr(wrong) if wrong else ""}
    (folder / "counts.json").write_text(json.dumps(counts), "utf-8")
    window.grab().save(str(folder / "end.png"))
    window.worker.finish(20.0)
    del application
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(Path(sys.argv[1])))
