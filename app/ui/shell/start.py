"""Starts the window."""

from __future__ import annotations

import gc
import signal
import sys
import tempfile
import traceback
from contextlib import suppress
from functools import partial
from importlib import import_module
from pathlib import Path
from types import TracebackType
from typing import cast

from PySide6.QtCore import Qt, QTimer
from PySide6.QtWidgets import QApplication

from ...core.atomic import sweep
from ...core.errors import HitofudeError
from ...core.progress import Progress
from ...core.resources import PACKAGE
from ...core.settings import Settings, config_folder, load_settings, state_folder
from ...drafting.document import Document
from ..framework.file_dialogs import search_no_icon_themes
from ..framework.icons import pixmap
from ..framework.worker import Worker
from .main_window import MainWindow
from .window_controller import WindowController
from .window_geometry import restore_geometry

_ENGINES = (
    "ezdxf",
    "ezdxf.recover",
    "shapely",
    "scipy.sparse.csgraph",
    "scipy.spatial",
    "cv2",
    f"{PACKAGE}.formats.dxf.dxf",
    f"{PACKAGE}.operations.compute",
    f"{PACKAGE}.usecases.making.make",
    f"{PACKAGE}.usecases.mending",
    f"{PACKAGE}.usecases.proposal.chosen_curves",
    f"{PACKAGE}.usecases.smoothing.result",
    "moderngl",
)


def places(settings: Settings) -> set[Path]:
    """Return the folders in which a run of the program that was killed may have left something unfinished, but for its
    own.
    """
    recent = {Path(name).parent for name in settings.recent_files}
    return recent | {Path(tempfile.gettempdir())} | ({Path(settings.last_folder)} if settings.last_folder else set())


def _warm(settings: Settings, progress: Progress) -> None:
    """Sweep, which may wait for a disk, and load what the first line, Open, Compute and plot need, which would make the
    window stutter later.
    """
    from ...core.jit.compiled import Kernel
    from ...core.jit.warm import warm
    from ...drafting.expressions.grammar import read_script
    from ...formats.tools.library import load_libraries
    from ..views.surfaces import picture_kernels

    read_script("")  # a parser is made of the grammar
    load_libraries()
    sweep(*places(settings))
    for engine in (*_ENGINES, "pyqtgraph"):
        import_module(engine)
    warm(progress)
    for painting in (picture_kernels.fill, picture_kernels.tint, picture_kernels.draw_lines):
        with suppress(HitofudeError):  # told where a scene is painted
            cast(Kernel, painting).load()


def build() -> tuple[MainWindow, WindowController]:
    """Return a window with an empty document, not shown yet, and its wiring."""
    search_no_icon_themes()
    window = MainWindow(Document(), load_settings())
    wiring = WindowController(window)
    window.set_theme_choice(window.preferences.settings.theme)
    window.setWindowIcon(pixmap("app", window.theme.accent_text, 3))
    return window, wiring


def _spare_the_collector(loading: bool) -> None:
    """Have the garbage collector leave out what is loaded for good, once it is.

    The engines' modules are some 350,000 objects: the pass that follows the next job would hold the window's thread
    up for 0.1 s on an idle core, while somebody opens or exports a file.
    """
    if not loading:
        gc.freeze()


def warm_up(window: MainWindow) -> Worker:
    """Load engines and have inner loops compiled in the background, so that the first Compute waits for little or
    nothing.
    """
    warmer = Worker(window)
    warmer.progress.connect(lambda _, text: window.status.show_waiting(text))
    warmer.busy_changed.connect(lambda _: window.status.show_waiting(""))
    warmer.busy_changed.connect(_spare_the_collector)
    warmer.start(partial(_warm, window.preferences.settings), 0)
    return warmer


def _tell_mistake(
    window: MainWindow, kind: type[BaseException], fault: BaseException, trace: TracebackType | None
) -> None:
    traceback.print_exception(kind, fault, trace)
    window.notice.ask(
        f"The program made a mistake here ({kind.__name__}: {fault}). Your drawing is safe; please report this.",
        error=True,
    )


def begin(wiring: WindowController, path: Path | None) -> None:
    """Open a file, or show the last files and samples; and offer what a crash has left."""
    if path is None:
        wiring.open_start()
        wiring.recovery_controller.offer()
        return
    wiring.files.open_controller.opened.connect(
        lambda _: wiring.recovery_controller.offer(), Qt.ConnectionType.SingleShotConnection
    )
    wiring.files.open_file(path)


def start(path: Path | None = None) -> int:
    """Open the window with a file, or with the last ones to choose from, and stay until it is closed.

    Returns:
        Exit status.
    """
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    sweep(state_folder(), config_folder())
    application = QApplication(sys.argv[:1])
    application.setApplicationName("Hitofude")
    application.setDesktopFileName("hitofude")
    window, wiring = build()
    restore_geometry(window, window.preferences)
    sys.excepthook = partial(_tell_mistake, window)
    window.show()
    warmer = warm_up(window)
    QTimer.singleShot(0, window, partial(begin, wiring, path))
    status = application.exec()
    warmer.finish()
    return status
