"""What is proven of contours that the control offsets by wear: on the written text, read with wear in its registers.

The text is read as the control would with 0 in the register, and with each end of the wear range. A tool that is
thinner or wider by the wear must then touch the same walls: nowhere does its path come nearer to a wall than its own
radius and the stock to leave, and beside a wall that the path at 0 touches it touches too. Distances to walls are exact
(`verify.clearance`); the paths are those that the reader makes of G41, by rules that were settled with LinuxCNC.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from ....core.progress import NO_PROGRESS, Progress
from ....gcode.interpreter.options import ReadOptions, ToolOffset
from ....gcode.interpreter.program import NcProgram
from ....gcode.interpreter.reader import read_program
from ....gcode.writer.write import NcFile
from ....geometry.distance import DistanceField
from ....geometry.primitives import CX, CY, TURN, X0, Y0, R, Rows, boxes, pack, points_at
from ....model.finding import Finding, FindingKind
from ....model.job import Job
from ....model.motion import MotionKind
from ....model.motion_path import anchored
from ....model.moves import Program, Purpose
from ....model.operation import Operation
from ....verify.verdict import pair_distance
from ..written import WrittenMotions, WrittenProgram

Floats = NDArray[np.float64]

REPORTED = 2e-3
"""mm; what a worn tool cuts too far, or leaves, counts from here on: the writing's own error at both of its ends."""

_SURFACE = 1e-6
"""mm; what lies less below the stock's top cuts nothing."""

_BLOCK = 256
"""Motions that are held against all walls at a time."""


@dataclass(frozen=True)
class WearProof:
    """What is proven of a contour operation.

    Attributes:
        range_mm: of wear, either way.
        gouge_mm: how far a worn tool cuts into a wall at most. left_mm: how far it stays off one that it is to touch.
        bare: motions along walls that no wear offsets. radius_mm: what stands in the register beside the wear.
        x, y: of the first, or of the deepest gouge; None = there is nothing to tell.
        fault: what the control would say, "" = nothing.
    """

    KEY: ClassVar[str] = "worn"

    range_mm: float
    gouge_mm: float
    left_mm: float
    bare: int
    radius_mm: float = 0.0
    x: float | None = None
    y: float | None = None
    fault: str = ""

    def values(self) -> dict[str, Any]:
        """Return it as a report lists it."""
        return {
            "range_mm": self.range_mm,
            "radius_mm": self.radius_mm,
            "gouge_mm": self.gouge_mm,
            "left_mm": self.left_mm,
            "motions_without": self.bare,
            "fault": self.fault or None,
        }

    def findings(self) -> Iterator[Finding]:
        """Yield what counts."""
        if self.fault:
            text = (
                f"With a wear of {self.range_mm:g} mm either way the control cannot follow the contour: {self.fault} "
                'Ask for a smaller wear_range, or compensation = "computer".'
            )
            yield Finding(FindingKind.TOLERANCE, text, self.x, self.y, amount=self.range_mm)
            return
        if self.gouge_mm > REPORTED:
            text = (
                f"With a wear of {self.range_mm:g} mm either way the tool cuts {self.gouge_mm:.4f} mm into a wall; "
                'ask for a smaller wear_range, or compensation = "computer".'
            )
            yield Finding(FindingKind.GOUGE, text, self.x, self.y, amount=self.gouge_mm)
        if self.left_mm > REPORTED:
            text = f"With a wear of {self.range_mm:g} mm either way the tool stays {self.left_mm:.4f} mm off a wall."
            yield Finding(FindingKind.LEFT_REACHABLE, text, self.x, self.y, amount=self.left_mm)
        if self.bare:
            text = (
                f"{self.bare} motions along walls are not offset by the control, because there is no room for a "
                "straight way longer than the tool's radius and an arc; make lead_radius smaller, or clear the place "
                "first."
                if self.radius_mm
                else f"{self.bare} motions along walls are not offset by the wear, because there is no room for a "
                "straight lead that is longer than it; make lead_radius smaller, or clear the place first."
            )
            yield Finding(FindingKind.LEFT_OUT, text, self.x, self.y, amount=float(self.bare))


