"""Kernels are compiled when they are first called, by other processes, and kept; one that cannot be is told and stops
nothing else.
"""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from tests.conftest import ROOT
from tests.said import without_how_far

INNER = """from app.core.jit import kernel


@kernel("float64(float64)")
def _twice(x):
    return 2.0 * x


@kernel("float64(float64)")
def inner(x):
    return _twice(x) / 2.0 + 1.0
"""
OUTER = """from app.core.jit import kernel
from app.room.inner_kernels import inner


@kernel("float64(float64)")
def outer(x):
    return 2.0 * inner(x)
"""
SHORT = "from app.room.outer_kernels import outer; print(outer(1.0))"


@pytest.fixture
def program(tmp_path: Path) -> Path:
    """Three kernels that call one another, and what they need of the program."""
    (tmp_path / "app" / "room").mkdir(parents=True)
    (tmp_path / "app" / "core").mkdir()
    # whole packages: one without this file gives way to the program that is installed
    for package in (
        "app",
        "app/core",
        "app/room",
    ):
        (tmp_path / package / "__init__.py").touch()
    for name in ("errors.py", "progress.py", "resources.py"):
        shutil.copy(ROOT / "app" / "core" / name, tmp_path / "app" / "core" / name)
    shutil.copytree(
        ROOT / "app" / "core" / "jit", tmp_path / "app" / "core" / "jit", ignore=shutil.ignore_patterns("__pycache__")
    )
    (tmp_path / "app" / "room" / "inner_kernels.py").write_text(INNER)
    (tmp_path / "app" / "room" / "outer_kernels.py").write_text(OUTER)
    (tmp_path / "resources").mkdir()
    (tmp_path / "resources" / "usual_kernels.txt").touch()
    return tmp_path


def command(folder: Path, code: str, **more: str) -> dict[str, Any]:
    """How a program in a folder is started, with its own cache and its own temporary folder."""
    (folder / "tmp").mkdir(exist_ok=True)
    own = {
        "PYTHONPATH": str(folder),
        "XDG_CACHE_HOME": str(folder / "cache"),
        "TMPDIR": str(folder / "tmp"),
        "PYTHONDONTWRITEBYTECODE": "1",
    }
    environment = {name: value for name, value in os.environ.items() if name != "HITOFUDE_KERNELS"} | own | more
    return {"args": [sys.executable, "-c", code], "cwd": folder, "env": environment, "text": True}


