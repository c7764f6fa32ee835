"""Shows the Cut view in a real window with OpenGL and says whether what stands on the screen is right: run under X."""

import sys
import time

import numpy as np
from PySide6.QtCore import QEventLoop, QTimer
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QApplication, QMainWindow, QStackedWidget, QWidget

from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.ui.framework.theme import DARK, LIGHT
from app.ui.views.cut.surface import GlSurface, ImageSurface, widgets_paint_in_software
from app.ui.views.cut.view import CutView
from app.ui.views.cut.zoom_controller import ZoomController, ZoomTarget
from tests.ui.cut.made_up import made_up
from tests.ui.cut.real_cut import real_shown


def wait(done):
    """Let the window live until something is so, at most 30 s."""
    end = time.monotonic() + 30
    while not done():
        if time.monotonic() > end:
            raise SystemExit("what should be shown did not come")
        loop = QEventLoop()
        QTimer.singleShot(10, loop.quit)
        loop.exec()


def pixels(window):
    """What the screen shows of a window, (height, width, 3)."""
    image = window.screen().grabWindow(window.winId()).toImage()
    image = image.convertToFormat(image.Format.Format_RGB888)
    flat = np.frombuffer(image.constBits(), np.uint8).reshape(image.height(), image.bytesPerLine())
    return flat[:, : 3 * image.width()].reshape(image.height(), image.width(), 3).astype(int)


def metal_share(window, view):
    """Share of the view that is not its ground."""
    shown = pixels(window)[: view.height(), : view.width()]
    ground = np.array(view.colours.theme.canvas.getRgb()[:3])
    return float((np.abs(shown - ground).max(axis=2) > 12).mean())


def look_closer(window, view):
    """Zoom into a real cut until its cells are fine, and out again."""
    shown, zooming = real_shown(), ZoomController(view.model, view.render_scheduler, view)
    zooming.found.connect(view.show_detail)
    zooming.follow(ZoomTarget(shown.cut))
    view.show_cut(shown.picture)
    view.fit()
    wait(lambda: view.render_scheduler.fine and metal_share(window, view) > 0.2)
    for _ in range(4):
        view.zoom_by(3.0)
        wait(lambda: view.render_scheduler.fine and not zooming.worker.busy)
        assert metal_share(window, view) > 0.7, "metal is missing round the finer part"
    assert view.model.detail.pitch < shown.picture.pitch / 10
    view.fit()
    wait(lambda: view.render_scheduler.fine and view.model.detail is None)
    zooming.worker.finish()


def settled(window, view):
    """What the screen shows once the fine picture has reached it."""
    wait(lambda: view.render_scheduler.fine)
    until = time.monotonic() + 0.5
    wait(lambda: time.monotonic() > until)
    return pixels(window)


def play(window, view):
    """Put a tool into the cut, let it move and take it out again."""
    tool = Tool(1, 6.0, ToolKind.BALL, flute_length=12.0, stick_out=30.0)
    bare = settled(window, view)
    for k in range(20):
        view.playback.show_tool(tool, (25.0 + k, 50.0, -8.0))
        wait(lambda: not view.render_scheduler.due)
    wait(lambda: view.render_scheduler.fine and (np.abs(pixels(window) - bare).max(axis=2) > 12).sum() > 500)
    view.playback.show_tool(None, None)
    wait(lambda: view.render_scheduler.fine and np.array_equal(pixels(window), bare))


def shown_as_a_picture(window, stack, view):
    """Show a cut where the processor paints: by a picture, so that the window stays the one it was."""
    before = window.winId()
    view.show_cut(made_up(100))
    stack.setCurrentWidget(view)
    wait(lambda: view.render_scheduler.fine and 0.3 < metal_share(window, view) < 0.7)
    assert isinstance(view.render_scheduler.surface, ImageSurface), type(view.render_scheduler.surface)
    assert window.winId() == before, "the window was made anew"
    assert not window.findChildren(QOpenGLWidget)


def with_hardware(parent, paint, _):
    """Return the surface of a screen with graphics hardware."""
    return GlSurface(parent, paint)


def main():
    """Show, resize, change the theme, leave the view and come back; print OK."""
    application = QApplication(sys.argv[:1])
    window, stack, view, other = QMainWindow(), QStackedWidget(), CutView(), QWidget()
    plain = CutView()
    stack.addWidget(plain)
    view.surface_host.make = with_hardware
    stack.addWidget(other)
    stack.addWidget(view)
    window.setCentralWidget(stack)
    window.resize(900, 600)
    view.set_theme(LIGHT)
    plain.set_theme(LIGHT)
    stack.setCurrentWidget(other)
    window.show()
    if widgets_paint_in_software():
        shown_as_a_picture(window, stack, plain)
    view.show_cut(made_up(200))
    assert view.render_scheduler.surface is None, "a surface before the view is shown"
    stack.setCurrentWidget(view)
    wait(lambda: view.render_scheduler.fine)
    assert isinstance(view.render_scheduler.surface, GlSurface), type(view.render_scheduler.surface)
    assert len(window.findChildren(QOpenGLWidget)) == 1, "more than one surface"
    wait(lambda: 0.3 < metal_share(window, view) < 0.7)
    play(window, view)
    window.resize(1100, 700)
    view.set_theme(DARK)
    wait(lambda: view.render_scheduler.fine and 0.3 < metal_share(window, view) < 0.7)
    stack.setCurrentWidget(other)
    wait(lambda: not view.isVisible())
    stack.setCurrentWidget(view)
    view.show_cut(made_up(160))
    wait(lambda: view.render_scheduler.fine and 0.3 < metal_share(window, view) < 0.7)
    look_closer(window, view)
    view.colours.worker.finish()
    print("OK")
    window.close()
    application.quit()


if __name__ == "__main__":
    main()
