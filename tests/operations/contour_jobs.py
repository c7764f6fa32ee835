"""Jobs of one contour operation, for the tests of contours: a drawing, clamps on a layer of their own, and what came of
it.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely

from app.geometry.primitives import Rows, contour_rows, sample
from app.model.contour_operation import ContourOperation
from app.model.curves import Primitive
from app.model.job import Job, Stock
from app.model.moves import Moves, Program, Purpose
from app.model.operation import CutParameters, Side
from app.model.part import Contour, Entity, Part
from app.model.tool import Tool
from app.toolpath.coverage.areas import move_rows
from app.toolpath.drawn_contours import drawn_contours
from app.toolpath.machining_areas import MachiningArea, MachiningAreas

CUTTING = (Purpose.CONTOUR, Purpose.TAB, Purpose.LEAD, Purpose.DOG_BONE)


def contour_job(
    closed: Sequence[Contour],
    operation: ContourOperation | None = None,
    diameter: float = 3.0,
    *,
    lines: Sequence[Primitive] = (),
    clamps: Sequence[Contour] = (),
    **changes: object,
) -> Job:
    drawing = [(curve, "0") for contour in closed for curve in contour.primitives] + [(curve, "0") for curve in lines]
    drawing += [(curve, "clamps") for contour in clamps for curve in contour.primitives]
    part = Part().with_entities(tuple(Entity(k, curve, layer) for k, (curve, layer) in enumerate(drawing, 1)))
    keep = {"keep_out_layers": ("clamps",), "keep_out_height": 5.0} if clamps else {}
    settings = {
        "tools": (Tool(2, diameter),),
        "operations": (operation or ContourOperation(CutParameters(2)),),
        "stock": Stock(10.0, 10.0),
    }
    return Job(part, **(settings | keep | changes))  # type: ignore[arg-type]


def outside(**changes: object) -> ContourOperation:
    return ContourOperation(CutParameters(2), Side.OUTSIDE, **changes)  # type: ignore[arg-type]


def sheet_of(job: Job) -> MachiningArea:
    sheet = MachiningAreas(job, drawn_contours(job)).of(job.operations[0])
    assert sheet is not None
    return sheet


def rows_of(moves: Moves, *purposes: Purpose) -> Rows:
    """Rows (n, 8) of the moves for some purposes."""
    return move_rows(moves)[np.isin(moves.purpose, purposes)]


def polygon(contour: Contour) -> shapely.Polygon:
    return shapely.Polygon(sample(contour_rows(contour), 1e-4))


def about(program: Program, word: str) -> list[str]:
    """Texts of the findings that speak of something."""
    return [finding.text for finding in program.findings if word in finding.text]
