"""Machine profiles: those that ship, the user's own, and what is wrong with a file."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from app.core.errors import InputError
from app.core.settings import config_folder
from app.core.toml_tables import write_tables
from app.formats.machine_toml import DEFAULT_MACHINE, load_machine, machine_files, read_machine

ROUTER = load_machine(DEFAULT_MACHINE)


@pytest.mark.parametrize("name", ["router", "bench_mill", "vmc"])
def test_what_ships_is_sane_and_comes_back(name: str) -> None:
    machine = load_machine(name)
    for moved in (machine, replace(machine, work_origin=(1.5, -2.0, 0.25), title='A "b"\\ 刃\n')):
        assert read_machine("m.toml", write_tables(moved).encode()) == moved
    assert all(100 <= axis.travel <= 2000 and axis.rapid >= machine.largest_feed / 2 for axis in machine.axes)


def test_a_users_machine_is_found_by_name_and_by_path(tmp_path: Path) -> None:
    folder = config_folder() / "machines"
    folder.mkdir(parents=True)
    mine = replace(ROUTER, title="Mine", largest_feed=1234.0)
    (folder / "mine.toml").write_bytes(write_tables(mine).encode())
    (folder / "vmc.toml").write_bytes(write_tables(mine).encode())
    (tmp_path / "other.toml").write_bytes(write_tables(mine).encode())
    assert list(machine_files()) == ["bench_mill", "mine", "router", "vmc"]
    assert load_machine("mine") == load_machine("vmc") == load_machine(str(tmp_path / "other.toml")) == mine


def test_a_machine_that_is_not_there_names_those_that_are() -> None:
    with pytest.raises(InputError, match="There is no machine 'lathe'; choose one of bench_mill, router, vmc"):
        load_machine("lathe")


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("largest_feed = 4000.0", "largest_feed = 0", r"m\.toml:2: largest_feed is 0; expected is a number from 1 to"),
        ("largest_feed = 4000.0", "largest_feed = true", r"m\.toml:2: largest_feed is True; expected is a number\."),
        ("largest_feed = 4000.0", "", r"m\.toml:1: largest_feed is missing; add a number\."),
        ("largest_feed", "fastest_feed", r"m\.toml:2: fastest_feed is not known; expected are title, x, y, z"),
        (
            "corner = 0.01",
            "work_origin = [1, 2]",
            r"m\.toml:4: work_origin is \[1, 2\]; expected is a list of 3 numbers",
        ),
        ("corner = 0.01", "corner = nan", r"m\.toml:4: corner is nan; expected is a number from 0 to 10"),
        ("low = -100.0", "low = 100.0", r"m\.toml:\d+: Travel goes from 100 to 0 mm; the low end must be less"),
        (
            "acceleration = 150.0",
            "acceleration = 0.5",
            r"m\.toml:\d+: z\.acceleration is 0\.5; expected is a number from 1",
        ),
        ("low = 6000.0", "low = 60000.0", r"m\.toml:\d+: Spindle range is 60000 to 24000 rpm"),
        ("[z]", "[w]", r"w is not known"),
        ("[z]", "[z", r"m\.toml: this is no TOML file"),
    ],
)
def test_what_is_wrong_is_named_with_its_line(old: str, new: str, words: str) -> None:
    text = write_tables(ROUTER).encode().decode()
    assert old in text
    with pytest.raises(InputError, match=words):
        read_machine("m.toml", text.replace(old, new).encode())


def test_what_may_be_left_out_has_its_default() -> None:
    text = "\n".join(
        line
        for line in write_tables(ROUTER).encode().decode().splitlines()
        if not line.startswith(("tool_change", "corner"))
    )
    machine = read_machine("m.toml", text.encode())
    assert (machine.tool_change, machine.corner, machine.work_origin) == (0.0, 0.01, None)
