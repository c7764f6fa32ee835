"""FreeCAD's tool bits: `.fctb`, a JSON text each, with quantities as texts ("5.00 mm", "90 °"); a library (`.fctl`)
gives them numbers.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping
from pathlib import PurePath
from typing import Any

from ...core.errors import InputError
from ...core.toml_tables import QUOTED, brief
from ...model.tool_kind import ToolKind
from .foreign import ForeignTool, NotUnderstoodError, Unreadable, edges_of, label_of, library_of, quantity, whole_in
from .library import ReadTools

Json = Mapping[str, Any]


def read_bit(name: str, data: bytes) -> ReadTools:
    """Return the tool of a bit's file.

    Raises:
        InputError: it is none, or a bit that is none of our kinds of tools.
    """
    return library_of(name, [_entry(name, data, 0)])


def read_bits(name: str, bits: Mapping[str, bytes], libraries: Mapping[str, bytes]) -> ReadTools:
    """Return the tools of many bits' files, with the numbers that a library has for them.

    Args:
        name: of the library or the folder, for sentences.
        bits: by their file's path. libraries: by theirs; a bit that none of them has gets a free number.

    Raises:
        InputError: a library is none, or no bit makes a tool.
    """
    numbers: dict[str, int] = {}
    missing: list[Unreadable] = []
    names = {PurePath(path).name: path for path in bits}
    for library, data in libraries.items():
        for each in _listed(library, data):
            bit = PurePath(str(each.get("path", "")).replace("\\", "/")).name
            number = whole_in(each, "nr")
            if bit in names:
                numbers.setdefault(names[bit], number)
            else:
                missing.append(
                    Unreadable(f"T{number}", f"its file {brief(bit, QUOTED) or 'that is not named'} is not there")
                )
    return library_of(name, [*(_entry(path, data, numbers.get(path, 0)) for path, data in bits.items()), *missing])


def _listed(name: str, data: bytes) -> list[Json]:
    tree = _tree(name, data)
    tools = tree.get("tools")
    if not isinstance(tools, list):
        raise InputError(f"{name}: this is no library of FreeCAD: it has no list 'tools'.")
    return [each for each in tools if isinstance(each, dict)]


def _tree(name: str, data: bytes) -> Json:
    try:
        tree = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{name}: this is no JSON text ({brief(str(error))}); save it anew from FreeCAD.") from error
    if not isinstance(tree, dict):
        raise InputError(f"{name}: this is no file of FreeCAD's tools; save it anew.")
    return tree


def _entry(path: str, data: bytes, number: int) -> ForeignTool | Unreadable:
    file = PurePath(path)
    try:
        tree = _tree(file.name, data)
    except InputError as error:
        return Unreadable(file.name, str(error).removeprefix(f"{file.name}: ").rstrip("."))
    label = label_of(tree.get("name") or file.stem, number)
    try:
        return _tool(tree, label, number)
    except NotUnderstoodError as error:
        return Unreadable(label, str(error))


def _tool(tree: Json, label: str, number: int) -> ForeignTool:
    shape = PurePath(str(tree.get("shape") or tree.get("shape-type") or "").replace("\\", "/")).name.lower()
    shape = shape.removesuffix(".fcstd").replace("-", "").replace("_", "")
    parameters = tree.get("parameter")
    bit = _Bit(parameters if isinstance(parameters, dict) else {})
    if shape not in _SHAPES:
        raise NotUnderstoodError(f"its shape '{brief(shape, QUOTED)}' is none of our kinds of tools")
    attributes = tree.get("attribute")
    more = attributes if isinstance(attributes, dict) else {}
    values: dict[str, Any] = {
        **_SHAPES[shape](bit),
        "name": label,
        "flutes": bit.whole("Flutes") or _Bit(more).whole("Flutes") or 2,
        "flute_length": bit.length("CuttingEdgeHeight"),
        "overall_length": bit.length("Length"),
        "stick_out": bit.length("Stickout"),
        "shank_diameter": bit.length("ShankDiameter"),
        "tool_material": edges_of(bit.values.get("Material") or more.get("Material")),
    }
    assumed = list(bit.assumed)
    overall = values["overall_length"]
    if overall and values["flute_length"] > overall:
        assumed.append("its cutting edge would be longer than the whole tool, so that is not taken over")
        values["flute_length"] = 0.0
    if bit.length("Chipload") or quantity(more.get("Chipload"), "Chipload"):
        assumed.append("its chip load has no surface speed beside it, so that is not taken over")
    return ForeignTool(label, number, values, tuple(assumed))


class _Bit:
    """The parameters of a bit."""

    def __init__(self, values: Json) -> None:
        self.values, self.assumed = values, list[str]()

    def length(self, key: str) -> float:
        """Return a length, mm; 0 where there is none."""
        return quantity(self.values.get(key), key)

    def angle(self, key: str) -> float:
        """Return an angle, radians; 0 where there is none."""
        return quantity(self.values.get(key), key, angle=True)

    def whole(self, key: str) -> int:
        """Return a whole number; 0 where there is none."""
        value = self.values.get(key)
        return int(value) if isinstance(value, str) and value.strip().isdecimal() else whole_in(self.values, key)


def _of_kind(kind: ToolKind) -> Callable[[_Bit], dict[str, Any]]:
    return lambda bit: {"kind": kind, "diameter": bit.length("Diameter")}


def _bull(bit: _Bit) -> dict[str, Any]:
    corner = bit.length("CornerRadius") or bit.length("TorusRadius")
    flat = bit.length("FlatRadius")
    if not corner and flat:
        corner = bit.length("Diameter") / 2 - flat
        bit.assumed.append(f"its corner radius is taken to be what its flat of {flat:g} mm leaves, {corner:g} mm")
    kind = ToolKind.BULL if corner else ToolKind.FLAT
    return {"kind": kind, "diameter": bit.length("Diameter"), "corner_radius": corner}


def _cone(bit: _Bit) -> dict[str, Any]:
    angle = bit.angle("CuttingEdgeAngle")
    if not angle:
        raise NotUnderstoodError("its CuttingEdgeAngle is not told")
    return {
        "kind": ToolKind.V,
        "diameter": bit.length("Diameter"),
        "tip_angle": angle,
        "tip_diameter": bit.length("TipDiameter"),
    }


def _drill(bit: _Bit) -> dict[str, Any]:
    return {"kind": ToolKind.DRILL, "diameter": bit.length("Diameter"), "tip_angle": bit.angle("TipAngle")}


def _tapered(bit: _Bit) -> dict[str, Any]:
    values = {
        "kind": ToolKind.TAPER,
        "diameter": bit.length("TaperDiameter"),
        "tip_diameter": bit.length("Diameter"),
        "tip_angle": bit.angle("TaperAngle"),
    }
    if not all(values.values()):
        raise NotUnderstoodError("its TaperDiameter, Diameter or TaperAngle is not told")
    return values


_SHAPES: dict[str, Callable[[_Bit], dict[str, Any]]] = {
    "endmill": _of_kind(ToolKind.FLAT),
    "ballend": _of_kind(ToolKind.BALL),
    "bullnose": _bull,
    "torus": _bull,
    "vbit": _cone,
    "chamfer": _cone,
    "drill": _drill,
    "reamer": _of_kind(ToolKind.REAMER),
    "tap": _of_kind(ToolKind.TAP),
    "threadmill": _of_kind(ToolKind.THREAD_MILL),
    "taperedballnose": _tapered,
}
"""By the name of the shape's file, without hyphens and suffix."""
