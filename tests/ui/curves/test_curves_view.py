"""The Curves view as it is used: a program is opened, smoothed, looked at and saved."""

import math

import numpy as np
import pytest
from PySide6.QtCore import QPointF, Qt
from PySide6.QtTest import QTest

from app.fitting.point_curves.correction import CorrectionScope
from app.fitting.point_curves.effective_points import PointState, RangeEnds
from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.ui.framework.view import View
from app.ui.views.nc.motion_shapes import ViewSide
from tests.ui.curves.facets import facets
from tests.ui.nc.opened import WAIT_MS, open_file

HEAD = "G21 G90 G17 G94\nT1 M6\nS1000 M3\nG0 X20 Y0 Z5\nG1 Z-1 F100\n"


def ring(radius: float = 20.0, count: int = 200) -> str:
    """A circle of chords, then a lone corner of two lines that nothing can make shorter."""
    angles = [2 * math.pi * k / count for k in range(1, count + 1)]
    chords = "".join(
        f"G1 X{radius * math.cos(a):.4f} Y{radius * math.sin(a):.4f} F300\n"
        if k == 0
        else f"X{radius * math.cos(a):.4f} Y{radius * math.sin(a):.4f}\n"
        for k, a in enumerate(angles)
    )
    return f"{HEAD}{chords}G0 Z5\nG0 X40 Y0\nG1 Z-1 F100\nX60 F300\nY30\nG0 Z5\nM2\n"


@pytest.fixture
def opened(qtbot, wiring, tmp_path):
    """The ring in the Curves view."""
    path = tmp_path / "ring.ngc"
    path.write_text(ring())
    open_file(qtbot, wiring, path)
    QTest.keyClick(wiring.window_, Qt.Key.Key_5, Qt.KeyboardModifier.ControlModifier)
    assert wiring.display_controller.view is View.CURVES
    return wiring


@pytest.fixture
def smooth(qtbot, opened):
    """The ring, smoothed."""
    press_smooth(qtbot, opened)
    return opened


def press_smooth(qtbot, wiring) -> None:
    QTest.mouseClick(wiring.window_.curves_panel.smooth, Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: not wiring.smoothing_controller.reading.worker.busy, timeout=6 * WAIT_MS)


def curves_of(wiring):
    return wiring.window_.views.curves


def test_without_a_program_there_is_nothing_to_smooth(wiring) -> None:
    wiring.display_controller.show_view(View.CURVES)
    window = wiring.window_
    assert window.views.empty.isVisible() and "no NC program" in window.views.empty.sentence.text()
    assert (
        window.curves_panel.isVisible() and not window.curves_panel.smooth.isEnabled() and not window.side.isVisible()
    )


def test_before_it_is_smoothed_the_program_is_shown_as_it_is(opened) -> None:
    view = curves_of(opened)
    assert view.path.picture is opened.window_.views.nc.shown.pictures[ViewSide.XY] and view.curves is None
    assert not opened.window_.views.empty.isVisible() and not view.deviation.isVisible()
    assert opened.window_.curves_panel.smooth.isEnabled()


def test_smoothing_shows_both_paths_the_certificate_and_the_deviation(smooth) -> None:
    view, panel = curves_of(smooth), smooth.window_.curves_panel
    shown = view.curves
    assert shown is not None and len(shown.changed) == 1 and view.deviation.isVisible()
    layers = shown.layers[ViewSide.XY]
    assert len(layers.before.only) >= 200 and 0 < len(layers.curves.only) <= 10
    assert len(layers.curves.only) + len(layers.stayed.only) == len(shown.now.shapes)
    piece = shown.done.pieces[shown.changed[0]]
    assert panel.figures["Proven"].text() == f"{shown.done.bound:.6f} mm" and shown.done.bound <= 0.01
    assert panel.figures["Blocks"].text().endswith(f" {sum(each.blocks[1] for each in shown.done.pieces)}")
    known = shown.track.off[np.isfinite(shown.track.off)]
    assert known.max() <= piece.judgement.bound
    assert known.max() >= 0.95 * max(piece.judgement.from_curve, piece.judgement.from_points)


def test_what_stayed_says_why_under_the_mouse(smooth) -> None:
    view = curves_of(smooth)
    why = [view.path.described(row) for row in range(len(view.curves.now.shapes)) if view.curves.why(row)]
    assert why and all(
        "stays as it was: it would not take fewer blocks" in words or "too short" in words for words in why
    )
    arcs = view.curves.layers[ViewSide.XY].curves.only
    assert all("stays" not in view.path.described(int(row)) for row in arcs)
    motions = view.curves.now.program.motions
    lines = view.curves.now.source.data.decode().split("\n")
    assert all(
        "X60" in lines[motions.line[row] - 1]
        or "Y30" in lines[motions.line[row] - 1]
        or "Z" in lines[motions.line[row] - 1]
        for row in range(len(motions))
        if view.curves.why(row)
    ), "lines are those of the text that is saved"


