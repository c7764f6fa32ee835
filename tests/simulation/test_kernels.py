"""The innermost loops are vector code: one that is not would be right, and ten times as slow."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.conftest import ROOT

LOOK = """
import re, sys
import numba
from app.simulation.sweeps import run_kernels, trace_kernels
if not {"avx2", "+avx2"} & set(re.split(r"[, ]", numba.core.codegen.get_host_cpu_features())):
    print("no vectors here")
runs = [getattr(run_kernels, name) for name in dir(run_kernels) if name.endswith("_run")]
for run in (*runs, trace_kernels.ball_trace):
    name, code = run.__name__, next(iter(run.for_callers().inspect_asm().values()))
    own = code.split("cpython")[0]
    packed = len(re.findall(r"v?sqrtps", own)) + len(re.findall(r"vrsqrt14ps", own))
    print(name, packed, len(re.findall(r"v?sqrtss", own)))
"""


@pytest.mark.exhaustive
def test_runs_take_roots_of_vectors(tmp_path: Path) -> None:
    environment = os.environ | {"XDG_CACHE_HOME": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", LOOK], cwd=ROOT, env=environment, capture_output=True, text=True, check=True, timeout=200
    )
    assert "no vectors" not in done.stdout
    for line in done.stdout.splitlines():
        name, of_vectors, of_numbers = line.split()
        assert int(of_vectors) >= 1, name
        assert int(of_numbers) == (name == "ball_trace"), name  # its arrays might overlap: then it goes cell by cell
