"""The Cut view on a real screen: its own OpenGL, in a process of its own, because Qt's platform is chosen once."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.conftest import ROOT


@pytest.mark.exhaustive
@pytest.mark.skipif(
    shutil.which("xvfb-run") is None, reason="a window with OpenGL needs an X server; install xvfb and xauth"
)
def test_a_real_window_shows_the_cut_by_its_own_opengl():
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, "-m", "tests.ui.cut.on_screen"]
    done = subprocess.run(
        command, cwd=ROOT, env={**os.environ, "QT_QPA_PLATFORM": "xcb"}, capture_output=True, text=True, timeout=180
    )
    assert done.stdout.strip().endswith("OK"), done.stdout + done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="only there a variable takes OpenGL away")
def test_without_any_opengl_the_view_says_what_to_do():
    code = """
from PySide6.QtWidgets import QApplication
application = QApplication([])
from app.ui.views.cut.view import CutView
from tests.ui.cut.made_up import made_up
view = CutView()
view.show()
view.show_cut(made_up(50))
assert view.render_scheduler.surface is None and not view.legend.isVisible() and not view.overlay.isVisible()
print(view.sentence.text())
"""
    environment = {**os.environ, "QT_QPA_PLATFORM": "offscreen", "__EGL_VENDOR_LIBRARY_FILENAMES": "/nowhere.json"}
    done = subprocess.run(
        [sys.executable, "-c", code], cwd=ROOT, env=environment, capture_output=True, text=True, timeout=120
    )
    assert "The cut cannot be shown. There is no OpenGL 3.3 here" in done.stdout and "libegl1" in done.stdout, (
        done.stdout + done.stderr
    )
