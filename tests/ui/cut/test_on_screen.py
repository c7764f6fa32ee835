"""The Cut view on a real screen: its own OpenGL, in a process of its own, because Qt's platform is chosen once."""

import os
import shutil
import subprocess
import sys

import pytest

from tests.conftest import ROOT


@pytest.mark.skipif(shutil.which("xvfb-run") is None, reason="a window with OpenGL needs an X server; install xvfb and xauth")
def test_a_real_window_shows_the_cut_by_its_own_opengl():
    command = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24", sys.executable, "-m", "tests.ui.cut.on_screen"]
    done = subprocess.run(command, cwd=ROOT, env={**os.environ, "QT_QPA_PLATFORM": "xcb"}, capture_output=True, text=True, timeout=180)
    assert done.stdout.strip().endswith("OK"), done.stdout + done.stderr
