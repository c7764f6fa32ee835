"""A plate or a gear made and exported for grbl by the real mouse and keys: `python -m … NAME FOLDER` under a display.

The plate is begun and drawn: 80 x 50 mm with rounded corners, a pocket, two drilled holes, cut out with tabs; once more
by keys alone. The gear is opened.
What came of it stands in FOLDER: the files of the program, the job as it was computed, pictures, and counts.json.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path

from PySide6.QtWidgets import QAbstractButton, QApplication, QComboBox, QDialogButtonBox, QFileDialog

from app.core.resources import resource
from app.model.operation import Operation
from app.ui.framework.computation import ComputationState
from app.ui.shell.start import begin, build, warm_up
from tests.ui.measure_window import Gaps, live_until
from tests.ui.real_mouse.hand import Hand, dialog_has_the_keys


def draw(hand: Hand) -> None:
    """Begin a plate of 80 x 50 mm for grbl, and draw by buttons and values at the pointer."""
    new = hand.ask(lambda: hand.window.views.start.new)
    hand.click(new.corners.edit)
    hand.press("ctrl+a")
    hand.type_seen("6")
    hand.click(hand.ask(lambda: new.machine.box))
    hand.press("g")
    hand.press("Return")
    hand.click(new.begin)
    hand.click_button("tool_circle")
    for word in ("12,25", "3", "68,25", "3"):
        hand.type_line(word)
    hand.hold_button("tool_rectangle")
    hand.click_button("tool_rectangle_round")
    hand.type_line("25,15")
    hand.type_values("30", "20")
    hand.type_line("4")
    hand.press("Escape")


def draw_by_keys(hand: Hand) -> None:
    """Do the same without the mouse."""
    for key in ("Tab", "Tab", "Tab"):
        hand.press(key)
    hand.type_seen("6")
    for key in ("Tab", "Tab", "g", "Tab", "Tab", "space"):
        hand.press(key)
    for line in ("circle 12,25 3", "circle 68,25 3", "rect 25,15 55,35 round 4"):
        hand.type_line(line)


def open_gear(hand: Hand, folder: Path) -> None:
    """Open a drawing; operations are proposed for it when it is computed."""
    own = folder / "wheel.draw"
    own.write_bytes(resource("samples", "gear.draw").read_bytes())
    hand.press("ctrl+o")
    hand.type_path(own)
    hand.wait_until(lambda: hand.wiring.proposal_controller.due, "the drawing")
    hand.focus_window()  # the dialog had it


def whole_job(hand: Hand, gaps: Gaps, name: str, folder: Path) -> None:
    """Draw or open, compute, export for grbl: operations are proposed at the first compute."""
    hand.focus_window()
    hand.ask(lambda: gaps.now("open" if name == "gear" else "draw"))
    if name == "gear":
        open_gear(hand, folder)
    else:
        {"plate": draw, "keys": draw_by_keys}[name](hand)
    hand.ask(lambda: gaps.now("compute"))
    hand.press("F5")
    computation = hand.wiring.computation
    hand.wait_until(lambda: computation.state in (ComputationState.CURRENT, ComputationState.FAILED), "the paths")
    assert hand.ask(lambda: computation.state) is ComputationState.CURRENT, hand.ask(lambda: computation.error)
    operations = hand.ask(lambda: [_in_words(each) for each in hand.wiring.document.job.operations])
    findings = hand.ask(lambda: [each.text for each in computation.made.findings if each.counts])
    (folder / "job.json").write_text(json.dumps({"operations": operations, "findings": findings}), "utf-8")
    hand.ask(lambda: gaps.now("export"))
    hand.press("ctrl+e")
    if name == "gear":
        _choose_grbl(hand, folder / name)
    else:
        hand.type_path(folder / name)
    hand.wait_until(lambda: any(folder.glob(f"{name}*.nc")), "the NC files")


def _choose_grbl(hand: Hand, path: Path) -> None:
    """Type where the program goes and choose its control, by the mouse."""
    hand.wait_until(dialog_has_the_keys, "the file dialog")
    hand.type_seen(str(path))
    hand.click(hand.ask(_kinds_of_file))
    hand.type_line("grbl")
    hand.confirm(lambda: hand.click(hand.ask(_save_button)))


def _in_words(operation: Operation) -> str:
    side, tabs = getattr(operation, "side", None), getattr(operation, "tabs", None)
    return " ".join(
        [operation.WORD, *([side.value] if side is not None else []), *(["tabs"] if tabs is not None else [])]
    )


def _save_button() -> QAbstractButton:
    box = _dialog().findChild(QDialogButtonBox)
    assert box is not None
    return box.button(QDialogButtonBox.StandardButton.Save)


def _dialog() -> QFileDialog:
    dialog = QApplication.activeModalWidget()
    assert isinstance(dialog, QFileDialog)
    return dialog


def _kinds_of_file() -> QComboBox:
    return next(box for box in _dialog().findChildren(QComboBox) if box.objectName() == "fileTypeCombo")


def main(name: str, folder: Path) -> int:
    """Do the job; return the exit status."""
    application = QApplication([])
    window, wiring = build()
    window.resize(1280, 800)
    window.show()
    hand, warmer = Hand(wiring), warm_up(window)
    begin(wiring, None)
    live_until(lambda: not warmer.busy)
    gaps = Gaps()
    wrong = hand.play(lambda hand: whole_job(hand, gaps, name, folder))
    counts = {"clicks": hand.clicks, "values": hand.values, "wrong": repr(wrong) if wrong else ""}
    gaps.now("end")
    counts |= {"longest_ms": gaps.longest, "busiest_ms": gaps.busiest, "slowed": gaps.slowed}
    (folder / "counts.json").write_text(json.dumps(counts), "utf-8")
    window.grab().save(str(folder / "end.png"))
    for worker in (window.worker, wiring.start_controller.worker):
        worker.finish(20.0)
    del application
    return 1 if wrong else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1], Path(sys.argv[2])))
