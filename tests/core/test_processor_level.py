"""A processor without what the libraries need is told so before they are loaded."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from app.core.processor_level import NEEDED, lacking, lacking_here

CORE_2, NEHALEM = 0x0000E3FD, 0x0098E3FD
"""ECX of CPUID's leaf 1, as these processors have it."""


def test_what_a_processor_lacks_is_named() -> None:
    assert lacking(NEHALEM) == ()
    assert lacking(CORE_2) == ("SSE4.1", "SSE4.2", "POPCNT")
    assert lacking(0) == tuple(NEEDED)


def test_this_processor_runs_the_libraries_and_an_unknown_one_is_given_a_try() -> None:
    assert lacking_here() == () == lacking_here(lambda: None)
    assert lacking_here(lambda: CORE_2) != ()


@pytest.mark.exhaustive
def test_a_processor_that_is_too_old_is_told_in_one_line() -> None:
    """Emulated, from the tree: an interpreter starts there, and NumPy would end it without a word."""
    emulator = shutil.which("qemu-x86_64")
    if emulator is None:
        pytest.skip("the emulator qemu-x86_64 is not installed here")
    root = Path(__file__).resolve().parents[2]
    program = f"import sys; sys.path.insert(0, {str(root)!r}); from app.__main__ import main; sys.exit(main())"
    command = [emulator, "-cpu", "core2duo", sys.executable, "-I", "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    told = [line for line in done.stderr.splitlines() if "warning: TCG" not in line]
    assert done.returncode == 2 and len(told) == 1
    assert "this processor lacks SSE4" in told[0] and "x86-64-v2" in told[0]
