"""The numbered steps of the 1986 text: what each is called, and what it does, in one sentence."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ..geometry.primitives import Rows
from .frame import Plane
from .trace import PixelChain
from .walls import Mask

STEPS: dict[int, tuple[str, str]] = {
    110: (
        "Show the shape",
        "The stored shape is drawn into the display memory, one pixel after the other: 1 on a contour, 0 elsewhere.",
    ),
    120: (
        "Offset the contours",
        "Every contour is offset into the area by the contour tool's radius, A becomes A'; this is the contour "
        "tool's path, and the screen is rewritten with it.",
    ),
    201: ("Contour pixels", "The pixels on the offset contours hold 1, all others 0."),
    202: (
        "Start pixels",
        "Row by row from the upper left, the first 1 behind a 0 is the start pixel S of a contour line.",
    ),
    203: (
        "Trace the contour lines",
        "From S the eight neighbours are searched, counter-clockwise from two vectors left of the one that "
        "led here; the directions 0 to 7 are the chain code, and what was traced holds 2.",
    ),
    204: ("All lines traced?", "As long as a 1 is left behind a 0, there is one more contour line to trace."),
    205: (
        "Find what must not count",
        "Where the line turns back in height, or lies twice in one pixel, a row would count it wrongly.",
    ),
    206: (
        "Mark R",
        "These pixels get the second mark, R; in the settled rule wherever the line crosses the middle of the pixel's "
        "row an even number of times.",
    ),
    207: (
        "Count along the rows",
        "Each row is scanned from the left and the 2s are counted: odd means inside, even outside.",
    ),
    208: ("Mark the inside", "Empty pixels behind an odd count get the mark I."),
    130: (
        "The area is filled",
        "2, R and I all become 1: the area A' that the pocket tool has to clear inside the contour tool's path.",
    ),
    301: (
        "Trace the border",
        "The border of what is left is traced; directions in which the average of five vectors would turn by 180 "
        "degrees or more cannot be a border.",
    ),
    302: ("The first time?", "Only the border that is traced first is the area's frame."),
    303: (
        "Keep the frame",
        "The start pixel and the chain code of the outermost border are stored, for the correction in step 306.",
    ),
    304: ("Mark it processed", "The traced pixels are marked processed; the area is now one pixel smaller all round."),
    305: (
        "Often enough?",
        "Peels come off until as many as the tool's radius has pixels; so far the area shrinks in city blocks, "
        "aslant only by 0.7 of what it should.",
    ),
    306: ("Read the frame", "The stored frame is read again, pixel by pixel."),
    307: (
        "Correct by circles",
        "The tool's circle follows the frame, and every pixel in it is marked processed: what is left is farther "
        "than the radius from the frame in every direction.",
    ),
    141: ("Shrink by the pocket tool", "The area is shrunk by the pocket tool's radius (steps 301 to 307)."),
    142: ("The outermost frame", "The border of what is left is the outermost path of the pocket tool."),
    143: (
        "Mark the overlap",
        "What lies within a step of the frame is marked processed, so that the next path overlaps this one as "
        "asked: a step is two radii less the overlap. The path is kept one stroke as far as possible.",
    ),
    144: ("Every region?", "The outermost frames of all regions come first."),
    145: ("Shrink again", "The area has shrunk by a step; the border of what is left is traced again."),
    146: ("The next path", "This border is the pocket tool's next path."),
    147: ("Mark its overlap", "And again what lies within a step of the path is marked processed."),
    148: ("All processed?", "Steps 145 to 147 are repeated until no pixel is left."),
    140: ("The tool paths", "The paths of both tools: the contour tool's dashed, the pocket tool's solid."),
    401: ("Whole circles", "A path that is one circle, by a fit to all its pixels, is one circle."),
    402: ("All done?", "What was a circle needs no more."),
    403: ("Long lines", "Straight pieces of at least ten tool diameters are found first."),
    404: ("Vertices", "Where two pieces cross is a corner; where they only touch, none."),
    405: ("Short lines", "Between corners and long lines, the shorter straight pieces."),
    406: (
        "Arcs",
        "What is left and lies on a circle, by a fit to its pixels, becomes an arc; arcs that nearly touch a line "
        "touch it.",
    ),
    407: (
        "Free curves",
        "Arcs that meet with a slight bend were no circles: a smooth curve takes their place. What fits nothing stays "
        "as it is, from pixel to pixel.",
    ),
}
"""Name and sentence of each step, in the order in which the text does them."""


@dataclass(frozen=True, eq=False)
class StepState:
    """The display memory after a step.

    Attributes:
        number: of the step in the text.
        plane: (rows, cols) codes, row 0 = top.
        chains: the chain codes that the step has just found or read.
        rows: (n, 8) lines and arcs, mm, that the step has made.
        region: number of the region it is about; 0 = all.
        turn: 1, 2, … where the step is repeated (peels, paths further in).
        wrong: (rows, cols) pixels in which the published rule errs; None where it is not about that.
        beside: what the published rule came to here, beside the settled one, in a sentence; "" = nothing to say.
    """

    number: int
    plane: Plane
    chains: tuple[PixelChain, ...] = ()
    rows: Rows = field(default_factory=lambda: np.zeros((0, 8)))
    region: int = 0
    turn: int = 1
    wrong: Mask | None = None
    beside: str = ""

    def __post_init__(self) -> None:
        self.plane.setflags(write=False)

    @property
    def name(self) -> str:
        """What the step is called."""
        return STEPS[self.number][0]

    @property
    def sentence(self) -> str:
        """What the step does, and what went wrong in it."""
        count = 0 if self.wrong is None else int(np.count_nonzero(self.wrong))
        told = f" The published rules err in {count} pixels here." if count else ""
        return STEPS[self.number][1] + told + (f" {self.beside}" if self.beside else "")

    @property
    def text(self) -> str:
        """The chain codes, a line each, with region and turn."""
        return "".join(f"region {self.region} turn {self.turn} start {chain.text()}\n" for chain in self.chains)
