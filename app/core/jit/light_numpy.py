"""Has numpy do without its masked arrays until somebody wants one: `np.unique` asks whether it was given one, for which
0.03 s of every start would go by.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

import numpy as np

_MASKED = "numpy.ma"


class _LateMaskedArrays(ModuleType):
    """Stands for the module until somebody asks it for more than whether an array is masked: none is, unmade."""

    def is_masked(self, values: object) -> bool:
        """Return whether any value of an array is masked."""
        return hasattr(values, "_mask") and bool(self.__getattr__("is_masked")(values))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if sys.modules.get(_MASKED) is self:
            sys.modules.pop(_MASKED, None)
        vars(np)["ma"] = made = import_module(_MASKED)  # which another thread may be importing: this waits for it
        return getattr(made, name)


def put_masked_arrays_off() -> None:
    """Let the module be imported when somebody wants one; it stays where it already was."""
    if _MASKED not in sys.modules:
        late = _LateMaskedArrays(_MASKED)
        late.__path__ = [f"{folder}/ma" for folder in np.__path__]  # its parts can be imported by their names
        sys.modules[_MASKED] = vars(np)["ma"] = late
