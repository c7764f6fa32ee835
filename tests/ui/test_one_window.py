"""Tests share a window only as long as nothing of one can be seen by the next."""

import os
import subprocess
import sys

import pytest
from PySide6.QtCore import Qt

from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.modes import CanvasTool
from tests.conftest import ROOT
from tests.ui.one_window import OneWindow
from tests.ui.traces import differences, traces


@pytest.fixture(scope="module")
def own(qapp):
    made = OneWindow()
    yield made
    made.close()


def draw(qtbot, wiring: WindowController) -> None:
    wiring.run("rect 0,0 40,20")
    wiring.window_.canvas.set_tool(CanvasTool.CIRCLE)
    qtbot.keyClicks(wiring.window_.command_line.edit, "10,10")
    qtbot.keyClick(wiring.window_.command_line.edit, Qt.Key.Key_Return)


def test_after_drawing_and_typing_the_window_is_as_new(qtbot, own: OneWindow) -> None:
    first, made = own.lend(qtbot), own.made
    draw(qtbot, first)
    own.take_back()
    assert "\n".join(own.left) == ""
    again = own.lend(qtbot)
    assert again is first and own.made == made
    assert not again.document.part.entities and not again.document.undo_name
    assert again.log.lines == []


def hide_the_menus(wiring: WindowController) -> None:
    wiring.window_.menuBar().hide()


def remember_something(wiring: WindowController) -> None:
    wiring.unit_choice._told_of = "whatever"


def change_a_label(wiring: WindowController) -> None:
    wiring.window_.status.unit.setText("ell")


def disable_an_action(wiring: WindowController) -> None:
    wiring.window_.actions_["about"].setEnabled(False)


@pytest.mark.parametrize("leave", [hide_the_menus, remember_something, change_a_label, disable_an_action])
def test_what_reset_does_not_know_of_is_seen_and_ends_the_window(qtbot, own: OneWindow, leave) -> None:
    first, made = own.lend(qtbot), own.made
    leave(first)
    own.take_back()
    assert own.left
    assert own.lend(qtbot) is not first and own.made == made + 1
    own.take_back()
    assert own.left == []


def test_traces_see_values_of_every_kind(qtbot, own: OneWindow) -> None:
    wiring = own.lend(qtbot)
    before = traces(wiring)
    assert len(before) > 2500 and differences(before, traces(wiring)) == []
    wiring.document.run("circle 0,0 5")
    told = differences(before, traces(wiring))
    assert any("radius" in line and "5.0" in line for line in told)
    own.take_back()


@pytest.mark.parametrize(
    "seed", ["1", pytest.param("2", marks=pytest.mark.exhaustive), pytest.param("3", marks=pytest.mark.exhaustive)]
)
def test_the_tests_of_a_module_pass_in_any_order(seed: str) -> None:
    command = [sys.executable, "-m", "pytest", "-p", "tests.ui.shuffled", "tests/ui/test_command_line.py"]
    done = subprocess.run(
        command, cwd=ROOT, env=os.environ | {"HITOFUDE_SEED": seed}, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stdout
