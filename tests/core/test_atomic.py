"""Several files that appear together or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from app.cli.main import main
from app.core.atomic import write_together
from app.core.errors import InputError
from app.formats.project.files import load_project


def content(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}


def test_all_appear(tmp_path: Path) -> None:
    (tmp_path / "a").write_bytes(b"old")
    write_together({tmp_path / "a": b"1", tmp_path / "b": b"2"})
    assert content(tmp_path) == {"a": b"1", "b": b"2"}


@pytest.mark.parametrize("order", [(0, 1, 2), (2, 1, 0), (1, 2, 0)])
def test_where_one_cannot_be_written_none_is(tmp_path: Path, order: tuple[int, ...]) -> None:
    (tmp_path / "a").write_bytes(b"old")
    (tmp_path / "c").mkdir()
    files = [(tmp_path / "a", b"1"), (tmp_path / "b", b"2"), (tmp_path / "c", b"3")]
    with pytest.raises(InputError, match=r"Cannot write .*/c: it is a folder"):
        write_together(dict(files[k] for k in order))
    assert content(tmp_path) == {"a": b"old"}


def test_where_a_later_file_cannot_take_its_place_the_earlier_ones_are_put_back(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in "ab":
        (tmp_path / name).write_bytes(b"old")
    right = os.replace

    def full(old: str, new: Path) -> None:
        if Path(new).name == "c":
            raise OSError(28, "No space left on device")
        right(old, new)

    monkeypatch.setattr(os, "replace", full)
    with pytest.raises(InputError, match="No space left on device"):
        write_together({tmp_path / name: b"new" for name in "anbc"})
    assert content(tmp_path) == {"a": b"old", "b": b"old"}


@pytest.mark.parametrize("name", ["part.dxf", "part.svg", "part.draw", "part.hito", "part.png"])
def test_a_pipe_or_a_device_is_refused_at_once(tmp_path: Path, capsys: pytest.CaptureFixture[str], name: str) -> None:
    os.mkfifo(tmp_path / name)
    assert main(["make", str(tmp_path / name), "-o", str(tmp_path / "out.ngc")]) == 2
    assert "pipe or a device" in capsys.readouterr().err
    (tmp_path / f"zero-{name}").symlink_to("/dev/zero")
    assert main(["make", str(tmp_path / f"zero-{name}"), "-o", str(tmp_path / "out.ngc")]) == 2
    with pytest.raises(InputError, match="pipe or a device"):
        load_project(tmp_path / name)
