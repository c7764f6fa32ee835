"""What smoothing did: the certificate, as JSON and as comments of the program."""

from __future__ import annotations

import dataclasses
import json
import math
from typing import Any

import numpy as np

from ...core.wording import counted
from ...fitting.fitted import RefusalReason, SplineRefusal
from ...fitting.line_arcs.arc_fit import BEND
from ...fitting.point_curves.effective_points import PointState
from ...fitting.point_curves.smoothness import joints_of
from ...gcode.interpreter.dialect import DIALECT_RULES
from ...model.finding import Finding, FindingKind
from .result import SmoothedProgram, SmoothedStretch

Json = dict[str, Any]
LISTED = 1000
"""Stretches that the report lists singly, those that changed first; and of each its ranges and points, by method D."""


def certificate(done: SmoothedProgram) -> tuple[str, ...]:
    """Return the proof in a few sentences, for the program's head."""
    changed = _changed(done)
    came, left = _blocks(done)
    head = f"hitofude smooth: {len(changed)} of {len(done.pieces)} stretches written anew"
    if not changed:
        return (head, *_other_control(done))
    reported = f"{head} as {done.kinds.words}"
    bend, step = _most(done, "bend"), _most(done, "curvature_step")
    return (
        f"{reported}, {came} blocks before, {left} after",
        *refused_words(done.refusals),
        *_straight_words(done),
        f"{_region_words(done)}; proven both ways, as written: {done.bound:.6f} mm; found: curve to "
        f"moves {max(piece.judgement.from_curve for piece in changed if piece.judgement):.6f} mm, moves to curve "
        f"{max(piece.judgement.from_points for piece in changed if piece.judgement):.6f} mm",
        f"largest bend {math.degrees(bend[0]):.3f} deg before, {math.degrees(bend[1]):.3f} after{_bend_words(done)}; "
        f"curvature step {step[0]:.4g} per mm before, {step[1]:.4g} after",
        _corner_words(done),
        *(
            f"effective points: {told['effective']} of {told['all']}, {told['corrected']} corrected; nearness "
            f"{told['nearness_mm']:g} mm to them, proven as written; found {told['farthest_mm']:.6f} mm"
            for told in _points(done)
        ),
        "the control may add what its own blending allows",
        *_other_control(done),
    )


def _region_words(done: SmoothedProgram) -> str:
    """Return how far apart curve and moves may be."""
    options = done.options
    if options.profile is None:
        return f"tolerance {options.tolerance:g} mm"
    radii = ", ".join(f"{options.profile.outline.radius(share):.4g}" for share in np.linspace(0, 1, 5))
    return f"region by its outline, {radii} mm from one point to the next by quarters"


def refused_words(refusals: tuple[SplineRefusal, ...]) -> tuple[str, ...]:
    """Return in a sentence for each reason where something else stands than the splines that were asked for."""
    told = []
    for reason in RefusalReason:
        about = [each for each in refusals if each.reason is reason]
        if not about:
            continue
        runs = "1 run" if len(about) == 1 else f"{len(about)} runs"
        blocks, instead = (sum(getattr(each, name) for each in about) for name in ("blocks", "instead"))
        took = f": {blocks} blocks, in place of {instead}" if blocks else ""
        told.append(f"no spline in {runs}, {reason.value}{took}")
    return tuple(told)


def _straight_words(done: SmoothedProgram) -> tuple[str, ...]:
    """Return how many lines stand where splines were insisted on and nothing else was: pieces that do not bend, which
    a control that drives splines as arcs finds none for.
    """
    lines = sum(piece.kinds.lines for piece in _changed(done) if not piece.refusals)
    if not done.options.insist or not lines:
        return ()
    return (f"{counted(lines, 'line')} where a spline is straight to the last decimal",)


def _bend_words(done: SmoothedProgram) -> str:
    """Return by how much neighbours were allowed to bend, where it is not what they always may."""
    requested = done.options.form.value == "arcs" and done.options.bend != BEND
    return (
        f", where up to {math.degrees(done.options.bend):g} deg or the moves' own bend was allowed" if requested else ""
    )


