"""What is kept of compiled kernels heals itself, is this user's alone, and goes when nobody wants it any more."""

from __future__ import annotations

import os
import platform
import subprocess
import sys
import time
from pathlib import Path

import llvmlite.binding as llvm
import pytest

from app.core.jit.numba_loader import LEVELS, plainer_processors
from app.core.jit.store import UNUSED_DAYS, Store, open_store
from tests.core.test_compiling import SHORT, entries, program, run

__all__ = ["program"]  # the fixture

NAME, CONTENT = "room.kernel-0123", b"machine code"
DAMAGES = {
    "empty": lambda data: b"",
    "cut in its head": lambda data: data[:20],
    "cut in its content": lambda data: data[: len(data) // 2],
    "a bit of the head flipped": lambda data: data[:25] + bytes([data[25] ^ 1]) + data[26:],
    "a bit of the content flipped": lambda data: data[:-100] + bytes([data[-100] ^ 4]) + data[-99:],
    "something else": lambda data: b"\x80\x04K\x2a.",
}


def store_at(folder: Path) -> Store:
    folder.mkdir(parents=True, exist_ok=True)
    return Store(folder)


@pytest.mark.exhaustive
@pytest.mark.parametrize("damage", DAMAGES)
def test_a_damaged_entry_is_removed_and_compiled_anew(program: Path, damage: str) -> None:
    run(program, SHORT)
    path = entries(program)["outer"]
    whole = path.read_bytes()
    path.write_bytes(DAMAGES[damage](whole))
    done = run(program, SHORT)
    assert (done.stdout.split(), done.stderr) == (["4.0"], "")
    assert len(entries(program)["outer"].read_bytes()) == pytest.approx(len(whole), rel=0.05)


def test_an_entry_under_another_name_is_none(tmp_path: Path) -> None:
    store = store_at(tmp_path)
    assert store.write(NAME, CONTENT)
    (tmp_path / NAME).rename(tmp_path / "other")
    assert store.read("other") is None
    assert not (tmp_path / "other").exists()


def test_what_came_with_the_program_is_read_where_it_is_and_left_as_it_is(tmp_path: Path) -> None:
    shipped = store_at(tmp_path / "shipped")
    assert shipped.write(NAME, CONTENT) and shipped.folder is not None
    store = Store(tmp_path / "own", shipped=(shipped.folder,))
    assert store.has(NAME) and store.read(NAME) == CONTENT
    store.drop(NAME)  # of no use to this machine
    assert not store.has(NAME) and store.read(NAME) is None
    assert shipped.read(NAME) == CONTENT
    (tmp_path / "own").mkdir()
    store = Store(tmp_path / "own", shipped=(shipped.folder,))
    damaged = (shipped.folder / NAME).read_bytes()[:-1]
    (shipped.folder / NAME).write_bytes(damaged)
    assert store.read(NAME) is None
    assert store.write(NAME, CONTENT) and store.read(NAME) == CONTENT
    assert (shipped.folder / NAME).read_bytes() == damaged


def test_what_others_may_write_beside_the_program_is_not_read(tmp_path: Path) -> None:
    shipped = store_at(tmp_path / "shipped")
    assert shipped.write(NAME, CONTENT) and shipped.folder is not None
    (shipped.folder / NAME).chmod(0o646)
    assert Store(tmp_path / "own", shipped=(shipped.folder,)).read(NAME) is None
    (shipped.folder / NAME).chmod(0o644)
    assert Store(tmp_path / "own", shipped=(shipped.folder,)).read(NAME) == CONTENT


def test_what_is_whole_but_of_no_use_is_compiled_anew(program: Path) -> None:
    """A pickle that another version of a library has written, say."""
    run(program, SHORT)
    path = entries(program)["outer"]
    Store(path.parent).write(path.name, b"\x80\x04K\x2a.")
    assert run(program, SHORT).stdout.split() == ["4.0"]
    assert path.stat().st_size > 1000


@pytest.mark.skipif(not hasattr(os, "fork"), reason="limits of a process are Unix's")
def test_a_full_disk_is_said_once_and_stops_nothing(program: Path) -> None:
    code = "import resource; resource.setrlimit(resource.RLIMIT_FSIZE, (100, 100))\n"
    done = run(program, f"{code}from app.room.outer_kernels import outer; print(outer(1.0)); print(outer(2.0))")
    assert done.stdout.split() == ["4.0", "6.0"]
    (told,) = done.stderr.splitlines()
    assert "cannot be kept" in told
    assert not list((program / "cache").rglob("*.part"))


@pytest.mark.exhaustive
def test_without_a_cache_folder_it_is_a_folder_of_this_users_own(program: Path) -> None:
    done = run(program, SHORT, XDG_CACHE_HOME="/dev/null/cache")
    assert (done.stdout.split(), done.stderr) == (["4.0"], "")
    (folder,) = (program / "tmp").iterdir()
    assert folder.stat().st_mode & 0o777 == 0o700
    assert list(folder.rglob("*outer*"))


def planted_link(place: Path) -> None:
    (place.parent / "elsewhere").mkdir()
    place.symlink_to(place.parent / "elsewhere")


def planted_folder(place: Path) -> None:
    if os.geteuid() != 0:
        pytest.skip("only root can make a folder that belongs to somebody else")
    place.mkdir(mode=0o777)
    os.chown(place, 12345, 12345)


def planted_file(place: Path) -> None:
    place.touch()


@pytest.mark.skipif(not hasattr(os, "geteuid"), reason="owners are Unix's")
@pytest.mark.parametrize("plant", [planted_link, planted_folder, planted_file])
def test_a_foreign_folder_is_not_trusted_and_a_fresh_one_is_removed_at_the_end(program: Path, plant) -> None:
    (program / "tmp").mkdir()
    plant(program / "tmp" / f"hitofude-{os.geteuid()}")
    before = sorted((program / "tmp").rglob("*"))
    done = run(program, SHORT, XDG_CACHE_HOME="/dev/null/cache")
    assert done.stdout.split() == ["4.0"]
    (told,) = done.stderr.splitlines()
    assert "cannot be kept" in told
    assert sorted((program / "tmp").rglob("*")) == before


def test_a_foreign_entry_is_not_read(tmp_path: Path) -> None:
    if not hasattr(os, "geteuid") or os.geteuid() != 0:
        pytest.skip("only root can make a file that belongs to somebody else")
    store = store_at(tmp_path)
    store.write(NAME, CONTENT)
    assert store.read(NAME) == CONTENT
    os.chown(tmp_path / NAME, 12345, 12345)
    assert store.read(NAME) is None


def test_an_entry_that_others_may_write_is_not_read(tmp_path: Path) -> None:
    store = store_at(tmp_path)
    store.write(NAME, CONTENT)
    assert (tmp_path / NAME).stat().st_mode & 0o777 == 0o600
    (tmp_path / NAME).chmod(0o666)
    assert store.read(NAME) is None


def test_a_link_to_an_entry_is_not_followed(tmp_path: Path) -> None:
    store = store_at(tmp_path / "a")
    store.write(NAME, CONTENT)
    other = store_at(tmp_path / "b")
    (tmp_path / "b" / NAME).symlink_to(tmp_path / "a" / NAME)
    assert other.read(NAME) is None


def test_the_own_cache_folder_is_closed_to_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    (tmp_path / "hitofude").mkdir(mode=0o775)
    (tmp_path / "hitofude").chmod(0o777)
    assert open_store(("version",)).folder == tmp_path / "hitofude" / "kernels" / "version"
    assert not (tmp_path / "hitofude").stat().st_mode & 0o022


def test_what_nobody_has_used_for_long_goes_with_the_folders_of_older_versions(tmp_path: Path) -> None:
    now, long_ago = time.time(), time.time() - (UNUSED_DAYS + 1) * 86400
    store = store_at(tmp_path / "kernels" / "new")
    older, in_use = tmp_path / "kernels" / "0f3a9c", tmp_path / "kernels" / "other"
    for folder in (older, in_use):
        folder.mkdir()
        (folder / "module.f-1.py311.nbi").write_bytes(b"index")
    for name in ("used", "unused", "killed.part"):
        (tmp_path / "kernels" / "new" / name).touch()
    for path in (older / "module.f-1.py311.nbi", store.folder / "unused", store.folder / "killed.part"):
        os.utime(path, (long_ago, long_ago))
    os.utime(in_use / "module.f-1.py311.nbi", (now, long_ago))
    store.sweep()
    assert sorted(path.name for path in (tmp_path / "kernels").iterdir()) == ["new", "other"]
    assert [path.name for path in store.folder.iterdir()] == ["used"]


def test_reading_notes_the_use(tmp_path: Path) -> None:
    store = store_at(tmp_path / "kernels" / "v")
    store.write(NAME, CONTENT)
    long_ago = time.time() - 40 * 86400
    os.utime(store.folder / NAME, (long_ago, long_ago))
    assert store.read(NAME) == CONTENT
    store.sweep()
    assert store.has(NAME)


def test_a_closed_stderr_is_no_reason_to_fail(program: Path) -> None:
    code = "import sys; sys.stderr = None\n" + SHORT
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=program,
        capture_output=True,
        text=True,
        timeout=300,
        env=os.environ | {"PYTHONPATH": str(program), "XDG_CACHE_HOME": "/dev/null/a", "TMPDIR": "/dev/null/b"},
    )
    assert done.stdout.split() == ["4.0"]


