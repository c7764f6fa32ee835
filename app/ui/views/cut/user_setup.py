"""What the user says of a program that is none of the job's: tools and stock. No Qt."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from ....model.tool import Tool

Box = tuple[float, float, float, float, float, float]
"""x0, y0, z0, x1, y1, z1, mm, program coordinates."""


@dataclass(frozen=True, eq=False)
class UserSetup:
    """What was said.

    Attributes:
        tools: by T number. stock: None = as the program tells.
        compare: with the open drawing. published: heights by facets in the depth buffer, the method of 1999.
    """

    tools: Mapping[int, Tool] = field(default_factory=dict)
    stock: Box | None = None
    compare: bool = False
    published: bool = False
