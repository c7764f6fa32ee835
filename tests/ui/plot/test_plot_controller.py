"""Print or plot: the sheets follow the drawing and what is asked; every format is true to scale."""

from __future__ import annotations

import re
import zlib
from dataclasses import dataclass
from pathlib import Path

import cv2
import numpy as np
import pytest
from PySide6.QtCore import Qt
from PySide6.QtGui import QImage

from app.core.errors import HitofudeError
from app.drafting.document import Document
from app.formats.plot.page import Paper
from app.ui.framework.view import View
from app.ui.framework.workspace import Workspace
from app.ui.views.plot.controller import PlotController
from app.ui.views.plot.panel import PlotPanel, read_scale
from app.ui.views.plot.preview import PlotPreview


def pdf_subpaths(data: bytes) -> list[list[tuple[float, float]]]:
    """Play back the lines of a PDF's first page: points in mm from the lower left corner, by the PDF's own matrices."""
    found: list[list[tuple[float, float]]] = []
    matrix, kept, numbers = np.eye(3), [], []
    for stream in re.findall(rb"stream\r?\n(.*?)\r?\nendstream", data, re.S):
        try:
            text = zlib.decompress(stream).decode("latin-1")
        except zlib.error:
            continue
        if " cm" not in text:
            continue
        for word in text.split():
            if re.fullmatch(r"[-+]?[\d.]+", word):
                numbers.append(float(word))
                continue
            if word == "q":
                kept.append(matrix)
            elif word == "Q":
                matrix = kept.pop()
            elif word == "cm":
                a, b, c, d, e, f = numbers[-6:]
                matrix = np.array([[a, b, 0], [c, d, 0], [e, f, 1]]) @ matrix
            elif word in ("m", "l"):
                x, y, _ = np.array([*numbers[-2:], 1.0]) @ matrix * 25.4 / 72
                found.extend([[]] if word == "m" else [])
                found[-1].append((float(x), float(y)))
            numbers = []
        return found
    raise AssertionError("no page")


@dataclass
class Plotted:
    """A line on paper: what prints it, its fields and its preview, without a window."""

    plot_controller: PlotController
    panel: PlotPanel
    preview: PlotPreview
    workspace: Workspace

    @property
    def document(self) -> Document:
        return self.workspace.document


@pytest.fixture
def plotted(qtbot, workspace):
    preview, panel = PlotPreview(), PlotPanel()
    for widget in (preview, panel):
        qtbot.addWidget(widget)
    preview.resize(900, 660)
    preview.show()
    made = Plotted(PlotController(preview, panel, workspace), panel, preview, workspace)
    made.plot_controller.failed.connect(workspace.notice.ask)
    workspace.document.run("line 20,20 120,20")
    made.plot_controller.start()
    settle(qtbot, made)
    return made


@pytest.fixture
def in_window(qtbot, wiring):
    wiring.document.run("line 20,20 120,20")
    wiring.window_.actions_["plot"].trigger()
    settle(qtbot, wiring)
    return wiring


def settle(qtbot, wiring) -> None:
    qtbot.waitUntil(lambda: not wiring.plot_controller.worker.busy, timeout=5000)


def save(qtbot, wiring, path: Path) -> None:
    wiring.plot_controller.save(path)
    qtbot.waitUntil(lambda: not wiring.plot_controller.writer.busy, timeout=10_000)


def choose_scale(qtbot, plotted, text: str) -> None:
    edit = plotted.panel.factor.edit
    edit.selectAll()
    qtbot.keyClicks(edit, text)
    qtbot.keyClick(edit, Qt.Key.Key_Return)
    settle(qtbot, plotted)


def test_the_preview_comes_beside_its_fields_and_escape_leaves_it(qtbot, in_window) -> None:
    window = in_window.window_
    assert window.views.plotting and window.plot_panel.isVisible()
    assert not window.side.isVisible() and not window.tool_strip.isVisible()
    qtbot.keyClick(window.views.plot, Qt.Key.Key_Escape)
    assert not window.views.plotting and not window.plot_panel.isVisible()
    assert window.side.isVisible() and window.tool_strip.isVisible()


def test_a_view_leaves_the_paper(in_window) -> None:
    in_window.window_.actions_["view_paths"].trigger()
    assert not in_window.window_.views.plotting
    assert in_window.display_controller.view is View.PATHS


def test_the_sheets_follow_the_drawing_and_the_fields(qtbot, plotted) -> None:
    panel = plotted.panel
    assert panel.told.text().startswith("2.69 : 1 on 1 sheet")
    plotted.document.run("line 0,0 0,300")
    settle(qtbot, plotted)
    assert panel.told.text().startswith("1 : 1.77 on 1 sheet")
    choose_scale(qtbot, plotted, "1:1")
    assert len(plotted.preview.sheets) == 2
    panel.paper.chosen.emit(Paper.A3)
    panel.lies.buttons[False].click()
    settle(qtbot, plotted)
    assert len(plotted.preview.sheets) == 1
    assert plotted.plot_controller.ready.sheets[0].page.height == 420.0