def _corner_words(done: SmoothedProgram) -> str:
    """Return which corners are kept, and how many bends as sharp are not: those of steps as small as the tolerance."""
    angle, rounded = f"{math.degrees(done.options.corner):g} deg", sum(piece.rounded for piece in done.pieces)
    reported = f"corners above {angle} kept where both legs are {done.options.least_leg:g} mm or longer"
    bends = "1 bend" if rounded == 1 else f"{rounded} bends"
    return (
        f"{reported}; {bends} above {angle} beside a shorter leg rounded, within the tolerance" if rounded else reported
    )


def _other_control(done: SmoothedProgram) -> tuple[str, ...]:
    """Return for which control the program was written, where it came for another one, and how far all else is from
    what it was.
    """
    came, left = (DIALECT_RULES[dialect].title for dialect in done.dialects)
    if came == left:
        return ()
    return (
        f"all of it is written for {left} and read back as {left}; what is not smoothed is within {done.off:.4g} mm "
        f"of the {came} program",
    )


def findings(done: SmoothedProgram) -> tuple[Finding, ...]:
    """Return what somebody has to know: stretches whose curve could not be proven."""
    lost = [piece for piece in done.pieces if piece.kept.startswith("as it was written")]
    return tuple(
        Finding(FindingKind.TOLERANCE, f"Lines {piece.lines[0]} to {piece.lines[1]} stay as they were: {piece.kept}.")
        for piece in lost
    ) + _not_splines(done)


def _not_splines(done: SmoothedProgram) -> tuple[Finding, ...]:
    """Return where splines were insisted on and something else stands."""
    if not done.options.insist:
        return ()
    refused = [
        (piece.lines, "; ".join(refused_words(piece.refusals)))
        for piece in done.pieces
        if piece.judgement is not None and piece.refusals
    ]
    return tuple(
        Finding(FindingKind.TOLERANCE, f"Lines {first} to {last} are not splines all along: {why}.")
        for (first, last), why in refused
    )


def report(done: SmoothedProgram) -> Json:
    """Return everything that smoothing found, lengths in mm, angles in degrees."""
    came, left = _blocks(done)
    bend, step = _most(done, "bend"), _most(done, "curvature_step")
    changed = _changed(done)
    listed = sorted(done.pieces, key=lambda piece: (piece.judgement is None, piece.stretch.first_line))[:LISTED]
    return {
        "program": done.name,
        "control": {
            "of_the_program": done.dialects[0].value,
            "written_for": done.dialects[1].value,
            "elsewhere_mm": done.off,
        },
        "warnings": [problem.message(done.name) for problem in done.source.problems],
        "as": done.options.form.value,
        "insist": done.options.insist,
        "written": dataclasses.asdict(done.kinds) | {"words": done.kinds.words},
        "not_splines": [
            {"reason": each.reason.value, "spline_blocks": each.blocks or None, "blocks": each.instead}
            for each in done.refusals[:LISTED]
        ],
        "tolerance": _tolerance(done),
        "blocks": {
            "before": came,
            "after": left,
            "moves_left_alone": {reason.value: n for reason, n in done.found.left.items() if n},
        },
        "largest_bend_deg": {"before": math.degrees(bend[0]), "after": math.degrees(bend[1])},
        "largest_curvature_step_per_mm": {"before": step[0], "after": step[1]},
        "points": next(iter(_points(done)), None),
        "bend_deg": math.degrees(done.options.bend),
        "corner_deg": math.degrees(done.options.corner),
        "corner_least_leg_mm": done.options.least_leg,
        "bends_rounded": sum(piece.rounded for piece in done.pieces),
        "stretches": {
            "found": len(done.pieces),
            "changed": len(changed),
            "listed": [_listed(piece) for piece in listed],
        },
    }


def _tolerance(done: SmoothedProgram) -> Json:
    """Return how far curves may be from the moves, how far they are proven to be at most, and were found."""
    options = done.options
    judged = [piece.judgement for piece in _changed(done) if piece.judgement]
    return {
        "asked_mm": options.tolerance,
        "middle_mm": options.middle,
        "outline": None if options.profile is None else options.profile.text,
        "widest_mm": options.widest,
        "proven_mm": done.bound,
        "curve_to_moves_found_mm": max((each.from_curve for each in judged), default=0.0),
        "moves_to_curve_found_mm": max((each.from_points for each in judged), default=0.0),
    }