@pytest.mark.exhaustive
def test_machine_code_for_plainer_processors_is_read_on_any_that_runs_it(program: Path) -> None:
    """A program that was packed elsewhere brings what every processor of a level runs: nothing is compiled here."""
    levels = plainer_processors("x86_64-unknown-linux-gnu", llvm.get_host_cpu_features())
    if not levels or platform.machine() not in ("x86_64", "AMD64"):
        pytest.skip("this processor is of no level of x86-64 that machine code is shipped for")
    run(program, SHORT, NUMBA_CPU_NAME=levels[0], NUMBA_CPU_FEATURES="")
    made = entries(program)
    assert set(made) == {"outer", "inner", "_twice"}
    shipped = program / "app" / "kernels" / made["outer"].parent.name
    shipped.parent.mkdir()
    made["outer"].parent.rename(shipped)
    assert run(program, SHORT).stdout.split() == ["4.0"]
    assert entries(program) == {}


def test_a_processor_runs_the_code_of_its_level_and_of_all_below() -> None:
    linux, all_of = "x86_64-unknown-linux-gnu", {name: dict.fromkeys(needed, True) for name, needed in LEVELS.items()}
    assert plainer_processors(linux, all_of["x86-64-v3"]) == ("x86-64-v3", "x86-64-v2")
    assert plainer_processors(linux, all_of["x86-64-v3"] | {"avx2": False}) == ("x86-64-v2",)
    assert plainer_processors(linux, all_of["x86-64-v2"] | {"avx2": True}) == ("x86-64-v2",)
    assert plainer_processors(linux, {}) == plainer_processors("aarch64-unknown-linux-gnu", all_of["x86-64-v3"]) == ()
