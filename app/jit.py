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


def _sources_digest() -> str:
    """Return a digest of all kernel files.

    It names the cache's folder, because numba looks only at a kernel's own file: one that calls a kernel of another
    file would go on using the old code of that after a change.
    """
    digest = hashlib.sha256()
    for path in sorted(Path(__file__).parent.glob("*/**/*kernels*.py")):
        digest.update(path.read_bytes())
    return digest.hexdigest()[:12]


def _cache_folder() -> str:
    """Return a folder that can be written, creating it."""
    for folder in (Path(platformdirs.user_cache_dir("hitofude")), Path(tempfile.gettempdir()) / "hitofude-cache"):
        kernels = folder / "kernels" / _sources_digest()
        try:
            kernels.mkdir(parents=True, exist_ok=True)
        except OSError:
            continue
        if os.access(kernels, os.W_OK):
            return str(kernels)
    return tempfile.mkdtemp(prefix="hitofude-kernels-")


if "NUMBA_CACHE_DIR" not in os.environ:
    numba.config.CACHE_DIR = _cache_folder()


def kernel(signature: str, counts: bool = True) -> Callable[[Compiled], Compiled]:
    """Compile a function for the given numba signature; it releases the GIL and is kept in the cache.

    Args:
        signature: such as "float64(float64[:, ::1], int64)".
        counts: whether it counts who holds an array, as it must if it makes one. Where an array goes through a short loop and a call
            or two, counting takes longer than these; its caller holds it anyhow.
    """
    return numba.njit(signature, nogil=True, cache=True, error_model="numpy", _nrt=counts)  # type: ignore[no-any-return]
