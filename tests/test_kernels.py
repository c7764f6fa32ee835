"""The cache of compiled kernels: one that cannot be compiled is told, and stops nothing that does without it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def run(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    environment = os.environ | {"PYTHONPATH": str(folder)}
    return subprocess.run([sys.executable, *arguments], cwd=folder, env=environment, capture_output=True, text=True, timeout=300)


def test_a_kernel_that_cannot_be_compiled_stops_nothing_else(tmp_path: Path) -> None:
    """The program is copied, one of its kernels is broken, and one that comes behind it in the order of names is looked for."""
    for name in ("app", "resources"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "ui"))
    kernels = sorted(path.relative_to(tmp_path) for path in (tmp_path / "app").glob("*/**/*kernels*.py"))
    for path in kernels:
        (tmp_path / path).write_text("LOADED = True\n")
    broken, last = kernels[0], kernels[-1]
    (tmp_path / broken).write_text(
        'from app.jit import kernel\n\n\n@kernel("int64(int64)")\ndef f(x):\n    return x.no_such_thing + undefined_name\n'
    )
    done = run(tmp_path, "-m", "app.kernels")
    assert done.returncode == 0
    assert "Traceback" not in done.stderr
    (told,) = [line for line in done.stderr.splitlines() if "cannot be compiled" in line]
    assert told.startswith(f"hitofude: {'.'.join(broken.with_suffix('').parts)} cannot be compiled")
    code = "import sys, app.kernels as k; failed = k.warm(); print(len(failed), sys.argv[1] in sys.modules)"
    assert run(tmp_path, "-c", code, ".".join(last.with_suffix("").parts)).stdout.split() == ["1", "True"]
    assert "grbl" in run(tmp_path, "-m", "app", "make", "--help").stdout
