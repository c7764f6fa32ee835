"""The curves that a command means: those it names, or what is selected."""

from __future__ import annotations

from ...core.errors import InputError
from ...model.curves import Curve
from ..expressions.arguments import Arguments
from .command import DraftingSession, check_ids


def chosen_curves(words: Arguments, session: DraftingSession, verb: str) -> dict[int, Curve]:
    """Return the curves that the rest of a command names, or those selected, by number; notes are passed over.

    Raises:
        InputError: there are none, or the drawing lacks one; `verb` says what was to be done with them.
    """
    ids = frozenset(words.ids())
    check_ids(session.part, ids)
    ids = ids or session.selection
    curves = {e.id: e.curve for e in session.part.entities if e.id in ids}
    if ids and not curves:
        raise InputError(
            f"Only points, construction lines and dimensions are chosen; select curves to {verb}, or write their "
            "numbers."
        )
    if not curves:
        raise InputError(f"Nothing is selected; select what to {verb}, or write its numbers after the command.")
    words.takes(curves.values())
    return curves
