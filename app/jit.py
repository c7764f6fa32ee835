"""Compiled inner loops: one decorator, one cache in the user's cache folder.

A kernel has an explicit signature, so importing its module compiles it or loads it from the cache: nothing is
compiled while a job runs. `python -m app.kernels` fills the cache at set-up.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
import platformdirs

Compiled = Callable[..., Any]
"""A kernel: its types are those of its signature, which mypy does not read."""


def _version() -> str:
    """Return a name that changes with any kernel's source: numba itself looks at one file, not at what it calls."""
    sources = sorted(Path(__file__).parent.rglob("*kernels*.py"))
    return hashlib.sha256(b"".join(path.read_bytes() for path in sources)).hexdigest()[:16]


def _cache_folder() -> str:
    """Return a folder that can be written, creating it."""
    version = _version()
    for base in (Path(platformdirs.user_cache_dir("hitofude")) / "kernels", Path(tempfile.gettempdir()) / "hitofude-kernels"):
        folder = base / version
        try:
            folder.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(folder, os.W_OK):
            return str(folder)
    return tempfile.mkdtemp(prefix="hitofude-kernels-")


if "NUMBA_CACHE_DIR" not in os.environ:
    numba.config.CACHE_DIR = _cache_folder()


def kernel(signature: str) -> Callable[[Compiled], Compiled]:
    """Compile a function for the given numba signature; it releases the GIL and is kept in the cache.

    Args:
        signature: such as "float64(float64[:, ::1], int64)".
    """
    return numba.njit(signature, nogil=True, cache=True, error_model="numpy")  # type: ignore[no-any-return]