def test_a_click_on_the_plot_marks_and_centres_the_place(qtbot, smooth) -> None:
    view = curves_of(smooth)
    view.path.zoom_by(8.0)
    plot = view.deviation.plot
    box = plot.getPlotItem().getViewBox()
    at = view.curves.track.along[-1] / 3
    place = box.mapViewToScene(QPointF(float(at), 0.5 * view.curves.done.options.tolerance)).toPoint()
    with qtbot.waitSignal(view.deviation.picked):
        QTest.mouseClick(plot.viewport(), Qt.MouseButton.LeftButton, pos=place)
    spot = view.path.spot
    assert spot is not None and spot.along == pytest.approx(at, abs=1.0)
    assert math.hypot(*spot.place[:2]) == pytest.approx(20.0, abs=0.02), "on the ring"
    line = ring().split("\n")[spot.line - 1]
    ends = [float(word[1:]) for word in line.replace("G1 ", "").split()[:2]]
    assert math.dist(ends, spot.place[:2]) < 0.7, "the line is that of the chord"
    middle = view.path.area.center()
    qtbot.waitUntil(lambda: (view.path.view.to_screen(spot.place[:2]) - middle).manhattanLength() < 2.0)
    assert f"line {spot.line}" in view.deviation.figures.text() and "mm apart" in view.deviation.figures.text()


@pytest.mark.exhaustive
@pytest.mark.parametrize("theme", ["theme_dark", "theme_light"])
def test_the_plot_counts_in_mm_in_every_theme(qtbot, smooth, theme) -> None:
    for name in (theme, "theme_dark", theme):
        smooth.window_.actions_[name].trigger()
        qtbot.wait(1)
    plot = curves_of(smooth).deviation.plot
    axis = plot.getAxis("left")
    assert axis.autoSIPrefixScale == 1.0 and "x0" not in axis.labelString() and "mm apart" in axis.labelString()
    paper = smooth.window_.theme.paper
    assert plot.grab().toImage().pixelColor(2, 2) == paper


def test_a_drag_over_the_plot_picks_nothing(smooth) -> None:
    view = curves_of(smooth)
    port = view.deviation.plot.viewport()
    middle = port.rect().center()
    QTest.mousePress(port, Qt.MouseButton.LeftButton, pos=middle)
    QTest.mouseRelease(port, Qt.MouseButton.LeftButton, pos=middle + middle / 3)
    assert view.path.spot is None


def test_what_is_saved_is_what_was_proven(smooth, tmp_path) -> None:
    path = tmp_path / "out.ngc"
    smooth.smoothing_controller.save(path)
    shown = curves_of(smooth).curves
    assert path.read_bytes() == shown.done.data
    again = read_program(path.read_bytes(), ReadOptions(Dialect.LINUXCNC))
    assert len(again.motions) == len(shown.done.after.motions) and b"proven both ways" in path.read_bytes()


def test_a_place_that_cannot_be_written_is_told(qtbot, smooth, tmp_path) -> None:
    with qtbot.waitSignal(smooth.smoothing_controller.failed) as told:
        smooth.smoothing_controller.save(tmp_path / "nowhere" / "out.ngc")
    assert "nowhere" in told.args[0]


def test_the_new_text_opens_in_the_nc_view_and_can_be_smoothed_on(qtbot, smooth) -> None:
    shown = curves_of(smooth).curves
    QTest.mouseClick(smooth.window_.curves_panel.nc, Qt.MouseButton.LeftButton)
    nc = smooth.window_.views.nc
    qtbot.waitUntil(
        lambda: smooth.display_controller.view is View.NC and nc.shown.source.data == shown.done.data, timeout=WAIT_MS
    )
    assert nc.shown.source.name == "ring-smooth.ngc"
    smooth.display_controller.show_view(View.CURVES)
    assert curves_of(smooth).curves is None, "the curves were of another program"


def test_curves_stay_while_other_views_are_looked_at(smooth) -> None:
    shown = curves_of(smooth).curves
    smooth.display_controller.show_view(View.NC)
    smooth.display_controller.show_view(View.CURVES)
    assert curves_of(smooth).curves is shown


