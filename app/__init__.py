"""Hitofude: from a line drawing to tool paths that can be trusted on a real machine.

The names of `api` are here too, each loaded when it is first asked for: `hitofude.make("part.dxf").save("part.ngc")`.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .api import *  # noqa: F403 (the names themselves stand in its `__all__`)

__version__ = "0.1.0"
"""Its number."""


def __getattr__(name: str) -> Any:
    if name.startswith("_") or name == "api":  # what Python looks for of its own; and the folder, while it is imported
        raise AttributeError(f"module {__name__} has no attribute {name}")
    return getattr(import_module(".api", __name__), name)


def __dir__() -> list[str]:
    own = [name for name in globals() if name.startswith("__")]  # no name that this file only needs itself
    return [*own, *import_module(".api", __name__).__all__]
