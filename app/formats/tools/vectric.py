"""Vectric's tool database, `.vtdb`: SQLite. A tool's shape is in `tool_geometry`, speeds and feeds by material and
machine in `tool_cutting_data`, which `tool_entity` joins to it; names are in `tool_tree_entry`, or a template of the
shape.
"""

from __future__ import annotations

import math
import re
import sqlite3
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ...core.errors import InputError
from ...core.toml_tables import QUOTED, brief
from ...model.tool import FeedRow
from ...model.tool_kind import ToolKind
from .foreign import INCH, ForeignTool, NotUnderstoodError, Rates, Unreadable, label_of, library_of, number_in, whole_in
from .library import ReadTools

_KINDS = {
    0: ToolKind.BALL,
    1: ToolKind.FLAT,
    2: ToolKind.BULL,
    3: ToolKind.V,
    4: ToolKind.V,
    5: ToolKind.TAPER,
    6: ToolKind.DRILL,
}
"""By `tool_type`; 4 is an engraving tool, a V with a flat."""

_OTHERS = {7: "a thread mill", 8: "a form tool", 9: "a diamond drag"}
_RATES = {1: 1.0, 4: INCH}
"""mm/min by `rate_units`: those that libraries are seen to use."""

Json = Mapping[str, Any]


def read_vectric(name: str, data: bytes) -> ReadTools:
    """Return the tools of a database, and what of it is left out.

    Raises:
        InputError: it is none, or there is no tool in it.
    """
    connection = sqlite3.connect(":memory:")
    try:
        if not data:  # of nothing SQLite would say that memory is short
            raise sqlite3.DatabaseError("the file is empty")
        connection.deserialize(data)
        connection.execute("PRAGMA trusted_schema = OFF")
        connection.row_factory = sqlite3.Row
        return library_of(name, list(_Database(connection).entries()))
    except (sqlite3.Error, OverflowError) as error:
        raise InputError(
            f"{name}: this is no tool database of Vectric ({brief(str(error))}); export it anew as .vtdb."
        ) from error
    finally:
        connection.close()


class _Cut(NamedTuple):
    """A row of cutting data, and the name of the material that it is for."""

    material: str
    values: Json


class _Database:
    """The tables of a file."""

    def __init__(self, connection: sqlite3.Connection) -> None:
        self._connection = connection
        found = self._rows("SELECT name FROM sqlite_master WHERE type = 'table'")
        self._tables = {str(row["name"]) for row in found}

    def _rows(self, query: str) -> list[dict[str, Any]]:
        return [dict(row) for row in self._connection.execute(query)]

    def entries(self) -> Iterator[ForeignTool | Unreadable]:
        """Yield a tool a shape, in the order of the tree where there is one."""
        names, materials = {}, {}
        if "tool_tree_entry" in self._tables:
            for row in self._rows("SELECT * FROM tool_tree_entry WHERE tool_geometry_id IS NOT NULL"):
                names[row["tool_geometry_id"]] = row.get("name")
        if "material" in self._tables:
            materials = {row["id"]: str(row.get("name") or "") for row in self._rows("SELECT * FROM material")}
        cuts: dict[Any, list[dict[str, Any]]] = {}
        joined = (
            "SELECT e.tool_geometry_id, e.material_id, d.* FROM tool_entity e "
            "JOIN tool_cutting_data d ON d.id = e.tool_cutting_data_id"
        )
        for row in self._rows(joined):
            cuts.setdefault(row["tool_geometry_id"], []).append(row)
        for shape in self._rows("SELECT * FROM tool_geometry"):
            own = cuts.get(shape["id"], [])
            number = next((found for each in own if (found := whole_in(each, "tool_number"))), 0)
            label = label_of(names.get(shape["id"]) or _rendered(shape), number)
            try:
                yield _tool(shape, [_Cut(materials.get(each["material_id"], ""), each) for each in own], label, number)
            except NotUnderstoodError as error:
                yield Unreadable(label, str(error))


