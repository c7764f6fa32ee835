"""Has every kernel compiled, so that nobody waits for a compiler later: `python -m app.core.jit.warm`."""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path

from ..progress import NO_PROGRESS, Progress, waits_reported_to
from ..resources import PACKAGE
from .compiled import REGISTERED


def kernel_modules() -> tuple[str, ...]:
    """Return the dotted names of all modules that hold kernels: files in the rooms with "kernels" in their name."""
    root = Path(__file__).resolve().parents[2]
    files = (path.relative_to(root).with_suffix("") for path in root.glob("*/**/*kernels*.py"))
    return tuple(sorted(".".join((PACKAGE, *file.parts)) for file in files))


def warm(progress: Progress = NO_PROGRESS) -> tuple[str, ...]:
    """Have every kernel that is not kept yet compiled; one that cannot be stops none of the others.

    Returns:
        A sentence for each kernel that failed: what needs it tells of it in its turn, everything else works.

    Raises:
        Cancelled: the job was asked to stop.
    """
    from .compilers import compilers

    for name in kernel_modules():
        progress.step(0.0)
        import_module(name)
    with waits_reported_to(lambda text: progress.step(compilers().share, text)):
        compilers().demand(*REGISTERED)
    progress.step(1.0)
    return tuple(why for kernel in REGISTERED if (why := compilers().why(kernel)))


if __name__ == "__main__":
    for sentence in warm():
        if sys.stderr is not None:
            print(f"hitofude: {sentence}", file=sys.stderr)
