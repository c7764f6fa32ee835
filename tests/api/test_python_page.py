"""The page about Python: all its examples run, as `hitofude` would be installed, beside the files that they name."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import app as hitofude
from tests.conftest import ROOT

PAGE = ROOT / "resources" / "docs" / "python.md"
SAMPLES = ("fig2.dxf", "inlay.draw", "spheres.toml")


@pytest.fixture
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the samples, in which the examples run."""
    for name in SAMPLES:
        shutil.copy(ROOT / "resources" / "samples" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def examples() -> list[str]:
    """The page's examples in their order."""
    return re.findall(r"```python\n(.*?)```", PAGE.read_text("utf-8"), flags=re.DOTALL)


def test_the_examples_run(beside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "hitofude", hitofude)
    names: dict[str, object] = {}
    assert len(examples()) == 7
    for code in examples():
        exec(code, names)
    written = {path.name for path in beside.iterdir()} - set(SAMPLES)
    inlay = {"badge_pocket.ngc", "badge_plug.ngc"}
    assert written == {"fig2.ngc", "fig2.pdf", "job_1_T1.nc", "job_2_T2.nc", "smooth.ngc", "spheres.ngc"} | inlay


def test_its_program_is_that_of_the_command_line(beside: Path) -> None:
    options = hitofude.MakeOptions(pocket_diameter=6, contour_diameter=3)
    from app.cli.main import main

    assert main(["make", "fig2.dxf", "-o", "line.ngc", "--pocket-tool", "6", "--contour-tool", "3", "--quiet"]) == 0
    assert hitofude.make("fig2.dxf", options).text == (beside / "line.ngc").read_text()


def test_importing_it_loads_nothing() -> None:
    code = (
        "import sys, app\n"
        "assert {'numpy', 'app.api'} & set(sys.modules) == set(), sorted(sys.modules)\n"
        "assert {'make', 'Job', 'cut'} <= set(dir(app))\n"
    )
    subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True)


def test_importing_it_takes_no_fifth_of_a_second() -> None:
    code = "import time; begin = time.process_time(); import app; print(time.process_time() - begin)"
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, check=True, capture_output=True, text=True)
    assert float(done.stdout) < 0.2


def test_a_sheet_is_one_of_two_kinds_of_files(beside: Path) -> None:
    made = hitofude.make("fig2.dxf")
    with pytest.raises(hitofude.HitofudeError, match=r"is \.pdf or \.html"):
        made.sheet("fig2.doc")
    assert made.sheet("fig2.html").read_bytes().startswith(b"<!DOCTYPE html>")


def test_every_name_is_there_and_no_other() -> None:
    for name in hitofude.api.__all__:
        assert getattr(hitofude, name) is getattr(hitofude.api, name)
    with pytest.raises(AttributeError, match="nothing_of_the_kind"):
        hitofude.nothing_of_the_kind  # noqa: B018


def test_what_cannot_be_used_is_told_and_nothing_written(beside: Path) -> None:
    with pytest.raises(hitofude.HitofudeError, match="does not exist; check the name"):
        hitofude.make("none.dxf")
    (beside / "bad.ngc").write_text("G0 X1\nG1 X5 Q\nM2\n")
    assert not hitofude.check("bad.ngc").clean
    made = hitofude.make("fig2.dxf")
    with pytest.raises(hitofude.HitofudeError):
        made.save(beside / "no" / "folder.ngc")
    assert "<svg" in made._repr_svg_()


def test_a_job_stops_when_it_is_told(beside: Path) -> None:
    import threading

    stop = threading.Event()

    def listener(fraction: float, text: str) -> None:
        if fraction > 0.3:
            stop.set()

    with pytest.raises(hitofude.Cancelled):
        hitofude.make("fig2.dxf", progress=hitofude.Progress(listener, stop))
