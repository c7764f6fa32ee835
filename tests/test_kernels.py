"""The cache of compiled kernels: one that cannot be compiled is told, and stops nothing that does without it.

Nor does it keep what was made of changed files, and processes that fill it at once do not disturb one another.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

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


INNER = """from app.jit import kernel


@kernel("float64(float64)")
def inner(x):
    return x + 1.0
"""
OUTER = """from app.jit import kernel
from app.room.inner_kernels import inner


@kernel("float64(float64)")
def outer(x):
    return 2.0 * inner(x)
"""


def small_program(folder: Path) -> None:
    """Two kernels, one of which calls the other, and what they need of the program."""
    (folder / "app" / "room").mkdir(parents=True)
    for package in ("app", "app/room"):  # whole packages: one without this file gives way to the program that is installed
        (folder / package / "__init__.py").touch()
    for name in ("jit.py", "errors.py", "kernels.py", "progress.py"):
        shutil.copy(ROOT / "app" / name, folder / "app" / name)
    (folder / "app" / "room" / "inner_kernels.py").write_text(INNER)
    (folder / "app" / "room" / "outer_kernels.py").write_text(OUTER)


def test_a_kernel_that_changes_while_the_program_runs_is_refused_and_not_kept(tmp_path: Path) -> None:
    """The caller's file stays as it is, so nothing would ever show that its cached code holds the other one's changed code."""
    small_program(tmp_path)
    change = """
import pathlib, app.jit
inner = pathlib.Path("app/room/inner_kernels.py")
before = inner.read_text()
inner.write_text(before.replace("1.0", "100.0"))
try:
    from app.room.outer_kernels import outer
    print(outer(1.0))
except Exception as error:
    print(type(error).__name__, error)
inner.write_text(before)
"""
    told = cached_run(tmp_path, change).stdout
    assert told.startswith("HitofudeError inner_kernels.py has changed since Hitofude was started")
    assert cached_run(tmp_path, "from app.room.outer_kernels import outer; print(outer(1.0))").stdout.split() == ["4.0"]


def cached_run(folder: Path, code: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(**command(folder, code), capture_output=True, check=True, timeout=300)


def command(folder: Path, code: str) -> dict[str, Any]:
    """How a program in a folder is started, with its own cache."""
    environment = {name: value for name, value in os.environ.items() if name != "NUMBA_CACHE_DIR"}
    environment |= {"PYTHONPATH": str(folder), "XDG_CACHE_HOME": str(folder / "cache"), "PYTHONDONTWRITEBYTECODE": "1"}
    return {"args": [sys.executable, "-c", code], "cwd": folder, "env": environment, "text": True}


def test_processes_that_fill_the_cache_at_once_all_get_what_they_want(tmp_path: Path) -> None:
    small_program(tmp_path)
    code = "from app.room.outer_kernels import outer; from app.room.inner_kernels import inner; print(outer(1.0), inner(1.0))"
    started = [subprocess.Popen(**command(tmp_path, code), stdout=subprocess.PIPE, stderr=subprocess.PIPE) for _ in range(4)]
    assert [process.communicate(timeout=300)[0].split() for process in started] == [["4.0", "2.0"]] * 4
    assert [process.returncode for process in started] == [0] * 4
    assert not list((tmp_path / "cache").glob("**/*.tmp.*"))
