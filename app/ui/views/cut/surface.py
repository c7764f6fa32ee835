"""Where a cut reaches the screen: a widget with OpenGL of its own, or, where there is none, a picture painted without a
screen.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cache, partial
from typing import TYPE_CHECKING, TypeVar

from PySide6.QtCore import QSize, Qt, Signal
from PySide6.QtGui import (
    QImage,
    QOffscreenSurface,
    QOpenGLContext,
    QPainter,
    QPaintEvent,
    QResizeEvent,
    QSurfaceFormat,
)
from PySide6.QtOpenGLWidgets import QOpenGLWidget
from PySide6.QtWidgets import QWidget

from ....core.errors import HitofudeError
from ....simulation.gpu.graphics import is_software, standalone_context
from .rendering.cut_scene import CutScene

if TYPE_CHECKING:
    import moderngl

T = TypeVar("T")
Paint = Callable[[CutScene], None]

_NEEDED = (3, 3)
_GL_RENDERER = 0x1F01
_FATAL = ("GL_OUT_OF_MEMORY", "GL_UNKNOWN_ERROR")
"""The second one is what a lost context is called here."""


def surface_format() -> QSurfaceFormat:
    """Return what the widget asks of OpenGL; depth and samples are those of the picture that it shows."""
    made = QSurfaceFormat()
    made.setVersion(*_NEEDED)
    made.setProfile(QSurfaceFormat.OpenGLContextProfile.CoreProfile)
    return made


@cache
def widgets_have_opengl() -> bool:
    """Return whether widgets can paint with OpenGL 3.3 here; Qt's offscreen platform cannot."""
    context = QOpenGLContext()
    context.setFormat(surface_format())
    return context.create() and context.format().version() >= _NEEDED


@cache
def widgets_paint_in_software() -> bool:
    """Return whether the OpenGL of widgets is the processor's work, and no graphics hardware's."""
    context, place = QOpenGLContext(), QOffscreenSurface()
    context.setFormat(surface_format())
    if not context.create():
        return True
    place.setFormat(context.format())
    place.create()
    if not context.makeCurrent(place):
        return True
    name = str(context.functions().glGetString(_GL_RENDERER))
    context.doneCurrent()
    return is_software(name)


class GlSurface(QOpenGLWidget):
    """Shows a scene by the OpenGL of the screen.

    Signals:
        renewed(): the scene is a new one and knows nothing. broken(words): nothing can be painted here any more.
    """

    renewed = Signal()
    broken = Signal(str)

    def __init__(self, parent: QWidget, paint: Paint) -> None:
        super().__init__(parent)
        self.setFormat(surface_format())
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self._paint = paint
        self._scene: CutScene | None = None
        self._resizing = False

    def resizeEvent(self, event: QResizeEvent) -> None:  # noqa: N802 (Qt's name)
        """Take another size; Qt would paint at once, and again when the window is painted."""
        self._resizing = True
        super().resizeEvent(event)
        self._resizing = False
        self.update()

    def initializeGL(self) -> None:  # noqa: N802 (Qt's name)
        """Make the scene; Qt calls this again when the widget moves to another window."""
        import moderngl

        try:
            self._scene = CutScene(moderngl.create_context(require=330))
        except Exception as fault:  # whatever a driver comes up with
            self.broken.emit(_words(fault))
            return
        self.context().aboutToBeDestroyed.connect(self._leave)
        self.renewed.emit()

    def paintGL(self) -> None:  # noqa: N802 (Qt's name)
        """Paint what is due and copy it to the screen."""
        if self._scene is None or self._resizing:
            return
        try:
            target = self._scene.ctx.detect_framebuffer(self.defaultFramebufferObject())
            self._paint(self._scene)
            self._scene.copy_to(target)
            target.use()
            ensure_sound(self._scene)
        except Exception as fault:  # whatever a driver comes up with
            self._scene = None
            self.broken.emit(_words(fault))

    def work(self, act: Callable[[CutScene], T]) -> T | None:
        """Do something with the scene between two paintings; None before the first one, and where it fails."""
        if self._scene is None:
            return None
        self.makeCurrent()
        try:
            return act(self._scene)
        except Exception as fault:  # whatever a driver comes up with
            self._scene = None
            self.broken.emit(_words(fault))
            return None
        finally:
            self.doneCurrent()

    def _leave(self) -> None:
        """Give everything back before the context goes."""
        self.work(CutScene.release)
        self._scene = None


