"""Compiled inner loops: one decorator, one cache in the user's cache folder.

A kernel has an explicit signature, so importing its module compiles it or loads it from the cache: nothing is
compiled while a job runs. `python -m app.kernels` fills the cache at set-up.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import numba
import platformdirs

from app.errors import HitofudeError

Compiled = Callable[..., Any]
"""A kernel: its types are those of its signature, which mypy does not read."""


def _digests() -> dict[Path, str]:
    """Return a digest of each kernel file."""
    files = sorted(Path(__file__).resolve().parent.glob("*/**/*kernels*.py"))
    return {path: hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


_AT_START = _digests()


def _sources_digest() -> str:
    """Return a digest of all kernel files.

    It names the cache's folder, because numba looks only at a kernel's own file: one that calls a kernel of another
    file would go on using the old code of that after a change.
    """
    return hashlib.sha256("".join(_AT_START.values()).encode()).hexdigest()[:12]


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


@cache
def _ensure_unchanged(file: Path) -> None:
    """Refuse a kernel file that is not what it was when the program was started.

    Its code would go into the cache under the old code's name, within whatever calls it, and would be given arrays as the
    old code wants them.
    """
    if file in _AT_START and hashlib.sha256(file.read_bytes()).hexdigest() != _AT_START[file]:
        raise HitofudeError(f"{file.name} has changed since Hitofude was started, and old and new parts do not go together; "
                            "close it and start it again.")


def kernel(signature: str, counts: bool = True) -> Callable[[Compiled], Compiled]:
    """Compile a function for the given numba signature; it releases the GIL and is kept in the cache.

    Args:
        signature: such as "float64(float64[:, ::1], int64)".
        counts: whether it counts who holds an array, as it must if it makes one. Where an array goes through a short loop and a call
            or two, counting takes longer than these; its caller holds it anyhow.

    Raises:
        HitofudeError: the kernel's file has changed since the program was started.
    """

    def compiled(function: Compiled) -> Compiled:
        _ensure_unchanged(Path(function.__code__.co_filename).resolve())
        made: Compiled = numba.njit(signature, nogil=True, cache=True, error_model="numpy", _nrt=counts)(function)
        return made

    return compiled
