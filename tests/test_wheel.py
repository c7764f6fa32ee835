"""The wheel is the whole program: put into an empty environment it makes a program and opens a window, far from the
source.
"""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

pytestmark = pytest.mark.exhaustive

DESKTOP = "resources/desktop"
OPEN_AND_CLOSE = """
import sys
from PySide6.QtCore import QTimer
from PySide6.QtWidgets import QApplication
import hitofude.ui.shell.start as start
from hitofude.core.resources import resource
began = start.begin
def begin(wiring, path):
    began(wiring, path)
    def look():
        if wiring.computation.made is not None:
            print("moves", len(wiring.computation.made.program.moves), start.__file__)
            wiring.document.load(wiring.document.job)
            wiring.window_.close()
        elif wiring.document.part.entities and wiring.computation.state.name == "NONE":
            wiring.compute()
    timer = QTimer(wiring.window_, interval=50)
    timer.timeout.connect(look)
    timer.start()
start.begin = begin
sys.exit(start.start(resource("samples", "fig2.dxf")))
"""


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An environment that holds the wheel and what it depends on, and nothing else."""
    folder = tmp_path_factory.mktemp("wheel")
    source = folder / "source"
    shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns(".[!c]*", "tests", "__pycache__"))
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "-q"]
    made = subprocess.run(
        [*pip, "wheel", "--no-deps", "-w", str(folder), str(source)], capture_output=True, text=True, timeout=300
    )
    if made.returncode and "No matching distribution" in made.stderr:
        pytest.skip("there is no package index to take the build back end from")
    assert made.returncode == 0, made.stderr
    (wheel,) = folder.glob("*.whl")
    shutil.rmtree(source)
    subprocess.run([sys.executable, "-m", "venv", str(folder / "venv")], check=True, timeout=120)
    python = folder / "venv" / "bin" / "python"
    subprocess.run(
        [str(python), "-m", "pip", "--disable-pip-version-check", "-q", "install", str(wheel)], check=True, timeout=600
    )
    return folder / "venv" / "bin"


def test_the_wheel_brings_one_package_of_its_own_name(installed: Path) -> None:
    (site,) = installed.parent.glob("lib/python3*/site-packages")
    names = {line.partition("/")[0] for line in next(site.glob("hitofude-*.dist-info/RECORD")).read_text().splitlines()}
    assert {name for name in names if ".dist-info" not in name and name != ".."} == {"hitofude"}


def run(folder: Path, *command: str) -> subprocess.CompletedProcess[str]:
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, timeout=300)


def test_make_writes_the_program(installed: Path, tmp_path: Path) -> None:
    shutil.copy(ROOT / "resources" / "samples" / "fig2.dxf", tmp_path)
    done = run(tmp_path, str(installed / "hitofude"), "make", "fig2.dxf", "-o", "fig2.ngc", "--post", "grbl")
    assert done.returncode == 0, done.stderr
    assert sorted(path.name for path in tmp_path.glob("*.ngc")) == ["fig2_1_T1.ngc", "fig2_2_T2.ngc"]


def test_without_environment_and_network_it_makes_what_the_tree_makes(installed: Path, tmp_path: Path) -> None:
    """No PATH, no HOME, no language; where a process may be cut off from the network, nobody answers it."""
    shutil.copy(ROOT / "resources" / "samples" / "fig2.dxf", tmp_path)
    alone = [shutil.which("unshare"), "--net"] if os.geteuid() == 0 and shutil.which("unshare") else []
    command = [*alone, installed / "python", "-I", "-m", "hitofude", "make", "fig2.dxf", "-o", "alone.ngc"]
    done = subprocess.run(command, cwd=tmp_path, env={}, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    here = [sys.executable, "-P", "-m", "app", "make", "fig2.dxf", "-o", "tree.ngc"]
    subprocess.run(here, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)}, check=True, capture_output=True)
    assert (tmp_path / "alone.ngc").read_bytes() == (tmp_path / "tree.ngc").read_bytes()


def test_desktops_find_entry_icon_kinds_of_files_and_manual_page(installed: Path) -> None:
    share = installed.parent / "share"
    assert (share / "applications/hitofude.desktop").read_bytes() == (ROOT / DESKTOP / "hitofude.desktop").read_bytes()
    assert {path.relative_to(share).as_posix() for path in share.rglob("hitofude*") if path.is_file()} == {
        "applications/hitofude.desktop",
        "icons/hicolor/scalable/apps/hitofude.svg",
        "mime/packages/hitofude.xml",
        "man/man1/hitofude.1",
    }


def test_many_parts_their_sheets_and_the_manual(installed: Path, tmp_path: Path) -> None:
    (tmp_path / "parts").mkdir()
    for name in ("a", "b"):
        (tmp_path / "parts" / f"{name}.draw").write_text("rect 0,0 20,15\n")
    command = str(installed / "hitofude")
    done = run(tmp_path, command, "batch", "parts", "-o", "out", "--jobs", "2", "--sheets", "pdf")
    assert done.returncode == 0, done.stderr
    tree = tmp_path / "tree.ngc"
    own = [sys.executable, "-P", "-m", "app", "make", str(tmp_path / "parts/a.draw"), "-o", str(tree)]
    subprocess.run(own, cwd=ROOT, check=True)
    assert (tmp_path / "out/a.ngc").read_bytes() == tree.read_bytes()
    assert (tmp_path / "out/b.pdf").read_bytes().startswith(b"%PDF")
    assert run(tmp_path, command, "manual", "-o", "site").returncode == 0 and (tmp_path / "site/index_ja.html").exists()
    assert "LGPL" in run(tmp_path, command, "licences").stdout


def test_the_window_opens_with_its_sample_and_computes_it(installed: Path, tmp_path: Path) -> None:
    done = run(tmp_path, str(installed / "python"), "-c", OPEN_AND_CLOSE)
    assert done.returncode == 0, done.stderr
    word, moves, where = done.stdout.splitlines()[0].split()  # it may look once more while the window closes
    assert word == "moves" and int(moves) > 100
    assert Path(where).is_relative_to(installed.parent)
