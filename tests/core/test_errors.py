"""Sentences for the user: nothing that a file says moves the cursor, clears the screen, or is longer than a line."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.cli.main import main
from app.core.errors import InputError, printable
from app.core.toml_tables import known_words
from app.gcode.interpreter.program import ProgramProblem
from app.model.finding import Finding, FindingKind


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("plain, 刃 and\xa0blanks\u3000stay", "plain, 刃 and\xa0blanks\u3000stay"),
        ("\x1b[2Jgone", "\\x1b[2Jgone"),
        ("a\nb\tc\r", "a b c "),
        ("\x00\x9b", "\\x00\\x9b"),
        ("txt.\u202efxd", "txt.\\u202efxd"),
        ("\udc80", "\\udc80"),
        ("a\u2028b", "a\\u2028b"),
    ],
)
def test_signs_that_a_terminal_obeys_are_spelled_out(text: str, shown: str) -> None:
    assert printable(text) == shown
    assert str(InputError(text)) == shown
    assert Finding(FindingKind.LEFT_OUT, text).text == shown
    assert ProgramProblem(3, 1, "", text).message("p.ngc") == f"p.ngc:3:1: {shown}"


def test_no_byte_of_a_program_reaches_the_terminal_as_a_command(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "a.ngc"
    path.write_bytes(b"G0 X1 \x1b[2J\n")
    assert main(["check", str(path)]) == 1
    said = capsys.readouterr()
    assert "\\x1b" in said.out and "\x1b" not in said.out + said.err


def test_a_name_that_is_no_text_is_told_and_not_passed_over(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A lone half of a sign cannot be printed in UTF-8: the whole sentence was lost, and the exit status alone told of
    a fault.
    """
    assert main(["check", str(tmp_path / "\udcff.ngc")]) == 2
    assert "\\udcff.ngc" in capsys.readouterr().err


def test_of_many_words_those_are_named_that_are_near() -> None:
    few = ["depth", "layers"]
    assert known_words("deep", few) == "depth, layers"
    many = [f"key_{k}_of_the_table" for k in range(30)]
    said = known_words("key_27_of_table", many)
    assert said.startswith("key_27_of_the_table, ") and said.endswith(" or one of 22 others") and len(said) < 200
