"""What the Cut view shows and from where: the state that painting, colours, playing and mouse share. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, field

from .camera import Camera, Floats, Size
from .colouring import CutColour, told
from .picking import Hit, Section, pick_finest
from .picture import CutPicture
from .window import Sighted


@dataclass(eq=False)
class CutModel:
    """The state of one Cut view.

    Attributes:
        picture: the cut; None = nothing. detail: a part of it that was cut again, finer; None = there is none.
        camera: from where both are seen, in the screen's px. section: what is taken away; None = nothing.
        looks: which kinds of path are shown. hit: the cell under the mouse.
        asked: what the colours of the metal shall tell.
    """

    picture: CutPicture | None = None
    detail: CutPicture | None = None
    camera: Camera = field(default_factory=Camera)
    section: Section | None = None
    looks: frozenset[int] = frozenset()
    hit: Hit | None = None
    asked: CutColour = CutColour.METAL

    @property
    def told(self) -> CutColour:
        """What the colours of the metal tell: METAL where what is asked for is not known."""
        return told(self.picture, self.asked) if self.picture is not None else CutColour.METAL

    def probe(self, x: float, y: float, size: Size) -> Hit | None:
        """Return the cell that is seen at a place of a view of a size, px; None beside the metal."""
        if self.picture is None:
            return None
        return pick_finest(self.picture, self.detail, self.camera.ray((x, y), size), self.section)

    def sighted(self, picture: CutPicture, size: Size) -> Sighted:
        """Return what of a picture is looked at in a view of a size, px."""
        return Sighted(picture, self.detail, self.camera, size, self.section)


def middle(picture: CutPicture) -> Floats:
    """Return the middle of the stock's box, mm."""
    return (picture.low + picture.high) / 2
