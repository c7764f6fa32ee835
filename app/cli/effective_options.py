"""The options of method D, effective points, for `hitofude smooth`."""

from __future__ import annotations

import argparse
from collections.abc import Callable
from typing import TypeVar

from ..core.errors import InputError
from ..core.wording import either
from ..fitting.point_curves.correction import CorrectionMove, CorrectionOptions, CorrectionScope
from ..fitting.point_curves.effective_method import EffectiveMethod, second_embodiment
from ..fitting.point_curves.effective_points import EffectiveOptions, RangeEnds
from .command import OptionParser, number

Kind = TypeVar("Kind")

_DEFAULTS = CorrectionOptions()
_ONLY = ("epsilon", "across", "nearness", "ends", "before", "after", "move", "select", "embodiment")


def add_effective_options(parser: OptionParser) -> None:
    """Add the options to the parser of `smooth`."""
    about = "for programs made from a polyhedron: points inside its facets lie off the true shape"
    group = parser.add_argument_group("effective points", about)
    _range_options(group)
    _correction_options(group)


def _range_options(group: argparse._ArgumentGroup) -> None:
    """Add which points are effective, and how near to them the curve is."""
    group.add_argument(
        "--method",
        choices=["tube", "effective-points"],
        default="tube",
        help="which points the curve goes by (default tube: all)",
    )
    group.add_argument(
        "--epsilon", metavar="E", type=number("epsilon"), help="points so near to one segment belong to one facet (mm)"
    )
    group.add_argument(
        "--across",
        action="store_true",
        default=None,
        help="tell points apart by the facets of the surface that neighbouring passes lie on, not path by path",
    )
    group.add_argument(
        "--nearness",
        metavar="N",
        type=number("nearness"),
        help="how far the curve may be from the points that it goes by (mm; default: some last digits of the program, "
        "or a twentieth of epsilon); the tolerance says how far it may leave the facets",
    )
    group.add_argument(
        "--ends",
        metavar="ratio:K|distance:D",
        type=_pair({"ratio": RangeEnds.RATIO, "distance": RangeEnds.DISTANCE}),
        help="points so near to the ends of a range are effective too: a share of it, or a length (default: the ends "
        "alone)",
    )


def _correction_options(group: argparse._ArgumentGroup) -> None:
    """Add what becomes of the other points."""
    group.add_argument(
        "--embodiment",
        type=int,
        choices=[1, 2],
        help="1: other points are left out; 2: they are corrected first (default 1)",
    )
    group.add_argument(
        "--before",
        metavar="N",
        type=int,
        help=f"effective points before a range for its correction (default {_DEFAULTS.before})",
    )
    group.add_argument("--after", metavar="N", type=int, help=f"effective points behind it (default {_DEFAULTS.after})")
    group.add_argument(
        "--move", choices=["nearest", "perpendicular"], help="where points go on the correction curve (default nearest)"
    )
    group.add_argument(
        "--select",
        metavar="kr:R|ei:D",
        type=_pair({"kr": CorrectionScope.RATIO, "ei": CorrectionScope.DISTANCE}),
        help="which points are corrected: within a share of an end, or moving no farther than a length (default all)",
    )


def effective_method(arguments: argparse.Namespace) -> EffectiveMethod | None:
    """Return method D as the options say, None where it is not asked for.

    Raises:
        InputError: options that do not go together.
    """
    given = [name for name in _ONLY if getattr(arguments, name) is not None]
    if arguments.method == "tube":
        if given:
            raise InputError(f"--{given[0]} belongs to --method effective-points; give that too, or leave it out")
        return None
    if arguments.epsilon is None:
        raise InputError(
            "--method effective-points needs --epsilon E; half of the tolerance that the points were made with is usual"
        )
    ends, limit = arguments.ends or (RangeEnds.OUTER, 0.0)
    choose = EffectiveOptions(arguments.epsilon, ends, limit)
    if arguments.embodiment != 2:
        if late := [name for name in ("before", "after", "move", "select") if name in given]:
            raise InputError(f"--{late[0]} belongs to --embodiment 2; give that too, or leave it out")
        return EffectiveMethod(choose, None, arguments.nearness, bool(arguments.across))
    move = CorrectionMove.PERPENDICULAR if arguments.move == "perpendicular" else CorrectionMove.NEAREST
    correct = second_embodiment(arguments.select, arguments.before, arguments.after, move)
    return EffectiveMethod(choose, correct, arguments.nearness, bool(arguments.across))


def _pair(kinds: dict[str, Kind]) -> Callable[[str], tuple[Kind, float]]:
    """Return a reader of a kind and its number, for argparse."""

    def read(text: str) -> tuple[Kind, float]:
        name, _, value = text.partition(":")
        if name not in kinds or not value:
            raise argparse.ArgumentTypeError(f"is wrong: '{text}'; write {either(f'{kind}:0.25' for kind in kinds)}")
        return kinds[name], number("value", least=0.0)(value)

    return read