def test_a_preset_sets_the_tolerance_and_a_typed_one_is_no_preset(qtbot, opened) -> None:
    panel = opened.window_.curves_panel
    QTest.mouseClick(panel.preset.buttons[0.05], Qt.MouseButton.LeftButton)
    assert panel.tolerance.value == 0.05
    panel.tolerance.edit.setFocus()
    panel.tolerance.edit.selectAll()
    QTest.keyClicks(panel.tolerance.edit, "0.03")
    QTest.keyClick(panel.tolerance.edit, Qt.Key.Key_Return)
    assert not any(button.isChecked() for button in panel.preset.buttons.values())
    press_smooth(qtbot, opened)
    assert curves_of(opened).curves.done.options.tolerance == pytest.approx(0.03)
    assert opened.window_.curves_panel.figures["Tolerance"].text() == "0.03 mm"


def test_every_choice_of_the_form_reaches_the_engine(qtbot, opened) -> None:
    panel = opened.window_.curves_panel
    for button in (panel.form.buttons["nurbs"], panel.region.buttons["barrel"]):
        QTest.mouseClick(button, Qt.MouseButton.LeftButton)
    assert panel.middle.isVisible() and panel.middle.value == pytest.approx(2 * panel.tolerance.number)
    panel.corner.show_value(45.0)
    panel.bend.show_value(7.0)
    panel.post.show_value("fanuc")
    press_smooth(qtbot, opened)
    options = curves_of(opened).curves.done.options
    assert (options.form.value, options.middle, options.post.title) == ("nurbs", pytest.approx(0.02), "Fanuc")
    assert (options.corner, options.bend) == (pytest.approx(math.radians(45.0)), pytest.approx(math.radians(7.0)))
    assert b"G6.2" in curves_of(opened).curves.done.data or b"G06.2" in curves_of(opened).curves.done.data


def test_what_cannot_be_is_said_in_a_sentence_and_what_was_there_stays(qtbot, smooth) -> None:
    before = curves_of(smooth).curves
    panel = smooth.window_.curves_panel
    panel.tolerance.show_value(0.0001)
    press_smooth(qtbot, smooth)
    assert panel.reason.isVisible() and "too near to the last decimal" in panel.reason.text()
    assert curves_of(smooth).curves is before


def test_cancelling_leaves_everything_as_it_was(qtbot, opened, tmp_path) -> None:
    panel, worker = opened.window_.curves_panel, opened.smoothing_controller.reading.worker
    QTest.mouseClick(panel.smooth, Qt.MouseButton.LeftButton)
    assert worker.busy and panel.smooth.text() == "Cancel"
    QTest.mouseClick(panel.smooth, Qt.MouseButton.LeftButton)
    assert not worker.busy and panel.smooth.text() == "Smooth" and curves_of(opened).curves is None


def test_other_sides_and_the_comb_are_shown(qtbot, smooth) -> None:
    view = curves_of(smooth)
    QTest.mouseClick(view.sides.buttons[ViewSide.XZ], Qt.MouseButton.LeftButton)
    qtbot.waitUntil(lambda: view.path.picture.side is ViewSide.XZ, timeout=WAIT_MS)
    view.set_side(ViewSide.XY)
    before = view.path.grab().toImage()
    QTest.mouseClick(view.comb, Qt.MouseButton.LeftButton)
    assert view.path.grab().toImage() != before
    comb = view.curves.comb
    size = np.linalg.norm(comb.tooth, axis=1)
    assert np.mean(np.isclose(size, 1 / 20, rtol=0.1)) > 0.8 and comb.tall == pytest.approx(1 / 20, rel=0.1), (
        "a ring bends evenly"
    )


def test_a_place_that_is_looked_at_stays_when_it_is_smoothed_again(qtbot, smooth) -> None:
    view = curves_of(smooth)
    view.path.zoom_by(5.0)
    looked_at = view.path.view
    press_smooth(qtbot, smooth)
    assert view.path.view == looked_at
    view.path.fit_now()
    assert view.path.view != looked_at


@pytest.fixture
def faceted(qtbot, wiring, tmp_path):
    """The polyhedron's circle in the Curves view, to be smoothed by effective points within 0.2 mm."""
    path = tmp_path / "facets.ngc"
    path.write_text(facets())
    open_file(qtbot, wiring, path)
    wiring.display_controller.show_view(View.CURVES)
    panel = wiring.window_.curves_panel
    panel.tolerance.show_value(0.2)
    click(panel.points.points, True)
    return wiring


def click(choice, value) -> None:
    QTest.mouseClick(choice.buttons[value], Qt.MouseButton.LeftButton)


