"""Compiled inner loops: one decorator, compiled when they are first called, kept in the user's cache folder."""

from ..errors import HitofudeError
from .compiled import Compiled, Kernel, kernel

__all__ = ["Compiled", "Kernel", "kernel"]


def _compile_missing(missing: Kernel) -> None:
    """Wait for a kernel to be compiled.

    Raises:
        HitofudeError: it cannot be.
        Cancelled: what waits was told to stop.
    """
    # only where something is missing: starting processes needs much that nothing else does
    from .compilers import (
        compilers,
    )

    compilers().demand(missing)
    if why := compilers().why(missing):
        raise HitofudeError(why)


Kernel.compile_missing = staticmethod(_compile_missing)
