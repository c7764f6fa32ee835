"""What making a program better has come to: in words, and as a report."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from typing import Any

from ...model.finding import Finding, FindingKind
from ..smoothing.report import certificate
from ..smoothing.report import findings as smooth_findings
from .picture import streaks
from .result import BetterProgram, ProgramFigures

Json = dict[str, Any]


def gains(done: BetterProgram) -> dict[str, float]:
    """Return by what share less the new program takes of each thing, 0 to 1; less than 0: it takes more."""
    old, new = _figures(done.old), _figures(done.new)
    return {name: 1 - new[name] / old[name] if old[name] > 0 else 0.0 for name in old}


def findings(done: BetterProgram) -> tuple[Finding, ...]:
    """Return what somebody has to know before the new program is used."""
    proofs = replace(done.written, loads=(), left=None).findings()  # of these the second cut tells, by the real stock
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
    corners, fitted, comparison = done.smoothed.corners, done.smoothed.fitted, done.comparison
    old, new = done.old, done.new
    left = f", {done.smoothed.passes.left_out} cut deeper later" if done.smoothed.passes.left_out else ""
    return (
        f"{done.name}: {len(done.smoothed.raster.rows)} passes, {corners.points} places{left}, "
        f"{corners.facets} facets, {len(corners.places)} {corners.kind.value}",
        f"  surface of {fitted.spans[0]} x {fitted.spans[1]} spans by them; those left out lie "
        f"{fitted.left_out_mm:.5f} mm off it",
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


def report(done: BetterProgram) -> Json:
    """Return everything that was found, lengths in mm, angles in degrees."""
    corners, fitted, comparison = done.smoothed.corners, done.smoothed.fitted, done.comparison
    return {
        "program": done.name,
        "tolerance_mm": done.options.tolerance,
        "passes": len(done.smoothed.raster.rows),
        "points": corners.points,
        "points_cut_deeper": done.smoothed.passes.left_out,
        "facets": corners.facets,
        "corners": len(corners.places),
        "corners_are": corners.kind.value,
        "spans": list(fitted.spans),
        "left_out_mm": fitted.left_out_mm,
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
    old, new = (math.degrees(streaks(each.cut.workpiece, done.smoothed)) for each in (done.old_cut, done.new_cut))
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
