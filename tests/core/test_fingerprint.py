"""A digest tells apart whatever makes other machine code, and nothing else."""

from __future__ import annotations

import re
from collections.abc import Callable
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from app.core.jit.compiled import REGISTERED, Kernel, digest
from app.core.jit.warm import kernel_modules
from tests.conftest import ROOT

SOURCE = """
from math import sqrt
FACTOR = 2.0
TABLE = np.array([1.0, 2.0])
SIZES = (1, 2)
def called(x):
    return x + 1
def f(x):
    return FACTOR * x + TABLE[0] + SIZES[1] + sqrt(x) + called(x)
"""


def digest_of(source: str, text: str = "") -> str:
    names: dict[str, Callable[..., float]] = {"np": np}
    exec(source, names)
    return digest(text, names["f"])


@pytest.mark.parametrize(
    ("before", "after"),
    [
        ("FACTOR = 2.0", "FACTOR = 2.5"),
        ("FACTOR = 2.0", "FACTOR = 2"),
        ("[1.0, 2.0]", "[1.0, 3.0]"),
        ("[1.0, 2.0]", "[1, 2]"),
        ("[1.0, 2.0]", "[[1.0], [2.0]]"),
        ("(1, 2)", "(1, 2, 3)"),
        ("x + 1", "x + 2"),
        ("FACTOR * x", "FACTOR - x"),
        ("[0]", "[1]"),
        ("import sqrt", "import floor as sqrt"),
        ("def f(x)", "def f(x, y=0)"),
    ],
)
def test_what_is_computed_otherwise_has_another(before: str, after: str) -> None:
    assert digest_of(SOURCE.replace(before, after)) != digest_of(SOURCE)


def test_another_signature_has_another() -> None:
    assert digest_of(SOURCE, "float64(float64)") != digest_of(SOURCE, "float32(float32)")


@pytest.mark.parametrize(
    "after", ["\n\n\n" + SOURCE, SOURCE + "\nUNUSED = 3\n", SOURCE.replace("def f(x):", "def f(x):  # says why")]
)
def test_what_is_computed_alike_has_the_same(after: str) -> None:
    assert digest_of(after) == digest_of(SOURCE)


def test_values_that_cannot_be_told_apart_are_refused() -> None:
    with pytest.raises(TypeError, match="FACTOR is a object"):
        digest_of(SOURCE.replace("FACTOR = 2.0", "FACTOR = object()"))


def test_every_kernel_has_one_of_its_own() -> None:
    for name in kernel_modules():
        import_module(name)
    assert len({kernel.entry for kernel in REGISTERED}) == len(REGISTERED) > 300


def test_every_kernel_is_wanted_by_python_or_by_another_kernel() -> None:
    """One that nothing calls would be compiled by everybody and run by nobody."""
    for name in kernel_modules():
        import_module(name)
    called: set[Kernel] = {callee for kernel in REGISTERED for callee in kernel.callees}
    words = {path: set(re.findall(r"\w+", path.read_text("utf-8"))) for path in (ROOT / "app").rglob("*.py")}

    def named(kernel: Kernel) -> bool:
        return any(
            kernel.function.__name__ in some
            for path, some in words.items()
            if path != Path(kernel.function.__code__.co_filename)
        )

    assert not [kernel.name for kernel in REGISTERED if kernel not in called and (kernel.inner or not named(kernel))]
