"""The folder that `.ci/bundle` packs is the whole program: where there is nothing but the C library and a shell it
makes the same NC text as the tree does, with no kernel left to compile.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app import __version__
from tests.conftest import ROOT
from tests.test_wheel import OPEN_AND_CLOSE

pytestmark = pytest.mark.exhaustive

PORTABLE = "HITOFUDE_PORTABLE"
SHELL = ("/bin/sh", "/usr/bin/dirname", "/usr/bin/readlink")
C_LIBRARY = ("libc.so.6", "libm.so.6", "libdl.so.2", "libpthread.so.0", "librt.so.1", "libutil.so.1", "libresolv.so.2")


@pytest.fixture(scope="module")
def bundle(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The packed program."""
    if not sys.platform.startswith("linux") or shutil.which("ldd") is None:
        pytest.skip("folders are packed on Linux, with ldd")
    folder = tmp_path_factory.mktemp("bundle") / "hitofude"
    done = subprocess.run(
        [sys.executable, str(ROOT / ".ci/bundle"), str(folder), "native"], capture_output=True, text=True, timeout=1200
    )
    assert done.returncode == 0, done.stderr
    return folder


@pytest.fixture(scope="module")
def bare(bundle: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A root in which there is a shell, the C library and the packed program, and nothing else."""
    if os.geteuid() != 0:
        pytest.skip("only root may change what the root of the file system is")
    root = tmp_path_factory.mktemp("bare")
    for name in ("bin", "lib64", "tmp", "work", "home"):
        (root / name).mkdir()
    for program in map(Path, SHELL):
        shutil.copy2(program.resolve(), root / "bin" / program.name)
        told = subprocess.run(["ldd", str(program)], capture_output=True, text=True, check=True).stdout
        for library in re.findall(r"/\S+", told):
            place = root / library.lstrip("/")
            place.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(Path(library).resolve(), place)
            for other in C_LIBRARY:
                if (Path(library).parent / other).is_file():
                    shutil.copy2((Path(library).parent / other).resolve(), place.parent / other)
    shutil.copytree(bundle, root / "opt" / "hitofude", copy_function=os.link)
    shutil.copy2(ROOT / "resources/samples/fig2.dxf", root / "work")
    return root


def run(root: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    line = f"cd /work; HOME=/home /opt/hitofude/hitofude {' '.join(arguments)}"
    return subprocess.run(["chroot", str(root), "/bin/sh", "-c", line], capture_output=True, text=True, timeout=300)


def test_it_makes_the_same_program_without_anything_but_a_c_library(bare: Path, tmp_path: Path) -> None:
    assert run(bare, "--version").stdout.split() == ["hitofude", __version__]
    done = run(bare, "make", "fig2.dxf", "-o", "fig2.ngc")
    assert done.returncode == 0, done.stderr
    here = [sys.executable, "-P", "-m", "app", "make", "fig2.dxf", "-o", str(tmp_path / "fig2.ngc")]
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    subprocess.run(here, cwd=bare / "work", env=environment, check=True, capture_output=True, timeout=300)
    assert (bare / "work" / "fig2.ngc").read_bytes() == (tmp_path / "fig2.ngc").read_bytes()
    assert not [path for path in (bare / "home").rglob("*kernel*") if path.is_file()]


@pytest.fixture
def portable() -> Path:
    """A folder that was packed for a level of processors, which takes half an hour: not for every run."""
    packed = os.environ.get(PORTABLE, "")
    if not packed:
        pytest.skip(f"{PORTABLE} names no folder packed by: .ci/bundle FOLDER x86-64-v3")
    return Path(packed)


def test_another_processor_makes_the_same_program_with_the_kernels_that_came_along(
    portable: Path, tmp_path: Path
) -> None:
    """An emulated Haswell, which has none of what this machine has beyond x86-64-v3."""
    emulator = shutil.which("qemu-x86_64")
    if emulator is None:
        pytest.skip("the emulator qemu-x86_64 is not installed here")
    shutil.copy2(ROOT / "resources/samples/fig2.dxf", tmp_path)
    environment = {"LD_LIBRARY_PATH": str(portable / "lib"), "HOME": str(tmp_path / "home"), "PATH": os.environ["PATH"]}
    python = next((portable / "bin").glob("python3*"))
    command = [emulator, "-cpu", "Haswell", str(python), "-I", "-m", "hitofude"]
    command += ["make", "fig2.dxf", "-o", "there.ngc"]
    done = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True, timeout=3600)
    assert done.returncode == 0, done.stderr
    here = [sys.executable, "-P", "-m", "app", "make", "fig2.dxf", "-o", "here.ngc"]
    subprocess.run(here, cwd=tmp_path, env=os.environ | {"PYTHONPATH": str(ROOT)}, check=True, capture_output=True)
    assert (tmp_path / "there.ngc").read_bytes() == (tmp_path / "here.ngc").read_bytes()
    assert not [path for path in (tmp_path / "home").rglob("*kernel*") if path.is_file()]


def test_its_window_opens_and_draws(bundle: Path) -> None:
    """Qt without the half of it that nothing imports."""
    home = bundle.parent / "home"
    environment = {
        "LD_LIBRARY_PATH": str(bundle / "lib"),
        "QT_QPA_PLATFORM": "offscreen",
        "HOME": str(home),
        "XDG_CACHE_HOME": str(home),
        "PATH": os.environ["PATH"],
    }
    python = next((bundle / "bin").glob("python3*"))
    done = subprocess.run(
        [str(python), "-I", "-c", OPEN_AND_CLOSE], env=environment, capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0 and done.stdout.startswith("moves"), done.stderr
