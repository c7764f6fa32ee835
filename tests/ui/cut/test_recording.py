"""What is played is recorded: painted apart from the window, written whole or not at all."""

import os
import shutil
import signal
import subprocess
import sys
import threading
from itertools import pairwise
from pathlib import Path

import cv2
import numpy as np
import pytest

from app.core.atomic import sweep, waiting_prefix
from app.core.errors import Cancelled, InputError
from app.core.progress import Progress
from app.core.settings import Settings
from app.model.tool import Tool
from app.ui.shell.start import places
from app.ui.views.cut.camera import Camera
from app.ui.views.cut.cell_colours import CutColourBy, cell_colours
from app.ui.views.cut.cell_patch import patch_of
from app.ui.views.cut.cut_player import PlaybackPace
from app.ui.views.cut.model import middle
from app.ui.views.cut.record_sheet import RecordedMotion, RecordPlan
from app.ui.views.cut.recording import (
    CutSnapshot,
    FrameChange,
    RecordingLength,
    record,
    rendered,
    write_gif,
    write_pictures,
)
from app.ui.views.cut.recording_controller import RecordingRequest, turntable
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from app.ui.views.cut.tool_outline import DrawnTool, outline_of
from tests.conftest import ROOT
from tests.ui.cut.pictures import INKS, LOOK, flat_picture, without_a_screen
from tests.ui.cut.real_cut import real_shown

SIZE = (120, 90)
COUNT = 5


def frame():
    picture = flat_picture(np.zeros((64, 64)))
    return CutFrame(Camera().fitted(picture.low, picture.high, SIZE), SIZE, LOOK)


def shots():
    """A tool that cuts a groove, a piece a picture, and a look from elsewhere at the end."""
    heights, values = np.zeros((64, 64), np.float32), np.full((64, 64), 255, np.uint8)
    picture = flat_picture(heights.copy())
    tool = DrawnTool(outline_of(Tool(1, 2.0, stick_out=4.0)))
    for k in range(COUNT):
        place = (slice(28, 36), slice(10 * k, 10 * k + 10))
        heights[place], values[place] = -3.0, 0
        whole = CutSnapshot(picture, cell_colours(picture, CutColourBy.METAL, INKS)) if k == 0 else None
        camera = Camera(target=(5.0, 5.0, 0.0), pitch=1.5, scale=8.0) if k == COUNT - 1 else None
        yield FrameChange(
            whole,
            (patch_of(heights, values, picture.pitch, place),),
            tool,
            (10 * (k + 1) * 10 / 64, 5.0, -3.0),
            camera=camera,
        )


def directly():
    """The same pictures by a scene that is shown everything anew each time."""
    with without_a_screen() as context:
        made = []
        for shot in shots():
            patch, scene = shot.patches[0], CutScene(context)
            heights = made[-1][0].copy() if made else np.zeros((64, 64), np.float32)
            heights[patch.rows, patch.columns] = patch.heights
            picture = flat_picture(heights)
            scene.show_picture(picture)
            scene.show_colours(cell_colours(picture, CutColourBy.METAL, INKS))
            scene.show_tool(shot.tool)
            scene.place_tool(shot.tip)
            scene.draw(CutFrame(shot.camera or frame().camera, SIZE, LOOK))
            made.append((heights, scene.pixels().copy()))
            scene.release()
    return [pixels for _, pixels in made]


@pytest.fixture(scope="module")
def expected():
    return directly()


def test_pictures_are_those_that_a_scene_paints_shown_everything_anew(expected):
    got = list(rendered(shots(), frame()))
    assert len(got) == COUNT
    assert all(np.array_equal(one, other) for one, other in zip(got, expected, strict=True))
    assert all(np.any(one != other) for one, other in pairwise(got))


def test_it_paints_on_another_thread_and_leaves_no_context_current_there_or_here(expected):
    with without_a_screen() as mine:
        scene, found = CutScene(mine), []

        def work():
            found.extend(rendered(shots(), frame()))

        thread = threading.Thread(target=work)
        thread.start()
        thread.join()
        scene.show_picture(flat_picture(np.zeros((8, 8))))
        scene.draw(frame())
        assert scene.pixels().shape == (90, 120, 3)
        scene.release()
    assert all(np.array_equal(one, other) for one, other in zip(found, expected, strict=True))


def test_single_pictures_are_numbered_files(tmp_path: Path, expected):
    told = []
    record(
        shots(),
        frame(),
        tmp_path / "play",
        RecordingLength(COUNT),
        Progress(lambda share, text: told.append((share, text))),
    )
    files = sorted((tmp_path / "play").iterdir())
    assert [file.name for file in files] == [f"frame_{k:04d}.png" for k in range(1, COUNT + 1)]
    for file, pixels in zip(files, expected, strict=True):
        assert np.array_equal(cv2.imread(str(file))[..., ::-1], pixels)
    assert [path.name for path in tmp_path.iterdir()] == ["play"]
    assert told[0] == (0.0, "Recording picture 1 of 5") and told[-1][0] == 1.0
    assert [share for share, _ in told] == sorted(share for share, _ in told)


