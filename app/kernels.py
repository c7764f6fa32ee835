"""Fills the cache of compiled kernels, so that nobody ever waits for a compiler: `python -m app.kernels`."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from app.progress import NO_PROGRESS, Progress


def kernel_modules() -> tuple[str, ...]:
    """Return the dotted names of all modules that hold kernels: files in the rooms with "kernels" in their name."""
    root = Path(__file__).parent
    files = (path.relative_to(root).with_suffix("") for path in root.glob("*/**/*kernels*.py"))
    return tuple(sorted(".".join(("app", *file.parts)) for file in files))


def warm(progress: Progress = NO_PROGRESS) -> None:
    """Compile every kernel, or load it from the cache.

    Raises:
        Cancelled: between two modules.
    """
    modules = kernel_modules()
    for done, name in enumerate(modules):
        progress.step(done / len(modules), f"Preparing {name.split('.')[1]}")
        import_module(name)
    progress.step(1.0, "Ready")


if __name__ == "__main__":
    warm()
