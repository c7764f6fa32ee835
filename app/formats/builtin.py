"""The formats of drawings that come with the program, in the order in which they are offered: importing this registers
them.
"""

from __future__ import annotations

from .draw import DRAW
from .dxf import DXF
from .project import PROJECT
from .registry import register
from .svg import SVG, SVGZ

for _format in (PROJECT, DXF, SVG, SVGZ, DRAW):
    register(_format)
