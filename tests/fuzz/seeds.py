"""Small inputs of every kind that read well: what mutations begin with."""

from __future__ import annotations

import io
import json
import tempfile
from dataclasses import asdict
from functools import cache
from itertools import islice
from pathlib import Path
from typing import Any

import cv2
import ezdxf
import numpy as np
import trimesh
from fontTools.fontBuilder import FontBuilder
from fontTools.pens.ttGlyphPen import TTGlyphPen

from app.core.settings import Settings
from app.drafting.document import drawn
from app.drafting.history import HistoryState
from app.drafting.recorded_lines import RecordedLine
from app.formats.project.project import Project, write_project
from app.formats.tools.files import read_tools, write_tools
from app.formats.tools.library import ToolLibrary
from app.model.job import Job
from tests.conftest import ROOT
from tests.formats import foreign_tools
from tests.formats.test_svg_damage import RICH
from tests.fuzz.any_solid import written
from tests.gcode.interpreter.rs274_programs import PROGRAMS
from tests.surfaces import solids

DATA, RESOURCES, GOLDEN = ROOT / "tests" / "data", ROOT / "resources", ROOT / "tests" / "gcode" / "golden"
WHERE = b'{"x0": -1.5, "y0": 2, "pitch": 0.5, "floor": -3.0}\n'


def _files(folder: Path, pattern: str, most: int = 40_000) -> tuple[bytes, ...]:
    return tuple(
        path.read_bytes() for path in sorted(folder.glob(pattern)) if path.is_file() and path.stat().st_size <= most
    )


def _dxf_document(version: str) -> Any:
    """A drawing with one of everything that is read, and some that is not."""
    document = ezdxf.new(version)
    document.header["$INSUNITS"] = 4
    block = document.blocks.new("B")
    block.add_lwpolyline([(0, 0, 0.5), (4, 0, 0), (4, 3, -0.2)], format="xyb", close=True)
    block.add_circle((1, 1), 0.5)
    space = document.modelspace()
    space.add_line((0, 0), (40, 0), dxfattribs={"layer": "CUT"})
    space.add_arc((40, 5), 5, -90, 90)
    space.add_ellipse((20, 20), (8, 2), 0.4, 0.3, 4.0)
    space.add_spline([(0, 30), (10, 40), (20, 25), (30, 33)])
    space.add_open_spline([(0, 50), (5, 60), (10, 50), (15, 55), (20, 50)], 3)
    space.add_rational_spline([(0, 70), (5, 80), (10, 70), (15, 75)], [1, 2, 0.5, 1], 4)
    space.add_polyline2d([(50, 0, 0.3), (60, 0, 0), (60, 10, 1)], format="xyb", close=True)
    space.add_blockref(
        "B", (30, 60), dxfattribs={"xscale": 2, "yscale": -1, "rotation": 30, "column_count": 2, "column_spacing": 9}
    )
    space.add_text("R5", height=3).set_placement((5, 90))
    space.add_mtext("two\\Plines", dxfattribs={"char_height": 2, "insert": (5, 100)})
    hatch = space.add_hatch()
    hatch.paths.add_polyline_path([(70, 0), (80, 0), (80, 8, 0.4)], is_closed=True)
    edges = hatch.paths.add_edge_path()
    edges.add_line((70, 20), (80, 20))
    edges.add_arc((75, 20), 5, 0, 180)
    space.add_point((1, 2))
    space.add_lwpolyline([(0, 0, 1, 3, 0), (50, 10, 0, 2, 0)], format="xyseb")
    if version >= "R2000":
        look = {"char_height": 2, "flow_direction": 3}
        space.add_mtext_dynamic_auto_height_columns("H e l l o", 9, 2, 7, 2, dxfattribs=look)
    space.add_solid([(90, 0), (95, 0), (90, 5), (95, 5)])
    return document


def _dxf_bytes(version: str, binary: bool) -> bytes:
    out: Any = io.BytesIO() if binary else io.StringIO()
    _dxf_document(version).write(out, fmt="bin" if binary else "asc")
    return out.getvalue() if binary else out.getvalue().encode()


def _entities_alone(data: bytes) -> bytes:
    """Of a DXF the section of entities and blocks: what is small is hit more often."""
    begin, end = data.find(b"  0\nSECTION\n  2\nBLOCKS"), data.find(b"  0\nSECTION\n  2\nOBJECTS")
    return data[begin:end] + b"  0\nEOF\n"


@cache
def dxf() -> tuple[bytes, ...]:
    whole = [_dxf_bytes(version, binary=False) for version in ("R2000", "R2010")]
    return (*_files(DATA / "dxf", "*.dxf", 26_000), whole[0], _entities_alone(whole[0]), _entities_alone(whole[1]))


