"""Every reader of the program, by name, with what it reads well."""

from __future__ import annotations

import atexit
import os
import shutil
import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np

from app.core.settings import load_settings, state_folder
from app.drafting.document import drawn
from app.formats.job.toml import read_job
from app.formats.machine_toml import read_machine
from app.formats.project.project import read_project
from app.formats.project.recovery import recoveries
from app.formats.readers import read_drawing
from app.formats.scene.edit import with_table, with_value
from app.formats.scene.toml import read_scene
from app.formats.tools.files import read_rows, read_tools
from app.formats.tools.materials import read_materials
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.gcode.posts import read_post
from app.geometry.typeface import outlined
from app.raster.picture import read_picture
from app.raster.picture_options import PictureOptions
from app.simulation.field.solid import read_solid
from app.simulation.heights_file import read_heights
from app.surfaces.meshes.orientation import orient_outwards
from app.surfaces.meshes.read import read_mesh
from app.usecases.examine import ExamineOptions, examine
from tests.fuzz import seeds
from tests.fuzz.apart import Read, Reader


@cache
def folder() -> Path:
    """Return a folder of this process, for readers of paths."""
    made = Path(tempfile.mkdtemp(prefix="hitofude-fuzz-"))
    atexit.register(shutil.rmtree, made, ignore_errors=True)
    return made


def _drawing(name: str) -> Read:
    def read(data: bytes) -> object:
        drawing = read_drawing(name, data)
        assert all(np.isfinite([*each.curve.start, *each.curve.end]).all() for each in drawing.part.entities), (
            "places that are none"
        )
        return [finding.text for finding in drawing.findings]

    return read


def _program(dialect: Dialect) -> Read:
    return lambda data: [problem.message("p.ngc") for problem in read_program(data, ReadOptions(dialect)).problems]


def _examined(data: bytes) -> object:
    found = examine("p.ngc", data, ExamineOptions())
    assert found.report()
    return [problem.message("p.ngc") for problem in found.problems]


def _mesh(name: str) -> Read:
    return lambda data: orient_outwards(read_mesh(name, data))


def _tools(name: str) -> Read:
    def read(data: bytes) -> object:
        read_rows(name, data)
        return list(read_tools(name, data)[1])

    return read


def _scene(data: bytes) -> object:
    read_scene("s.toml", data)
    text = data.decode("utf-8-sig")
    with_value(text, ("name",), "n")
    return with_table(text, "passes", {"pitch": 1.0})


def _post(data: bytes) -> object:
    path = folder() / "post.toml"
    path.write_bytes(data)
    return read_post(path)


def _settings(data: bytes) -> object:
    os.environ["HITOFUDE_CONFIG"] = str(folder())
    (folder() / "settings.json").write_bytes(data)
    return load_settings()


def _recovered(data: bytes) -> object:
    os.environ["HITOFUDE_CONFIG"] = str(folder())
    state_folder().mkdir(exist_ok=True)
    (state_folder() / "one.hito").write_bytes(data)
    (left,) = recoveries()
    left.edited()
    try:
        return left.load()
    finally:
        left.discard()


def _font(data: bytes) -> object:
    path = folder() / "font.ttf"
    path.write_bytes(data)
    return outlined(str(path), "HOi")


def _picture(data: bytes) -> object:
    return list(read_picture("p.png", data, PictureOptions(pitch=0.1)).remarks)


READERS: dict[str, tuple[Read, Callable[[], tuple[bytes, ...]]]] = {
    "dxf": (_drawing("d.dxf"), seeds.dxf),
    "binary dxf": (_drawing("d.dxf"), seeds.binary_dxf),
    "svg": (_drawing("d.svg"), seeds.svg),
    "draw": (_drawing("d.draw"), seeds.draw),
    "script": (lambda data: drawn(data.decode("utf-8", "replace")), seeds.draw),
    "project": (lambda data: read_project("p.hito", data), seeds.project),
    "recovery": (_recovered, seeds.recovery),
    "picture": (_picture, seeds.pictures),
    "font": (_font, seeds.fonts),
    "heights": (lambda data: read_heights("s.npy", data, seeds.WHERE), seeds.heights),
    "place of heights": (lambda data: read_heights("s.npy", seeds.heights()[0], data), lambda: (seeds.WHERE,)),
    "solid": (lambda data: read_solid("s.stl", data), seeds.stl),
    "stl": (_mesh("s.stl"), seeds.stl),
    "obj": (_mesh("s.obj"), seeds.obj),
    "ply": (_mesh("s.ply"), seeds.ply),
    "3mf": (_mesh("s.3mf"), seeds.three_mf),
    "job": (lambda data: read_job("j.toml", data), seeds.jobs),
    "scene": (_scene, seeds.scenes),
    "machine": (lambda data: read_machine("m.toml", data), seeds.machines),
    "post": (_post, seeds.posts),
    "tools toml": (_tools("t.toml"), seeds.libraries),
    "tools csv": (_tools("t.csv"), seeds.spreadsheets),
    "tools tbl": (_tools("t.tbl"), seeds.tables),
    "tools fusion": (_tools("t.json"), lambda: seeds.fusion()[:1]),
    "tools fusion archive": (_tools("t.tools"), lambda: seeds.fusion()[1:]),
    "tools freecad": (_tools("t.fctb"), seeds.bits),
    "tools vectric": (_tools("t.vtdb"), seeds.vectric),
    "materials": (lambda data: read_materials("m.toml", data), seeds.materials),
    "settings": (_settings, seeds.settings),
    "examined": (_examined, seeds.programs),
    **{f"nc {each.value}": (_program(each), seeds.programs) for each in Dialect},
}
"""By name: the reader, and what makes its seeds."""


def reader(name: str) -> Reader:
    """Return a reader with its seeds."""
    read, made = READERS[name]
    return Reader(read, made())
