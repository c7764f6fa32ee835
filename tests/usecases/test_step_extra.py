"""Fetching what reads STEP files: told as it goes, left when that is asked, refused in words; real child processes."""

from __future__ import annotations

import sys
import time

import pytest

from app.core.errors import InputError
from app.core.progress import Cancelled
from app.usecases.step_extra import PACKAGE, fetch_step_reader


class Told:
    """A progress that keeps what it is told, and stops at a word."""

    def __init__(self, stop: str = "") -> None:
        self.lines: list[str] = []
        self._stop = stop

    def step(self, fraction: float, text: str) -> None:
        self.lines.append(text)
        if self._stop and self._stop in text:
            raise Cancelled


def python(text: str) -> tuple[str, ...]:
    return sys.executable, "-u", "-c", text


def test_what_is_done_is_told_line_by_line():
    told = Told()
    fetch_step_reader(python("print('Collecting a'); print('Downloading b')"), told)
    assert told.lines == ["Fetching Open CASCADE", "Collecting a", "Downloading b"]


def test_why_it_failed_is_said():
    with pytest.raises(InputError, match=r"could not be fetched: no network\. Look whether"):
        fetch_step_reader(python("print('no network'); raise SystemExit(1)"), Told())


def test_it_is_left_at_once():
    begun = time.monotonic()
    with pytest.raises(Cancelled):
        fetch_step_reader(python("import time; print('Collecting a'); time.sleep(60)"), Told("Collecting"))
    assert time.monotonic() - begun < 20


def test_it_fetches_what_the_extra_of_the_program_names():
    import tomllib
    from pathlib import Path

    project = tomllib.loads((Path(__file__).parents[2] / "pyproject.toml").read_text())
    assert project["project"]["optional-dependencies"]["step"] == [PACKAGE]
