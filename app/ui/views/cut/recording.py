"""Records the cut as it is played: pictures painted apart from the window, written as single files or as a moving
picture. No Qt.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from ....core.atomic import sweep, waiting_prefix, write_atomically
from ....core.errors import HitofudeError, InputError
from ....core.progress import NO_PROGRESS, Progress
from ....simulation.gpu.graphics import standalone_context
from ....simulation.gpu.wedges_picture import WedgesPicture
from .camera import Camera
from .cell_colours import CellColours
from .cell_patch import CellPatch
from .cut_picture import CutPicture
from .gif import MOST_PER_SECOND, Pixels, gif_chunks
from .rendering.cut_frame import CutFrame
from .rendering.cut_scene import CutScene
from .rendering.tool_body import Place
from .tool_outline import DrawnTool

_PACKING = 3
"""How hard PNG files are packed, 0 to 9: harder takes longer than painting."""


@dataclass(frozen=True, eq=False)
class CutSnapshot:
    """A cut to begin with, or to go on with: heights, and the colours of its cells."""

    picture: CutPicture
    colours: CellColours


@dataclass(frozen=True, eq=False)
class FrameChange:
    """What one picture of a recording shows otherwise than the one before.

    Attributes:
        whole: another cut; the first shot has one. patches: cells that have changed.
        tool: what is shown at `tip`, mm; None = none. wedges: facets round it.
        camera: from where; None = from where the frame says.
    """

    whole: CutSnapshot | None = None
    patches: tuple[CellPatch, ...] = ()
    tool: DrawnTool | None = None
    tip: Place = (0.0, 0.0, 0.0)
    wedges: WedgesPicture | None = None
    camera: Camera | None = None


@dataclass(frozen=True, slots=True)
class RecordingLength:
    """How many pictures a recording has, >= 1, and how many are shown a second, in (0, 50] for GIF."""

    count: int
    per_second: float = 25.0


def rendered(shots: Iterable[FrameChange], frame: CutFrame) -> Iterator[Pixels]:
    """Paint pictures in a context of their own, on the caller's thread, so that no window is disturbed.

    Args:
        shots: what each shows. frame: size, look, section, paths, and the camera where a shot has none of its own.

    Yields:
        (height, width, 3), each its own array.

    Raises:
        HitofudeError: there is no OpenGL 3.3.
    """
    context = standalone_context()
    with context:
        scene = CutScene(context)
    try:
        before = FrameChange()
        for shot in shots:
            with context:  # only while it is painted: meanwhile the thread may need another one
                _set_up(scene, shot, before)
                scene.draw(replace(frame, camera=shot.camera or frame.camera, budget=0))
                pixels = scene.pixels().copy()
            before = shot
            yield pixels
    finally:
        with context:
            scene.release()
        context.release()


def _set_up(scene: CutScene, shot: FrameChange, before: FrameChange) -> None:
    """Show what a shot shows otherwise than the one before."""
    if shot.whole is not None:
        scene.show_picture(shot.whole.picture)
        scene.show_colours(shot.whole.colours)
        scene.show_paths(shot.whole.picture.paths)
    for patch in shot.patches:
        scene.patch(patch)
    if shot.tool is not before.tool:
        scene.show_tool(shot.tool)
    if shot.wedges is not before.wedges:
        scene.show_wedges(shot.wedges)
    scene.place_tool(shot.tip)


def record(
    shots: Iterable[FrameChange], frame: CutFrame, target: Path, reel: RecordingLength, progress: Progress = NO_PROGRESS
) -> None:
    """Paint and write: a moving picture where the target's name ends in ".gif", else a folder of single pictures.

    Raises:
        HitofudeError: there is no OpenGL 3.3. InputError: it cannot be written.
        Cancelled: nothing was written.
    """
    sweep(target.parent)
    write = write_gif if target.suffix.casefold() == ".gif" else write_pictures
    write(rendered(shots, frame), target, reel, progress)


def write_gif(frames: Iterator[Pixels], path: Path, reel: RecordingLength, progress: Progress = NO_PROGRESS) -> None:
    """Write pictures as a GIF that is shown for ever: whole or not at all.

    Raises:
        InputError: it cannot be written, or shall be shown faster than a GIF can be. Cancelled: nothing was written.
    """
    if not 0 < reel.per_second <= MOST_PER_SECOND:
        raise InputError(
            f"A GIF cannot show {reel.per_second:g} pictures a second; use more than 0 and not more than "
            f"{MOST_PER_SECOND:g}."
        )
    write_atomically(path, b"".join(gif_chunks(_told(frames, reel, progress), reel.per_second)))
    progress.step(1.0, "Recorded")


def write_pictures(
    frames: Iterator[Pixels], folder: Path, reel: RecordingLength, progress: Progress = NO_PROGRESS
) -> None:
    """Write pictures as frame_0001.png and so on into a new folder: all or none.

    Raises:
        InputError: they cannot be written, or something is in the folder already. Cancelled: nothing was written.
    """
    try:
        if folder.exists() and (not folder.is_dir() or any(folder.iterdir())):
            raise InputError(
                f"{folder} is not empty; name a new folder for the pictures, so that no others are among them."
            )
        waiting = Path(tempfile.mkdtemp(prefix=waiting_prefix(folder.name), suffix=".part", dir=folder.parent))
        try:
            whole = waiting / "whole"  # a folder for one's own eyes alone is no place for pictures
            whole.mkdir()
            for number, frame in enumerate(_told(frames, reel, progress), 1):
                (whole / f"frame_{number:04d}.png").write_bytes(_png(frame))
            if folder.exists():
                folder.rmdir()
            whole.rename(folder)
        finally:
            shutil.rmtree(waiting, ignore_errors=True)
    except OSError as error:
        raise InputError(f"Cannot write {folder}: {error.strerror or error}.") from error
    progress.step(1.0, "Recorded")


def _told(frames: Iterator[Pixels], reel: RecordingLength, progress: Progress) -> Iterator[Pixels]:
    """Hand pictures on, and tell how many there were; stop painting when nobody wants more."""
    try:
        for number in range(reel.count):
            progress.step(number / reel.count, f"Recording picture {number + 1} of {reel.count}")
            frame = next(frames, None)
            if frame is None:
                return
            yield frame
    finally:
        close = getattr(frames, "close", None)
        if close is not None:
            close()


def _png(frame: Pixels) -> bytes:
    import cv2

    done, packed = cv2.imencode(".png", np.ascontiguousarray(frame[..., ::-1]), [cv2.IMWRITE_PNG_COMPRESSION, _PACKING])
    if not done:
        raise HitofudeError(f"OpenCV {cv2.__version__} cannot pack a picture as PNG.")
    return bytes(packed)