def wear_proofs(
    program: Program, job: Job, written: WrittenProgram, motions: WrittenMotions, progress: Progress = NO_PROGRESS
) -> dict[int, WearProof]:
    """Return what is proven, by index of the operation, of those whose contours the control offsets.

    Raises:
        Cancelled: by progress.
    """
    worn = [k for k, each in enumerate(job.operations) if each.wear and each.cut.enabled]
    proofs = {}
    for n, index in enumerate(worn):
        share = progress.part(n / len(worn), (n + 1) / len(worn))
        share.step(0.0, "Reading the program with worn tools")
        proofs[index] = _Worn(program, job, written, np.array(motions.origin)).proof(index, share)
    return proofs


@dataclass(frozen=True, eq=False)
class _FeedsAsRead:
    """Feeds of an operation below the stock's top, as read, n of them, part coordinates.

    Attributes:
        rows: (n, 8) in the plane. line: (n,) of the text.
        along: (n,) whether it is level and along a wall.
    """

    rows: Rows
    line: NDArray[np.int32]
    along: NDArray[np.bool_]

    def last_of(self, line: NDArray[np.int32]) -> NDArray[np.int64]:
        """Return the last way of each line, -1 where there is none: before it are those round corners."""
        if not len(self.line):
            return np.full(len(line), -1)
        at = np.searchsorted(self.line, line, side="right") - 1
        return np.where((at >= 0) & (self.line[at] == line), at, -1)


@dataclass(frozen=True, eq=False)
class _WornWalls:
    """What a path keeps off, and by how much: the tool's radius and the stock to leave, mm.

    Attributes:
        rows, field: (n, 8) of the walls, mm, and distances from them.
        keep: from the walls, mm.
    """

    rows: Rows
    field: DistanceField
    keep: float

    def gouges(self, rows: Rows, keep: float) -> tuple[Floats, Floats]:
        """Return how much nearer than `keep` each path comes to a wall, mm, and where, (n, 2); 0 where it does not."""
        deep, places = np.zeros(len(rows)), rows[:, 2:4].copy()
        around = boxes(self.rows)
        for begin in range(0, len(rows), _BLOCK):
            own = boxes(rows[begin : begin + _BLOCK])
            near = (own[:, None, :2] <= around[None, :, 2:] + keep).all(axis=2)
            near &= (own[:, None, 2:] >= around[None, :, :2] - keep).all(axis=2)
            one, other = np.nonzero(near)
            distance, place = pair_distance(rows, self.rows, one + begin, other)
            for k in np.argsort(-distance):  # the nearest wall last
                if keep - distance[k] > 0:
                    deep[one[k] + begin], places[one[k] + begin] = keep - distance[k], place[k]
        return deep, places

    def far(self, rows: Rows, fraction: float) -> Floats:
        """Return how far a place of each path is from the nearest wall, mm."""
        return self.field.nearest(points_at(rows, np.full(len(rows), fraction)))[0]


