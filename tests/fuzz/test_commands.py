"""Whole commands on spoilt inputs and absurd options: an end, a clear sentence, no partial file.

`HITOFUDE_FUZZ=1000 pytest tests/fuzz/test_commands.py` tries that many inputs of each command, from
`HITOFUDE_FUZZ_FROM` on.
"""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path

import pytest

from tests.fuzz.commands import VALUES, Command, commands, fault, numeric_options, spoilt

FEW, MANY = int(os.environ.get("HITOFUDE_FUZZ", "8")), 300
FIRST = int(os.environ.get("HITOFUDE_FUZZ_FROM", "0"))
SPOILT = ("cut", "smooth", "surface", "tools", "stages")


def faults(command: Command, folder: Path, numbers: range) -> list[str]:
    """Return what goes wrong, and for which input."""
    found = []
    for number in numbers:
        data = spoilt(command, number)
        if wrong := fault(command, folder, data):
            found.append(f"{number}: {wrong} for {data[:400]!r}")
    return found


@pytest.mark.parametrize("name", commands())
def test_the_command_works_as_it_is(name: str, tmp_path: Path) -> None:
    command = commands()[name]
    assert fault(command, tmp_path, command.data) == ""
    assert list((tmp_path / "out").rglob("*"))


@pytest.mark.parametrize("name", SPOILT)
def test_spoilt_inputs_end_well(name: str, tmp_path: Path) -> None:
    assert faults(commands()[name], tmp_path, range(FIRST, FIRST + FEW)) == []


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", SPOILT)
def test_hundreds_of_spoilt_inputs_end_well(name: str, tmp_path: Path) -> None:
    assert faults(commands()[name], tmp_path, range(FIRST + FEW, FIRST + FEW + MANY)) == []


def absurd(command: Command, folder: Path, values: tuple[str, ...]) -> list[str]:
    """Return what goes wrong with values of its numeric options."""
    found = []
    for option in numeric_options(command):
        for value in values:
            if wrong := fault(command, folder, command.data, (f"{option}={value}",)):
                found.append(f"{option}={value[:20]}: {wrong}")
    return found


@pytest.mark.parametrize("name", commands())
def test_options_that_are_no_numbers_are_refused_in_a_sentence(name: str, tmp_path: Path) -> None:
    assert absurd(commands()[name], tmp_path, ("nan", "", "9" * 5000)) == []


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", commands())
def test_absurd_values_of_every_option_end_well(name: str, tmp_path: Path) -> None:
    assert absurd(commands()[name], tmp_path, VALUES) == []


def test_the_judge_of_commands_sees(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from app.cli.commands import check as cli_check

    check = commands()["check"]

    def crash(*given: object) -> int:
        raise KeyError("k")

    monkeypatch.setattr(cli_check, "COMMAND", replace(cli_check.COMMAND, run=crash))
    assert "should not have happened (KeyError" in fault(check, tmp_path, check.data)
    monkeypatch.setattr(cli_check, "COMMAND", replace(cli_check.COMMAND, run=lambda *given: 7))
    assert fault(check, tmp_path, check.data) == "status 7"
