"""Programs that are samples say in their head what is to be learned from them; each such command does it as typed."""

from __future__ import annotations

import re
import shlex
import shutil

import pytest

from app.cli.main import main
from app.core.resources import resource


def lesson(name: str) -> list[list[str]]:
    """The words of the commands that a sample's head names."""
    text = resource("samples", f"{name}.ngc").read_text()
    [said] = re.findall(r"^\(The lesson: hitofude (.*)\)$", text, re.MULTILINE)
    return [shlex.split(line) for line in said.partition("; the passes")[0].split("; then ")]


@pytest.mark.exhaustive
@pytest.mark.parametrize(
    ("name", "taught"),
    [
        ("facets", r"31 arcs, 120 blocks before.*effective points: 25 of 121"),
        ("points", r"1 spline, 65 blocks before, 4\d after\n.*bend 7.506 deg before, 0.000 after"),
        ("valley", r"16 boundary points.*chords: .* proven.*blocks 1612 -> [67]\d,"),
    ],
)
def test_the_head_of_a_sample_is_a_lesson_that_can_be_typed(tmp_path, monkeypatch, capsys, name, taught) -> None:
    shutil.copy(resource("samples", f"{name}.ngc"), tmp_path)
    monkeypatch.chdir(tmp_path)
    for words in lesson(name):
        assert main(words) == 0, words
    assert re.search(taught, capsys.readouterr().out, re.DOTALL)
