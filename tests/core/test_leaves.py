"""The leaves of the house: settings, files that appear whole, threads, compiled kernels, and the window library's
health.
"""

import json
import os
import stat
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from app.core.atomic import write_atomically
from app.core.errors import Cancelled, InputError
from app.core.jit.warm import kernel_modules, warm
from app.core.pool import pool
from app.core.progress import Progress
from app.core.resources import resource
from app.core.settings import RECENT_FILES, Settings, ThemeChoice, config_folder, load_settings, save_settings
from tests.conftest import ROOT


def test_settings_come_back() -> None:
    settings = Settings(ThemeChoice.DARK, ("/a/刃.dxf", "/a/\udcff.dxf"), "AdnQ", "/a")
    save_settings(settings)
    assert load_settings() == settings


def test_first_start_has_defaults() -> None:
    assert load_settings() == Settings()


@pytest.mark.parametrize(
    "text", ["", "{", "[1]", '{"theme": "pink", "recent_files": 7, "window_geometry": null, "unknown": 1}', "\x00\xff"]
)
def test_damaged_settings_become_defaults(text: str) -> None:
    config_folder().joinpath("settings.json").write_text(text, "utf-8")
    assert load_settings() == Settings()


def test_what_is_right_in_damaged_settings_stays() -> None:
    config_folder().joinpath("settings.json").write_text(
        json.dumps({"theme": "dark", "recent_files": ["/a", 3], "last_folder": 1})
    )
    assert load_settings() == Settings(ThemeChoice.DARK, ("/a",))


def test_recent_files_are_few_and_each_once(tmp_path: Path) -> None:
    settings = Settings()
    for k in [*range(15), 12]:
        settings = settings.with_recent_file(tmp_path / f"{k}.dxf")
    assert len(settings.recent_files) == RECENT_FILES
    assert [Path(name).stem for name in settings.recent_files[:3]] == ["12", "14", "13"]
    assert settings.last_folder == str(tmp_path)


def test_settings_that_cannot_be_kept_say_so(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("HITOFUDE_CONFIG", str(tmp_path / "file" / "config"))
    with pytest.raises(InputError, match="settings folder"):
        save_settings(Settings())


def test_a_file_is_replaced_whole_and_keeps_its_permissions(tmp_path: Path) -> None:
    path = tmp_path / "out.ngc"
    write_atomically(path, b"old")
    path.chmod(0o640)
    write_atomically(path, b"new")
    assert path.read_bytes() == b"new"
    assert stat.S_IMODE(path.stat().st_mode) == 0o640
    assert os.listdir(tmp_path) == ["out.ngc"]


def test_a_new_file_has_the_usual_permissions(tmp_path: Path) -> None:
    usual, path = tmp_path / "usual", tmp_path / "out.ngc"
    usual.touch()
    write_atomically(path, b"")
    assert path.stat().st_mode == usual.stat().st_mode


def test_a_link_is_followed(tmp_path: Path) -> None:
    target, link = tmp_path / "target", tmp_path / "link"
    target.touch()
    link.symlink_to(target)
    write_atomically(link, b"new")
    assert link.is_symlink()
    assert target.read_bytes() == b"new"


def test_a_failure_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "out.ngc"
    path.write_bytes(b"old")
    with pytest.raises(TypeError):
        write_atomically(path, "text is no bytes")  # type: ignore[arg-type]
    assert path.read_bytes() == b"old"
    assert os.listdir(tmp_path) == ["out.ngc"]


@pytest.mark.parametrize("name", ["missing/out.ngc", ".", "file/out.ngc"])
def test_a_place_that_cannot_be_written_is_named(tmp_path: Path, name: str) -> None:
    (tmp_path / "file").touch()
    with pytest.raises(InputError, match="Cannot write") as error:
        write_atomically(tmp_path / name, b"new")
    assert str(tmp_path / name) in str(error.value)


def test_a_device_is_written_to_and_stays_a_device() -> None:
    write_atomically(Path(os.devnull), b"new")
    assert stat.S_ISCHR(os.stat(os.devnull).st_mode)


def test_there_is_one_pool_and_its_threads_work_together() -> None:
    both = threading.Barrier(2, timeout=20)
    assert {future.result() for future in [pool().submit(both.wait) for _ in range(2)]} == {0, 1}
    assert pool() is pool()


def test_every_kernel_file_is_warmed() -> None:
    using = {path for path in (ROOT / "app").rglob("*.py") if "import kernel\n" in path.read_text("utf-8")}
    assert using
    assert {".".join(path.relative_to(ROOT).with_suffix("").parts) for path in using} <= set(kernel_modules())


def test_warming_reports_and_stops_when_asked() -> None:
    seen: list[tuple[float, str]] = []
    assert warm(Progress(lambda fraction, text: seen.append((fraction, text)))) == ()
    assert seen[-1][0] == 1.0
    stop = threading.Event()
    stop.set()
    with pytest.raises(Cancelled):
        warm(Progress(cancelled=stop))


def test_resources_are_found_and_missing_ones_named() -> None:
    assert resource("samples", "fig2.dxf").is_file()
    with pytest.raises(FileNotFoundError, match=r"samples/none\.dxf"):
        resource("samples", "none.dxf")


def test_the_window_library_keeps_its_references_to_none() -> None:
    code = (
        "import sys; from PySide6.QtGui import QPainterPath; path = QPainterPath(); before = sys.getrefcount(None)\n"
        "for _ in range(1000): path.moveTo(1, 1)\n"
        "sys.exit(before - sys.getrefcount(None) > 500)"
    )
    assert subprocess.run([sys.executable, "-c", code], timeout=60).returncode == 0
