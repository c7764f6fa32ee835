"""A tree that is installed as it stands is the package `hitofude` to whoever imports it, as an installed wheel is."""

import os
import runpy
import shutil
import subprocess
import sys
from pathlib import Path
from types import ModuleType

import pytest

from tests.conftest import ROOT

READ = "import hitofude; print(len(hitofude.read({drawing!r}).part.entities), hitofude.__file__)"


def printed_by(python: Path | str, program: str, *paths: Path) -> str:
    """Return what a program prints that finds packages in these folders only."""
    environment = {name: value for name, value in os.environ.items() if not name.startswith("PYTHON")}
    environment["PYTHONPATH"] = os.pathsep.join(map(str, paths))
    command = [str(python), "-P", "-c", program]
    done = subprocess.run(command, cwd=ROOT, env=environment, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_the_package_of_a_tree_reads_a_drawing(samples: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    hooks = ModuleType("hatchling.builders.hooks.plugin.interface")  # the back end is there while pip builds only
    vars(hooks)["BuildHookInterface"] = object
    monkeypatch.setitem(sys.modules, hooks.__name__, hooks)
    (tmp_path / "hitofude").mkdir()
    text = runpy.run_path(str(ROOT / ".ci" / "editable_package.py"))["door_text"](ROOT)
    (tmp_path / "hitofude" / "__init__.py").write_text(text, encoding="utf-8")
    said = printed_by(sys.executable, READ.format(drawing=str(samples / "fig2.dxf")), tmp_path)
    count, file = said.split(maxsplit=1)
    assert int(count) > 0 and Path(file.strip()) == ROOT / "app" / "__init__.py"


@pytest.mark.exhaustive
def test_pip_installs_a_tree_under_its_name(tmp_path: Path) -> None:
    source, environment = tmp_path / "source", tmp_path / "venv"
    shutil.copytree(ROOT, source, ignore=shutil.ignore_patterns(".[!c]*", "tests", "__pycache__"))
    subprocess.run([sys.executable, "-m", "venv", str(environment)], check=True, timeout=120)
    python = environment / "bin" / "python"
    pip = [str(python), "-m", "pip", "--disable-pip-version-check", "-q", "install", "--no-deps", "-e", str(source)]
    done = subprocess.run(pip, capture_output=True, text=True, timeout=300)
    if done.returncode and "No matching distribution" in done.stderr:
        pytest.skip("there is no package index to take the build back end from")
    assert done.returncode == 0, done.stderr
    said = printed_by(python, "import hitofude, hitofude.core.resources as r; print(r.PACKAGE, r.resource('samples'))")
    assert said.split(maxsplit=1) == ["hitofude", f"{source / 'resources' / 'samples'}\n"]
    (site,) = environment.glob("lib/python3*/site-packages")
    assert [path.name for path in (site / "hitofude").iterdir() if path.name != "__pycache__"] == ["__init__.py"]
