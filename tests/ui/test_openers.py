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


@pytest.mark.parametrize("name", ["O1234", "part.pim", "part.H"])
def test_a_program_of_any_name_is_known_by_its_first_blocks(tmp_path, name):
    path = tmp_path / name
    path.write_text("%\nO1234 (LID)\nN10 G21 G90\nN20 G0 X0 Y0\nM30\n%\n")
    assert opener_of(path) == "program"
    picture = tmp_path / "photo.xyz"
    picture.write_bytes(b"\0G1\nG2\nG3\n")
    assert opener_of(picture) == ""


@pytest.mark.parametrize("name", ["letter.docx", "part.ipt", "nothing"])
def test_what_no_part_of_the_window_opens_is_told_all_that_can_be_opened(wiring, tmp_path, name):
    path = tmp_path / name
    path.write_text("Dear reader,\n")
    wiring.window_.dropped.emit(str(path))
    notice = wiring.window_.notice
    assert notice.isVisible() and notice.sentence.startswith(f"{name} is of no kind that can be opened.")
    assert all(each in notice.sentence for each in (".dxf", ".stl", ".png", ".ngc", ".mpf", ".h", ".tbl", ".toml"))
    assert not wiring.window_.worker.busy
