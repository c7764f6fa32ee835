"""A solid opens by itself: seen at once and whole, its passes later; units are asked where the file has none."""

from __future__ import annotations

import numpy as np
import pytest
import trimesh
from PySide6.QtCore import QMimeData, QPointF, Qt, QUrl
from PySide6.QtGui import QDropEvent

from app.ui.framework.figures import TIMES
from app.ui.framework.view import View
from app.ui.views.surfaces.scene_computation import SceneState
from app.usecases.scene.solid_files import SOLIDS, is_solid
from app.usecases.scene.solid_scene import OpenedSolid
from app.usecases.step_extra import step_files_readable

WAIT_MS = 60_000


@pytest.fixture
def ball(tmp_path):
    """A ball of 1.2 inches in an STL file, which has no units."""
    path = tmp_path / "Ball.STL"
    path.write_bytes(trimesh.creation.icosphere(2, 1.2).export(file_type="stl"))
    return path


def drop(window, path):
    data = QMimeData()
    data.setUrls([QUrl.fromLocalFile(str(path))])
    none = Qt.KeyboardModifier.NoModifier
    event = QDropEvent(QPointF(10, 10), Qt.DropAction.CopyAction, data, Qt.MouseButton.LeftButton, none)
    window.dropEvent(event)


def test_a_dropped_solid_is_seen_before_its_passes_and_its_units_are_asked_once(qtbot, wiring, ball):
    window, work = wiring.window_, wiring.scenes.work
    view, moves = window.views.surfaces, []
    work.computed.connect(lambda shown, again: moves.append(len(shown.computed.moves.moves)))
    drop(window, ball)
    qtbot.waitUntil(lambda: view.shown is not None, timeout=3000)
    assert moves == [0] and wiring.display_controller.view is View.SURFACES
    assert window.file_label.text() == "Ball.toml"
    assert window.notice.text.text() == (
        f"Ball.STL does not say its units: 2.4 {TIMES} 2.4 {TIMES} 2.4. It is taken as millimetres."
    )
    seen = view.canvas.camera.project(view.shown.space.triangles.reshape(-1, 3), view.canvas._size)
    assert np.ptp(seen[:, 1]) > view.canvas.height() / 3, "a speck"
    window.notice.buttons[0].click()
    assert work.state is not SceneState.PROVEN, "what was proven is of the solid in millimetres"
    qtbot.waitUntil(lambda: work.state is SceneState.PROVEN and moves[-1] > 0, timeout=WAIT_MS)
    low, high = view.shown.computed.stock.x0, view.shown.computed.stock.x1
    assert high - low == pytest.approx(2.4 * 25.4, rel=1e-3)
    assert "scale = 25.4" in wiring.scenes.document.text
    assert not window.notice.isVisible() and wiring.scenes.document.modified
    assert window.preferences.settings.recent_files[0] == str(ball)


def test_a_file_that_is_damaged_is_refused_and_nothing_changes(qtbot, wiring, tmp_path):
    path = tmp_path / "part.3mf"
    path.write_bytes(b"nothing")
    wiring.files.open_file(path)
    qtbot.waitUntil(lambda: wiring.window_.notice.isVisible(), timeout=WAIT_MS)
    assert "part.3mf: this is no 3MF file" in wiring.window_.notice.text.text()
    assert not wiring.scenes.document.open or wiring.scenes.document.name != "part.toml"


def test_units_are_asked_only_where_the_file_has_none():
    size = (30.0, 20.0, 10.0)
    assert OpenedSolid("a.stl", "/a.stl", size, True).question()
    assert not OpenedSolid("a.3mf", "/a.3mf", size, False).question()
    assert not OpenedSolid("a.step", "/a.step", None, False).question()


@pytest.mark.parametrize(("across", "diameter"), [(2.0, 1.0), (40.0, 5.0), (500.0, 12.0)])
def test_the_first_tool_suits_the_size(across, diameter):
    from app.formats.scene.toml import read_scene

    scene = read_scene("a.toml", OpenedSolid("a.stl", "/a.stl", (across, across, 9.0), True).text().encode())
    assert scene.tools[0].diameter == diameter
    assert across / scene.passes[0].pitch < 300


def test_every_suffix_is_taken_by_open_and_drop():
    from app.ui.shell.file_controller import open_filter

    assert all(f"*{suffix}" in open_filter() and is_solid(f"A{suffix.upper()}") for suffix in SOLIDS)


def test_a_surface_that_cannot_be_made_hides_no_other_one_but_no_path_is_made_without_it(qtbot, wiring, tmp_path):
    path = tmp_path / "two.toml"
    path.write_text(
        '[[tool]]\nnumber = 1\ndiameter = 6.0\nkind = "ball"\n'
        '[[surface]]\nname = "dome"\nshape = { kind = "sphere", centre = [0, 0, 0], radius = 20 }\n'
        '[[surface]]\nname = "lost"\nshape = { kind = "mesh", file = "gone.stl" }\n'
        "[[passes]]\ntool = 1\npitch = 2.0\n"
    )
    wiring.files.open_file(path)
    view = wiring.window_.views.surfaces
    qtbot.waitUntil(lambda: wiring.scenes.work.state is SceneState.FAILED, timeout=WAIT_MS)
    assert view.shown is not None and [each.name for each in view.shown.computed.scene.surfaces] == ["dome"]
    assert "gone.stl" in wiring.window_.notice.text.text()
    assert wiring.scenes.work.proven is None and wiring.window_.status.badge.text() == "Could not be computed"


def test_what_reads_step_files_is_offered_where_it_is_missing(qtbot, wiring, tmp_path):
    if step_files_readable():
        pytest.skip("it is there")
    path = tmp_path / "part.step"
    path.write_bytes(b"ISO-10303-21;")
    wiring.files.open_file(path)
    notice = wiring.window_.notice
    assert "part.step is a STEP file" in notice.text.text()
    assert [button.text() for button in notice.buttons] == ["Fetch it and open", "Not now"]
    assert "pip" not in notice.text.text()
