"""Fusion's tool libraries: JSON (`.json`), or that in a zip archive (`.tools`), each tool in units of its own.

Read as its exports are written (version 36 and before): `data` lists tools with `type`, `unit`, `geometry` (DC cutting
diameter, RE corner radius, TA taper angle a side, SIG point angle, LCF flutes, LB below the holder, OAL overall, SFDM
shank, NOF flutes), `post-process` with the number, `holder` with its segments from below, `start-values` with presets.
"""

from __future__ import annotations

import io
import json
import lzma
import math
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from typing import Any, NamedTuple

from ...core.errors import MOST_QUOTED, InputError
from ...core.toml_tables import QUOTED, brief
from ...model.tool import FeedRow, HolderPoint
from ...model.tool_kind import ToolKind
from .foreign import (
    INCH,
    ForeignTool,
    NotUnderstoodError,
    Rates,
    Unreadable,
    edges_of,
    label_of,
    library_of,
    number_in,
    whole_in,
)
from .library import ReadTools

MOST_BYTES = 64 * 2**20
"""Of the text in an archive: no library comes near, and a small archive can hold any amount of nothing."""

_UNITS = {"millimeters": 1.0, "mm": 1.0, "inches": INCH, "in": INCH}
_STRAIGHT = {
    "flat end mill": ToolKind.FLAT,
    "ball end mill": ToolKind.BALL,
    "reamer": ToolKind.REAMER,
    "tap right hand": ToolKind.TAP,
    "thread mill": ToolKind.THREAD_MILL,
}
"""Types of which the diameter tells all."""

Json = Mapping[str, Any]


def read_fusion(name: str, data: bytes) -> ReadTools:
    """Return the tools of a library, and what of it is left out.

    Args:
        name: of the file. data: its bytes, JSON or a zip archive with it.

    Raises:
        InputError: it is none, or there is no tool in it.
    """
    tree = _tree(name, _text(name, data))
    entries = tree.get("data") if isinstance(tree, dict) else None
    if not isinstance(entries, list):
        raise InputError(f"{name}: this is no tool library of Fusion: it has no list 'data'; export the library anew.")
    return library_of(name, [_entry(each, at) for at, each in enumerate(entries, 1)])


def _text(name: str, data: bytes) -> bytes:
    """Return the JSON text, of an archive that of the one file in it that ends so."""
    if not data.startswith(b"PK"):
        return data
    try:
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            found = [each for each in archive.infolist() if each.filename.lower().endswith(".json")]
            if len(found) != 1:
                raise InputError(
                    f"{name}: the archive holds {len(found)} files .json, and a library has one; export it anew."
                )
            if found[0].file_size > MOST_BYTES:
                raise InputError(f"{name}: {found[0].filename} in the archive is too large for a library of tools.")
            with archive.open(found[0]) as file:
                return file.read(MOST_BYTES)
    except (zipfile.BadZipFile, zlib.error, lzma.LZMAError, ValueError, RuntimeError, OSError, EOFError) as error:
        raise InputError(
            f"{name}: the archive cannot be opened ({str(error)[:MOST_QUOTED]}); export the library anew."
        ) from error


def _tree(name: str, text: bytes) -> Any:
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{name}: this is no JSON text ({brief(str(error))}); export the library anew.") from error


def _entry(entry: Any, at: int) -> ForeignTool | Unreadable:
    if not isinstance(entry, dict):
        return Unreadable(f"entry {at}", "it is no tool")
    number = whole_in(_table(entry, "post-process"), "number")
    label = label_of(entry.get("description"), number)
    try:
        return _FusionEntry(entry).tool(label, number)
    except NotUnderstoodError as error:
        return Unreadable(label, str(error))


def _table(entry: Json, key: str) -> Json:
    value = entry.get(key)
    return value if isinstance(value, dict) else {}


class _Preset(NamedTuple):
    """Speed and feeds, and the name of what they are for."""

    name: str
    rates: Rates


