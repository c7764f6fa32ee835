"""A computed scene drawn on paper, surface by surface, in the order of generation."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from enum import Enum
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...formats.plot.hpgl import hpgl_bytes
from ...formats.plot.layout import PlotOptions, lay_out
from ...formats.plot.page_pdf import pages_pdf
from ...formats.plot.page_svg import page_svg
from ...formats.plot.surface_plot import VIEWS, BySurface, PlotColouring, PlottedKind, Projection, RunPiece
from ...model.moves import Purpose
from ...model.scene import Passes
from ...model.tool import Tool
from ...surfaces.sections.compound import NO_SURFACE, BoundaryKind, BoundaryPoints
from .compute import ComputedFamily, ComputedScene

FORMATS = (".svg", ".pdf", ".png", ".hpgl", ".plt")


class PlottedPart(Enum):
    """What of a scene is drawn."""

    PATHS = "paths"
    SURFACE = "surface"
    BOTH = "both"


@dataclass(frozen=True, slots=True)
class PlotScene:
    """How a scene is drawn.

    Attributes:
        view: see VIEWS, or any other. look: what tells parts apart. drawn: the cutters' paths, the compound surface, or
            both.
        marks: boundary points get a circle. labels: and their name, where there is room. legend: under the drawing.
        layout: paper, scale, frame.
    """

    view: Projection = VIEWS["isometric"]
    look: PlotColouring = PlotColouring.COLOURS
    drawn: PlottedPart = PlottedPart.PATHS
    marks: bool = True
    labels: bool = True
    legend: bool = True
    layout: PlotOptions = field(default_factory=PlotOptions)


def plot_surface(computed: ComputedScene, suffix: str, what: PlotScene = PlotScene()) -> tuple[bytes, ...]:
    """Return a plot as a file's bytes: one of FORMATS; of SVG and PNG one a sheet, otherwise one for all.

    Raises:
        InputError: the format is none of FORMATS, nothing is to be drawn, or it takes more than 200 sheets.
    """
    suffix = suffix.lower()
    if suffix not in FORMATS:
        raise InputError(f"{suffix or 'No suffix'} names no format of a plot; end the file in {', '.join(FORMATS)}.")
    shown = by_surface(computed, what)
    pages = lay_out(shown, what.layout).pages
    if suffix == ".svg":
        return tuple(page_svg(page, shown.title) for page in pages)
    if suffix == ".png":
        from ...formats.plot.page_png import page_png

        return tuple(page_png(page) for page in pages)
    return (pages_pdf(pages, shown.title) if suffix == ".pdf" else hpgl_bytes(pages),)


def by_surface(computed: ComputedScene, what: PlotScene = PlotScene()) -> BySurface:
    """Return what is drawn of a computed scene, for `lay_out`."""
    tools = list({family.tool.number: family.tool for family in computed.families}.values())
    number = {tool.number: at for at, tool in enumerate(tools)}
    pieces: list[RunPiece] = []
    marks: list[tuple[NDArray[np.float64], str]] = []
    if what.drawn is not PlottedPart.PATHS:
        for family in computed.families:
            pieces += _surface_pieces(family, number[family.tool.number])
            marks += _boundary_marks(family.surface.boundaries)
    if what.drawn is not PlottedPart.SURFACE:
        pieces += _path_pieces(computed, number)
        if what.drawn is PlottedPart.PATHS:
            marks = [mark for family in computed.families for mark in _boundary_marks(family.path.boundaries)]
    surfaces = [
        *(PlottedKind(surface.name, surface.colour, surface.line) for surface in computed.scene.surfaces),
        PlottedKind(computed.names[-1]),
    ]
    places = np.array([place for place, _ in marks]).reshape(-1, 3) if what.marks else np.zeros((0, 3))
    return BySurface(
        title=computed.scene.name,
        surfaces=surfaces,
        tools=[PlottedKind(_tool_words(tool)) for tool in tools],
        pieces=pieces,
        marks=places,
        labels=[label for _, label in marks] if what.marks and what.labels else (),
        view=what.view,
        look=what.look,
        notes=[_passes_words(family.passes, family.tool) for family in computed.families],
        with_legend=what.legend,
    )


def _surface_pieces(family: ComputedFamily, tool: int) -> Iterator[RunPiece]:
    for run in family.surface.runs:
        for first, last in _stretches(run.owner):
            yield RunPiece(int(run.owner[first]), tool, run.points[first : last + 1], fine=True)


def _path_pieces(computed: ComputedScene, tools: dict[int, int]) -> Iterator[RunPiece]:
    """Yield what the cutters follow on the surfaces, in the order of the moves."""
    moves, start = computed.moves.moves, computed.moves.moves.start
    on = np.where(moves.purpose == Purpose.CONTOUR, computed.moves.surface, NO_SURFACE)
    for first, last in _stretches(np.stack([on, moves.operation], axis=1)):
        if on[first] != NO_SURFACE:
            yield RunPiece(
                int(on[first]),
                tools[int(moves.tool[first])],
                np.concatenate([start[first : first + 1], moves.end[first:last]]),
            )


def _stretches(keys: NDArray[np.int64]) -> Iterator[tuple[int, int]]:
    """Yield first and one past the last row of each stretch of equal rows."""
    rows = keys.reshape(len(keys), -1)
    at = np.flatnonzero(np.any(np.diff(rows, axis=0) != 0, axis=1)) + 1
    yield from pairwise([0, *at.tolist(), len(rows)])


def _boundary_marks(found: BoundaryPoints) -> Iterator[tuple[NDArray[np.float64], str]]:
    """Yield place and name of the boundary points between two surfaces; of a jump also its other height."""
    numbers = (found.before.tolist(), found.after.tolist(), found.kind.tolist())
    for i, j, kind, place, end in zip(*numbers, found.place, found.end, strict=True):
        if NO_SURFACE in (i, j):
            continue
        yield place, boundary_name(i, j)
        if kind == BoundaryKind.JUMP:
            yield end, ""


def boundary_name(before: int, after: int) -> str:
    """Return the name of a boundary point of two surfaces, which count from 0: CR12, CR9-10."""
    return f"CR{before + 1}{'-' if max(before, after) > 8 else ''}{after + 1}"


def _tool_words(tool: Tool) -> str:
    return f"T{tool.number} {tool.kind.value} {tool.diameter:g} mm"


def _passes_words(passes: Passes, tool: Tool) -> str:
    spacing = f"pitch {passes.pitch:g} mm" if passes.pitch is not None else f"scallop {passes.scallop:g} mm"
    return f"{passes.name}: {_tool_words(tool)}, {spacing}" if passes.name else f"{_tool_words(tool)}, {spacing}"
