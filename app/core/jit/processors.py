"""Plainer processors than the one of this machine, whose machine code runs here as well.

The levels of x86-64 are those of the psABI of System V: what every processor of a level has, named as LLVM names it.
"""

from __future__ import annotations

from collections.abc import Mapping

_LEVEL_2 = ("cmov", "cx8", "cx16", "fxsr", "popcnt", "sahf", "sse", "sse2", "sse3", "sse4.1", "sse4.2", "ssse3")
_LEVEL_3 = (*_LEVEL_2, "avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave")
LEVELS = {"x86-64-v3": _LEVEL_3, "x86-64-v2": _LEVEL_2}
"""What a processor has to have, by LLVM's name of the level; the best first."""


def plainer_processors(triple: str, features: Mapping[str, bool]) -> tuple[str, ...]:
    """Return the names of levels whose machine code runs on a processor, the best first.

    Args:
        triple: of LLVM, such as x86_64-unknown-linux-gnu. features: of the processor, by LLVM's names; those that are
            not there it has not.
    """
    if not triple.startswith("x86_64"):
        return ()
    return tuple(name for name, needed in LEVELS.items() if all(features.get(each, False) for each in needed))
