"""What G51 and G51.1 make of the words of a program's axes."""

from __future__ import annotations

from dataclasses import dataclass

from .offsets import Place, place_of


@dataclass(frozen=True, slots=True)
class ProgramScale:
    """What is done to the words of an axis: factor * word + shift.

    Attributes:
        factors: of X, Y, Z, not 0; negative = mirrored. shifts: mm, for words that are no increments.
        mirrored: the axes, 0 to 2, that G51.1 mirrors. scaled: whether G51 is in force.
    """

    factors: Place = (1.0, 1.0, 1.0)
    shifts: Place = (0.0, 0.0, 0.0)
    mirrored: frozenset[int] = frozenset()
    scaled: bool = False

    @property
    def plain(self) -> bool:
        """Whether nothing is in force."""
        return not self.scaled and not self.mirrored

    def turns_over(self, u: int, v: int) -> bool:
        """Tell whether what turns one way in the plane of two axes turns the other way."""
        return self.factors[u] * self.factors[v] < 0.0

    def of(self, place: Place) -> Place:
        """Return where program coordinates lead."""
        x, y, z = (a * value + b for a, value, b in zip(self.factors, place, self.shifts, strict=True))
        return (x, y, z)

    def changes(self, axis: int) -> bool:
        """Tell whether words of an axis are not what they say."""
        return self.factors[axis] != 1.0 or self.shifts[axis] != 0.0

    def about(self, centre: Place, factors: Place) -> ProgramScale:
        """Return a scale about a point, program coordinates, mm."""
        x, y, z = (c * (1.0 - a) if a != 1.0 else 0.0 for c, a in zip(centre, factors, strict=True))
        return ProgramScale(factors, (x, y, z), self.mirrored, scaled=True)

    def mirrored_at(self, at: dict[int, float]) -> ProgramScale:
        """Return it with axes mirrored at coordinates, mm."""
        factors, shifts = list(self.factors), list(self.shifts)
        for axis, value in at.items():
            factors[axis], shifts[axis] = -1.0, 2.0 * value
        return ProgramScale(place_of(factors), place_of(shifts), self.mirrored | at.keys())

    def unmirrored(self, axes: frozenset[int]) -> ProgramScale:
        """Return it with axes no more mirrored."""
        factors = [1.0 if axis in axes else value for axis, value in enumerate(self.factors)]
        shifts = [0.0 if axis in axes else value for axis, value in enumerate(self.shifts)]
        return ProgramScale(place_of(factors), place_of(shifts), self.mirrored - axes)
