"""Files of tools as other programs write them, by their published structure: Fusion, FreeCAD, Vectric."""

from __future__ import annotations

import io
import json
import sqlite3
import uuid
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

Json = dict[str, Any]


def fusion_tool(type_: str = "flat end mill", number: int = 1, unit: str = "millimeters", **more: Any) -> Json:
    """Return an entry of a library; `more`: keys of the geometry, or of the entry where it has them."""
    geometry = {"CSP": False, "DC": 6.0, "HAND": True, "LB": 25.0, "LCF": 15.0, "NOF": 3, "OAL": 57.0, "SFDM": 6.0}
    entry: Json = {
        "BMC": "carbide",
        "GRADE": "Mill Generic",
        "description": f"{type_} {number}",
        "geometry": geometry,
        "guid": str(uuid.UUID(int=number)),
        "post-process": {"break-control": False, "comment": "", "live": True, "number": number, "turret": 0},
        "product-id": "",
        "start-values": {"presets": []},
        "type": type_,
        "unit": unit,
        "vendor": "",
    }
    for key, value in more.items():
        (entry if key in ("BMC", "description", "holder", "start-values", "post-process") else geometry)[
            key.replace("_", "-") if key.startswith("tip_") else key
        ] = value
    return entry


def preset(material: str, n: float, v_f: float, v_f_plunge: float) -> Json:
    """Return speed and feeds for a material."""
    return {
        "description": "",
        "material": {"category": "all", "query": material, "use-hardness": False},
        "n": n,
        "name": "Default preset",
        "tool-coolant": "flood",
        "v_f": v_f,
        "v_f_plunge": v_f_plunge,
    }


def fusion_json(entries: Sequence[Any]) -> bytes:
    """Return a library as JSON."""
    return json.dumps({"data": list(entries), "version": 36}).encode()


def fusion_archive(entries: Sequence[Any]) -> bytes:
    """Return a library as `.tools`."""
    made = io.BytesIO()
    with zipfile.ZipFile(made, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("tools.json", fusion_json(entries))
    return made.getvalue()


def bit(shape: str, name: str = "bit", attribute: Json | None = None, **parameter: Any) -> bytes:
    """Return a bit of FreeCAD."""
    return json.dumps(
        {
            "version": 2,
            "name": name,
            "shape": f"{shape}.fcstd",
            "parameter": parameter,
            "attribute": attribute or {},
        }
    ).encode()


def bit_library(bits: dict[int, str]) -> bytes:
    """Return a library of FreeCAD: bits' files by number."""
    return json.dumps(
        {"label": "Default", "tools": [{"nr": nr, "path": path} for nr, path in bits.items()], "version": 1}
    ).encode()


SCHEMA = """
CREATE TABLE version (version INTEGER NOT NULL UNIQUE, PRIMARY KEY(version));
CREATE TABLE material (id TEXT NOT NULL UNIQUE, name TEXT NOT NULL UNIQUE, PRIMARY KEY(id));
CREATE TABLE machine (id TEXT NOT NULL UNIQUE, name TEXT, make TEXT, model TEXT, PRIMARY KEY(id));
CREATE TABLE tool_geometry (id TEXT NOT NULL UNIQUE, name_format TEXT, notes TEXT, tool_type INTEGER, units INTEGER,
  diameter REAL, included_angle REAL, flat_diameter REAL, num_flutes INTEGER, flute_length REAL, thread_pitch REAL,
  outline BLOB, tip_radius REAL, laser_watt INTEGER, custom_attributes TEXT, PRIMARY KEY(id));
CREATE TABLE tool_cutting_data (id TEXT NOT NULL UNIQUE, rate_units INTEGER, feed_rate REAL, plunge_rate REAL,
  spindle_speed INTEGER, spindle_dir INTEGER, stepdown REAL, stepover REAL, notes TEXT, tool_number INTEGER,
  length_units INTEGER NOT NULL DEFAULT 0, PRIMARY KEY(id));
CREATE TABLE tool_entity (id TEXT NOT NULL UNIQUE, material_id TEXT, machine_id TEXT, tool_geometry_id TEXT,
  tool_cutting_data_id TEXT NOT NULL);
CREATE TABLE tool_tree_entry (id TEXT NOT NULL UNIQUE, parent_group_id TEXT, sibling_order INTEGER NOT NULL,
  tool_geometry_id TEXT UNIQUE, name TEXT, notes TEXT, expanded INTEGER);
"""


def vectric(tools: Sequence[Json], path: Path) -> bytes:
    """Return a database; each tool: columns of its shape, `name`, and `cuts`, columns of cutting data with `material`.

    Args:
        path: of a file that may be made.
    """
    with sqlite3.connect(path) as base:
        base.executescript(SCHEMA)
        materials: dict[str, str] = {}
        for k, tool in enumerate(tools):
            shape = {"units": 0, "num_flutes": 2, **{key: tool[key] for key in tool if key not in ("name", "cuts")}}
            _insert(base, "tool_geometry", {"id": f"g{k}", **shape})
            if "name" in tool:
                entry = {"id": f"t{k}", "sibling_order": k, "tool_geometry_id": f"g{k}", "name": tool["name"]}
                _insert(base, "tool_tree_entry", entry)
            for j, cut in enumerate(tool.get("cuts", ())):
                values = {key: value for key, value in cut.items() if key != "material"}
                name = cut.get("material")
                if name and name not in materials:
                    materials[name] = f"m{len(materials)}"
                    _insert(base, "material", {"id": materials[name], "name": name})
                _insert(base, "tool_cutting_data", {"id": f"c{k}.{j}", "rate_units": 1, **values})
                entity = {"id": f"e{k}.{j}", "tool_geometry_id": f"g{k}", "tool_cutting_data_id": f"c{k}.{j}"}
                _insert(base, "tool_entity", {**entity, "material_id": materials.get(name or "")})
    base.close()
    return path.read_bytes()


def _insert(base: sqlite3.Connection, table: str, values: Json) -> None:
    places = ", ".join("?" * len(values))
    base.execute(f"INSERT INTO {table} ({', '.join(values)}) VALUES ({places})", list(values.values()))
