"""How a drawing is to be read: what its file leaves open, or says otherwise than is meant; and which file a part was
read from.
"""

from __future__ import annotations

import os
from dataclasses import dataclass, replace
from pathlib import Path

from .part import Units
from .read_options import AS_DRAWN, DrawingOptions


@dataclass(frozen=True, slots=True)
class ReadingOptions:
    """Everything that is said about how a drawing is read.

    Attributes:
        units: of a drawing that names none, or, where `how` overrules it, of any; None = as the file says.
        layers: whose curves alone are read, frozen ones too; empty = all.
        how: the rest.
    """

    units: Units | None = None
    layers: tuple[str, ...] = ()
    how: DrawingOptions = AS_DRAWN

    def in_units(self, units: Units) -> ReadingOptions:
        """Return it so that a drawing is in these units, whatever its file names, and pixels have no say."""
        return replace(self, units=units, how=replace(self.how, overrule=True, pixels_per_inch=None))

    def with_pixels(self, per_inch: float | None) -> ReadingOptions:
        """Return it so that an SVG has so many units to the inch; None = as its generator has it."""
        return replace(self, units=None, how=replace(self.how, overrule=False, pixels_per_inch=per_inch))


AS_THE_FILE_SAYS = ReadingOptions()


@dataclass(frozen=True, slots=True)
class DrawingSource:
    """The file that a part was read from, and how, so that it can be read again in another way.

    Attributes:
        path: of the drawing; in a project file it is told from the project's folder where it lies in that.
    """

    path: str
    reading: ReadingOptions = AS_THE_FILE_SAYS

    def from_folder(self, folder: Path) -> DrawingSource:
        """Return it with the path as it is seen from elsewhere, where it is told from this folder."""
        return replace(self, path=os.path.join(folder.absolute(), self.path))

    def in_folder(self, folder: Path) -> DrawingSource:
        """Return it with the path told from this folder, where the drawing lies in that."""
        path = Path(self.path)
        return (
            replace(self, path=path.relative_to(folder.absolute()).as_posix())
            if path.is_relative_to(folder.absolute())
            else self
        )
