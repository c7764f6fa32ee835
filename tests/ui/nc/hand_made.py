"""Read programs written by hand, for the parts of the NC view that only show one."""

from __future__ import annotations

import numpy as np

from app.gcode.interpreter.program import ModalState, NcProgram, ProgramProblem
from app.model.motion import MotionKind, Motions, Plane


def motions_of(rows: list[tuple], start=(0.0, 0.0, 0.0)) -> Motions:
    """Return motions for rows of (kind, end, line) or (kind, end, line, more) with centre, plane, turns, feed, state in
    `more`.
    """
    ends = np.array([row[1] for row in rows], float).reshape(-1, 3)
    more = [row[3] if len(row) > 3 else {} for row in rows]
    whole = np.int32
    return Motions(
        start=np.concatenate([np.array([start], float), ends[:-1]]) if rows else ends,
        end=ends,
        centre=np.array([m.get("centre", (np.nan,) * 3) for m in more], float).reshape(-1, 3),
        kind=np.array([row[0] for row in rows], np.uint8),
        plane=np.array([m.get("plane", Plane.XY) for m in more], np.uint8),
        turns=np.array([m.get("turns", int("centre" in m)) for m in more], whole),
        feed=np.array(
            [m.get("feed", 0.0 if row[0] == MotionKind.RAPID else 600.0) for row, m in zip(rows, more, strict=True)],
            float,
        ),
        line=np.array([row[2] for row in rows], whole),
        state=np.array([m.get("state", 0) for m in more], whole),
    )


def program_of(
    rows: list[tuple], states: tuple[ModalState, ...] = (ModalState(tool=1),), problems: tuple[ProgramProblem, ...] = ()
) -> NcProgram:
    """Return a read program of such rows."""
    return NcProgram(motions_of(rows), states, problems=problems, line_count=max((row[2] for row in rows), default=0))


def long_program(count: int) -> tuple[bytes, NcProgram]:
    """Return `count` short lines that fill a disc, and what they move."""
    k = np.arange(count)
    radius, turn = 50 * np.sqrt(k / count), k * 0.05
    ends = np.stack([radius * np.cos(turn), radius * np.sin(turn), -0.001 * k], axis=1).round(4)
    text = "\n".join(f"G1 X{x:.4f} Y{y:.4f} Z{z:.4f} F600" for x, y, z in ends.tolist()) + "\n"
    none, whole = np.full((count, 3), np.nan), np.zeros(count, np.int32)
    motions = Motions(
        np.concatenate([np.zeros((1, 3)), ends[:-1]]),
        ends,
        none,
        np.full(count, 1, np.uint8),
        np.zeros(count, np.uint8),
        whole,
        np.full(count, 600.0),
        (k + 1).astype(np.int32),
        whole,
    )
    return text.encode(), NcProgram(motions, (ModalState(tool=1),), line_count=count)
