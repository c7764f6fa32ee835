"""A format that is registered from outside of the program is opened and exported by the window."""

from pathlib import Path

import pytest

from app.ui.shell.file_controller import open_filter
from app.ui.shell.files.drawing_export_controller import offered
from tests.formats.test_registry import registered  # noqa: F401 (a fixture for each test here)
from tests.ui.conftest import WAIT_MS


def test_open_offers_and_reads_it(qtbot, wiring, tmp_path: Path) -> None:
    assert "*.foo" in open_filter()
    path = tmp_path / "x.foo"
    path.write_text("0 0 40 30\n")
    with qtbot.waitSignal(wiring.files.open_controller.opened, timeout=WAIT_MS):
        wiring.files.open_file(path)
    assert len(wiring.document.part.entities) == 4


@pytest.mark.parametrize("name", ["out", "out.foo"])
def test_it_is_exported(qtbot, wiring, tmp_path: Path, name: str) -> None:
    assert offered()["Boxes (*.foo)"] == ".foo"
    wiring.document.run("circle 0,0 5")
    wiring.drawing_export.choose_file = lambda first: (tmp_path / name, ".foo")
    with qtbot.waitSignal(wiring.drawing_export.written, timeout=WAIT_MS):
        wiring.window_.actions_["export_drawing"].trigger()
    assert (tmp_path / "out.foo").read_bytes() == b"1"
