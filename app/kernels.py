"""Fills the cache of compiled kernels, so that nobody ever waits for a compiler: `python -m app.kernels`."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

from app.progress import NO_PROGRESS, Progress


def kernel_modules() -> tuple[str, ...]:
    """Return the dotted names of all modules that hold kernels: files in the rooms with "kernels" in their name."""
    root = Path(__file__).parent
    files = (path.relative_to(root).with_suffix("") for path in root.glob("*/**/*kernels*.py"))
    return tuple(sorted(".".join(("app", *file.parts)) for file in files))


def warm(progress: Progress = NO_PROGRESS) -> tuple[str, ...]:
    """Compile every kernel, or load it from the cache; one that cannot be compiled stops none of the others.

    Returns:
        A sentence for each module that failed: what needs it tells of it in its turn, everything else works.

    Raises:
        Cancelled: between two modules.
    """
    modules, failed = kernel_modules(), []
    for done, name in enumerate(modules):
        progress.step(done / len(modules), f"Preparing {name.split('.')[1]}")
        try:
            import_module(name)
        except Exception as error:
            cause = " ".join(str(error).split())[:200]
            failed.append(f"{name} cannot be compiled, so what needs it will not work: {type(error).__name__}: {cause}")
    progress.step(1.0, "Ready")
    return tuple(failed)


if __name__ == "__main__":
    for sentence in warm():
        print(f"hitofude: {sentence}", file=sys.stderr)
