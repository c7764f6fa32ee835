"""Any number of small drawings, each different, as texts of the shape language."""

from __future__ import annotations

from pathlib import Path

import numpy as np


def write_drawings(folder: Path, count: int, seed: int = 1) -> list[Path]:
    """Write so many drawings, plates with a hole and a corner cut off, into a folder; return their paths."""
    rng = np.random.default_rng(seed)
    folder.mkdir(exist_ok=True)
    paths = []
    for number in range(count):
        width, height = rng.uniform(14, 24, 2)
        x, y = rng.uniform(6.5, 7.5, 2)
        path = folder / f"part-{number:03d}.draw"
        path.write_text(f"rect 0,0 {width:.3f},{height:.3f}\ncircle {x:.3f},{y:.3f} 1.2\n")
        paths.append(path)
    return paths
