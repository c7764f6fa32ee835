"""The list of what is compiled ahead is up to date."""

from __future__ import annotations

from pathlib import Path

from tests.core.usual_kernels import LIST, taken


def test_the_kernels_that_the_sample_part_takes_are_listed_and_no_others(tmp_path: Path) -> None:
    listed = LIST.read_text(encoding="utf-8").split()
    assert listed == taken(tmp_path / "fig2.ngc"), "write it anew: python -m tests.core.usual_kernels"
