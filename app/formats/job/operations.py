"""The operations of a job file: which keys each kind has."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

from ...model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from ...model.operation import OPERATION_KINDS, ContourOperation, Cut, Direction, Operation, Side
from .tables import Table, read_angle, read_flag, read_number, read_points, read_share, read_texts, read_whole, word

_MILLS = ("pocket", "rest", "contour")


KEYS: dict[str, tuple[Callable[[Any], Any], str, tuple[str, ...]]] = {
    "kind": (word(OPERATION_KINDS, "kind of operation"), "kind", tuple(OPERATION_KINDS)),
    "tool": (read_whole, "cut.tool", tuple(OPERATION_KINDS)),
    "depth": (read_number, "cut.depth", tuple(OPERATION_KINDS)),
    "stepdown": (read_number, "cut.stepdown", _MILLS),
    "stepover": (read_number, "stepover", ("pocket", "rest")),
    "stock_to_leave": (read_number, "cut.stock_to_leave", _MILLS),
    "direction": (word({each.value: each for each in Direction}, "direction"), "cut.direction", _MILLS),
    "enabled": (read_flag, "cut.enabled", tuple(OPERATION_KINDS)),
    "layers": (read_texts, "cut.layers", tuple(OPERATION_KINDS)),
    "finish_depth": (read_number, "cut.finish_depth", _MILLS),
    "floor_to_leave": (read_number, "cut.floor_to_leave", _MILLS),
    "entry": (word({each.value: each for each in EntryKind}, "way into the metal"), "entry.kind", _MILLS),
    "entry_angle": (read_angle, "entry.angle", _MILLS),
    "most_engaged": (read_share, "most_engaged", _MILLS),
    "outside_in": (read_flag, "outside_in", ("pocket",)),
    "side": (word({each.value: each for each in Side}, "side"), "side", ("contour",)),
    "lead": (word({each.value: each for each in LeadKind}, "lead"), "lead.kind", ("contour",)),
    "lead_radius": (read_number, "lead.radius", ("contour",)),
    "lead_overlap": (read_number, "lead.overlap", ("contour",)),
    "tabs": (read_whole, "tabs.count", ("contour",)),
    "tab_width": (read_number, "tabs.width", ("contour",)),
    "tab_height": (read_number, "tabs.height", ("contour",)),
    "tab_places": (read_points, "tabs.places", ("contour",)),
    "spring_passes": (read_whole, "spring_passes", ("contour",)),
    "dog_bones": (read_flag, "dog_bones", ("contour",)),
    "finish_width": (read_number, "finish_width", ("contour",)),
    "finish_each_pass": (read_flag, "finish_each_pass", ("contour",)),
    "peck": (read_number, "peck", ("drill",)),
    "least": (read_number, "least", ("drill",)),
    "most": (read_number, "most", ("drill",)),
    "through": (read_number, "through", ("drill",)),
}
"""By key: how it is read, the field that it goes into, and the kinds of operation that it has an effect on."""

_DEFAULT = ContourOperation(Cut(tool=1))
_SLOPED = (lambda each: each.cut.entry.sloped, 'where the tool goes straight down; write entry = "helix" or "ramp"')
_LED = (lambda each: each.lead.wanted, 'without a lead; write lead = "arc" or "line"')
_HELD = (lambda each: each.tabs.wanted, "without tabs; add tabs = 4 or tab_places")
_NEEDS: dict[str, tuple[object, Callable[[Any], bool], str]] = {
    "entry_angle": (_DEFAULT.cut.entry.angle, *_SLOPED),
    "lead_radius": (_DEFAULT.lead.radius, *_LED),
    "lead_overlap": (_DEFAULT.lead.overlap, *_LED),
    "tab_width": (_DEFAULT.tabs.width, *_HELD),
    "tab_height": (_DEFAULT.tabs.height, *_HELD),
    "finish_each_pass": (False, lambda each: each.finish_width > 0, "without a finish pass; add finish_width = 0.2"),
}
"""By key: its default, which may stand anywhere; when another value has an effect; and what to do where it has none."""


def operations_of(tables: list[Table], kept: bool = False) -> Iterator[Operation]:
    """Yield the operations that tables [[operation]] describe.

    Args:
        tables: one each.
        kept: a key may be there that has no effect on an operation of this kind.

    Raises:
        InputError: a key is missing, unknown, out of its range, or has no effect.
    """
    for table in tables:
        given = tuple(table.values)
        for key, (read, target, _) in KEYS.items():
            table.take(key, read, target)
        table.done(", ".join(KEYS))
        for key, target in (("kind", "kind"), ("tool", "cut.tool")):
            if target not in table.taken:
                raise table.error(key, f"is missing in this [[operation]]; add {key} = …")
        kind = next(name for name, each in OPERATION_KINDS.items() if each is table.taken["kind"])
        for key in given:
            kept_anyway = kept and KEYS[key][1].startswith(("cut.", "entry."))
            if kind not in (kinds := KEYS[key][2]) and not kept_anyway:
                raise table.error(key, f"belongs to {_listed(kinds)} operations; remove it from this {kind} operation")
        operation = table.text.built("operation", table.index, lambda taken=table.taken: _operation(taken))  # type: ignore[misc]
        for key in given if not kept else ():
            default, has_effect, remedy = _NEEDS.get(key, (None, bool, ""))
            if remedy and table.taken[KEYS[key][1]] != default and not has_effect(operation):
                raise table.error(key, f"has no effect {remedy}, or take it out")
        yield operation


def _listed(kinds: tuple[str, ...]) -> str:
    return " and ".join([*([", ".join(kinds[:-1])] if len(kinds) > 1 else []), kinds[-1]])


def _operation(taken: dict[str, Any]) -> Operation:
    """Return the operation of values by field; those of its parts have the part's name before a dot."""
    of = {part: {name.partition(".")[2]: value for name, value in taken.items() if name.startswith(f"{part}.")}
          for part in ("cut", "entry", "lead", "tabs")}  # fmt: skip
    own = {name: value for name, value in taken.items() if "." not in name and name != "kind"}
    cut = Cut(**of["cut"], entry=Entry(**of["entry"]))
    if taken["kind"] is ContourOperation:
        return ContourOperation(cut, lead=Lead(**of["lead"]), tabs=Tabs(**of["tabs"]), **own)
    operation: Operation = taken["kind"](cut, **own)
    return operation
