"""`make --propose`, `--curves` and `--write-job` as their user sees them."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from app.cli.main import main

PLATE = "rect 0,0 40,30\nrect 5,5 20,25\ncircle 30,15 3\n"


@pytest.fixture
def plate(tmp_path: Path) -> Path:
    path = tmp_path / "plate.draw"
    path.write_text(PLATE)
    return path


def refused(capsys: pytest.CaptureFixture[str], *arguments: object) -> str:
    assert main(["make", *map(str, arguments)]) == 2
    return capsys.readouterr().err


def test_a_proposal_is_told_reported_and_written_as_a_job_that_makes_the_same_program(
    plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out, job, report = (tmp_path / name for name in ("o.ngc", "j.toml", "r.json"))
    assert (
        main(["make", str(plate), "-o", str(out), "--propose", "--write-job", str(job), "--report", str(report)]) == 0
    )
    told = capsys.readouterr().out
    for words in (
        "1 drill T70 [circles:6]: 1 hole of 6 mm",
        "pocket T8 [inner]: 1 inner contour",
        "contour T8 [outer]: 1 outline",
    ):
        assert words in told
    assert "places out of reach" in told
    assert [each["curves"] for each in json.loads(report.read_text())["proposal"]["operations"]] == [
        ["circles:6"],
        ["inner"],
        ["outer"],
    ]
    again = tmp_path / "again.ngc"
    assert main(["make", str(plate), "-o", str(again), "--job", str(job), "--quiet"]) == 0
    assert again.read_bytes() == out.read_bytes()


def test_curves_are_named_one_by_one(plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "o.ngc"
    assert main(["make", str(plate), "-o", str(out), "--curves", "#5", "--curves", "circles:6"]) == 0
    assert "curves=+23+5/circles+3A+6" in out.read_text() and "curves no. 5 and circles 6 mm" in out.read_text()
    capsys.readouterr()
    assert main(["make", str(plate), "-o", str(out), "--curves", "#5", "--curves", "#77"]) == 1
    assert "asks for #77, and there is none; the drawing has #1 to #9." in capsys.readouterr().out


@pytest.mark.parametrize(
    ("options", "text"),
    [
        (("--curves", "outside"), "--curves is wrong: 'outside' selects no curves; write \"#12\""),
        (("--thickness", "3"), "--thickness has no effect without --propose"),
        (("--propose", "--bitmap", "100"), "--propose has no effect on pixels"),
        (("--propose", "--drill", "6"), "--drill does not go with --propose"),
        (("--propose", "--curves", "outer"), "--curves does not go with --propose"),
        (("--bitmap", "100", "--curves", "outer"), "--curves has no effect on pixels"),
    ],
)
def test_what_does_not_go_together_is_refused(
    options: tuple[str, ...], text: str, plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert text in refused(capsys, plate, "-o", tmp_path / "o.ngc", *options)
    assert not (tmp_path / "o.ngc").exists()


def test_tools_of_a_library_and_the_thickness_are_those_of_the_proposal(
    plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    job = tmp_path / "tools.toml"
    job.write_text("[[tool]]\nnumber = 4\ndiameter = 3.0\n\n[[operation]]\nkind = 'pocket'\ntool = 4\n")
    made = tmp_path / "j.toml"
    options = ["--job", str(job), "--propose", "--thickness", "4", "--write-job", str(made)]
    assert main(["make", str(plate), "-o", str(tmp_path / "o.ngc"), *options]) == 0
    text = made.read_text()
    assert text.count("[[tool]]") == 1 and "thickness = 4.0" in text and "margin = 5.0" in text
    assert "T4 flat 3 mm mills it" in capsys.readouterr().out


def test_old_job_files_name_layers_and_say_the_same(plate: Path, tmp_path: Path) -> None:
    texts = []
    for keys in ("layers = ['0']", "curves = ['layer:0']"):
        job = tmp_path / "j.toml"
        job.write_text(f"[[tool]]\nnumber = 1\ndiameter = 3\n[[operation]]\nkind = 'pocket'\ntool = 1\n{keys}\n")
        assert main(["make", str(plate), "-o", str(tmp_path / "o.ngc"), "--job", str(job), "--quiet"]) == 0
        texts.append((tmp_path / "o.ngc").read_text())
    assert texts[0] == texts[1]


def test_layers_and_curves_of_one_operation_are_refused(
    plate: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    job = tmp_path / "j.toml"
    job.write_text("[[operation]]\nkind = 'pocket'\ntool = 1\nlayers = ['0']\ncurves = ['outer']\n")
    assert "layers goes into curves" in refused(capsys, plate, "-o", tmp_path / "o.ngc", "--job", job)


@pytest.mark.parametrize("name", ["fig2.dxf", "nameplate.draw"])
def test_a_sample_that_is_proposed_has_no_finding_that_counts(name: str, samples: Path, tmp_path: Path) -> None:
    assert main(["make", str(samples / name), "-o", str(tmp_path / "o.ngc"), "--propose", "--quiet"]) == 0
