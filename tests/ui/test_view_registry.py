"""A view from outside the program: registered by name, found in menu, bar and window, shown and told so."""

import pytest
from PySide6.QtWidgets import QLabel

from app.ui.framework.controller import Controller
from app.ui.framework.missing import NOTHING, MissingHint
from app.ui.framework.view import View, ViewPage, register, unregister
from app.ui.framework.workspace import Workspace
from app.ui.shell.start import build
from tests.ui.one_window import end


class Counter(Controller):
    """Counts the curves of the drawing, for whoever looks."""

    def __init__(self, label: QLabel, workspace: Workspace) -> None:
        super().__init__(label)
        self.label, self.document, self.seen = label, workspace.document, False
        self.document.subscribe(lambda _: self.show())

    def show(self) -> None:
        self.label.setText(str(len(self.document.part.entities)))
        self.changed.emit()

    def see(self, seen: bool) -> None:
        self.seen = seen


class Plain(QLabel):
    """What the view shows; it has nothing to zoom."""

    zoomed = 1.0

    def fit(self) -> None:
        self.zoomed = 1.0

    def zoom_by(self, factor: float) -> None:
        self.zoomed *= factor


@pytest.fixture
def counted(qtbot):
    made: list[Counter] = []

    def page(workspace: Workspace) -> ViewPage:
        shown, beside = Plain(), QLabel("beside")
        counter = Counter(shown, workspace)
        made.append(counter)
        return ViewPage(
            shown,
            shown,
            prompt=lambda: "Draw, and it counts",
            missing=lambda: NOTHING if shown.text() else MissingHint("Nothing is counted yet.", "Count", "compute"),
            summary=lambda: f"{shown.text()} counted",
            side=lambda: beside,
            controller=counter,
        )

    view = register(View("view_counter", "C&ounter", "Ctrl+Alt+9", page))
    window, wiring = build()
    window.show()
    yield wiring, made[0]
    unregister(view)
    end(wiring)


def test_a_view_that_is_registered_is_in_the_window(counted) -> None:
    wiring, counter = counted
    window = wiring.window_
    assert list(window.top_bar.tabs)[-1] == "view_counter"
    window.actions_["view_counter"].trigger()
    page = wiring.display_controller.page
    assert window.views.currentWidget() is page.widget is counter.label and counter.seen
    assert page.side().isVisible() and window.side.isHidden() and window.tool_strip.isHidden()
    assert window.views.empty.sentence.text() == "Nothing is counted yet."
    wiring.document.run("circle 0,0 5")
    assert counter.label.text() == "1" and window.views.empty.isHidden()
    assert window.status.message.text() == "1 counted"
    window.actions_["zoom_in"].trigger()
    assert counter.label.zoomed == 1.5
    window.actions_["view_draw"].trigger()
    assert not counter.seen and page.side().isHidden() and not window.side.isHidden()


def test_a_name_is_given_once() -> None:
    with pytest.raises(ValueError, match="view_draw already"):
        register(View("view_draw", "Draw"))
