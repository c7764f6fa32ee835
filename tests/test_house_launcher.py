"""The launcher, run by a real shell in a checkout that is set up already: what it passes on, and from where it can be
called.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.cli.program import SUMMARIES
from tests.conftest import ROOT

pytestmark = pytest.mark.skipif(shutil.which("sh") is None, reason="no POSIX shell on this machine")

SAY_WHAT_CAME = (
    "import os, sys\nprint(*sys.argv[1:], os.getcwd(), sep='|')\nsys.exit(3 if 'three' in sys.argv else 0)\n"
)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    """A checkout whose program only repeats its arguments, with a .venv that runs this Python."""
    root = tmp_path / "a checkout"
    (root / ".venv" / "bin").mkdir(parents=True)
    (root / "app").mkdir()
    shutil.copy(ROOT / "hitofude", root)
    shutil.copy(ROOT / "pyproject.toml", root)
    (root / "app" / "__init__.py").touch()
    (root / "app" / "__main__.py").write_text(SAY_WHAT_CAME)
    python = root / ".venv" / "bin" / "python"
    python.write_text(f'#!/bin/sh\nPYTHONPATH="{root}" exec "{sys.executable}" "$@"\n')
    python.chmod(0o755)
    (root / ".venv" / "installed").write_text(f"{root}\n")
    (root / ".venv" / "libraries").touch()
    newer = root.joinpath("pyproject.toml").stat().st_mtime + 10
    os.utime(root / ".venv" / "installed", (newer, newer))
    return root


def call(launcher: Path, *arguments: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run([str(launcher), *arguments], cwd=folder, capture_output=True, text=True, timeout=60)


def test_arguments_and_folder_are_passed_on(checkout: Path, tmp_path: Path) -> None:
    done = call(checkout / "hitofude", "make", "a b.dxf", "--depth=-1", "", folder=tmp_path)
    assert done.stdout == f"make|a b.dxf|--depth=-1||{tmp_path}\n"


def test_the_exit_status_is_the_program_s(checkout: Path, tmp_path: Path) -> None:
    assert call(checkout / "hitofude", "make", "three", folder=tmp_path).returncode == 3


def test_it_works_through_a_link(checkout: Path, tmp_path: Path) -> None:
    link = tmp_path / "hito"
    link.symlink_to(checkout / "hitofude")
    assert call(link, "make", folder=tmp_path).stdout == f"make|{tmp_path}\n"


def test_a_folder_named_app_where_it_is_called_does_not_matter(checkout: Path, tmp_path: Path) -> None:
    (tmp_path / "app").mkdir()
    (tmp_path / "app" / "__main__.py").write_text("print('wrong')")
    (tmp_path / "app" / "__init__.py").touch()
    assert call(checkout / "hitofude", "make", folder=tmp_path).stdout == f"make|{tmp_path}\n"


def test_a_newer_pyproject_is_installed_again(checkout: Path, tmp_path: Path) -> None:
    python = checkout / ".venv" / "bin" / "python"
    python.write_text(
        f'#!/bin/sh\ncase "$2" in pip) echo "pip $*" >&2;; *) PYTHONPATH="{checkout}" exec "{sys.executable}" "$@";; '
        "esac\n"
    )
    newer = checkout.joinpath(".venv/installed").stat().st_mtime + 10
    os.utime(checkout / "pyproject.toml", (newer, newer))
    done = call(checkout / "hitofude", "make", folder=tmp_path)
    assert f"install -q --disable-pip-version-check --no-compile -e {checkout}" in done.stderr
    assert done.stdout == f"make|{tmp_path}\n"


def test_a_checkout_that_was_moved_is_set_up_again(checkout: Path, tmp_path: Path) -> None:
    (checkout / ".venv" / "installed").write_text("/somewhere/else\n")
    python = checkout / ".venv" / "bin" / "python"
    python.write_text(
        f'#!/bin/sh\ncase "$2" in pip) echo "pip $*" >&2;; *) PYTHONPATH="{checkout}" exec "{sys.executable}" "$@";; '
        "esac\n"
    )
    assert "setting up" in call(checkout / "hitofude", "make", folder=tmp_path).stderr


def test_no_command_but_that_of_graphics_hardware_waits_for_the_libraries_of_the_window() -> None:
    pattern = re.search(
        r"^    ([a-z0-9 |]+) \| -\*\) install_project ''", (ROOT / "hitofude").read_text(), re.MULTILINE
    )
    assert pattern is not None and set(pattern[1].split(" | ")) == set(SUMMARIES) - {"figure11"}
