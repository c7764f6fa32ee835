"""Every state that is reached is, bit for bit, what cutting from the start leaves; in whatever order, with whatever is
kept.
"""

import threading

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from app.core.errors import Cancelled
from app.core.progress import Progress
from app.model.motion import MotionKind, Motions
from app.simulation.field.workpiece import Workpiece
from app.simulation.history.history import History, HistoryOptions, Playhead, changed_box
from app.simulation.sweeps import sweeps
from app.simulation.sweeps.course import Course, TrimOptions
from app.simulation.sweeps.sweeps import CutField
from app.simulation.sweeps.trim import trim
from tests.examples import examples
from tests.simulation.courses import CUTTERS, arc, box_piece, course_of, joined, motions_of, polyline
from tests.simulation.test_sweep import walk

TOOLS = {k + 1: cutter for k, cutter in enumerate(CUTTERS.values())}


def mixed(seed: int, count: int = 40) -> Course:
    """A walk by all tools, with rapids in between and arcs behind."""
    places = walk(seed, count, 2.0, 1.0)
    kinds = [MotionKind.RAPID if k % 9 == 8 else MotionKind.LINE for k in range(count - 1)]
    straight = [motions_of(places[k : k + 1], places[k + 1 : k + 2], kind) for k, kind in enumerate(kinds)]
    round_ = [arc((3, 0, -2 - 0.1 * k), (0, 3, -2 - 0.1 * k), (0, 0, -2 - 0.1 * k), ccw=bool(k % 2)) for k in range(4)]
    motions = joined([*straight, *round_])
    return Course(motions, (1 + np.arange(len(motions)) // 7 % len(TOOLS)).astype(np.int32))


def from_start(piece: Workpiece, courses: list[Course], motion: int) -> CutField:
    """What the first motions of some courses leave, cut one course after the other."""
    owner, done = np.full(piece.heights.shape, -1, np.int32), 0
    for course in courses:
        cut = trim(piece, course, TOOLS, TrimOptions(trace=True, stop=motion - done))
        assert cut.owner is not None
        owner, piece, done = (
            np.where(cut.owner >= 0, cut.owner + np.int32(done), owner),
            cut.workpiece,
            done + len(course.motions),
        )
    return CutField(piece.heights, owner)


def assert_alike(got: CutField, want: CutField) -> None:
    assert np.array_equal(got.heights, want.heights)
    assert np.array_equal(got.owner, want.owner)


@given(st.integers(0, 1000), st.integers(1, 60), st.sampled_from([0, 100_000, 400_000, 1 << 24]), st.data())
@settings(max_examples=examples(25), deadline=None)
def test_any_state_in_any_order(seed: int, blocks: int, budget: int, data: st.DataObject) -> None:
    piece, courses = box_piece(cells=150), [mixed(seed), mixed(seed + 1, 20)]
    history = History(piece, courses, TOOLS, HistoryOptions(blocks, budget))
    assert history.bytes <= budget
    head = Playhead(history)
    for motion in data.draw(st.lists(st.integers(0, history.motions), min_size=1, max_size=6)):
        head.move_to(motion)
        assert head.motion == motion
        assert_alike(head.field, from_start(piece, courses, motion))


def test_on_many_tiles_and_in_many_batches(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sweeps, "BATCH", 16)  # pieces that are made at a time: a size, as of memory, not a behaviour
    piece, courses = box_piece(cells=600), [mixed(3), mixed(5)]
    head = Playhead(History(piece, courses, TOOLS, HistoryOptions(11)))
    for motion in (17, 60, 59, 3, head.history.motions, 0, 31):
        head.move_to(motion)
        assert_alike(head.field, from_start(piece, courses, motion))


def test_there_and_back_motion_by_motion() -> None:
    piece, course = box_piece(cells=150), mixed(9)
    head = Playhead(History(piece, [course], TOOLS, HistoryOptions(8)))
    states = []
    for motion in range(head.history.motions + 1):
        head.move_to(motion)
        states.append(CutField(head.field.heights.copy(), head.field.owner.copy()))
    assert len({state.heights.tobytes() for state in states}) > 30
    for motion in reversed(range(head.history.motions + 1)):
        head.move_to(motion)
        assert_alike(head.field, states[motion])


def test_the_end_is_what_the_whole_course_leaves() -> None:
    piece, course = box_piece(cells=200), mixed(4)
    head = Playhead(History(piece, [course], TOOLS))
    head.move_to(10**9)
    whole = trim(piece, course, TOOLS, TrimOptions(trace=True))
    assert whole.owner is not None
    assert_alike(head.field, CutField(whole.heights, whole.owner))


def test_a_state_is_what_a_shorter_course_leaves() -> None:
    """Not bit for bit, for lines of cells may run the other way; but nothing is cut that the motions so far do not
    reach.
    """
    piece, course = box_piece(cells=150), mixed(2)
    head = Playhead(History(piece, [course], TOOLS))
    head.move_to(23)
    names = ("start", "end", "centre", "kind", "plane", "turns", "feed", "line", "state")
    short = Motions(*(getattr(course.motions, name)[:23] for name in names))
    apart = np.abs(head.field.heights - trim(piece, Course(short, course.tool[:23]), TOOLS).heights)
    assert np.mean(apart > 1e-5) < 1e-3


def test_less_memory_means_fewer_blocks_not_other_states() -> None:
    piece, course = box_piece(cells=256), mixed(6)
    rich, poor = (History(piece, [course], TOOLS, HistoryOptions(40, budget)) for budget in (1 << 24, 1_100_000))
    assert len(rich.ends) > 2 * len(poor.ends) >= 2
    assert poor.bytes <= 1_100_000 < rich.bytes
    assert rich.ends[-1] == poor.ends[-1] == len(course.motions)
    assert set(poor.ends.tolist()) < set(rich.ends.tolist())


def test_nothing_to_cut() -> None:
    piece = box_piece(cells=40)
    head = Playhead(History(piece, [course_of(Motions.none())], TOOLS))
    head.move_to(3)
    assert head.motion == 0
    assert np.array_equal(head.field.heights, piece.heights)


def test_the_work_piece_stays() -> None:
    piece = box_piece(cells=64)
    before = piece.heights.copy()
    head = Playhead(History(piece, [mixed(1)], TOOLS))
    head.move_to(30)
    head.move_to(2)
    assert np.array_equal(piece.heights, before)


def test_a_cancelled_move_leaves_no_half_state() -> None:
    piece, course = box_piece(cells=600), mixed(7)
    head = Playhead(History(piece, [course], TOOLS, HistoryOptions(1, 0)))
    stopped = threading.Event()
    stopped.set()
    with pytest.raises(Cancelled):
        head.move_to(30, Progress(cancelled=stopped))
    head.move_to(30)
    assert_alike(head.field, from_start(piece, [course], 30))


def test_what_has_changed_is_told_once() -> None:
    piece = box_piece(cells=200)
    head = Playhead(History(piece, [course_of(polyline([(-9, -9, 1), (-9, -9, -1), (-5, -9, -1)]))], TOOLS))
    shown = CutField(piece.heights.copy(), np.full(piece.heights.shape, -1, np.int32))
    head.move_to(3)
    box = changed_box(head.field, shown)
    assert box is not None
    cut = np.argwhere(head.field.heights < 0)
    assert np.all(cut >= box[:2])
    assert np.all(cut < box[2:])
    assert box[2] < 100
    assert changed_box(head.field, shown) is None
    assert_alike(shown, head.field)