@cache
def binary_dxf() -> tuple[bytes, ...]:
    return tuple(_dxf_bytes(version, binary=True) for version in ("R2000", "R2010"))


@cache
def svg() -> tuple[bytes, ...]:
    lengths = (
        b'<svg xmlns="http://www.w3.org/2000/svg" width="calc(40mm + 2em)" viewBox="0 0 90 60" style="font-size:9px">'
        b'<style>.a{width:calc((3em - 2px)*2);font:bold 120%/1 Arial}</style><g font-size="larger">'
        b'<rect class="a" x="10%" y="1rem" height="2ex" rx="1ch"/><circle cx="50%" cy="3em" r="calc(5% + 1mm)"/>'
        b"</g></svg>"
    )
    clips = (
        b'<svg xmlns="http://www.w3.org/2000/svg" width="40mm" height="40mm" viewBox="0 0 40 40">'
        b'<rect width="100%" height="100%" fill="white"/><clipPath id="c" clip-rule="evenodd"><path d="M0 0h9v9h-9z'
        b'M2 2h3v3h-3z" transform="rotate(9)"/><use href="#d"/></clipPath><mask id="m" style="mask-type:alpha">'
        b'<g fill="#777"><circle id="d" cx="9" cy="9" r="7"/></g></mask><style>g:not([id^="x"]){fill:red}</style>'
        b'<g clip-path="url(#c)"><path d="M1 1h20v20z" mask="url(#m)"/></g><svg x="9" width="9" height="9">'
        b'<rect width="20" height="5"/></svg><text>A<tspan>b</tspan></text></svg>'
    )
    return (RICH.encode(), lengths, clips, *_files(DATA / "svg", "*.svg"))


@cache
def draw() -> tuple[bytes, ...]:
    more = b"""let w = 60 + 2
define bolt(c, r)
  circle c r
end
repeat 3 as i
  let p = polar(0,0, 20, 9*i)
  bolt p 2+i
end
polyline 0,0 10,0 arc 15,5 10,10 close
arc 0,0 10,0 radius 8 cw
ellipse 50,50 60,50 4 from 0 to 200
spline 0,0 10,10 20,0 30,5
text 5,5 4 "Ab1" angle 10
slot 0,30 20,30 6
polygon 6 50,20 60,20
rect 70,0 90,9
fillet 2 31-34
offset 1.5 80,20 31-34 round
array 2 2 @10,10 3
mirror 0,0 1,1 copy 4
measure 1-3
"""
    return (*_files(RESOURCES / "samples", "*.draw"), more)


@cache
def project() -> tuple[bytes, ...]:
    part = drawn(
        'layer "CUT"\nrect 0,0 20,10 round 2\ncircle 5,5 2\nellipse 9,5 12,5 1\nspline 0,0 5,9 9,2 12,4\ntext 3,3 2 "A"'
    )
    state = HistoryState(Job(part), "CUT", (1.0, 2.0), {"w": 3.0, "p": (1.0, 2.0)}, {}, RecordedLine(part))
    return (*_files(DATA, "*.hito"), write_project(Project(state)))


@cache
def recovery() -> tuple[bytes, ...]:
    note = b'# recovery of ["/tmp/a.hito", [1, 2, 3]]\n'
    return tuple(note + each for each in project())


@cache
def pictures() -> tuple[bytes, ...]:
    gray = np.zeros((24, 30), np.uint8)
    gray[4:20, 6:20] = 255
    made = [
        cv2.imencode(suffix, image)[1].tobytes()
        for suffix in (".png", ".jpg", ".bmp")
        for image in (gray, cv2.cvtColor(gray, cv2.COLOR_GRAY2BGR))
    ]
    deep = cv2.imencode(".png", gray.astype(np.uint16) * 257)[1].tobytes()
    return (*made, deep, *_files(DATA / "figures", "fig*.png", 7000))


@cache
def fonts() -> tuple[bytes, ...]:
    builder, pen = FontBuilder(1000, isTTF=True), TTGlyphPen(None)
    pen.moveTo((0, 0))
    pen.lineTo((500, 0))
    pen.qCurveTo((700, 300), (500, 700))
    pen.closePath()
    glyph = pen.glyph()
    names = [".notdef", "H", "O", "i"]
    builder.setupGlyphOrder(names)
    builder.setupCharacterMap({ord("H"): "H", ord("O"): "O", ord("i"): "i"})
    builder.setupGlyf(dict.fromkeys(names, glyph))
    builder.setupHorizontalMetrics(dict.fromkeys(names, (600, 0)))
    builder.setupHorizontalHeader(ascent=800, descent=-200)
    builder.setupNameTable({"familyName": "Small"})
    builder.setupOS2(sCapHeight=700)
    builder.setupPost()
    out = io.BytesIO()
    builder.save(out)
    return (out.getvalue(),)


