"""Projects on the command line: computed with the job that lies in them, and options override it."""

from dataclasses import replace
from pathlib import Path

import pytest

from app.cli.main import main
from app.drafting.history import HistoryState
from app.formats.job.write import empty_lists, job_lines
from app.formats.project.project import Project, write_project
from app.model.job import Job
from app.model.operation import CutParameters, PocketOperation
from app.model.part import Part
from app.model.tool import Tool
from tests.formats.project_cases import plate


@pytest.fixture
def project(tmp_path: Path) -> Path:
    job = Job(plate(), (Tool(7, 5.0, feed_rate=777.0),), (PocketOperation(CutParameters(7, 1.25)),))
    path = tmp_path / "plate.hito"
    path.write_bytes(write_project(Project(HistoryState(job))))
    return path


def made(path: Path, *options: str) -> str:
    out = path.with_suffix(".ngc")
    assert main(["make", str(path), "-o", str(out), "--quiet", *options]) in (0, 1)
    return out.read_text()


def test_make_takes_the_job_of_the_project(project: Path) -> None:
    text = made(project)
    assert "T7 M6" in text and "F777" in text and "Z-1.25" in text and "plate" in text


def test_options_override_it(project: Path) -> None:
    text = made(project, "--depth", "0.5", "--feed", "321")
    assert "F321" in text and "Z-0.5" in text and "Z-1.25" not in text


def test_a_job_file_takes_its_place(project: Path, tmp_path: Path) -> None:
    other = Job(Part(), (Tool(3, 4.0),), (PocketOperation(CutParameters(3)),))
    (tmp_path / "j.toml").write_text("\n".join([*empty_lists(other), *job_lines(other)]))
    assert "T3 M6" in made(project, "--job", str(tmp_path / "j.toml"))


def test_stages_and_tools_read_projects(project: Path, tmp_path: Path) -> None:
    assert main(["stages", str(project), "-o", str(tmp_path / "s"), "--bitmap", "100", "--quiet"]) in (0, 1)
    assert len(list((tmp_path / "s").glob("*.png"))) > 3
    assert main(["tools", str(project), "--quiet"]) in (0, 1)


def test_layers_are_chosen(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["make", str(project), "-o", str(project.with_suffix(".ngc")), "--layer", "none"]) == 2
    assert "no layer none" in capsys.readouterr().err


def test_the_backup_of_a_project_is_one(project: Path) -> None:
    backup = project.replace(project.with_name("plate.hito~"))
    assert "T7 M6" in made(backup)


def test_a_newer_project_is_refused_and_stays(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    data = project.read_bytes().replace(b"version = 1", b"version = 9")
    project.write_bytes(data)
    assert main(["make", str(project), "-o", str(project.with_suffix(".ngc"))]) == 2
    assert "version 9" in capsys.readouterr().err
    assert project.read_bytes() == data


def test_a_project_without_operations_says_so(project: Path, capsys: pytest.CaptureFixture[str]) -> None:
    project.write_bytes(write_project(Project(HistoryState(replace(Job(plate()), operations=())))))
    assert main(["make", str(project), "-o", str(project.with_suffix(".ngc"))]) == 2
    assert "no operation" in capsys.readouterr().err
