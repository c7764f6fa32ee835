"""Starting: files that are not there, libraries that are missing and screens that are not there end in one clear
line.
"""

import os
import subprocess
import sys

import pytest


def hitofude(*arguments: str, before: str = "pass", **environment: str) -> subprocess.CompletedProcess[str]:
    program = (
        f"import sys; {before}; sys.argv = ['hitofude', *{list(arguments)!r}]; from app.__main__ import main; "
        "sys.exit(main())"
    )
    surroundings = {
        k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM")
    } | environment
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=surroundings, timeout=60)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("open", "nothing.dxf"), "nothing.dxf: there is no such file"),
        (("nothing.dxf",), "nothing.dxf: there is no such file"),
        (("open", "a.dxf", "b.dxf"), "open takes one drawing, not 2"),
        (("open", "--fast"), "open has no option --fast"),
        ((), "no screen here"),
    ],
)
def test_one_line_and_status_2(arguments, words):
    done = hitofude(*arguments)
    assert done.returncode == 2
    assert words in done.stderr
    assert done.stderr.count("\n") == 1


def test_missing_libraries_name_the_line_that_installs_them():
    done = hitofude(before="sys.modules['PySide6.QtCore'] = None", QT_QPA_PLATFORM="offscreen")
    assert done.returncode == 2
    assert "apt-get install libegl1" in done.stderr
    assert done.stderr.count("\n") == 1


def test_commands_go_to_the_command_line_without_the_window():
    done = hitofude("--version", before="sys.modules['PySide6'] = None")
    assert done.returncode == 0
    assert done.stdout.startswith("hitofude ")


CLOSE_WHILE_COMPUTING = """
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
import app.ui.shell.window_controller as wiring
plain = wiring.WindowController.__init__
def watched(self, window):
    plain(self, window)
    self.files.open_controller.opened.connect(lambda _: (self.compute(), QTimer.singleShot(300, window.close)))
wiring.WindowController.__init__ = watched
"""


CLOSE_WHEN_SHOWN = """
from PySide6.QtCore import QTimer
import app.ui.views.nc.controller as control
plain = control.NcController._on_foreign
def watched(self, remember, shown):
    plain(self, remember, shown)
    print(shown.source.name, len(shown.shapes))
    QTimer.singleShot(50, self._view.window().close)
control.NcController._on_foreign = watched
"""


def test_a_program_named_on_the_command_line_is_shown(data, tmp_path):
    program = str(data / "nc" / "tux.ngc")
    done = hitofude(
        "open",
        program,
        before=f"exec({CLOSE_WHEN_SHOWN!r})",
        QT_QPA_PLATFORM="offscreen",
        HITOFUDE_CONFIG=str(tmp_path),
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.split() == ["tux.ngc", "4287"]
    assert "Traceback" not in done.stderr


@pytest.mark.exhaustive
def test_window_closed_while_computing_ends_cleanly(data, tmp_path):
    drawing = str(data / "dxf" / "complex.dxf")
    done = hitofude(
        "open",
        drawing,
        before=f"exec({CLOSE_WHILE_COMPUTING!r})",
        QT_QPA_PLATFORM="offscreen",
        HITOFUDE_CONFIG=str(tmp_path),
    )
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "settings.json").exists()
