"""Tests share a window only as long as nothing of one can be seen by the next."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from PySide6.QtCore import Qt

from app.core.settings import ThemeChoice
from app.ui.framework.computation import ComputationState
from app.ui.framework.view import View, views
from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.modes import CanvasTool
from tests.conftest import ROOT
from tests.ui.nc.opened import SMALL, WAIT_MS, open_file
from tests.ui.one_window import OneWindow
from tests.ui.traces import differences, traces
from tests.ui.words import said_by


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


def test_contours_that_somebody_asked_for_are_forgotten(qtbot, own: OneWindow) -> None:
    first = own.lend(qtbot)
    first.run("rect 0,0 40,20")
    qtbot.waitUntil(lambda: bool(first.document.part.entities), timeout=WAIT_MS)
    assert first._contours.of(first.document.job).closed
    own.take_back()
    assert "\n".join(own.left) == ""
    assert own.lend(qtbot) is first


def open_a_program(qtbot, wiring: WindowController, folder: Path) -> None:
    """A foreign one, which does not tell its tool: it is asked for beside the cut."""
    first, second = folder / "one.ngc", folder / "other.ngc"
    first.write_text(SMALL)
    second.write_text(SMALL.replace("X40", "X41"))
    view = open_file(qtbot, wiring, first)
    wiring.nc.compare(second)
    qtbot.waitUntil(lambda: view.compared is not None, timeout=WAIT_MS)
    wiring.nc.show_cut()
    qtbot.waitUntil(lambda: wiring.window_.cut_form.name.text() == first.name, timeout=WAIT_MS)


def open_the_sample_and_its_cut(qtbot, wiring: WindowController, folder: Path) -> None:
    wiring.files.open_sample()
    qtbot.waitUntil(lambda: wiring.computation.state is ComputationState.CURRENT, timeout=WAIT_MS)
    wiring.display_controller.show_view(View.CUT)
    qtbot.waitUntil(lambda: wiring.cut_controller.cut is not None, timeout=WAIT_MS)


def look_at_every_view_and_page(qtbot, wiring: WindowController, folder: Path) -> None:
    wiring.run("rect 0,0 40,20")
    for view in views():
        wiring.display_controller.show_view(view)
    for page in wiring.window_.side.tabs:
        wiring.window_.side.show_page(page)
    wiring.palette.open()


def leave_while_programs_are_read(qtbot, wiring: WindowController, folder: Path) -> None:
    """What comes too late is nobody's."""
    path = folder / "late.ngc"
    path.write_text(SMALL)
    wiring.files.open_file(path)
    wiring.files.open_sample()


def read_the_manual(qtbot, wiring: WindowController, folder: Path) -> None:
    wiring.language.help.show_page("sign")


OPENERS = [
    open_a_program,
    open_the_sample_and_its_cut,
    look_at_every_view_and_page,
    leave_while_programs_are_read,
    read_the_manual,
]


@pytest.mark.parametrize("opener", OPENERS)
def test_whatever_was_opened_no_widget_tells_of_it_seen_or_not(qtbot, own: OneWindow, tmp_path: Path, opener) -> None:
    """A page that is hidden is translated, and searched, as one that is seen."""
    first, made = own.lend(qtbot), own.made
    before = said_by(first.window_)
    opener(qtbot, first, tmp_path)
    own.take_back()
    assert "\n".join(own.left) == ""
    again = own.lend(qtbot)
    qtbot.wait(50)
    assert again is first and own.made == made
    assert not again.nc.foreign and not again.document.part.entities
    assert said_by(again.window_) == before
    again.window_.set_theme_choice(ThemeChoice.DARK)  # whatever was opened follows
    again.window_.set_theme_choice(ThemeChoice.LIGHT)
    own.take_back()
    assert "\n".join(own.left) == ""


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


def test_what_is_worked_out_of_the_rest_is_no_trace(qtbot, own: OneWindow) -> None:
    """Whoever asks first has it remembered, and nothing is another."""
    wiring = own.lend(qtbot)
    theme = wiring.window_.theme
    vars(theme).pop("tools", None)
    before = traces(wiring)
    assert theme.tools and "tools" in vars(theme)
    assert differences(before, traces(wiring)) == []
    own.take_back()


@pytest.mark.parametrize(
    ("seed", "module"),
    [
        ("1", "test_snap_controller.py"),
        pytest.param("2", "test_command_line.py", marks=pytest.mark.exhaustive),
        pytest.param("3", "test_window.py", marks=pytest.mark.exhaustive),
    ],
)
def test_the_tests_of_a_module_pass_in_any_order(seed: str, module: str) -> None:
    command = [sys.executable, "-m", "pytest", "-p", "tests.ui.shuffled", f"tests/ui/{module}"]
    done = subprocess.run(
        command, cwd=ROOT, env=os.environ | {"HITOFUDE_SEED": seed}, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stdout
