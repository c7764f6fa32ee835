"""The job that a new part begins with. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...formats.tools.library import load_libraries
from ...formats.tools.materials import stock_materials
from ...model.job import Job, Stock
from ...model.part import Part
from ...model.tool_kind import ToolKind
from ..panels.changes import for_material

MATERIALS = ("aluminium", "wood", "plastics", "steel")
"""Those that the libraries of the program know feeds for."""

_LIBRARY = "metric-mills"


@dataclass(frozen=True, slots=True)
class NewPart:
    """What is asked for.

    Attributes:
        x, y, z: how large it is, mm, > 0; its stock is `z` thick.
        material: for speeds and feeds. post: of the machine. outline: its rectangle is drawn.
        round: radius of the rectangle's corners, mm, 0 = they are sharp.
    """

    x: float
    y: float
    z: float
    material: str
    post: str
    outline: bool = True
    round: float = 0.0

    @property
    def widest_round(self) -> float:
        """The radius at which the shorter sides are half circles, mm."""
        return min(self.x, self.y) / 2

    def line(self) -> str:
        """Return the line of the drawing language that draws it."""
        rounded = f" round {self.round:.12g}" if self.round else ""
        return f"rect 0,0 {self.x:.12g},{self.y:.12g}{rounded}"


def new_job(part: NewPart) -> Job:
    """Return the job: the default one with mills of the library, run as the material asks."""
    known = part.material in {each.word for each in stock_materials()}
    job = Job(Part(), stock=Stock(thickness=part.z, material=part.material if known else ""), post=part.post)
    library = load_libraries().libraries.get(_LIBRARY)
    mills = {tool.diameter: tool for tool in library.tools if tool.kind is ToolKind.FLAT} if library else {}
    tools = tuple(
        replace(for_material(mills[tool.diameter], part.material), number=tool.number)
        if tool.diameter in mills
        else tool
        for tool in job.tools
    )
    return replace(job, tools=tools)
