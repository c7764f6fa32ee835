"""States of the Surfaces view for the kept pictures: how it is looked at, what stands beside it, and what is wrong."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from app.ui.framework.view import View
from app.ui.shell.window_controller import WindowController
from app.ui.views.surfaces.scene_computation import SceneState
from app.ui.views.surfaces.scene_raster import SceneColourBy
from app.ui.views.surfaces.view import ViewDirection

_PATIENCE = 600


def scene_states(wiring: WindowController, wait: Callable[[int], None]) -> Iterator[str]:
    """Put the window into every state and give its name."""
    window, work = wiring.window_, wiring.scenes.work
    view, side = window.views.surfaces, window.scene_side

    def until(state: SceneState) -> None:
        for _ in range(_PATIENCE):
            if work.state is state:
                return
            wait(100)
        raise TimeoutError(f"the scene is {work.state}, not {state}: {work.problem}")

    window.notice.dismiss()
    wiring.display_controller.show_view(View.SURFACES)
    yield "surfaces-empty"
    wiring.scenes.open_sample("compound")
    until(SceneState.PROVEN)
    side.panel.choose(("surface", 1))
    yield "surfaces-3D"
    view.set_look(ViewDirection.PLAN)
    side.panel.choose(("passes", 0))
    yield "surfaces-plan"
    view.set_look(ViewDirection.SECTION)
    side.show_page("Points")
    side.points.choose(17)
    yield "surfaces-section"
    view.set_look(ViewDirection.SPACE)
    view.canvas.set_colour_by(SceneColourBy.LINE)
    side.show_page("Text")
    window.scene.edit(lambda text: text.replace("pitch = 5.0", "pitch = five"))
    until(SceneState.WRONG)
    side.text.editor.go_to(side.text.editor.wrong)
    yield "surfaces-wrong-line"
    window.scene.document.undo()
    view.canvas.set_colour_by(SceneColourBy.SURFACE)
    until(SceneState.PROVEN)
    side.show_page("Scene")
