"""A virtual display, and a program that has a real mouse and keys on it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]


def run_on_display(folder: Path, module: str, *arguments: str) -> None:
    """Run a module in a process of its own under a virtual display; its settings, and counts.json, are in a folder."""
    if not (shutil.which("xvfb-run") and shutil.which("xdotool")):
        pytest.skip(
            "xvfb-run and xdotool are needed for a virtual display with a mouse: apt install xvfb xauth xdotool"
        )
    own = {"QT_QPA_PLATFORM": "xcb", "HITOFUDE_CONFIG": str(folder / "config"), "PYTHONPATH": str(ROOT)}
    display = ["xvfb-run", "-a", "-s", "-screen 0 1400x900x24"]
    command = [*display, sys.executable, "-m", module, *arguments]
    run = subprocess.run(command, cwd=ROOT, env=os.environ | own, capture_output=True, text=True, timeout=400)
    counts = folder / "counts.json"
    assert run.returncode == 0, run.stderr + (counts.read_text("utf-8") if counts.exists() else "")