@dataclass(frozen=True, eq=False)
class _Worn:
    """A program whose registers hold wear.

    Attributes:
        program, job: as planned. written: as it was read back.
        origin: (3,) of the work offset, mm in part coordinates.
    """

    program: Program
    job: Job
    written: WrittenProgram
    origin: Floats

    def proof(self, index: int, progress: Progress) -> WearProof:
        """Return what is proven of an operation."""
        operation, area = self.job.operations[index], self.program.areas[index]
        radius = self.job.tool(operation.cut.tool).radius
        made = WearProof(operation.wear, 0.0, 0.0, 0, radius if operation.offset_by_control else 0.0)
        rows = pack(area.regions).rows
        if not len(rows):
            return made
        keep = radius + operation.cut.stock_to_leave
        walls = _WornWalls(rows, DistanceField.of(rows), keep)
        for k, (file, check) in enumerate(zip(self.written.files, self.written.checks, strict=True)):
            nominal = self._ways(check.program, file, index)
            if not nominal.along.any():
                continue
            for part, wear in enumerate((-operation.wear, operation.wear)):
                progress.step((k + part / 2) / len(self.written.files))
                read = self._read(file.nc.text.encode(), operation, wear)
                if read.problems:
                    first = read.problems[0]
                    return replace(made, fault=f"NC line {first.line}: {first.text}")
                made = _worse(made, nominal, self._ways(read, file, index), walls, wear)
        return made

    def _read(self, text: bytes, operation: Operation, wear: float) -> NcProgram:
        """Return the text as a control reads it in whose register of the operation's tool a wear stands, on top of the
        radius where it offsets by that.
        """
        whole = {each.cut.tool for each in self.job.operations if each.offset_by_control}
        table = {
            tool.number: ToolOffset(
                diameter=tool.diameter * (tool.number in whole) + 2 * wear * (tool.number == operation.cut.tool),
                diameter_known=True,
            )
            for tool in self.job.tools
        }
        return read_program(text, ReadOptions(self.written.post.dialect, table))

    def _ways(self, read: NcProgram, file: NcFile, index: int) -> _FeedsAsRead:
        """Return the feeds of an operation in a file as it was read."""
        motions, moves = anchored(read.motions), self.program.moves
        move = np.minimum(np.searchsorted(file.nc.lines, motions.line), len(file.nc.lines) - 1) + file.first
        top = -self.origin[2] - _SURFACE
        low = np.minimum(motions.start[:, 2], motions.end[:, 2])
        level = np.abs(motions.start[:, 2] - motions.end[:, 2]) <= _SURFACE
        moved = np.any(motions.start[:, :2] != motions.end[:, :2], axis=1) | (motions.kind > MotionKind.LINE)
        own = np.flatnonzero(
            (moves.operation[move] == index) & (motions.kind != MotionKind.RAPID) & (low < top) & moved
        )
        rows = np.zeros((len(own), 8))
        rows[:, :2], rows[:, 2:4] = (each[own, :2] + self.origin[:2] for each in (motions.start, motions.end))
        arc = motions.kind[own] != MotionKind.LINE
        rows[arc, CX], rows[arc, CY] = (motions.centre[own[arc], :2] + self.origin[:2]).T
        rows[arc, R] = np.hypot(rows[arc, X0] - rows[arc, CX], rows[arc, Y0] - rows[arc, CY])
        rows[arc, TURN] = np.where(motions.kind[own[arc]] == MotionKind.ARC_CCW, 1.0, -1.0)
        along = level[own] & np.isin(moves.purpose[move[own]], (Purpose.CONTOUR, Purpose.TAB))
        return _FeedsAsRead(rows, motions.line[own], along)


def _worse(made: WearProof, nominal: _FeedsAsRead, worn: _FeedsAsRead, walls: _WornWalls, wear: float) -> WearProof:
    """Return a proof with what one wear adds to it.

    Args:
        nominal, worn: the same ways, read with nothing and with the wear in the register.
    """
    keep = walls.keep + wear
    deep, places = walls.gouges(worn.rows, keep)
    if len(deep) and deep.max() > max(made.gouge_mm, REPORTED / 4):
        at = int(np.argmax(deep))
        made = replace(made, gouge_mm=float(deep[at]), x=float(places[at, 0]), y=float(places[at, 1]))
    same = worn.last_of(nominal.line)
    own = np.flatnonzero(nominal.along & (same >= 0))
    rows, moved = nominal.rows[own], worn.rows[same[own]]
    bare = own[np.hypot(*(moved[:, 2:4] - rows[:, 2:4]).T) < abs(wear) / 2]
    if len(bare) and made.x is None:
        made = replace(made, x=float(nominal.rows[bare[0], 2]), y=float(nominal.rows[bare[0], 3]))
    touching = np.all([np.abs(walls.far(rows, part) - walls.keep) <= REPORTED for part in (0.0, 0.5, 1.0)], axis=0)
    left = (walls.far(moved, 0.5) - keep)[touching & ~np.isin(own, bare)]
    return replace(made, left_mm=max(made.left_mm, float(left.max(initial=0.0))), bare=max(made.bare, len(bare)))