def run(folder: Path, code: str, **more: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(**command(folder, code, **more), capture_output=True, check=True, timeout=300)


def entries(folder: Path) -> dict[str, Path]:
    """The kept kernels by their own names."""
    return {
        path.name.split("-")[0].rpartition(".")[2]: path
        for path in (folder / "cache" / "hitofude" / "kernels").glob("*/*")
    }


def test_what_is_called_is_compiled_kept_and_found_again(program: Path) -> None:
    assert run(program, SHORT).stdout.split() == ["4.0"]
    kept = entries(program)
    assert set(kept) == {"outer", "inner", "_twice"}
    times = {name: path.stat().st_mtime_ns for name, path in kept.items()}
    assert run(program, SHORT).stdout.split() == ["4.0"]
    assert {name: path.stat().st_mtime_ns for name, path in entries(program).items()} == times


def test_nothing_is_compiled_until_something_is_called(program: Path) -> None:
    assert run(program, "import sys, app.room.outer_kernels; print('numba' in sys.modules)").stdout.split() == ["False"]
    assert entries(program) == {}


def test_what_is_loaded_alone_is_loaded_without_what_it_calls(program: Path) -> None:
    run(program, SHORT)
    for name in ("inner", "_twice"):
        entries(program)[name].unlink()
    assert run(program, SHORT).stdout.split() == ["4.0"]
    assert set(entries(program)) == {"outer"}


@pytest.mark.exhaustive
def test_a_kernel_is_compiled_again_when_one_that_it_calls_has_changed_in_another_file(program: Path) -> None:
    run(program, SHORT)
    inner = program / "app" / "room" / "inner_kernels.py"
    inner.write_text(INNER.replace("return 2.0 * x", "return 20.0 * x"))
    assert run(program, SHORT).stdout.split() == ["22.0"]
    inner.write_text(INNER)
    assert run(program, SHORT).stdout.split() == ["4.0"]


def test_what_changes_while_the_program_runs_is_never_kept_under_another_name(program: Path) -> None:
    change = """
import pathlib
from app.room import inner_kernels
file = pathlib.Path("app/room/inner_kernels.py")
file.write_text(file.read_text().replace("+ 1.0", "+ 100.0"))
from app.room.outer_kernels import outer
print(outer(1.0))
"""
    assert run(program, change).stdout.split() == ["4.0"], "what was imported is what counts"
    assert run(program, SHORT).stdout.split() == ["202.0"]


def test_what_a_job_usually_takes_is_compiled_ahead_of_its_import(program: Path) -> None:
    (program / "resources" / "usual_kernels.txt").write_text("room.outer_kernels:outer\n")
    code = """
import time
from app.core.jit.compilers import compilers
from app.room.inner_kernels import inner
print(inner(1.0))
while compilers().share < 1.0:
    time.sleep(0.05)
"""
    assert run(program, code).stdout.split() == ["2.0"]
    assert set(entries(program)) == {"outer", "inner", "_twice"}


@pytest.mark.exhaustive
def test_what_is_not_usual_waits_for_somebody_who_waits(program: Path) -> None:
    code = "from app.room.outer_kernels import outer; from app.room.inner_kernels import inner; print(inner(1.0))"
    assert run(program, f"{code}; import time; time.sleep(2.0)").stdout.split() == ["2.0"]
    assert "outer" not in entries(program), "the cores are for what the program computes"


def test_an_inner_kernel_has_no_door_for_python(program: Path) -> None:
    done = run(
        program, "from app.room.inner_kernels import _twice\ntry: _twice(1.0)\nexcept TypeError as error: print(error)"
    )
    assert "called by kernels alone" in done.stdout


@pytest.mark.exhaustive
def test_processes_that_fill_the_cache_at_once_all_get_what_they_want(program: Path) -> None:
    code = (
        "from app.room.outer_kernels import outer; from app.room.inner_kernels import inner; print(outer(1.0), "
        "inner(1.0))"
    )
    started = [
        subprocess.Popen(**command(program, code), stdout=subprocess.PIPE, stderr=subprocess.PIPE) for _ in range(4)
    ]
    assert [process.communicate(timeout=300)[0].split() for process in started] == [["4.0", "2.0"]] * 4
    assert [process.returncode for process in started] == [0] * 4
    assert set(entries(program)) == {"outer", "inner", "_twice"}


def test_compiling_processes_end_with_the_program(program: Path) -> None:
    code = f"{SHORT}; import app.core.jit.compilers as c; print(*[process.pid for process in c.compilers()._processes])"
    pids = [int(word) for word in run(program, code).stdout.split()[1:]]
    until = time.monotonic() + 20
    while any(Path("/proc", str(pid)).exists() for pid in pids) and time.monotonic() < until:
        time.sleep(0.05)
    assert not any(Path("/proc", str(pid)).exists() for pid in pids)


def test_whoever_waits_is_told_and_may_leave(program: Path) -> None:
    code = """
from app.core.errors import Cancelled
from app.core.progress import waits_reported_to
from app.room.outer_kernels import outer
told = []
def waiter(text):
    told.append(text)
    raise Cancelled
with waits_reported_to(waiter):
    try:
        outer(1.0)
    except Cancelled:
        print("left", told)
print(outer(1.0))
"""
    done = run(program, code).stdout
    assert "left ['Compiling inner loops, this first time only: 0 of 3']" in done
    assert done.split()[-1] == "4.0"


@pytest.mark.exhaustive
def test_the_command_line_says_once_that_it_is_the_first_time_only(tmp_path: Path) -> None:
    (tmp_path / "t.ngc").write_text("G21\nG1 X1 F100\nM2\n")
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    told = []
    for _ in range(2):
        done = subprocess.run(
            [sys.executable, "-m", "app", "check", str(tmp_path / "t.ngc")],
            cwd=ROOT,
            env=environment,
            capture_output=True,
            text=True,
            timeout=300,
        )
        assert done.returncode == 0
        told.append(without_how_far(done.stderr).splitlines())
    assert len(told[0]) == 1 and "this first time only" in told[0][0]
    assert told[1] == []


@pytest.mark.exhaustive
def test_a_kernel_that_cannot_be_compiled_stops_nothing_else(tmp_path: Path) -> None:
    """The program is copied with a few of its kernels' files, one of which is broken; one that comes behind it in the
    order of names is asked for.
    """
    for name in ("app", "resources"):
        shutil.copytree(ROOT / name, tmp_path / name, ignore=shutil.ignore_patterns("__pycache__", "ui"))
    all_kernels = sorted(path.relative_to(tmp_path) for path in (tmp_path / "app").glob("*/**/*kernels*.py"))
    kernels = [all_kernels[0], *all_kernels[20:-1:20], all_kernels[-1]]
    for path in all_kernels:
        (tmp_path / path).unlink()
    for path in kernels:
        (tmp_path / path).write_text(
            'from app.core.jit import kernel\n\n\n@kernel("int64(int64)")\ndef f(x):\n    return x + 1\n'
        )
    (tmp_path / "resources" / "usual_kernels.txt").write_text("")
    broken, last = kernels[0], kernels[-1]
    (tmp_path / broken).write_text(
        'from app.core.jit import kernel\n\n\n@kernel("int64(int64)")\ndef f(x):\n    return x.no_such_thing + '
        "undefined_name\n"
    )
    names = [".".join(path.with_suffix("").parts) for path in (broken, last)]
    code = f"""
import importlib, runpy
from app.core.errors import HitofudeError
try:
    importlib.import_module({names[0]!r}).f(1)
except HitofudeError as error:
    print("refused", error)
print("other", importlib.import_module({names[1]!r}).f(1))
runpy.run_module("app.core.jit.warm", run_name="__main__")
"""
    done = run(tmp_path, code)
    assert f"refused {names[0]}:f cannot be compiled" in done.stdout
    assert "other 2" in done.stdout
    (told,) = [line for line in done.stderr.splitlines() if "cannot be compiled" in line]
    assert told.startswith(f"hitofude: {names[0]}:f cannot be compiled")
