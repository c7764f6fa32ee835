"""The table of a batch for spreadsheets: what stands in a cell can be read again."""

from __future__ import annotations

import csv
import io
import shlex

import pytest

from app.usecases.batch.table import results_csv
from app.usecases.batch.task import BatchRow, BatchVerdict


def outputs_cell(*files: str) -> str:
    table = results_csv([BatchRow("a.dxf", BatchVerdict.CLEAN)], [files]).decode()
    return next(csv.DictReader(io.StringIO(table)))["outputs"]


@pytest.mark.parametrize(
    "files",
    [
        ("a b.ngc", "a b.pdf"),
        ("left & right/it's.ngc", "左 右.ngc", "two\nlines.ngc"),
        ("=1+1.ngc", "b.ngc"),
        ("=it's.ngc",),
        ("@ a.ngc", "-o.ngc"),
        (),
    ],
)
def test_names_of_files_are_told_apart(files: tuple[str, ...]) -> None:
    assert shlex.split(outputs_cell(*files)) == list(files)
    assert not outputs_cell(*files).startswith(("=", "@", "+"))


def test_plain_names_stand_as_they_always_did() -> None:
    assert outputs_cell("sub/a.ngc", "sub/a.pdf") == "sub/a.ngc sub/a.pdf"
