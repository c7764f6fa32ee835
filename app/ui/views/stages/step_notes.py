"""What the class is told beside each step: what the text of 1986 says, and what was settled where it leaves something
open. No Qt.
"""

from __future__ import annotations

from collections.abc import Mapping

NOTES: Mapping[int, str] = {
    110: "The screen has {cols} by {rows} points{then}. What is drawn on it is stored as data, and from here on the "
    "pixels are all that is known. A pixel belongs to the contour when the contour passes through its square.",
    120: "The text calls the offset “well known” and leaves it open. Here a pixel belongs to A' when its distance "
    "from everything outside, less 1.21 pixels, reaches the radius: so the tool cannot gouge, wherever in their "
    "pixels the contours ran.",
    201: "From here on the memory knows only 1 and 0. All that follows reads these pixels, never the drawing.",
    202: "The scan begins at the upper left, as the beam of the screen does. The place of S is the first entry of the "
    "line's data.",
    203: "Starting two vectors to the left finds the outer side of the line first. Read word by word, the text would "
    "meet the way back instead; counter-clockwise from there is what works. The end mark of the data is the point "
    "behind the last digit.",
    204: "If a 1 with a 0 at its left is found that was not traced, step 202 begins again there: islands, and the "
    "other regions.",
    205: "The text speaks of acute angles, and of vertices that are “convex in the horizontal direction”; both "
    "directions follow from the inner product of the vectors in and out. A flat top of several pixels has to be taken "
    "as one vertex.",
    206: "As published, R is set by the look of the chain code. That fails where two strands share a run of pixels, "
    "and where tracing cut a corner. Settled: each pixel notes, while it is drawn, how often the line crosses the "
    "middle of its row.",
    207: "A 2 counts only when the pixel before it is 0. Two lines side by side are thus one count as published; "
    "switch the fill to “Published” and look for red.",
    208: "An odd count means that the row is inside. One wrong parity spoils its row up to the right edge: the red "
    "stripes.",
    130: "The screen is rewritten with the filled area. It is the pocket tool's field of work; the line round it is "
    "the contour tool's.",
    301: "The same eight-direction tracing, now on the border of what is left. What the averages of five vectors come "
    "to by formula I', and what it cannot tell, is computed under “Published”.",
    302: "All borders after the first one are only peeled off.",
    303: "Start pixel and chain code are stored. Nothing is taken from the area between here and step 306 but whole "
    "borders.",
    304: "The text leaves pixels unmarked where strands are nearer than two pixels, so that areas do not fall apart: "
    "so it is done under “Published”, with the pixels that differ; step 307 takes them after all. Settled, a neck that "
    "is too narrow parts: the tool does not fit there.",
    305: "As many borders come off as the radius has pixels. What is left is exactly what is farther than that in "
    "city blocks, steps along rows and columns: aslant too little comes off, by a factor of 0.707.",
    306: "The frame that was stored in step 303 comes back, and the tool's centre is led along it.",
    307: "A circle of the tool's radius is drawn round every pixel of the frame. What no circle reaches is farther "
    "than the radius in every direction; a distance transform gives the same pixels at once.",
    141: "The radius is the pocket tool's “offset amount”. One region after the other is treated.",
    142: "Here the tool's centre runs along the wall that the contour tool finishes. Lines and arcs come from steps "
    "401 to 407.",
    143: "“Pixels that correspond to the overlap” can be read in two ways; read as peel and peel again, more overlap "
    "would give paths farther apart. Settled: from path to path it is one diameter less the overlap.",
    144: "Only when each region has its outermost frame do the inner paths begin.",
    145: "No path is peeled from the one before it: all are levels of one distance field, so that rounding does not "
    "add up.",
    146: "Paths further in follow in all regions alike, until nothing is left.",
    147: "What lies nearer than the next path has to is processed before that path is looked for.",
    148: "The paths are then linked into one stroke for each connected area.",
    140: "The contour tool goes along the walls, the pocket tool clears what is inside. In the Paths view they are "
    "lines and arcs.",
    401: "The text's test, C = (x² + y²) / y, is constant only for circles that touch the axis at the origin. "
    "Settled: one fit to all pixels, with the half pixel that tracing takes off put back.",
    402: "If the whole path was one circle, smoothing ends here.",
    403: "Long means ten tool diameters. They are found first, so that nothing shorter spoils them. Settled: the "
    "longest fit within the tolerance. “Published”: both sums SA and SB, and a histogram of directions with one peak.",
    404: "Averages of five vectors shift with the pixel they begin at; under “Published” five beginnings are tried, "
    "and the sharpest counts. Settled: a corner is where two fitted pieces cross.",
    405: "The same test as in 403, from corner to corner.",
    406: "Settled: the centre comes from a fit to all pixels of the stretch. “Published”: from eight of them.",
    407: "“Published” lays a spline through what is left. Fitted paths lie up to a pixel nearer to the walls than "
    "their pixels, as near as the pixels' squares allow, and never nearer than the tool does.",
}
"""Two or three sentences for each step, as `note` fills them in."""

_SIZE_1986 = (400, 400)


def note(number: int, shape: tuple[int, int]) -> str:
    """Return what is told beside a step.

    Args:
        number: of the step.
        shape: rows and columns of the display memory.
    """
    rows, cols = shape
    return NOTES[number].format(rows=rows, cols=cols, then="" if shape == _SIZE_1986 else "; in 1986 it had 400 by 400")
