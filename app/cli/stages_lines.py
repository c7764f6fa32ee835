"""What `stages` prints."""

from __future__ import annotations

from pathlib import Path

from ..exhibits.films.step import TextFilm
from ..exhibits.stage_files import MOST_TURNS_PX, TURNS, StagesRun
from ..exhibits.stages import Variant
from .output import finding_lines


def film_lines(film: TextFilm, folder: Path) -> list[str]:
    """Return a line a step: what it came to."""
    lines = [f"{folder}: {len(film.steps)} steps of text {film.text.value}, {film.text.number}, on {film.source}"]
    for step in film.steps:
        told = "; ".join(f"{figure.name} {figure.words}" for figure in step.figures)
        lines.append(f"  {step.number} {step.name}" + (f": {told}" if told else ""))
    return lines


def stages_lines(run: StagesRun, folder: Path) -> list[str]:
    """Return in a few lines what was made."""
    frame, given_up = run.ready.part.frame, run.made.given_up
    wrong = run.wrong_pixels
    lines = [
        f"{folder}: {len(run.last)} steps on {frame.cols} x {frame.rows} px of {frame.pitch:.4g} mm; paths along the "
        f"walls up to {given_up.most_mm:.3f} mm farther from them than asked ({given_up.mean_mm:.3f} mm in the mean)"
    ]
    if not run.all_turns:
        lines.append(
            f"  - {TURNS}/ is left out: the planes of all times would be more than {MOST_TURNS_PX / 1e9:.1f} billion "
            "pixels; a smaller bitmap has them"
        )
    if run.variant is Variant.PUBLISHED:
        lines.append(f"  - the fill as published is wrong in {wrong} pixels" + ("" if wrong else " here"))
    return lines + finding_lines(run.findings)
