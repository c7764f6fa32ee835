"""Lint, layout and types are tests like the others, so that the last line of a run tells everything."""

import subprocess
import sys

import pytest

from tests.conftest import ROOT

JUDGES = [("mypy",), ("ruff", "check"), ("ruff", "format", "--check")]


@pytest.mark.parametrize("judge", JUDGES, ids=" ".join)
def test_the_whole_tree_passes(judge: tuple[str, ...]) -> None:
    done = subprocess.run([sys.executable, "-m", *judge], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 0, f"{' '.join(judge)}:\n{done.stdout}{done.stderr}"
