"""What the Cut view shows and from where: the state that painting, colours, playing and mouse share. No Qt."""

from __future__ import annotations

from dataclasses import dataclass, field

from .camera import Camera, Floats, Size
from .cell_colours import CutColourBy, colour_text
from .cell_picking import PickedCell, SectionPlane, pick_finest
from .cut_picture import CutPicture
from .visible_region import RegionQuery


@dataclass(eq=False)
class CutModel:
    """The state of one Cut view.

    Attributes:
        picture: the cut; None = nothing. detail: a part of it that was cut again, finer; None = there is none.
        camera: from where both are seen, in the screen's px. section: what is taken away; None = nothing.
        looks: which kinds of path are shown. hit: the cell under the mouse.
        requested_colour: what the colours of the metal shall tell.
    """

    picture: CutPicture | None = None
    detail: CutPicture | None = None
    camera: Camera = field(default_factory=Camera)
    section: SectionPlane | None = None
    looks: frozenset[int] = frozenset()
    hit: PickedCell | None = None
    requested_colour: CutColourBy = CutColourBy.METAL

    @property
    def colour_shown(self) -> CutColourBy:
        """What the colours of the metal tell: METAL where what is asked for is not known."""
        return colour_text(self.picture, self.requested_colour) if self.picture is not None else CutColourBy.METAL

    def probe(self, x: float, y: float, size: Size) -> PickedCell | None:
        """Return the cell that is seen at a place of a view of a size, px; None beside the metal."""
        if self.picture is None:
            return None
        return pick_finest(self.picture, self.detail, self.camera.ray((x, y), size), self.section)

    def sighted(self, picture: CutPicture, size: Size) -> RegionQuery:
        """Return what of a picture is looked at in a view of a size, px."""
        return RegionQuery(picture, self.detail, self.camera, size, self.section)


def middle(picture: CutPicture) -> Floats:
    """Return the middle of the stock's box, mm."""
    return (picture.low + picture.high) / 2
