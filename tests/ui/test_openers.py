"""Every file that the window takes goes to who opens it; what is a drawing to none of them."""

from __future__ import annotations

from pathlib import Path

import pytest

from app.core.resources import resource
from app.ui.shell.file_controller import Openers
from app.ui.shell.main_window import opened_suffixes

SCENE, JOB = "torus.toml", "job.toml"


def opener_of(path: Path) -> str:
    """Return who opens a file, "" for the drawing's own."""
    opened: list[str] = []
    names = ("program", "picture", "scene", "solid", "tools", "job")
    openers = Openers(*(lambda _, name=name: opened.append(name) for name in names))
    opens = openers.of(path)
    if opens is not None:
        opens(path)
    return "".join(opened)


@pytest.mark.parametrize(
    ("name", "opener"),
    [
        *((f"a{suffix}", "program") for suffix in (".ngc", ".NC", ".tap", ".gcode", ".mpf", ".eia")),
        *((f"a{suffix}", "solid") for suffix in (".stl", ".3mf", ".obj", ".step", ".STP")),
        *((f"a{suffix}", "tools") for suffix in (".tbl", ".csv", ".fctb", ".fctl")),
        *((f"a{suffix}", "") for suffix in (".dxf", ".svg", ".draw", ".hito", ".png", ".jpg")),
    ],
)
def test_a_suffix_tells_who_opens_a_file(name, opener):
    assert opener_of(Path(name)) == opener
    assert name.lower().endswith(opened_suffixes()), "it can be dropped, and is shown by Open"


def test_of_toml_its_tables_tell(tmp_path):
    library = tmp_path / "mine.toml"
    library.write_text(
        "format = 1\n\n[[tool]]\nnumber = 1\ndiameter = 6\n\n[[tool.feeds]]\nmaterial = 'wood'\n", "utf-8"
    )
    assert opener_of(library) == "tools"
    assert opener_of(resource("samples", SCENE)) == "scene"
    assert opener_of(resource("samples", JOB)) == "job", "it has tools, too"
    empty = tmp_path / "empty.toml"
    empty.write_text("", "utf-8")
    assert opener_of(empty) == "job"
