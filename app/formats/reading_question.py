"""What has to be asked before a drawing can be read, or is worth asking after it: the facts, and how it is read by each
answer.

Readers make these where they refuse a drawing or assume something; the command line says the same by its options.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import NamedTuple

from ..core.errors import InputError
from ..core.wording import in_plane
from ..geometry.chaining.pieces import FARTHEST
from ..model.curves import Point
from ..model.part import Units
from ..model.reading import ReadingOptions

UNIT_WORDS = {Units.MM: "mm", Units.INCH: "inch", Units.CM: "cm", Units.M: "m", Units.FOOT: "foot", Units.MICRON: "µm"}
_OFFERED = (Units.MM, Units.INCH, Units.M)
_MOST_LAYOUTS = 4
"""That are offered, those with the most in them."""
_MOST_LETTERS = 40
"""Of a name on a button; a DXF allows 255."""
_THIN, _TIMES = "\N{THIN SPACE}", "\N{MULTIPLICATION SIGN}"

Size = tuple[float, float]
"""Width and height, mm."""


@dataclass(frozen=True, slots=True)
class ReadingChoice:
    """One answer.

    Attributes:
        words: on its button.
        reading: how the drawing is read then.
        outcome: what comes of it, in a few words.
        likely: True of the one that is most probably meant.
        now: True of the one that the drawing is read by already.
    """

    words: str
    reading: ReadingOptions
    outcome: str = ""
    likely: bool = False
    now: bool = False


@dataclass(frozen=True, slots=True)
class ReadingQuestion:
    """What there is to ask about a drawing: a sentence of facts, and the answers."""

    text: str
    choices: tuple[ReadingChoice, ...]


class UndecidedError(InputError):
    """A drawing cannot be read before somebody has said how; the text says by which options of the command line."""

    def __init__(self, text: str, question: ReadingQuestion | None) -> None:
        """Make an error whose `question` can be asked; None where no answer would help."""
        super().__init__(text)
        self.question = question


@dataclass(frozen=True, slots=True)
class FileContents:
    """What a file holds that can be chosen from.

    Attributes:
        layers: names of all layers. layouts: of paper space, with how many entities are in each.
        types: of the entities that were met, in order.
        units: that it names; None = none.
        per_inch: user units to the inch that its generator has; None where there is no need for it. editor: that
            generator, or "".
    """

    layers: tuple[str, ...] = ()
    layouts: tuple[tuple[str, int], ...] = ()
    types: tuple[str, ...] = ()
    units: Units | None = None
    per_inch: float | None = None
    editor: str = ""


NO_CHOICE = FileContents()
"""Of a file in which there is nothing to choose."""


def size_words(size: Size) -> str:
    """Return a size for people, the times sign between width and height."""
    wide, high = map(_length, size)
    return f"{wide} {_TIMES} {high} mm"


def _length(value: float) -> str:
    """Return mm with three decimals at most, or three digits where that would be next to nothing."""
    text = f"{value:,.3f}".rstrip("0").rstrip(".") if value >= 0.01 else f"{value:.3g}"
    return text.replace(",", _THIN)


def _scaled(size: Size, factor: float) -> Size:
    return size[0] * factor, size[1] * factor


def far_question(first: Point, reading: ReadingOptions, units: Units) -> ReadingQuestion:
    """Ask what to do with a drawing all of which lies beyond 1 km.

    Args:
        first: place of its first curve, mm. reading: by which it lies there. units: in which it was read.
    """
    moved = replace(reading, how=replace(reading.how, to_zero=True))
    choices = [ReadingChoice("Move it to zero", moved, "its lower left corner becomes zero", likely=True)]
    for other in _OFFERED[:2]:
        x, y = _scaled(first, other.value / units.value)
        if other.value < units.value and max(abs(x), abs(y)) < FARTHEST:
            choices.append(
                ReadingChoice(
                    f"Take it as {UNIT_WORDS[other]}",
                    reading.in_units(other),
                    f"it then begins at {in_plane(x, y)} mm",
                )
            )
    away = math.hypot(*first) / 1e6
    return ReadingQuestion(
        f"All of it stands more than 1 km from zero: its first curve, at {in_plane(*first)} mm, {away:,.1f} km away.",
        tuple(choices),
    )


def strays_question(count: int, reading: ReadingOptions) -> ReadingQuestion:
    """Ask what to do with a drawing of which some curves lie beyond 1 km and none does when it is moved to zero."""
    moved = replace(reading, how=replace(reading.how, to_zero=True))
    what = (
        "1 curve lies beyond 1 km and is missing." if count == 1 else f"{count} curves lie beyond 1 km and are missing."
    )
    return ReadingQuestion(
        what,
        (
            ReadingChoice("Move it to zero", moved, "nothing is missing then", likely=True),
            ReadingChoice("Keep it where it is", reading, "what lies beyond is left out", now=True),
        ),
    )


def layouts_question(layouts: Mapping[str, int], reading: ReadingOptions) -> ReadingQuestion:
    """Ask which layout to take of a drawing whose model space is empty; `layouts` has how many entities each holds."""
    ranked = sorted(layouts.items(), key=lambda each: -each[1])
    choices = tuple(
        ReadingChoice(
            f"Take layout {_short(name)}",
            replace(reading, how=replace(reading.how, layout=name)),
            _entities(count),
            likely=name == ranked[0][0],
        )
        for name, count in ranked[:_MOST_LAYOUTS]
    )
    if len(ranked) == 1:
        return ReadingQuestion(
            f"Model space holds no curve; all that is drawn stands on the layout {_short(ranked[0][0])}.", choices
        )
    return ReadingQuestion(f"Model space holds no curve; what is drawn stands on {len(ranked)} layouts.", choices)


def _short(name: str) -> str:
    return name if len(name) <= _MOST_LETTERS else f"{name[: _MOST_LETTERS - 1]}…"


def _entities(count: int) -> str:
    return "1 entity" if count == 1 else f"{count} entities"


def frozen_question(layers: tuple[str, ...], curves: int, reading: ReadingOptions) -> ReadingQuestion:
    """Ask whether to read what stands on frozen layers, where nothing else is drawn."""
    words = f"Read layer {_short(layers[0])}" if len(layers) == 1 else f"Read {len(layers)} layers"
    read = ReadingChoice(
        words,
        replace(reading, layers=layers),
        f"{curves} curve{'s' * (curves != 1)} on {', '.join(layers)}",
        likely=True,
    )
    return ReadingQuestion("Nothing of it is shown: all blocks are inserted on layers that are frozen.", (read,))


class SizeInUnits(NamedTuple):
    """Units that may be meant, and the size in them, mm."""

    units: Units
    size: Size


class AssumedDensity(NamedTuple):
    """Units to the inch that an SVG was read with, and the editor that they are of, or ""."""

    per_inch: float
    editor: str


def size_question(
    size: Size, whence: str, keep: ReadingChoice, others: Iterable[SizeInUnits], tools: tuple[float, ...]
) -> ReadingQuestion:
    """Ask for the units of a drawing whose size cannot be meant.

    Args:
        size: as it was read, mm. whence: why in these units.
        keep: the answer that this is right, after which it is read all the same.
        others: what may be meant; none where no size would be better.
        tools: diameters, mm.
    """
    offered = list(others)
    likely = min(offered, key=lambda each: _oddness(each.size, tools)).units if offered else None
    choices = [
        ReadingChoice(
            f"Take it as {UNIT_WORDS[each]}", keep.reading.in_units(each), size_words(found), likely=each is likely
        )
        for each, found in offered
    ]
    choices.sort(key=lambda choice: not choice.likely)
    tool, extreme = (max(tools), "largest") if max(size) > max(tools) else (min(tools), "smallest")
    return ReadingQuestion(
        f"It is {size_words(size)}, and the {extreme} tool {tool:g} mm. {whence}; which unit is meant?",
        (*choices, keep),
    )


def _oddness(size: Size, tools: tuple[float, ...]) -> float:
    """Return how far a size is from that of a usual part, some twenty tools long."""
    return abs(math.log(max(*size, 1e-9) / (20 * max(tools))))


def units_question(units: Units, size: Size, reading: ReadingOptions) -> ReadingQuestion:
    """Ask for the units of a drawing that names none and was read in some."""
    choices = [ReadingChoice(f"Keep {UNIT_WORDS[units]}", replace(reading, units=units), size_words(size), now=True)]
    for other in _OFFERED[:2]:
        if other is not units:
            factor = other.value / units.value
            choices.append(
                ReadingChoice(
                    f"Read in {UNIT_WORDS[other]}", replace(reading, units=other), size_words(_scaled(size, factor))
                )
            )
    return ReadingQuestion(f"It names no units. It was read in {UNIT_WORDS[units]}.", tuple(choices))


def pixels_question(
    assumed: AssumedDensity,
    others: Iterable[float],
    size_of: Callable[[ReadingOptions], Size],
    reading: ReadingOptions,
) -> ReadingQuestion:
    """Ask how large the units of an SVG without a real size are.

    Args:
        assumed: as it was read.
        others: units to the inch of other editors.
        size_of: returns the size of the drawing when it is read in a way, mm.
        reading: by which it was read.
    """
    per_inch, editor = assumed
    ways = {
        f"Keep {per_inch:g} to the inch": reading.with_pixels(per_inch),
        **{f"Read {each:g} to the inch": reading.with_pixels(each) for each in others if each != per_inch},
        **{f"Read in {UNIT_WORDS[each]}": replace(reading.with_pixels(None), units=each) for each in _OFFERED[:2]},
    }
    choices = tuple(
        ReadingChoice(words, way, size_words(size_of(way)), now=k == 0) for k, (words, way) in enumerate(ways.items())
    )
    who = f"It was written by {editor}" if editor else "It names no editor"
    return ReadingQuestion(f"It has no real size. {who} and was read with {per_inch:g} units to the inch.", choices)
