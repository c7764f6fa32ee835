"""What a program is smoothed with: read once, before anything is fitted."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from ...core.errors import InputError
from ...core.options import option
from ...core.progress import Progress
from ...fitting.point_curves.corners import corners
from ...fitting.point_curves.effective_method import states_across, without_repeats
from ...fitting.point_curves.tube import ToleranceTube
from ...gcode.interpreter.program import ModalState, NcProgram
from ...gcode.interpreter.text import ProgramBuffer
from ...gcode.posts import NurbsForm, Post
from ...gcode.rework.stretches import FoundStretches, find_stretches
from ...model.motion import Floats
from .result import REACH, SmoothOptions
from .source import SourceProgram, SourceReading, read_source

_ROUNDING = 1e-6
"""Of a decimal: what places that are told with it may be off by in a float."""


@dataclass(frozen=True, eq=False)
class SmoothContext:
    """A program whose stretches are to be written anew.

    Attributes:
        options: what was asked.
        source: the program, in the words that it is written in.
        found: its stretches of straight feed moves, and what is in none.
        points: of each stretch its places, none twice in a row, mm: as the source has them, where it has them.
        astray: numbers of stretches whose moves are not the source's one by one; they stay.
        tubes: regions that curves are fitted in, the widest first: one, or narrower and narrower parts of a profile.
    """

    options: SmoothOptions
    source: SourceProgram
    found: FoundStretches
    points: tuple[Floats, ...]
    astray: frozenset[int]
    tubes: tuple[ToleranceTube, ...]

    @property
    def post(self) -> Post:
        """Whose words are written."""
        return self.source.post

    @property
    def program(self) -> NcProgram:
        """The program in these words, before it is smoothed."""
        return self.source.program

    def state(self, k: int) -> ModalState:
        """Return what is in force where a stretch begins."""
        state: ModalState = self.program.states[int(self.program.motions.state[self.found.stretches[k].first])]
        return state

    def digit(self, k: int) -> float:
        """Return the last decimal of an axis word in a stretch, mm."""
        units = self.state(k).units
        return float(10.0 ** -self.post.digits(units).X * units.value)

    def own_digit(self, k: int) -> float:
        """Return the last decimal that the points of a stretch are told with, mm: no finer than an axis word's."""
        units = self.state(k).units
        for decimals in range(self.post.digits(units).X):
            step = float(10.0**-decimals * units.value)
            told = self.points[k] / step
            if np.all(np.abs(told - np.rint(told)) < _ROUNDING):
                return step
        return self.digit(k)

    @cached_property
    def coarsest_digit(self) -> float:
        """The last decimal of an axis word, mm: the coarser one where the program has two units."""
        units = {self.program.states[k].units for k in np.unique(self.program.motions.state).tolist()}
        return max((10.0 ** -self.post.digits(unit).X * unit.value for unit in units), default=0.0)

    @property
    def nearness(self) -> float | None:
        """How far from the points of method D curves may be, mm; None without it."""
        method = self.options.effective
        return None if method is None else method.nearness_for(self.coarsest_digit)

    def corners(self, points: Floats) -> NDArray[np.int64]:
        """Return the numbers of points that are kept exactly, the first and the last one among them."""
        return corners(points, self.options.corner, REACH * self.options.rounds)

    @cached_property
    def states_across(self) -> dict[int, NDArray[np.uint8]]:
        """What the points of stretches are by the facets of the surface that they lie on, where that is asked for."""
        method = self.options.effective
        if method is None or not method.across:
            return {}
        numbers = [k for k, points in enumerate(self.points) if len(points) > 2]
        paths = [self.points[k] for k in numbers]
        states = states_across(paths, [self.corners(points) for points in paths], method.choose.epsilon)
        return dict(zip(numbers, states, strict=True))


def resolved(name: str, data: bytes, options: SmoothOptions, progress: Progress) -> SmoothContext:
    """Return a program ready to be smoothed.

    Raises:
        InputError: it cannot be read to its end, or its control knows no splines and they are insisted on.
    """
    reading = SourceReading(options.dialect, options.units)
    source = read_source(name, data, reading, options.post, progress.part(0.0, 0.75))
    if options.insist and source.post.nurbs.form is NurbsForm.NONE:
        raise InputError(
            f"{source.post.title} knows no splines, so none can be insisted on; leave {option('insist')} out, or name "
            f"a post that has them, {option('post', 'fanuc')} or {option('post', 'linuxcnc')}."
        )
    found = find_stretches(source.program, ProgramBuffer(source.data), progress.part(0.75, 1.0))
    own = [source.points(stretch) for stretch in found.stretches]
    points = tuple(
        without_repeats(stretch.points if points is None else points)
        for stretch, points in zip(found.stretches, own, strict=True)
    )
    profile = options.profile
    tubes = (ToleranceTube(options.tolerance, options.middle),) if profile is None else tuple(profile.tried)
    return SmoothContext(
        options, source, found, points, frozenset(k for k, each in enumerate(own) if each is None), tubes
    )
