"""All stages of a job, kept as what each changes of the one before: small enough to keep hundreds, quick to step
through. No Qt.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ....core.progress import NO_PROGRESS, Progress
from ....geometry.primitives import Rows
from ....raster.frame import Plane
from ....raster.steps import STEPS, StepState
from ....raster.trace import PixelChain
from ....raster.walls import Mask

Ints = NDArray[np.int32]

PHASES = (
    (110, 120),
    (201, 202, 203, 204, 205, 206, 207, 208, 130),
    (301, 302, 303, 304, 305, 306, 307, 141, 142, 143, 144),
    (145, 146, 147, 148),
    (140,),
    (401, 402, 403, 404, 405, 406, 407),
)
"""Steps that belong together: within one, the same codes have the same meaning."""

_REPEATED = (2, 3)
"""Phases whose steps follow one another many times."""

_PHASE_OF = {number: k for k, numbers in enumerate(PHASES) for number in numbers}


@dataclass(frozen=True, eq=False)
class FilmFrame:
    """One stage without its pixels.

    Attributes:
        number, chains, rows, region, turn, wrong: as of the `StepState`.
        name, sentence: what it is called, what it does.
        pixels, before, after: (n,) places in the flattened plane that it changes, and their codes before and after.
    """

    number: int
    name: str
    sentence: str
    chains: tuple[PixelChain, ...]
    rows: Rows
    region: int
    turn: int
    wrong: Mask | None
    pixels: Ints
    before: Plane
    after: Plane

    @property
    def phase(self) -> int:
        """Number of its phase, in PHASES."""
        return _PHASE_OF[self.number]


@dataclass(frozen=True, eq=False)
class Film:
    """Stages in the order in which they happen.

    Attributes:
        shape: rows and columns.
        stills: at least one.
        codes: of each step, which codes its planes hold anywhere.
    """

    shape: tuple[int, int]
    stills: tuple[FilmFrame, ...]
    codes: dict[int, frozenset[int]]

    def __len__(self) -> int:
        return len(self.stills)

    @property
    def numbers(self) -> tuple[int, ...]:
        """The steps that happen, in the text's order."""
        seen = {still.number for still in self.stills}
        return tuple(number for number in STEPS if number in seen)

    def codes_near(self, at: int) -> frozenset[int]:
        """Return the codes to explain at a stage: those of its step, or of all steps that are repeated together with
        it.
        """
        still = self.stills[at]
        together = PHASES[still.phase] if still.phase in _REPEATED else (still.number,)
        return frozenset().union(*(self.codes.get(number, frozenset()) for number in together))

    def chains_of(self, number: int) -> tuple[PixelChain, ...]:
        """Return the chains of the first time that a step is done."""
        return next((still.chains for still in self.stills if still.number == number), ())

    def seek_step(self, number: int, at: int) -> int:
        """Return the next stage of a step behind stage `at`, or else its first; `at` itself where there is none."""
        places = [k for k, still in enumerate(self.stills) if still.number == number]
        return next((k for k in places if k > at), places[0]) if places else at

    def seek_part(self, at: int, way: int) -> int:
        """Return where the next part begins (way +1), or this one, or the one before (-1): another phase, or another
        region.
        """
        starts = [0, *(k for k in range(1, len(self)) if self._part(k) != self._part(k - 1))]
        if way > 0:
            return next((k for k in starts if k > at), len(self) - 1)
        return max((k for k in starts if k < at), default=0)

    def _part(self, at: int) -> tuple[int, int]:
        return self.stills[at].phase, self.stills[at].region


def film_of(stages: Iterable[StepState], count: int, progress: Progress = NO_PROGRESS) -> Film:
    """Return a film of stages, which all have planes of one shape.

    Args:
        stages: at least one.
        count: about how many, for the progress.

    Raises:
        Cancelled: by progress.
    """
    stills: list[FilmFrame] = []
    codes: dict[int, frozenset[int]] = {}
    last: Plane | None = None
    for stage in stages:
        progress.step(min(len(stills) / max(count, 1), 0.99), f"{stage.number} {stage.name}")
        plane = stage.plane.ravel()
        before = last if last is not None else np.zeros_like(plane)
        pixels = np.flatnonzero(plane != before).astype(np.int32)
        stills.append(
            FilmFrame(
                stage.number,
                stage.name,
                stage.sentence,
                stage.chains,
                stage.rows,
                stage.region,
                stage.turn,
                stage.wrong,
                pixels,
                before[pixels],
                plane[pixels],
            )
        )
        present = np.flatnonzero(np.bincount(plane)).tolist()
        codes[stage.number] = codes.get(stage.number, frozenset()) | frozenset(present)
        last = plane
        shape = stage.plane.shape
    return Film((shape[0], shape[1]), tuple(stills), codes)


class Projector:
    """Shows a film still by still: one plane that goes from stage to stage.

    Attributes:
        film: what it shows. plane: (rows, cols) codes of stage `at`; it changes when another is shown.
    """

    def __init__(self, film: Film) -> None:
        """Begin with the first stage."""
        self.film, self.at = film, -1
        self.plane: Plane = np.zeros(film.shape, np.uint8)
        self.show(0)

    def show(self, at: int) -> None:
        """Go to a stage, 0 <= at < len(film)."""
        flat = self.plane.reshape(-1)
        while self.at < at:
            self.at += 1
            flat[self.film.stills[self.at].pixels] = self.film.stills[self.at].after
        while self.at > at:
            flat[self.film.stills[self.at].pixels] = self.film.stills[self.at].before
            self.at -= 1


def chain_at(chains: Sequence[PixelChain], row: int, col: int) -> int | None:
    """Return the number of the chain that runs through a pixel, or None."""
    for k, chain in enumerate(chains):
        if bool(np.any(np.all(chain.pixels() == (row, col), axis=1))):
            return k
    return None