class _FusionEntry:
    """Reads one entry."""

    def __init__(self, entry: Json) -> None:
        self._entry, self._geometry = entry, _table(entry, "geometry")
        unit = entry.get("unit")
        if not isinstance(unit, str) or unit not in _UNITS:
            raise NotUnderstoodError(f"its unit is {brief(repr(unit), QUOTED)}, neither millimeters nor inches")
        self._unit = _UNITS[unit]
        self._assumed: list[str] = []

    def tool(self, label: str, number: int) -> ForeignTool:
        """Return the tool.

        Raises:
            NotUnderstoodError: its type is none that cuts as we know it, or its numbers are none.
        """
        flutes = whole_in(self._geometry, "NOF") or 2
        values: dict[str, Any] = {
            **self._shape(),
            "name": label,
            "flutes": flutes,
            "flute_length": self._length("LCF"),
            "stick_out": self._length("LB"),
            "overall_length": self._length("OAL"),
            "shank_diameter": self._length("SFDM"),
            "tool_material": edges_of(self._entry.get("BMC")),
            "remark": self._remark(),
            "holder": self._holder(),
        }
        overall = values["overall_length"]
        for key, what in (("flute_length", "flutes"), ("stick_out", "length below the holder")):
            if overall and values[key] > overall:
                self._assumed.append(f"its {what} would be longer than the whole tool, so that is not taken over")
                values[key] = 0.0
        rates = list(self._presets())
        if rates:
            values |= rates[0].rates.values
        values["feeds"] = self._rows(rates, values["diameter"], flutes)
        return ForeignTool(label, number, values, tuple(self._assumed))

    def _length(self, key: str) -> float:
        return number_in(self._geometry, key) * self._unit

    def _angle(self, key: str) -> float:
        return math.radians(number_in(self._geometry, key))

    def _shape(self) -> dict[str, Any]:
        """Return kind and shape."""
        type_, diameter = str(self._entry.get("type")), self._length("DC")
        if type_ in _STRAIGHT:
            return {"kind": _STRAIGHT[type_], "diameter": diameter}
        if type_ in ("bull nose end mill", "face mill"):
            corner = self._length("RE")
            if type_ == "face mill" and self._angle("TA"):
                raise NotUnderstoodError("it is a face mill with slanted sides, which is none of our kinds")
            return {"kind": ToolKind.BULL if corner else ToolKind.FLAT, "diameter": diameter, "corner_radius": corner}
        if type_ == "drill":
            return {"kind": ToolKind.DRILL, "diameter": diameter, "tip_angle": self._angle("SIG")}
        if type_ == "chamfer mill":
            return self._cone(diameter, 2 * self._angle("TA"))
        if type_ in ("spot drill", "counter sink"):
            return self._cone(diameter, self._angle("SIG"))
        if type_ == "tapered mill":
            return self._tapered(diameter)
        raise NotUnderstoodError(f"its type '{brief(type_, QUOTED)}' is none of our kinds of tools")

    def _cone(self, diameter: float, angle: float) -> dict[str, Any]:
        if not angle:
            raise NotUnderstoodError("its angle is not told")
        return {
            "kind": ToolKind.V,
            "diameter": diameter,
            "tip_angle": angle,
            "tip_diameter": self._length("tip-diameter"),
        }

    def _tapered(self, tip: float) -> dict[str, Any]:
        """Return a cone from a tip on, whose diameter is DC: with a ball there, or flat; as wide as it is at the
        flutes' end, at most as the shank.
        """
        half, ball, flutes = self._angle("TA"), self._length("RE"), self._length("LCF")
        if not (0 < half < math.pi / 2 and flutes):
            raise NotUnderstoodError("its taper angle or its flute length is not told")
        if ball:
            if abs(2 * ball - tip) > 0.02 * tip:
                raise NotUnderstoodError("its tip is neither a ball nor flat")
            widest = 2 * (ball * math.cos(half) + (flutes - ball * (1 - math.sin(half))) * math.tan(half))
        else:
            widest = tip + 2 * flutes * math.tan(half)
        shank = self._length("SFDM")
        widest = min(widest, shank) if shank > tip else widest
        return {
            "kind": ToolKind.TAPER if ball else ToolKind.V,
            "diameter": widest,
            "tip_diameter": tip,
            "tip_angle": 2 * half,
        }

    def _remark(self) -> str:
        parts = (
            self._entry.get("vendor"),
            self._entry.get("product-id"),
            _table(self._entry, "post-process").get("comment"),
        )
        return " ".join(" ".join(part.split()) for part in parts if isinstance(part, str) and part.strip())

    def _holder(self) -> tuple[HolderPoint, ...]:
        """Return the outline of the holder, in units of its own: segments from below, each a frustum."""
        holder = _table(self._entry, "holder")
        segments = holder.get("segments")
        if not isinstance(segments, list) or not segments:
            return ()
        unit, height, points = _UNITS.get(str(holder.get("unit")), self._unit), 0.0, list[HolderPoint]()
        try:
            for each in segments:
                points.append((height, number_in(each, "lower-diameter") * unit / 2))
                height += number_in(each, "height") * unit
                points.append((height, number_in(each, "upper-diameter") * unit / 2))
        except (NotUnderstoodError, AttributeError):
            self._assumed.append("its holder is not understood and not taken over")
            return ()
        return tuple(point for k, point in enumerate(points) if not k or point != points[k - 1])

    def _presets(self) -> Iterator[_Preset]:
        """Yield speed and feeds by what they are for; feeds are in the tool's unit a minute."""
        start = _table(self._entry, "start-values")
        presets = start.get("presets")
        for preset in presets if isinstance(presets, list) else [start.get("*")]:
            if not isinstance(preset, dict):
                continue
            query = _table(preset, "material").get("query")
            name = query if isinstance(query, str) and query.strip() else str(preset.get("name") or "")
            try:
                speed = number_in(preset, "n")
                plunge = number_in(preset, "v_f_plunge") * self._unit
                feed = number_in(preset, "v_f") * self._unit or plunge
            except NotUnderstoodError as error:
                self._assumed.append(f"of its preset '{brief(name, QUOTED)}' {error}, so that is not taken over")
                continue
            yield _Preset(name, Rates(speed, feed, plunge))

    def _rows(self, presets: list[_Preset], diameter: float, flutes: int) -> tuple[FeedRow, ...]:
        """Return rows of feeds, each material once."""
        rows: dict[str, FeedRow] = {}
        for name, rates in presets:
            row = rates.row(name, diameter, flutes)
            if row is None:
                continue
            if row.material.casefold() in rows:
                self._assumed.append(f"a second preset for '{brief(name, QUOTED)}' is not taken over")
            rows.setdefault(row.material.casefold(), row)
        return tuple(rows.values())
