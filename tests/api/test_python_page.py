"""The page about Python: all its examples run, as `hitofude` would be installed, beside the files that they name."""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from enum import Enum
from pathlib import Path

import pytest

import app as hitofude
from app.model.fields import declared_of, parameters_of
from app.model.operation_kinds import OPERATION_KINDS
from tests.conftest import ROOT

PAGE = ROOT / "resources" / "docs" / "python.md"
JAPANESE, README = PAGE.with_name("python_ja.md"), ROOT / "README.md"
SAMPLES = ("fig2.dxf", "inlay.draw", "raster.ngc", "spheres.toml")


@pytest.fixture
def beside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with the samples, in which the examples run."""
    for name in SAMPLES:
        shutil.copy(ROOT / "resources" / "samples" / name, tmp_path)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def examples(page: Path = PAGE) -> list[str]:
    """The page's examples in their order."""
    return re.findall(r"```python\n(.*?)```", page.read_text("utf-8"), flags=re.DOTALL)


@pytest.mark.exhaustive
def test_the_examples_run(beside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "hitofude", hitofude)
    names: dict[str, object] = {}
    assert len(examples()) == 9
    for code in examples():
        exec(code, names)
    written = {path.name for path in beside.iterdir()} - set(SAMPLES)
    inlay = {"badge_pocket.ngc", "badge_plug.ngc"}
    assert written == {"fig2.ngc", "fig2.pdf", "job_1_T1.nc", "job_2_T2.nc", "smooth.ngc", "spheres.ngc"} | inlay


def test_the_japanese_page_has_the_same_examples() -> None:
    assert examples(JAPANESE) == examples()


def test_the_script_of_ten_lines_in_the_readme_runs(beside: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "hitofude", hitofude)
    (script,) = examples(README)
    assert len([line for line in script.splitlines() if line]) <= 10
    (beside / "resources" / "samples").mkdir(parents=True)
    shutil.copy(beside / "fig2.dxf", beside / "resources" / "samples")
    exec(script, {})
    assert (beside / "fig2.ngc").exists() and (beside / "fig2.pdf").exists()


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


def test_every_choice_of_an_operation_or_a_tool_is_among_the_names() -> None:
    defaults = [placed.default for kind in OPERATION_KINDS.values() for placed in parameters_of(kind).values()]
    defaults += [placed.default for placed in declared_of(hitofude.Tool).values()]
    choices = {type(default).__name__ for default in defaults if isinstance(default, Enum)}
    assert "Direction" in choices and "ThreadSize" in choices
    assert choices <= set(hitofude.api.__all__)


def test_what_cannot_be_used_is_told_and_nothing_written(beside: Path) -> None:
    with pytest.raises(hitofude.HitofudeError, match="does not exist; check the name"):
        hitofude.make("none.dxf")
    (beside / "bad.ngc").write_text("G0 X1\nG1 X5 Q\nM2\n")
    assert not hitofude.check("bad.ngc").clean
    made = hitofude.make("fig2.dxf")
    with pytest.raises(hitofude.HitofudeError):
        made.save(beside / "no" / "folder.ngc")
    assert "<svg" in made._repr_svg_()
    assert repr(made) == f"<MadeProgram {made}>", "a prompt shows a line, not all that is behind it"


@pytest.mark.parametrize(
    ("mistake", "told"),
    [
        (lambda: hitofude.read("fig2.dxf", units="furlong"), "Units.MM or Units.INCH"),
        (
            lambda: hitofude.make("fig2.dxf", {"pocket_diameter": 6}),
            r"a dict; it must be hitofude\.MakeOptions",
        ),
        (lambda: hitofude.make("fig2.dxf", hitofude.MakeOptions(pocket_diameter="6mm")), "'6mm'; it must be a number"),
        (lambda: hitofude.make("fig2.dxf", parameters(depht=3)), "'depht'; use depth"),
        (lambda: hitofude.make("fig2.dxf", parameters(side="outside")), "'outside'; it must be a member of Side"),
        (lambda: hitofude.make(hitofude.Job(hitofude.read("fig2.dxf"))), r"read\(\.\.\.\)\.part"),
        (lambda: hitofude.make(hitofude.Job(hitofude.read("fig2.dxf").part, tools=hitofude.Tool(1, 6))), r"\(tool,\)"),
        (lambda: hitofude.check(hitofude.make("fig2.dxf")), "save it, and give the path"),
        (lambda: hitofude.cut(), "no program to cut"),
        (lambda: hitofude.batch(["fig2.dxf"]), r"BatchPart\(path, options\)"),
        (lambda: hitofude.batch([hitofude.BatchPart("fig2.dxf", None)]), "one of MakeOptions, ExamineOptions"),
        (lambda: hitofude.feeds(hitofude.Tool(1, 6.0), "cheese"), "'cheese' is no material"),
        (lambda: hitofude.Tool(1, 6.0, "ball"), "a member of ToolKind"),
        (lambda: hitofude.CutParameters(tool=1, depth="3"), "Depth is '3'; it must be a number"),
    ],
)
def test_a_slip_of_a_script_is_told_in_a_sentence(beside: Path, mistake: Callable[[], object], told: str) -> None:
    with pytest.raises(hitofude.HitofudeError, match=told):
        mistake()


def parameters(**values: object) -> object:
    return hitofude.MakeOptions(machining=hitofude.MachiningOptions(values=values))


def test_a_job_stops_when_it_is_told(beside: Path) -> None:
    import threading

    stop = threading.Event()

    def listener(fraction: float, text: str) -> None:
        if fraction > 0.3:
            stop.set()

    with pytest.raises(hitofude.Cancelled):
        hitofude.make("fig2.dxf", progress=hitofude.Progress(listener, stop))
