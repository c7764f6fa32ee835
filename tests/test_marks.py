"""Every test has one mark: it runs each time, or with `--all`; and no room of the house goes without tests that run
each time.
"""

from collections import Counter
from pathlib import PurePosixPath

import pytest

from tests.conftest import ROOT
from tests.exhaustive import COLLECTED, FAMILIES, parameters_of
from tests.parallel import DEFAULT_S, OF_SENTENCES, ON_A_SCREEN, SECONDS, DearestFirst, group_of, seconds_of

FEWEST = 5


@pytest.fixture
def collected(pytestconfig: pytest.Config) -> dict[str, bool]:
    """Every test of this run before any was left out, and whether it is exhaustive; of all tests where all are asked
    for.
    """
    return pytestconfig.stash[COLLECTED]


def room_of(nodeid: str) -> str:
    return PurePosixPath(nodeid.split("::")[0]).parts[1]


def test_default_and_exhaustive_tests_together_are_all(
    request: pytest.FixtureRequest, collected: dict[str, bool]
) -> None:
    chosen = {item.nodeid for item in request.session.items if item.get_closest_marker("benchmark") is None}
    if request.config.option.markexpr == "not exhaustive and not benchmark":
        assert chosen == {nodeid for nodeid, exhaustive in collected.items() if not exhaustive}
    else:
        assert chosen <= set(collected)
    assert request.node.nodeid in collected


def test_every_room_has_tests_that_run_each_time(collected: dict[str, bool]) -> None:
    every, quick = (
        Counter(map(room_of, collected)),
        Counter(room_of(nodeid) for nodeid, exhaustive in collected.items() if not exhaustive),
    )
    slow = [room for room, count in every.items() if quick[room] < min(count, 1 if room.endswith(".py") else FEWEST)]
    assert set(slow) <= {"test_bundle.py", "test_wheel.py"}, (
        "to install or to pack takes a minute; all others are quick"
    )


@pytest.mark.parametrize("table", ["run_each_time", "exhaustive"])
def test_every_family_that_is_named_is_there_and_keeps_members(collected: dict[str, bool], table: str) -> None:
    files = {nodeid.split("::")[0] for nodeid in collected}
    members: dict[str, set[str]] = {}
    for nodeid in collected:
        members.setdefault(nodeid.split("[")[0], set()).add(parameters_of(nodeid))
    named = {family: set(some) for family, some in FAMILIES[table].items() if family.split("::")[0] in files}
    assert {family: some - members.get(family, set()) for family, some in named.items()} == {
        family: set() for family in named
    }
    assert all(0 < len(some) < len(members[family]) for family, some in named.items())


def test_files_and_screens_stay_together() -> None:
    assert group_of("tests/a/test_b.py::test_c[x/y]") == "tests/a/test_b.py"
    assert {group_of(f"{place}::test") for place in ON_A_SCREEN} == {"screen"}
    assert {group_of(f"{file}::test") for file in OF_SENTENCES} == {"sentences"}
    assert all((ROOT / place).exists() for place in (*ON_A_SCREEN, *OF_SENTENCES))


def test_what_is_said_to_be_dear_is_there(collected: dict[str, bool]) -> None:
    """Rooms and tests are renamed; what nobody finds any more would begin last."""
    files = {nodeid.split("::")[0] for nodeid in collected}
    asked = [begin for begin in SECONDS if any(begin.startswith(file) for file in files) or _is_whole(begin, files)]
    assert [begin for begin in asked if not any(nodeid.startswith(begin) for nodeid in collected)] == []


def _is_whole(begin: str, files: set[str]) -> bool:
    """Tell whether all files whose names begin so are among those collected."""
    there = {str(path.relative_to(ROOT)) for path in (ROOT / "tests").rglob("test_*.py")}
    mine = {file for file in there if file.startswith(begin)}
    return "::" not in begin and mine <= files


def test_the_dearest_group_is_taken_first() -> None:
    queue = DearestFirst()
    for file, count in (("tests/a/test_b.py", 100), ("tests/test_wheel.py", 3), ("tests/c/test_d.py", 1)):
        queue[file] = {f"{file}::test_{k}": False for k in range(count)}
    assert [queue.popitem()[0] for _ in range(3)] == ["tests/test_wheel.py", "tests/a/test_b.py", "tests/c/test_d.py"]
    assert seconds_of("tests/a/test_b.py::test_c") == DEFAULT_S
