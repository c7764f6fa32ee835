"""Recovery files: those of the dead are offered, those of the living are not, and a damaged one stops nobody."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.core.settings import state_folder
from app.drafting.document import Document
from app.formats.project.project import Project
from app.formats.project.recovery import EditedFile, RecoveryFile, recoveries
from tests.conftest import ROOT

CRASH = """
import os, sys
from pathlib import Path
from app.drafting.document import Document
from app.formats.project.project import Project
from app.formats.project.recovery import EditedFile, RecoveryFile
document = Document()
document.run("circle 1,2 3")
RecoveryFile().keep(Project(document.state), EditedFile(Path("/home/me/plate.hito"), (1, 2, 3)))
os.kill(os.getpid(), 9)
"""


def crash() -> None:
    subprocess.run([sys.executable, "-c", CRASH], cwd=ROOT, timeout=60, check=False)


def project(line: str) -> Project:
    document = Document()
    document.run(line)
    return Project(document.state)


def names() -> set[str]:
    return {path.suffix for path in state_folder().iterdir()} if state_folder().exists() else set()


def test_what_a_crash_leaves_is_offered_once_to_one() -> None:
    crash()
    (found,) = recoveries()
    assert found.edited() == EditedFile(Path("/home/me/plate.hito"), (1, 2, 3))
    assert len(found.load().state.job.part.entities) == 1
    assert recoveries() == ()
    found.leave()
    (again,) = recoveries()
    again.discard()
    assert recoveries() == () and names() == set()


def test_a_lock_that_a_crash_leaves_alone_is_cleared_away() -> None:
    state_folder().mkdir(parents=True)
    (state_folder() / "x.lock").write_text("")
    assert recoveries() == () and names() == set()


def test_the_living_are_left_alone() -> None:
    mine = RecoveryFile()
    mine.keep(project("line 0,0 1,1"), EditedFile())
    assert recoveries() == ()
    mine.close()
    assert recoveries() == () and names() == set()


def test_a_later_state_takes_the_place_of_the_one_before() -> None:
    mine = RecoveryFile()
    mine.keep(project("line 0,0 1,1"), EditedFile())
    mine.keep(project("rect 0,0 1,1"), EditedFile())
    assert mine.path.read_text().count("line ") == 4
    mine.forget()
    mine.forget()
    mine.close()


@pytest.mark.parametrize(
    "data", [b"", b"\xff\x00", b"# recovery of [\n", b'# recovery of ["a", 3]\nformat = "hitofude"\n']
)
def test_a_damaged_file_is_told_and_set_aside(data: bytes) -> None:
    state_folder().mkdir(parents=True)
    (state_folder() / "x.hito").write_bytes(data)
    (found,) = recoveries()
    assert found.edited() == EditedFile()
    with pytest.raises(InputError):
        found.load()
    assert found.set_aside().read_bytes() == data
    assert recoveries() == ()


def test_a_folder_that_cannot_be_made_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("HITOFUDE_CONFIG", str(tmp_path / "file"))
    with pytest.raises(InputError, match="No recovery files can be kept"):
        RecoveryFile()
    assert recoveries() == ()


def test_without_a_folder_nothing_is_found() -> None:
    assert not os.path.exists(state_folder()) and recoveries() == ()