class ImageSurface(QWidget):
    """Shows a scene as a picture that is painted without a screen.

    Signals:
        renewed(): the scene is a new one and knows nothing. broken(words): nothing can be painted here any more.
    """

    renewed = Signal()
    broken = Signal(str)

    def __init__(self, parent: QWidget, paint: Paint) -> None:
        """Make the scene.

        Raises:
            HitofudeError: there is no OpenGL 3.3.
        """
        super().__init__(parent)
        self.setAttribute(Qt.WidgetAttribute.WA_TransparentForMouseEvents)
        self.setAttribute(Qt.WidgetAttribute.WA_OpaquePaintEvent)
        self._paint, self._context = paint, standalone_context()
        with self._context:
            self._scene = CutScene(self._context)
        self.destroyed.connect(partial(_leave, self._context, self._scene))

    def work(self, act: Callable[[CutScene], T]) -> T:
        """Do something with the scene; its context is current meanwhile and not a moment longer, for others want
        theirs.
        """
        with self._context:
            return act(self._scene)

    def paintEvent(self, event: QPaintEvent) -> None:  # noqa: N802 (Qt's name)
        """Paint what is due and show it."""
        try:
            self.work(self._paint)
            self.work(ensure_sound)
            picture = self.work(image_of)
        except Exception as fault:  # whatever a driver comes up with
            self.broken.emit(_words(fault))
            return
        picture.setDevicePixelRatio(self.devicePixelRatioF())
        QPainter(self).drawImage(0, 0, picture)


def _leave(context: moderngl.Context, scene: CutScene) -> None:
    """Give everything back that a picture was painted with."""
    with context:
        scene.release()
    context.release()


def image_of(scene: CutScene) -> QImage:
    """Return what a scene has painted last."""
    pixels = scene.pixels()
    height, width, _ = pixels.shape
    return QImage(pixels.tobytes(), width, height, 3 * width, QImage.Format.Format_RGB888).copy()


def ensure_sound(scene: CutScene) -> None:
    """Refuse a graphics system that has lost its memory or its context; the toolkit's own calls may leave lesser errors
    behind.

    Raises:
        RuntimeError: it has; its name for it.
    """
    if (error := scene.ctx.error) in _FATAL:
        raise RuntimeError(error)


def _words(fault: Exception) -> str:
    return " ".join(str(fault).split())[:160] or type(fault).__name__


def made_surface(parent: QWidget, paint: Paint, own: bool = True) -> GlSurface | ImageSurface:
    """Return the surface that this screen can have.

    A widget with OpenGL has Qt make the window anew, which is seen and takes the keyboard from it, and put all of it
    together with OpenGL from then on. That is worth it where hardware does so; the processor takes 20 ms longer for
    each picture of any view, so what it paints is handed over as a picture.

    Args:
        parent: of the widget.
        paint: paints what is due; called with the context current.
        own: False: not by the screen's OpenGL, as it has failed.

    Raises:
        HitofudeError: there is no OpenGL 3.3.
    """
    if not own or not widgets_have_opengl():
        return ImageSurface(parent, paint)
    if widgets_paint_in_software():
        with suppress(HitofudeError):  # no OpenGL but the screen's
            return ImageSurface(parent, paint)
    return GlSurface(parent, paint)


def pixel_size(widget: QWidget) -> tuple[int, int]:
    """Return width and height of a widget in the screen's own px, at least 1."""
    size: QSize = widget.size()
    ratio = widget.devicePixelRatioF()
    return max(1, round(size.width() * ratio)), max(1, round(size.height() * ratio))