def report_text(done: SmoothedProgram) -> str:
    """Return the report as JSON."""
    return json.dumps(report(done), indent=1) + "\n"


def _listed(piece: SmoothedStretch) -> Json:
    reported: Json = {
        "lines": list(piece.lines),
        "blocks": {"before": piece.blocks[0], "after": piece.blocks[1]},
    }
    if piece.judgement is None:
        return reported | {"kept": piece.kept}
    judgement = piece.judgement
    x, y, z = judgement.place
    return reported | {
        "proven_mm": judgement.bound,
        "curve_to_moves_found_mm": judgement.from_curve,
        "moves_to_curve_found_mm": judgement.from_points,
        "farthest": {"x": x, "y": y, "z": z, "chord": judgement.chord},
        "written": dataclasses.asdict(piece.kinds),
        **_rounds(piece),
        **_joints(piece),
        **_points_of(piece),
    }


def _rounds(piece: SmoothedStretch) -> Json:
    """Return the rounds of the text's figure 4, where splines were tried."""
    names = {
        "farthest": "farthest_mm",
        "outside": "points_outside",
        "unproven": "chords_unproven",
        "spread": "thinning",
    }
    told = [
        {names.get(name, name): value for name, value in dataclasses.asdict(each).items()}
        for each in piece.rounds[:LISTED]
    ]
    return {"rounds": told} if told else {}


def _joints(piece: SmoothedStretch) -> Json:
    """Return where one written motion goes over into the next, those that bend most first."""
    if piece.curve is None:
        return {}
    joints = sorted(joints_of(piece.curve), key=lambda each: -each.bend)
    return {
        "joints": [
            {
                "x": each.place[0],
                "y": each.place[1],
                "z": each.place[2],
                "bend_deg": math.degrees(each.bend),
                "curvature_step_per_mm": each.curvature_step,
            }
            for each in joints[:LISTED]
        ],
        "joints_not_listed": max(len(joints) - LISTED, 0),
    }


def _changed(done: SmoothedProgram) -> list[SmoothedStretch]:
    return [piece for piece in done.pieces if piece.judgement is not None]


def _blocks(done: SmoothedProgram) -> tuple[int, int]:
    return sum(piece.blocks[0] for piece in done.pieces), sum(piece.blocks[1] for piece in done.pieces)


def _points(done: SmoothedProgram) -> list[Json]:
    """Return how many points of the stretches that changed are effective and corrected, of how many; nothing without
    method D.
    """
    classes = [piece.classes for piece in _changed(done) if piece.classes is not None]
    if not classes:
        return []
    states = np.bincount(np.concatenate([each.state for each in classes]), minlength=len(PointState)).tolist()
    return [
        {
            "effective": states[PointState.EFFECTIVE],
            "corrected": states[PointState.CORRECTED],
            "left_out": states[PointState.INVALID],
            "all": sum(states),
            "nearness_mm": done.nearness,
            "farthest_mm": done.farthest_point,
        }
    ]


def _points_of(piece: SmoothedStretch) -> Json:
    """Return the ranges of a stretch, and what each of its points is to the curve."""
    if (classes := piece.classes) is None:
        return {}
    names = [PointState(state).name.lower() for state in classes.state[:LISTED].tolist()]
    places, moved = piece.points[:LISTED].tolist(), classes.moved[:LISTED].tolist()
    return {
        "ranges": [{"first": first, "last": last} for first, last in classes.ranges[:LISTED].tolist()],
        "points": [
            {"number": number, "x": x, "y": y, "z": z, "is": name, "moved_mm": by}
            for number, (name, (x, y, z), by) in enumerate(zip(names, places, moved, strict=True))
        ],
        "points_not_listed": max(len(classes.state) - LISTED, 0),
    }


def _most(done: SmoothedProgram, name: str) -> tuple[float, float]:
    """Return the largest value before and after, of the stretches that changed."""
    changed = _changed(done)
    before, after = ([getattr(getattr(piece, side), name) for piece in changed] for side in ("before", "after"))
    return max(before, default=0.0), max(after, default=0.0)
