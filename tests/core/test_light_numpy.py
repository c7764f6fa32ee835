"""Masked arrays are imported when somebody wants one, and are what they were."""

from __future__ import annotations

import subprocess
import sys

import pytest

from tests.conftest import ROOT

_ASK = """
import sys
import numpy as np
from app.core.jit.numba_loader import put_masked_arrays_off
put_masked_arrays_off()
assert np.unique([3, 1, 3]).tolist() == [1, 3] and "numpy.ma.core" not in sys.modules
{way}
values = ma.array([1, 2, 2], mask=[0, 0, 1])
assert np.ma.is_masked(values) and not np.ma.is_masked(np.ones(2)) and np.ma.MaskedArray is ma.MaskedArray
print(type(np.unique(values)).__name__, sys.modules["numpy.ma"].__file__ is not None)
"""


@pytest.mark.parametrize("way", ["import numpy.ma as ma", "from numpy import ma", "import numpy.ma.core as ma"])
def test_masked_arrays_are_there_when_somebody_asks(way: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", _ASK.format(way=way)], check=True, capture_output=True, text=True, cwd=ROOT
    )
    assert done.stdout.split() == ["MaskedArray", "True"]
