"""What making a program better has come to: in words, and as a report."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

from ...core.wording import counted
from ...model.finding import Finding, FindingKind
from ..smoothing.report import certificate
from ..smoothing.report import findings as smooth_findings
from .picture import streaks
from .result import BetterProgram, ProgramFigures, SurfaceFigures

Json = dict[str, Any]


def gains(done: BetterProgram) -> dict[str, float]:
    """Return by what share less the new program takes of each thing, 0 to 1; less than 0: it takes more."""
    old, new = _figures(done.old), _figures(done.new)
    return {name: 1 - new[name] / old[name] if old[name] > 0 else 0.0 for name in old}


def findings(done: BetterProgram) -> tuple[Finding, ...]:
    """Return what somebody has to know before the new program is used."""
    written = done.written and replace(done.written, loads=(), left=None)  # of these the second cut tells
    proofs = written.findings() if written is not None else ()
    return (*_apart(done), *_no_better(done), *proofs, *smooth_findings(done.curves), *done.new_cut.findings)


def _apart(done: BetterProgram) -> tuple[Finding, ...]:
    """Return where the new cut differs from the old one by more than it may."""
    comparison, tolerance = done.comparison, done.options.tolerance
    found = []
    ways = (
        (comparison.deeper, FindingKind.GOUGE, "deeper than the old one"),
        (comparison.left, FindingKind.LEFT_REACHABLE, "above the old one"),
    )
    for cell, kind, words in ways:
        if cell.amount_mm > tolerance:
            text = (
                f"The new cut is {cell.amount_mm:.4f} mm {words} at X{cell.x:.3f} Y{cell.y:.3f}, and {tolerance:g} mm "
                "are allowed; use a larger tolerance, a smaller pitch, or keep the old program."
            )
            found.append(Finding(kind, text, cell.x, cell.y, amount=cell.amount_mm))
    beside = max(comparison.beside_left_mm, comparison.beside_deeper_mm)
    if beside > tolerance:
        text = (
            f"Beside the passes the new cut differs from the old one by {beside:.4f} mm, and {tolerance:g} mm are "
            "allowed; use a larger tolerance, or keep the old program."
        )
        found.append(Finding(FindingKind.TOLERANCE, text, amount=beside))
    if not done.budget.kept:
        text = f"The tolerance's shares are not kept: {done.budget.lines()[-1]}; use a larger tolerance."
        found.append(Finding(FindingKind.TOLERANCE, text))
    return tuple(found)


def _no_better(done: BetterProgram) -> tuple[Finding, ...]:
    if any(share > 1e-3 for share in gains(done).values()):
        return ()
    text = "The new program takes no fewer blocks, is no shorter, no smoother and no quicker; keep the old one."
    return (Finding(FindingKind.TOLERANCE, text),)


def lines(done: BetterProgram) -> tuple[str, ...]:
    """Return what was done, for people."""
    figures, comparison, old, new = done.figures, done.comparison, done.old, done.new
    return (
        *_surface_lines(done.name, figures),
        *(f"  {line}" for line in done.budget.lines()),
        f"  cut again: at most {comparison.left.amount_mm:.4f} mm above the old cut, {comparison.deeper.amount_mm:.4f} "
        f"mm below it, {comparison.mean_mm:.4f} mm in the mean square, square to it, on {comparison.cells} cells of "
        f"{comparison.spacing_mm:.3g} mm; {done.options.tolerance:g} mm allowed",
        f"  slope of the metal changes along the passes by {_streaks(done)[0]:.4f} -> {_streaks(done)[1]:.4f} deg from "
        "cell to cell, in the mean square: what light shows of the facets",
        f"  blocks {old.blocks} -> {new.blocks}, length {old.length_mm:.1f} -> {new.length_mm:.1f} mm, largest bend "
        f"{math.degrees(old.bend):.2f} -> {math.degrees(new.bend):.2f} deg, time {old.time_s:.1f} -> "
        f"{new.time_s:.1f} s",
    )


def _surface_lines(name: str, figures: SurfaceFigures) -> tuple[str, ...]:
    """Return what the smooth surfaces are, for people."""
    deeper = f", {figures.cut_deeper} cut deeper later" if figures.cut_deeper else ""
    kept = f", {figures.kept} of none and kept" if figures.kept else ""
    shape = "; ".join(f"{count} {kind}" for count, kind in figures.shape)
    spans = ", ".join(f"{u} x {v}" for u, v in figures.spans)
    found = (
        f"{name}: {counted(figures.passes, 'pass', 'passes')}, {counted(figures.places, 'place')}{deeper}{kept}, "
        f"{counted(figures.facets, 'facet')}, {shape}",
        f"  {_counted(len(figures.spans))} of {spans} spans by them; those left out lie {figures.left_out_mm:.5f} mm "
        "off it",
    )
    if not figures.boundaries:
        return found
    return (
        *found,
        f"  {figures.boundaries} boundary points from surface to surface, their heights alike within "
        f"{figures.apart_mm:.1e} mm",
    )


def _counted(surfaces: int) -> str:
    return "surface" if surfaces == 1 else f"{surfaces} surfaces"


def report(done: BetterProgram) -> Json:
    """Return everything that was found, lengths in mm, angles in degrees."""
    figures, comparison = done.figures, done.comparison
    return {
        "program": done.name,
        "tolerance_mm": done.options.tolerance,
        "passes": figures.passes,
        "points": figures.places,
        "points_cut_deeper": figures.cut_deeper,
        "points_kept": figures.kept,
        "facets": figures.facets,
        "surfaces": [
            {"places": count, "places_are": kind, "spans": list(spans)}
            for (count, kind), spans in zip(figures.shape, figures.spans, strict=True)
        ],
        "boundary_points": figures.boundaries,
        "boundary_points_apart_mm": figures.apart_mm,
        "lifted": done.scene is None,
        "left_out_mm": figures.left_out_mm,
        "budget": done.budget.report(),
        "certificate": list(certificate(done.curves)),
        "cut_again": {
            "above_mm": comparison.left.amount_mm,
            "above_at": [comparison.left.x, comparison.left.y],
            "below_mm": comparison.deeper.amount_mm,
            "below_at": [comparison.deeper.x, comparison.deeper.y],
            "mean_square_mm": comparison.mean_mm,
            "beside_above_mm": comparison.beside_left_mm,
            "beside_below_mm": comparison.beside_deeper_mm,
            "cells": comparison.cells,
            "spacing_mm": comparison.spacing_mm,
        },
        "slope_change_along_passes_deg": dict(zip(("old", "new"), _streaks(done), strict=True)),
        "old": _figures(done.old),
        "new": _figures(done.new),
        "findings": [
            {"kind": found.kind.value, "text": found.text, "counts": found.counts} for found in findings(done)
        ],
    }


def _streaks(done: BetterProgram) -> tuple[float, float]:
    """Return what light shows of facets in the old cut, and in the new one, degrees."""
    old, new = (math.degrees(streaks(each.cut.workpiece, done.smoothed.area)) for each in (done.old_cut, done.new_cut))
    return old, new


def report_text(done: BetterProgram) -> str:
    """Return the report as JSON."""
    return json.dumps(report(done), indent=1) + "\n"


def _figures(figures: ProgramFigures) -> dict[str, float]:
    return {
        "blocks": figures.blocks,
        "length_mm": round(figures.length_mm, 4),
        "time_s": round(figures.time_s, 3),
        "largest_bend_deg": round(math.degrees(figures.bend), 4),
    }
