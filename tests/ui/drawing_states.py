"""What the Draw view is photographed with: every tool half-way, every page of the right side, the panels, menus and
windows over it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

from PySide6.QtCore import QPoint, Qt
from PySide6.QtTest import QTest
from PySide6.QtWidgets import QMenu, QWidget

from app.drafting.document import Document
from app.model.part import Part
from app.ui.framework.view import View
from app.ui.shell.help.keys_window import KeysWindow
from app.ui.shell.help.tour import STEPS
from app.ui.shell.window_controller import WindowController
from app.ui.views.canvas.modes import CanvasTool as T

Place = tuple[float, float]

PART = (
    "rect 10,10 90,60",
    "circle 35,35 12",
    "line 55,5 75,65",
    "guide across 0,70",
    "point 70,35",
    "dimension 10,10 90,10 place 50,0",
    "layer holes",
    "circle 80,20 4",
    "layer part",
)
SEEN = (-5.0, -5.0, 135.0, 98.0)
RING, ALL = "select 5", "select all"

TOOLS: dict[T, tuple[str, tuple[Place | str, ...]]] = {
    T.LINE: ("", ((20, 72), (70, 88))),
    T.POLYLINE: ("", ((15, 72), (40, 88), (70, 72), (95, 90))),
    T.ARC_THREE: ("", ((20, 75), (45, 92), (80, 75))),
    T.ARC_CENTRE: ("", ((20, 75), (80, 75), (50, 70))),
    T.ARC_RADIUS: ("", ((20, 75), (80, 75), (50, 92))),
    T.ARC_ON: ("", ((110, 80),)),
    T.CIRCLE: ("", ((100, 45), (115, 55))),
    T.CIRCLE_TWO: ("", ((95, 45), (120, 45))),
    T.CIRCLE_THREE: ("", ((95, 45), (110, 60), (125, 45))),
    T.RECTANGLE: ("", ((95, 20), (125, 50))),
    T.RECTANGLE_ROUND: ("", ((95, 20), (130, 60), (124, 54))),
    T.POLYGON: ("", ((110, 45), (125, 45))),
    T.SLOT: ("", ((98, 20), (98, 60), (105, 45))),
    T.ELLIPSE: ("", ((110, 40), (128, 40), (110, 50))),
    T.SPLINE: ("", ((15, 72), (40, 90), (70, 72), (100, 90))),
    T.TEXT: ("", ((98, 40),)),
    T.POINT: ("", ((100, 40),)),
    T.GUIDE: ("", ((100, 40), (115, 50))),
    T.DIMENSION: ("", ((10, 60), (90, 60), (50, 78))),
    T.MEASURE: ("", ((10, 10), (90, 60))),
    T.MOVE: (RING, ((35, 35), (100, 40))),
    T.COPY: (RING, ((35, 35), (110, 40))),
    T.ROTATE: (RING, ((60, 35), (70, 55))),
    T.SCALE: (RING, ((35, 35), (55, 35))),
    T.MIRROR: (RING, ((60, 20), (64, 50))),
    T.ARRAY: (RING, ((35, 35), (62, 62))),
    T.ARRAY_POLAR: (RING, ((62, 35),)),
    T.OFFSET: (RING, ((52, 35),)),
    T.TRIM: ("", ((64, 34),)),
    T.EXTEND: ("", ((74, 63),)),
    T.BREAK: ("", ((20, 60), (40, 60))),
    T.FILLET: ("", ("12", (20, 60), (10, 50))),
    T.CHAMFER: ("", ("10", (20, 60), (10, 50))),
    T.JOIN: (ALL, ()),
    T.EXPLODE: (ALL, ()),
    T.REVERSE: ("", ()),
}
"""What is selected first, and what is then clicked (points, mm) or typed; over the last point the mouse only stands."""

FAULTS = ("line 100,60 120,60", "line 100,60 120,60; line 120,60.005 120,80; line 110,40 110.005,40")
"""A line twice, a gap, and a tiny one: what cleaning up finds."""

BROKEN = "# a plate\nlet w = 80\nrect 0,0 w,50\ncircle 20,25 1O\n"


class DrawingStates:
    """Puts the shown window into each state.

    Args:
        wait: lets the window live for so many milliseconds.
    """

    def __init__(self, wiring: WindowController, wait: Callable[[int], None]) -> None:
        self._wiring, self._wait = wiring, wait
        self._window, self._canvas = wiring.window_, wiring.window_.canvas

    def begin(self) -> None:
        """Show a drawing that has some of everything; what was drawn is not kept."""
        document: Document = self._wiring.document
        document.load(replace(document.job, part=Part()))
        for line in PART:
            document.run(line)
        self._wiring.display_controller.show_view(View.DRAW)
        self._window.side.show_page("Drawing")
        self._wait(100)
        self._canvas.fit_to(SEEN)
        self._wait(300)

    def tools(self) -> Iterator[str]:
        """Take every tool half-way; its name when it is there to be seen."""
        for tool, (chosen, answers) in TOOLS.items():
            self._rest()
            self._wiring.run(chosen or "select none")
            self._window.actions_[f"tool_{tool.value}"].trigger()
            for at, answer in enumerate(answers):
                if isinstance(answer, str):
                    self._canvas.type_text(answer)
                else:
                    self._point(answer, click=at < len(answers) - 1)
            yield f"tool-{tool.value}"
        self._rest()

    def pages(self) -> Iterator[str]:
        """Bring every section and page of the right side to the front."""
        window = self._window
        for chosen in ("select none", RING, ALL):
            self._wiring.run(chosen)
            yield f"properties-{chosen.split()[1]}"
        window.drawing_page.layers.menu("holes").popup(self._under(window.drawing_page.layers))
        yield "layer-menu"
        self._close_popup()
        for _ in range(3):
            self._wiring.document.undo()
        yield "history"
        for _ in range(3):
            self._wiring.document.redo()
        for line in FAULTS:
            self._wiring.document.run(line)
        window.actions_["clean_up"].trigger()
        window.drawing_page.cleanup.look.click()
        self._wait(800)
        yield "clean-up"
        self._wiring.document.undo()
        self._wiring.document.undo()
        window.actions_["text"].trigger()
        self._wiring.language.control.text = BROKEN
        self._wait(800)
        yield "text-error"
        self._wiring.language.control.fill_from_drawing()
        self._wait(800)
        yield "text"
        window.side.show_page("Job")
        yield "job"
        for name in ("tool_library", "which_tool"):
            window.actions_[name].trigger()
            self._wait(1500 if name == "which_tool" else 0)
            yield name
            window.actions_[name].trigger()

    def over(self) -> Iterator[str]:
        """Open what opens over the window: menus, palette, choices, tour, notice, findings."""
        window = self._window
        for action in window.menuBar().actions():
            menu = action.menu()
            if isinstance(menu, QMenu):
                menu.popup(window.menuBar().mapToGlobal(window.menuBar().actionGeometry(action).bottomLeft()))
                yield f"menu-{action.text().replace('&', '').lower()}"
                menu.hide()
        for name, button in (("snap", window.status.snap), ("polar", window.status.polar)):
            choices = button.menu()
            choices.popup(button.mapToGlobal(QPoint(0, -choices.sizeHint().height())))
            yield f"choices-{name}"
            choices.hide()
        self._wiring.run(RING)
        self._wiring.context_menu.made(5).popup(self._canvas.mapToGlobal(self._at((35, 47))))
        yield "menu-canvas"
        self._close_popup()
        variants = window.tool_strip.buttons["tool_arc_three"]
        variants.open()
        yield "variants"
        variants.row.hide()
        self._wiring.palette.open()
        self._wiring.palette.edit.setText("arc")
        yield "palette"
        self._wiring.palette.hide()
        self._wiring.tour.start()
        for number in range(len(STEPS)):
            self._wiring.tour.go(number)
            yield f"tour-{number + 1}"
        self._wiring.tour.end()
        window.drawing_page.layers.removal.emit("holes", 1)
        yield "question"
        window.notice.dismiss()
        self._wiring.display_controller.open_findings()
        yield "findings"
        window.findings_list.hide()

    def printing(self) -> Iterator[str]:
        """Show the sheets."""
        self._window.actions_["plot"].trigger()
        self._wait(1000)
        yield "print"
        self._wiring.plot_controller.left.emit()

    def windows(self, folder: Path, ending: str) -> None:
        """Save the pictures of the windows beside: keys, manual, shape language."""
        keys, manual = (
            KeysWindow(self._window, self._window.actions_, self._wiring.shortcuts),
            self._wiring.language.help,
        )
        posts = partial(manual.show_page, "posts")
        for name, show, shown in (
            ("keys", keys.show, keys),
            ("help", manual.show_page, manual),
            ("manual", posts, manual),
        ):
            show()
            self._save(shown, folder / f"window-{name}-{ending}")
            shown.close()

    def _save(self, shown: QWidget, path: Path) -> None:
        self._wait(400)
        shown.grab().save(str(path))

    def _at(self, place: Place) -> QPoint:
        return self._canvas.view.to_screen(place).toPoint()

    def _under(self, widget: QWidget) -> QPoint:
        return widget.mapToGlobal(QPoint(60, widget.height()))

    def _point(self, place: Place, click: bool) -> None:
        QTest.mouseMove(self._canvas, self._at(place) + QPoint(3, 0))
        QTest.mouseMove(self._canvas, self._at(place))
        if click:
            QTest.mouseClick(self._canvas, Qt.MouseButton.LeftButton, pos=self._at(place))

    def _rest(self) -> None:
        for _ in range(3):
            self._canvas.cancel()

    def _close_popup(self) -> None:
        for menu in self._window.findChildren(QMenu):
            menu.hide()
