"""Goes through the views of a window that has warmed up, and prints what the window's thread still has to load:
`python -m tests.ui.loaded_late`. Each is a pause that the user feels.
"""

from __future__ import annotations

import os
import sys
import threading
from collections.abc import Callable, Sequence
from importlib.machinery import ModuleSpec
from types import ModuleType

os.environ.setdefault("QT_QPA_PLATFORM", "offscreen")

from PySide6.QtWidgets import QApplication

from app.core.jit.compiled import Kernel

first_call: Callable[..., object] = Kernel._first_call
OURS = ("app.", "numba", "scipy", "ezdxf", "shapely", "pyqtgraph", "cv2", "moderngl")
DRAWN = ("rect 0,0 80,50 round 6", "rect 25,15 55,35 round 4", "circle 12,25 3", "circle 68,25 3")


def on_window_thread() -> bool:
    """Return whether this runs on the window's own thread."""
    return threading.current_thread() is threading.main_thread()


class LateImports:
    """A finder that finds nothing, and tells what is looked for."""

    doing = ""

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Tell a module of the program or its engines that the window's thread imports."""
        if self.doing and on_window_thread() and name.startswith(OURS):
            print(f"{self.doing}: module {name}")
        return None


def watched(imports: LateImports) -> Callable[..., object]:
    """Return what a kernel does at its first call, told where the window waits for it."""

    def call(kernel: Kernel, *arguments: object) -> object:
        if imports.doing and on_window_thread():
            print(f"{imports.doing}: kernel {kernel.name}")
        return first_call(kernel, *arguments)

    return call


def main() -> None:
    """Warm up, go through the views, print."""
    imports = LateImports()
    Kernel._first_call = watched(imports)  # type: ignore[method-assign]  # before any kernel is made
    application = QApplication([])
    from app.ui.framework.computation import ComputationState
    from app.ui.framework.view import View
    from app.ui.shell.start import begin, build, warm_up
    from tests.ui.measure_window import live_until

    window, wiring = build()
    window.show()
    warmer = warm_up(window)
    live_until(lambda: not warmer.busy)
    sys.meta_path.insert(0, imports)
    imports.doing = "start"
    begin(wiring, None)
    imports.doing = "draw"
    for line in DRAWN:
        wiring.run(line)
    imports.doing = "compute"
    window.actions_["compute"].trigger()
    live_until(lambda: wiring.computation.state in (ComputationState.CURRENT, ComputationState.FAILED))
    for view in (View.CUT, View.NC, View.CURVES, View.STAGES, View.SURFACES):
        imports.doing = view.value
        wiring.display_controller.show_view(view)
        live_until(lambda: not window.activity.busy, 20.0)
        live_until(lambda: False, 0.5)
    imports.doing = "scene"
    wiring.scenes.open_sample("torus")
    live_until(lambda: window.views.surfaces.shown is not None)
    live_until(lambda: False, 0.5)
    imports.doing = ""
    window.worker.finish(20.0)
    application.quit()
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