@cache
def heights() -> tuple[bytes, ...]:
    made = []
    for kind in (np.float32, np.float64):
        out = io.BytesIO()
        np.save(out, np.linspace(-3, 0, 12, dtype=kind).reshape(3, 4))
        made.append(out.getvalue())
    return tuple(made)


def _solid() -> trimesh.Trimesh:
    return trimesh.Trimesh(**trimesh.triangles.to_kwargs(solids.pocketed_block()))


@cache
def stl() -> tuple[bytes, ...]:
    return solids.stl(solids.pocketed_block()), trimesh.exchange.stl.export_stl_ascii(_solid()).encode()


@cache
def obj() -> tuple[bytes, ...]:
    return (
        trimesh.exchange.obj.export_obj(_solid()).encode(),
        b"mtllib a.mtl\no one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
        b"vt 0 0\nvn 0 0 1\nusemtl m\nf 1/1/1 3/1/1 2/1/1\nf 1 2 4\nf 2 3 4\nf -4 -1 -2\n",
    )


@cache
def ply() -> tuple[bytes, ...]:
    return tuple(trimesh.exchange.ply.export_ply(_solid(), encoding=each) for each in ("binary", "ascii"))


@cache
def three_mf() -> tuple[bytes, ...]:
    triangles = solids.pocketed_block()
    return written(triangles, "3mf"), written(triangles[:8], "3mf")


@cache
def fusion() -> tuple[bytes, ...]:
    entries = [foreign_tools.fusion_tool("drill", 3, SIG=118), foreign_tools.fusion_tool("ball end mill", 4, "inches")]
    rates = {"presets": [foreign_tools.preset("aluminium", 9000, 800, 200)]}
    entries.append(foreign_tools.fusion_tool(number=5, start_values=rates))
    return foreign_tools.fusion_json(entries), foreign_tools.fusion_archive(entries)


@cache
def bits() -> tuple[bytes, ...]:
    return (
        foreign_tools.bit("endmill", "six", {"Flutes": 2}, Diameter="6.00 mm", Length="50 mm"),
        foreign_tools.bit("v-bit", "vee", Diameter="0.25 in", CuttingEdgeAngle="60 deg", TipDiameter="0.1 mm"),
    )


@cache
def vectric() -> tuple[bytes, ...]:
    cuts = [{"material": "Oak", "feed_rate": 900, "rate_units": 1, "spindle_speed": 12000}]
    tools = [{"name": "mill", "tool_type": 1, "diameter": 6.0, "cuts": cuts}, {"tool_type": 3, "diameter": 6.0}]
    with tempfile.TemporaryDirectory() as folder:
        return (foreign_tools.vectric(tools, Path(folder) / "t.vtdb"),)


@cache
def materials() -> tuple[bytes, ...]:
    return ((RESOURCES / "materials.toml").read_bytes(),)


@cache
def jobs() -> tuple[bytes, ...]:
    return tuple((RESOURCES / "samples" / name).read_bytes() for name in ("job.toml", "layers.toml"))


@cache
def scenes() -> tuple[bytes, ...]:
    return tuple(
        (RESOURCES / "samples" / f"{name}.toml").read_bytes() for name in ("compound", "spheres", "torus", "die")
    )


@cache
def machines() -> tuple[bytes, ...]:
    return _files(RESOURCES / "machines", "*.toml")


@cache
def posts() -> tuple[bytes, ...]:
    return (*_files(RESOURCES / "posts", "*.toml"), b'extends = "linuxcnc"\ntitle = "Mine"\n[numbers]\nstart = 5\n')


@cache
def libraries() -> tuple[bytes, ...]:
    return _files(RESOURCES / "tools", "*.toml")


def _short_library() -> ToolLibrary:
    library, _ = read_tools("t.toml", libraries()[-1])
    return ToolLibrary("some", tuple(islice(library.tools, 5)))


@cache
def spreadsheets() -> tuple[bytes, ...]:
    return (write_tools("t.csv", _short_library()),)


@cache
def tables() -> tuple[bytes, ...]:
    return (
        write_tools("t.tbl", _short_library()),
        b"T1 P1 D0.125 Z+0.511 ;1/8 end mill\nT2 P2 D6 X1 Y2 Z3 A0 I10 J20 Q1\n",
    )


@cache
def settings() -> tuple[bytes, ...]:
    return (json.dumps(asdict(Settings()), default=lambda choice: choice.value, indent=1).encode(),)


@cache
def programs() -> tuple[bytes, ...]:
    real = [b"".join(path.read_bytes().splitlines(keepends=True)[:50]) for path in sorted((DATA / "nc").glob("*"))]
    ours = [b"".join(path.read_bytes().splitlines(keepends=True)[:50]) for path in sorted(GOLDEN.rglob("*.ngc"))]
    return (*(text.encode() for text in PROGRAMS.values()), *real, *ours)
