"""Rows of the panel beside a foreign program come and go without end: a process of its own, as a fault would end it."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from tests.conftest import ROOT

ROWS_COME_AND_GO = """
from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtWidgets import QApplication

application = QApplication([])
from app.ui.framework.labels import Elided
from app.ui.framework.section import PanelSection
from app.ui.views.nc.program_panel import _row

section = PanelSection("Tools")
section.show()
rows = []
for k in range(900):
    for row in rows:
        row.hide()
        row.deleteLater()
    rows = [_row("T", Elided("x")) for _ in range(k % 5)]
    for row in rows:
        section.add_indented(row)
    for milliseconds in (0, 1):
        loop = QEventLoop()
        QTimer.singleShot(milliseconds, loop.quit)
        loop.exec()
"""


@pytest.mark.exhaustive
def test_rows_that_go_take_nothing_with_them() -> None:
    """A widget in a layout that was not yet in a window was freed twice, and soon the program was gone."""
    done = subprocess.run(
        [sys.executable, "-c", ROWS_COME_AND_GO],
        cwd=ROOT,
        env={**os.environ, "QT_QPA_PLATFORM": "offscreen", "PYTHONPATH": str(ROOT)},
        capture_output=True,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr.decode()[-500:]