def test_a_name_that_ends_in_gif_is_a_moving_picture(tmp_path: Path, expected):
    record(shots(), frame(), tmp_path / "play.GIF", RecordingLength(COUNT, 20.0))
    done, found = cv2.imreadanimation(str(tmp_path / "play.GIF"))
    assert done and list(found.durations) == [50] * COUNT and len(found.frames) == COUNT
    for got, pixels in zip(found.frames, expected, strict=True):
        assert np.abs(got[..., 2::-1].astype(int) - pixels).mean() < 1.5


def test_a_folder_with_something_in_it_is_refused_and_an_empty_one_taken(tmp_path: Path):
    folder = tmp_path / "play"
    folder.mkdir()
    write_pictures(iter([np.zeros((4, 4, 3), np.uint8)]), folder, RecordingLength(1))
    with pytest.raises(InputError, match="play is not empty; name a new folder"):
        write_pictures(iter([np.zeros((4, 4, 3), np.uint8)]), folder, RecordingLength(1))
    assert len(list(folder.iterdir())) == 1
    (tmp_path / "file").write_text("x")
    with pytest.raises(InputError, match="file is not empty"):
        write_pictures(iter([]), tmp_path / "file", RecordingLength(1))
    with pytest.raises(InputError, match=r"Cannot write .*nowhere"):
        write_pictures(iter([]), tmp_path / "nowhere" / "play", RecordingLength(1))


@pytest.mark.parametrize("name", ["play", "play.gif"])
@pytest.mark.parametrize("fault", [Cancelled, RuntimeError])
def test_what_ends_before_its_end_leaves_nothing_behind(tmp_path: Path, name, fault):
    released = []

    def frames():
        try:
            yield np.zeros((4, 4, 3), np.uint8)
            if fault is Cancelled:
                stop.set()
                yield np.zeros((4, 4, 3), np.uint8)
                yield np.zeros((4, 4, 3), np.uint8)
            raise RuntimeError
        finally:
            released.append(True)

    stop = threading.Event()
    write = write_gif if name.endswith("gif") else write_pictures
    with pytest.raises(fault):
        write(frames(), tmp_path / name, RecordingLength(9), Progress(cancelled=stop))
    assert not list(tmp_path.iterdir()) and released == [True]


def test_a_gif_that_would_be_too_fast_is_refused(tmp_path: Path):
    with pytest.raises(InputError, match="cannot show 60 pictures a second; use more than 0 and not more than 50"):
        write_gif(iter([]), tmp_path / "play.gif", RecordingLength(1, 60.0))


KILLED = """
import os, signal, sys
from pathlib import Path
import numpy as np
from app.ui.views.cut.recording import RecordingLength, write_pictures

def frames():
    yield np.zeros((4, 4, 3), np.uint8)
    os.kill(os.getpid(), signal.SIGKILL)

write_pictures(frames(), Path(sys.argv[1]), RecordingLength(9))
"""


def test_what_a_killed_recording_has_left_is_swept_by_the_next_one_and_at_start(tmp_path: Path):
    def killed() -> Path:
        done = subprocess.run([sys.executable, "-c", KILLED, str(tmp_path / "play")], cwd=ROOT, timeout=60)
        assert done.returncode == -signal.SIGKILL
        (left,) = tmp_path.iterdir()
        assert len(list((left / "whole").iterdir())) == 1
        return left

    left = killed()
    record(shots(), frame(), tmp_path / "other", RecordingLength(COUNT))
    assert not left.exists() and [each.name for each in tmp_path.iterdir()] == ["other"]
    shutil.rmtree(tmp_path / "other")
    left = killed()
    assert tmp_path in places(Settings(last_folder=str(tmp_path)))
    sweep(*places(Settings(last_folder=str(tmp_path))))
    assert not left.exists()


def test_a_folder_that_tells_no_writer_or_a_living_one_is_not_swept(tmp_path: Path):
    (tmp_path / ".cut.a1b2c3d4.part").mkdir()
    os.utime(tmp_path / ".cut.a1b2c3d4.part", (0, 0))
    mine = tmp_path / f"{waiting_prefix('cut')}a1b2c3d4.part"
    mine.mkdir()
    sweep(tmp_path)
    assert len(list(tmp_path.iterdir())) == 2


def test_a_turntable_turns_the_whole_cut_once_round_its_middle():
    shown = real_shown()
    camera = Camera().fitted(shown.picture.low, shown.picture.high, SIZE)
    plan = RecordPlan(0.4, 20.0, SIZE[0], RecordedMotion.TURNTABLE)
    requested = RecordingRequest(
        shown, CutFrame(camera, SIZE, LOOK), plan, PlaybackPace.TIME, CutColourBy.METAL, INKS, False, Path("a.gif")
    )
    changes = list(turntable(requested))
    assert len(changes) == plan.count == 8 and changes[0].whole is not None and changes[1].whole is None
    centre = middle(shown.picture)[None]
    seen = [each.camera.project(centre, SIZE)[0, :2] for each in changes]
    assert np.allclose(seen, seen[0], atol=1e-6)
    turns = np.diff([each.camera.yaw for each in changes])
    assert np.allclose(turns, 2 * np.pi / 8)
