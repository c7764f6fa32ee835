"""The whole way of a scene's program, told in one place: cut beside the surfaces, made smooth, and cut again."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

from ...core.input_file import FileBytes
from ...core.progress import NO_PROGRESS, Progress
from ...model.scene_curves import SceneFiles
from ..cutting.cut import CutOptions, cut
from ..cutting.ready_setup import setup_of
from ..cutting.report import cut_report
from ..examine import ExamineOptions, examine
from ..scene.part import scene_part
from ..smoothing.report import report as smooth_report
from ..smoothing.result import SmoothOptions
from ..smoothing.smooth import smooth
from .nc import WrittenScene

CELLS = 400
"""Along the longer side of the stock."""
_PROVENANCE = re.compile(rb"Surface \d+ [^)\n]*")
_TOLD = ("gouge", "left", "rapids_in_material", "removed_mm3", "certificate")

Json = dict[str, Any]


def closed_loop(written: WrittenScene, sources: SceneFiles, tolerance: float, progress: Progress = NO_PROGRESS) -> Json:
    """Return what the cut of a scene's program leaves of its surfaces, what smoothing makes of it, and what the cut of
    that leaves.

    Args:
        sources: reads the files that the scene names. tolerance: of smoothing, mm.

    Returns:
        "cut" and "cut_smoothed": gouge, metal left, rapids in metal, as `hitofude cut` reports them; "smooth": as
        `hitofude smooth` does, a list, one for each program; "boundaries_kept": whether every comment on a surface and
        its boundary points is still there.

    Raises:
        HitofudeError: a program cannot be cut or smoothed. Cancelled: the job was asked to stop.
    """
    texts = tuple(
        FileBytes(f"{number}{file.suffix}", file.nc.text.encode()) for number, file in enumerate(written.files, 1)
    )
    first = _cut(written, sources, texts, progress.part(0.0, 0.4))
    options = SmoothOptions(tolerance=tolerance, post=written.post, dialect=written.post.dialect)
    share = 0.2 / len(texts)
    done = [
        smooth(*text, options, progress.part(0.4 + n * share, 0.4 + (n + 1) * share)) for n, text in enumerate(texts)
    ]
    smoothed = tuple(FileBytes(each.name, each.data) for each in done)
    return {
        "cut": first,
        "smooth": [smooth_report(each) for each in done],
        "boundaries_kept": all(
            _PROVENANCE.findall(one.data) == _PROVENANCE.findall(other.data)
            for one, other in zip(texts, smoothed, strict=True)
        ),
        "cut_smoothed": _cut(written, sources, smoothed, progress.part(0.6, 1.0)),
    }


def _cut(written: WrittenScene, sources: SceneFiles, texts: Sequence[FileBytes], progress: Progress) -> Json:
    """Return what programs leave of the stock, beside the scene's surfaces."""
    dialect = written.post.dialect
    ready = setup_of(tuple(examine(*text, ExamineOptions(dialect), progress.part(0.0, 0.3)) for text in texts))
    part = scene_part(written.computed.scene, sources, None, None, None)
    done = cut(replace(ready.setup, part=part), CutOptions(CELLS), progress.part(0.3, 1.0))
    data = cut_report(done, ready).data
    return {key: data[key] for key in _TOLD}
