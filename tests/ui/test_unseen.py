"""What a typed line draws beside the picture is not drawn unseen."""

import pytest


@pytest.mark.parametrize(
    ("line", "told"),
    [("circle 8000,25 3", True), ("circle 40,25 3", False), ("line 40,25 8000,25", False), ("move @1,1 1", False)],
)
def test_what_is_drawn_outside_of_the_picture_is_told(qtbot, wiring, monkeypatch, line, told):
    canvas, notice = wiring.window_.canvas, wiring.window_.notice
    wiring.run("rect 0,0 80,50")
    qtbot.waitUntil(lambda: len(wiring.document.part.entities) == 4)
    canvas.fit()
    qtbot.waitUntil(lambda: canvas._glide.state() is not canvas._glide.State.Running)
    assert not notice.isVisible()
    wiring.run(line)
    qtbot.waitUntil(lambda: not wiring.language.lines.busy)
    assert notice.isVisible() == told
    if told:
        assert notice.sentence == "What was drawn lies outside of the picture."
        notice.buttons[0].click()
        qtbot.waitUntil(lambda: canvas._glide.state() is not canvas._glide.State.Running)
        assert canvas.area.contains(canvas.view.to_screen((8000.0, 25.0)))
