"""Project files on the disk: whole, with the version before, and not over another program's work."""

import os
import resource
import signal
from dataclasses import replace
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.drafting.expressions.values import Curves
from app.drafting.history import HistoryState
from app.formats.project.extras import ProjectExtras
from app.formats.project.files import ChangedElsewhere, load_project, save_project, stamp_of
from app.formats.project.project import Project, read_project
from app.model.job import Job
from app.model.part import Part, Units
from app.model.read_options import DrawingOptions
from app.model.reading import DrawingSource, ReadingOptions
from app.model.underlay import Underlay
from tests.formats.project_cases import plate


def named(name: str) -> Project:
    part = plate()
    return Project(HistoryState(Job(Part(part.entities, part.layers, part.units, name))))


def name_in(path: Path) -> str:
    return read_project(path.name, path.read_bytes()).state.job.part.name


def test_the_version_before_is_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.hito"
    stamp = save_project(path, named("one"))
    assert not (tmp_path / "a.hito~").exists()
    stamp = save_project(path, named("two"), stamp)
    assert (name_in(path), name_in(tmp_path / "a.hito~")) == ("two", "one")
    save_project(path, named("three"), stamp)
    assert (name_in(path), name_in(tmp_path / "a.hito~")) == ("three", "two")
    assert sorted(each.name for each in tmp_path.iterdir()) == ["a.hito", "a.hito~"]


def test_without_a_backup_none_is_made(tmp_path: Path) -> None:
    path = tmp_path / "a.hito"
    save_project(path, named("one"))
    save_project(path, named("two"), backup=False)
    assert [each.name for each in tmp_path.iterdir()] == ["a.hito"]


def test_what_another_program_made_is_not_overwritten(tmp_path: Path) -> None:
    path = tmp_path / "a.hito"
    save_project(path, named("one"))
    _, stamp = load_project(path)
    path.write_bytes(path.read_bytes() + b"# mine\n")
    theirs = path.read_bytes()
    with pytest.raises(ChangedElsewhere, match=r"a\.hito was changed by another program"):
        save_project(path, named("two"), stamp)
    assert path.read_bytes() == theirs and not (tmp_path / "a.hito~").exists()
    save_project(path, named("two"), None)
    assert name_in(path) == "two" and (tmp_path / "a.hito~").read_bytes() == theirs


def test_a_file_that_has_gone_is_written_again(tmp_path: Path) -> None:
    path = tmp_path / "a.hito"
    stamp = save_project(path, named("one"))
    path.unlink()
    save_project(path, named("two"), stamp)
    assert name_in(path) == "two"


def test_a_link_stays_one(tmp_path: Path) -> None:
    (tmp_path / "real").mkdir()
    save_project(tmp_path / "real" / "a.hito", named("one"))
    (tmp_path / "a.hito").symlink_to(tmp_path / "real" / "a.hito")
    save_project(tmp_path / "a.hito", named("two"))
    assert (tmp_path / "a.hito").is_symlink()
    assert name_in(tmp_path / "real" / "a.hito") == "two" and name_in(tmp_path / "a.hito~") == "one"


def test_where_two_names_for_a_file_are_not_possible_the_backup_is_a_copy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.hito"
    save_project(path, named("one"))

    def refuses(*_: object) -> None:
        raise PermissionError("no links here")

    monkeypatch.setattr(os, "link", refuses)
    save_project(path, named("two"))
    assert (name_in(path), name_in(tmp_path / "a.hito~")) == ("two", "one")


def test_a_folder_that_is_not_there_is_told_and_nothing_is_left(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="Cannot write"):
        save_project(tmp_path / "none" / "a.hito", named("one"))
    assert list(tmp_path.iterdir()) == []


def test_the_names_of_the_folder_reach_the_disk_too(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    flushed: list[str] = []
    right = os.fsync

    def noted(handle: int) -> None:
        flushed.append(os.path.realpath(f"/proc/self/fd/{handle}"))
        right(handle)

    monkeypatch.setattr(os, "fsync", noted)
    save_project(tmp_path / "a.hito", named("one"))
    assert flushed[-1] == str(tmp_path.resolve()) and len(flushed) == 2


def test_a_picture_in_the_folder_moves_with_it_and_one_elsewhere_stays(tmp_path: Path) -> None:
    (tmp_path / "one" / "pictures").mkdir(parents=True)
    for picture in (tmp_path / "one" / "pictures" / "plan b.png", tmp_path / "else.png"):
        project = Project(named("one").state, beside=ProjectExtras(Underlay(str(picture))))
        save_project(tmp_path / "one" / "a.hito", project)
        assert load_project(tmp_path / "one" / "a.hito").project.beside == project.beside
        (tmp_path / "two").mkdir(exist_ok=True)
        (tmp_path / "one" / "a.hito").replace(tmp_path / "two" / "a.hito")
        place = load_project(tmp_path / "two" / "a.hito").project.beside.underlay
        assert place is not None
        assert place.path == str(picture).replace("/one/", "/two/")


def test_a_full_disk_leaves_file_and_backup(tmp_path: Path) -> None:
    path = tmp_path / "a.hito"
    for name in ("one", "two"):
        save_project(path, named(name))
    before = {each.name: each.read_bytes() for each in tmp_path.iterdir()}
    handling, limits = signal.signal(signal.SIGXFSZ, signal.SIG_IGN), resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (500, limits[1]))
    try:
        with pytest.raises(InputError, match=r"Cannot write .*File too large"):
            save_project(path, named("three"))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
        signal.signal(signal.SIGXFSZ, handling)
    assert {each.name: each.read_bytes() for each in tmp_path.iterdir()} == before


@pytest.mark.parametrize(
    "name", ["a b.hito", "図面 穴.hito", "q'\"uote.hito", "x" * 250 + ".hito", "\udcff.hito", ".hito", "%s{}.hito"]
)
def test_any_name_will_do(tmp_path: Path, name: str) -> None:
    save_project(tmp_path / name, named("one"))
    assert load_project(tmp_path / name).project.state.job == named("one").state.job


def test_what_could_not_be_read_again_is_not_written(tmp_path: Path) -> None:
    state = HistoryState(Job(plate()), names={f"n{k}": Curves(tuple(range(1, 400_000, 2))) for k in range(8)})
    save_project(tmp_path / "a.hito", named("one"))
    with pytest.raises(InputError, match="beside its curves the project has"):
        save_project(tmp_path / "a.hito", Project(state))
    assert name_in(tmp_path / "a.hito") == "one"


def test_stamps(tmp_path: Path) -> None:
    assert stamp_of(tmp_path / "none") is None
    with pytest.raises(InputError, match="Cannot read"):
        load_project(tmp_path / "none.hito")


def test_the_drawing_it_was_read_from_is_told_from_its_folder_where_it_lies_in_that(tmp_path: Path) -> None:
    reading = ReadingOptions(Units.MM, (), DrawingOptions(overrule=True, to_zero=True))
    for drawing, told in (
        (tmp_path / "cad" / "a.dxf", 'path = "cad/a.dxf"'),
        (tmp_path.parent / "b.dxf", f'path = "{tmp_path.parent}'),
    ):
        project = Project(replace(named("one").state, source=DrawingSource(str(drawing), reading)))
        save_project(tmp_path / "p.hito", project)
        assert told in (tmp_path / "p.hito").read_text()
        assert load_project(tmp_path / "p.hito").project.state.source == DrawingSource(str(drawing), reading)