def test_only_fields_that_matter_are_seen(opened) -> None:
    form = opened.window_.curves_panel.points
    late = (form.before, form.after, form.move_to, form.select)
    assert form.method() is None and not any(
        field.isVisible() for field in (form.epsilon, form.ends, form.others, *late)
    )
    click(form.points, True)
    assert (
        form.epsilon.isVisible()
        and form.others.isVisible()
        and not any(field.isVisible() for field in (*late, form.share, form.reach))
    )
    click(form.ends, RangeEnds.RATIO)
    assert form.share.isVisible() and not form.reach.isVisible()
    click(form.others, "corrected")
    assert all(field.isVisible() for field in late) and not form.near.isVisible() and not form.moved.isVisible()
    click(form.select, CorrectionScope.DISTANCE)
    assert form.moved.isVisible() and not form.near.isVisible()
    method = form.method()
    assert method is not None and method.correct is not None and method.choose.ends is RangeEnds.RATIO
    assert method.correct.select is CorrectionScope.DISTANCE and method.correct.limit == form.moved.number
    click(form.points, False)
    assert not any(field.isVisible() for field in (form.epsilon, form.share, form.moved, *late))


@pytest.mark.parametrize(("others", "effective", "corrected"), [("left out", 61 + 2 * 60, 0), ("corrected", 61, 660)])
def test_points_are_told_apart_and_counted(qtbot, faceted, others, effective, corrected) -> None:
    view, panel = curves_of(faceted), faceted.window_.curves_panel
    if others == "left out":
        click(panel.points.ends, RangeEnds.RATIO)
    click(panel.points.others, others)
    press_smooth(qtbot, faceted)
    points = view.curves.points
    assert points.told_apart and len(points.was) == 721
    state = np.bincount(points.state, minlength=3)
    assert (state[PointState.EFFECTIVE], state[PointState.CORRECTED]) == (effective, corrected) and state.sum() == 721
    assert panel.figures["Effective"].text() == f"{effective} of 721" and panel.figures["Corrected"].text() == str(
        corrected
    )
    view.path.zoom_by(6.0)
    words = [row.words for row in view.path._key()]
    assert ("Left out" in words, "Corrected" in words, "Effective" in words) == (
        state[PointState.INVALID] > 0,
        corrected > 0,
        True,
    )
    radius = np.hypot(*points.places[points.state != PointState.INVALID][:, :2].T)
    assert abs(radius - 20).max() <= 0.03


def test_corrected_points_are_of_a_third_hue(qtbot, faceted) -> None:
    view, panel = curves_of(faceted), faceted.window_.curves_panel
    click(panel.points.others, "corrected")
    press_smooth(qtbot, faceted)
    view.path.zoom_by(60.0)
    view.path.mark(view.deviation.track.farthest())
    qtbot.wait(400)
    picture = view.path.grab().toImage()
    hues = {picture.pixelColor(x, y).name() for x in range(picture.width()) for y in range(picture.height() // 2)}
    theme = faceted.window_.theme
    assert theme.left.name() in hues


def test_a_method_that_spends_the_tolerance_is_told(qtbot, faceted) -> None:
    panel = faceted.window_.curves_panel
    panel.tolerance.show_value(0.005)
    press_smooth(qtbot, faceted)
    assert "epsilon" in panel.reason.text()


def test_degree_is_a_choice_of_splines(qtbot, opened) -> None:
    panel = opened.window_.curves_panel
    assert not panel.degree.isVisible()
    click(panel.form, "nurbs")
    click(panel.degree, 5)
    assert panel.degree.isVisible()
    press_smooth(qtbot, opened)
    assert curves_of(opened).curves.done.options.degree == 5


def test_who_insists_on_splines_is_told_what_was_written(qtbot, opened) -> None:
    panel = opened.window_.curves_panel
    assert not panel.insist.isVisible()
    panel.post.show_value("fanuc")
    click(panel.form, "nurbs")
    assert panel.insist.isVisible() and panel.insist.value is False
    click(panel.insist, True)
    press_smooth(qtbot, opened)
    done = curves_of(opened).curves.done
    assert done.options.insist and done.kinds.splines > 0 == done.kinds.lines + done.kinds.arcs
    assert done.kinds.words in panel.title.text()


def test_a_region_by_its_outline_reaches_the_engine_or_says_what_is_wrong(qtbot, opened) -> None:
    panel = opened.window_.curves_panel
    click(panel.region, "outline")
    assert panel.outline.isVisible() and not panel.tolerance.isVisible()
    panel.outline.edit.setText("0.01 + 0.01 * zz")
    press_smooth(qtbot, opened)
    assert "zz" in panel.reason.text()
    panel.outline.edit.setText("0=0.01,0.5=0.02,1=0.01")
    press_smooth(qtbot, opened)
    done = curves_of(opened).curves.done
    assert done.options.profile.text == "0=0.01,0.5=0.02,1=0.01" and done.options.tolerance == 0.01
    click(panel.region, "cylinder")
    assert panel.tolerance.isVisible() and not panel.outline.isVisible()