def _tool(shape: Json, cuts: list[_Cut], label: str, number: int) -> ForeignTool:
    if shape.get("units") not in (0, 1):
        raise NotUnderstoodError(f"its units have the code {brief(repr(shape.get('units')), QUOTED)}")
    unit, assumed = INCH if shape["units"] == 1 else 1.0, list[str]()
    diameter, flutes = number_in(shape, "diameter") * unit, whole_in(shape, "num_flutes") or 2
    values: dict[str, Any] = {
        **_shape(shape, unit, assumed),
        "diameter": diameter,
        "name": label,
        "flutes": flutes,
        "flute_length": number_in(shape, "flute_length") * unit,
        "remark": " ".join(str(shape.get("notes") or "").split()),
    }
    rows: dict[str, FeedRow] = {}
    for material, cut in cuts:
        rates = _rates(cut, material, assumed)
        if rates is None:
            continue
        if "spindle_speed" not in values:
            values |= rates.values
        row = rates.row(material, diameter, flutes)
        if row is not None:
            rows.setdefault(row.material.casefold(), row)
    values["feeds"] = tuple(rows.values())
    return ForeignTool(label, number, values, tuple(dict.fromkeys(assumed)))


def _shape(shape: Json, unit: float, assumed: list[str]) -> dict[str, Any]:
    type_ = shape.get("tool_type")
    kind = _KINDS.get(type_) if isinstance(type_, int) else None
    if kind is None:
        what = _OTHERS.get(type_, f"of type {brief(repr(type_), QUOTED)}") if isinstance(type_, int) else "of no type"
        raise NotUnderstoodError(f"it is {what}, which is none of our kinds of tools")
    angle, tip = math.radians(number_in(shape, "included_angle")), number_in(shape, "tip_radius") * unit
    if kind is ToolKind.BULL:
        return {"kind": kind, "corner_radius": tip} if tip else {"kind": ToolKind.FLAT}
    if kind in (ToolKind.V, ToolKind.TAPER) and not angle:
        raise NotUnderstoodError("its angle is not told")
    if kind is ToolKind.V:
        return {"kind": kind, "tip_angle": angle, "tip_diameter": number_in(shape, "flat_diameter") * unit}
    if kind is ToolKind.TAPER:
        if not tip:
            raise NotUnderstoodError("its tip radius is not told")
        assumed.append(f"its angle of {math.degrees(angle):g} degrees is taken to be that of one side")
        return {"kind": kind, "tip_angle": 2 * angle, "tip_diameter": 2 * tip}
    return {"kind": kind, "tip_angle": angle} if kind is ToolKind.DRILL and angle else {"kind": kind}


def _rates(cut: Json, material: str, assumed: list[str]) -> Rates | None:
    """Return speed and feeds for a material; None where they are not told, or in units that are not known."""
    try:
        speed, feed, plunge = (number_in(cut, key) for key in ("spindle_speed", "feed_rate", "plunge_rate"))
    except NotUnderstoodError as error:
        assumed.append(f"of its feeds {error}, so they are not taken over")
        return None
    if not (speed or feed or plunge):
        return None
    unit = _RATES.get(cut.get("rate_units"))  # type: ignore[arg-type]  # whatever a file has there
    if unit is None:
        where = f" for {brief(material, QUOTED)}" if material else ""
        assumed.append(f"its feeds{where} have units of the code {cut.get('rate_units')!r}, so they are not taken over")
        return None
    return Rates(speed, feed * unit, plunge * unit)


def _rendered(shape: Json) -> str:
    """Return the name that a shape's template makes, such as "{Tool Type} ({Diameter|F}{Units Short})"."""
    words = {
        "Tool Type": {0: "Ball Nose", 1: "End Mill", 2: "Radiused End Mill", 3: "V-Bit", 4: "Engraving"}.get(
            shape.get("tool_type") or 0, "Tool"
        ),
        "Diameter": _plain(shape.get("diameter")),
        "Included Angle": _plain(shape.get("included_angle")),
        "Side Angle": _plain(shape.get("included_angle")),
        "Flat Diameter": _plain(shape.get("flat_diameter")),
        "Tip Radius": _plain(shape.get("tip_radius")),
        "Units Short": " in" if shape.get("units") == 1 else " mm",
    }
    template = str(shape.get("name_format") or "{Tool Type} {Diameter}{Units Short}")
    return re.sub(r"\{([^{}|]{1,40})(?:\|[^{}]{0,20})?\}", lambda match: words.get(match[1].strip(), ""), template)


def _plain(value: Any) -> str:
    return f"{value:g}" if isinstance(value, int | float) else "?"