def test_nothing_drawn_says_so_and_saves_nothing(qtbot, plotted) -> None:
    plotted.document.undo()
    settle(qtbot, plotted)
    panel = plotted.panel
    assert "Nothing is drawn" in panel.wrong.text()
    assert not panel.save.isEnabled() and not panel.print.isEnabled()


def test_the_paper_shows_the_line_where_it_will_be(qtbot, plotted) -> None:
    choose_scale(qtbot, plotted, "1:1")
    preview = plotted.preview
    picture: QImage = preview.grab().toImage()
    scale, middle = preview.px_per_mm, preview.width() / 2
    row = [y for y in range(preview.height()) if picture.pixelColor(round(middle), y).value() < 200]
    assert picture.pixelColor(round(middle - 55 * scale), row[len(row) // 2]).value() > 200
    ys = [
        y
        for y in row
        if picture.pixelColor(round(middle - 48 * scale), y).value() < 200
        and picture.pixelColor(round(middle + 48 * scale), y).value() < 200
        and picture.pixelColor(round(middle - 55 * scale), y).value() > 240
    ]
    assert ys


@pytest.mark.parametrize(("scale", "length"), [("1:1", 100.0), ("1:2", 50.0), ("200%", 200.0)])
def test_100_mm_are_100_mm_in_pdf(qtbot, plotted, tmp_path: Path, scale: str, length: float) -> None:
    choose_scale(qtbot, plotted, scale)
    save(qtbot, plotted, tmp_path / "rule.pdf")
    data = (tmp_path / "rule.pdf").read_bytes()
    width, height = map(float, re.search(rb"/MediaBox \[0 0 ([\d.]+) ([\d.]+)\]", data).groups())  # type: ignore[union-attr]
    assert (width, height) == pytest.approx((297 / 25.4 * 72, 210 / 25.4 * 72), abs=0.5)
    line = next(line for line in pdf_subpaths(data) if len(line) == 2)
    assert abs(line[1][0] - line[0][0]) == pytest.approx(length, abs=0.005)
    assert line[1][1] == pytest.approx(line[0][1], abs=1e-6)


def test_100_mm_are_100_mm_in_png_which_tells_its_size(qtbot, plotted, tmp_path: Path) -> None:
    plotted.panel.framed.switch.click()
    choose_scale(qtbot, plotted, "1:1")
    save(qtbot, plotted, tmp_path / "rule.png")
    picture = QImage(str(tmp_path / "rule.png"))
    assert picture.dotsPerMeterX() == 11811
    grey = cv2.imread(str(tmp_path / "rule.png"), cv2.IMREAD_GRAYSCALE)
    columns = np.flatnonzero((grey < 128).any(axis=0))
    assert (columns[-1] - columns[0] + 1) / 11.811 == pytest.approx(100.35, abs=0.1)


def test_many_sheets_are_one_pdf_and_a_numbered_svg_each(qtbot, plotted, tmp_path: Path) -> None:
    choose_scale(qtbot, plotted, "5:1")
    save(qtbot, plotted, tmp_path / "rule.pdf")
    assert re.search(rb"/Count 2\b", (tmp_path / "rule.pdf").read_bytes())
    save(qtbot, plotted, tmp_path / "rule.svg")
    save(qtbot, plotted, tmp_path / "rule.plt")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["rule-1.svg", "rule-2.svg", "rule.pdf", "rule.plt"]
    assert plotted.workspace.log.lines[-1].command == "plot rule.plt"


def test_a_place_that_cannot_be_written_is_told(qtbot, plotted, tmp_path: Path) -> None:
    save(qtbot, plotted, tmp_path / "none" / "rule.pdf")
    assert "Cannot write" in plotted.workspace.notice.text.text()


def test_paths_are_offered_once_they_are_computed(qtbot, computed) -> None:
    computed.window_.actions_["plot"].trigger()
    settle(qtbot, computed)
    panel = computed.window_.plot_panel
    assert panel.paths.switch.isEnabled()
    before = len(computed.plot_controller.ready.sheets[0].drawing.strokes)
    panel.paths.switch.click()
    settle(qtbot, computed)
    assert len(computed.plot_controller.ready.sheets[0].drawing.strokes) > before
    computed.document.run("line 0,0 10,10")
    settle(qtbot, computed)
    assert not panel.paths.switch.isEnabled()


def test_the_wheel_goes_nearer_where_the_mouse_is_and_f_shows_all(qtbot, in_window) -> None:
    preview = in_window.window_.views.plot
    before = preview.px_per_mm
    in_window.window_.actions_["zoom_in"].trigger()
    assert preview.px_per_mm == pytest.approx(1.5 * before)
    in_window.window_.actions_["fit"].trigger()
    assert preview.px_per_mm == before


@pytest.mark.parametrize(
    ("text", "scale"), [("1:2", 0.5), ("2 : 1", 2.0), ("50%", 0.5), ("0.25", 0.25), ("1:2.5", 0.4)]
)
def test_scales_are_read_as_people_write_them(text: str, scale: float) -> None:
    assert read_scale(text) == scale


@pytest.mark.parametrize("text", ["", "1:0", "0", "-1", "1:5000", "a:b"])
def test_what_is_no_scale_is_refused(text: str) -> None:
    with pytest.raises(HitofudeError):
        read_scale(text)
