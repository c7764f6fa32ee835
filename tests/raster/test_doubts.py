"""The places of a line drawing that can be read in two ways are found where they are, and clean lines have none."""

import cv2
import numpy as np
import pytest

from app.raster.ambiguities import Ambiguity, AmbiguityKind, ambiguities
from app.raster.picture import thresholded
from app.raster.picture_options import PictureOptions
from tests.raster.test_picture import ink_of, paper


def test_a_clear_picture_leaves_nothing_open() -> None:
    assert ambiguities(thresholded(paper(), 1.0, PictureOptions()).ink) == ()
    assert ambiguities(np.zeros((9, 9), bool)) == ()


def doubts(gray: np.ndarray) -> list[tuple[AmbiguityKind, int, int]]:
    found = ambiguities(thresholded(gray, 1.0, PictureOptions()).ink)
    return [(each.kind, round(each.col / 5) * 5, round(each.row / 5) * 5) for each in found]


def test_where_lines_meet_is_told() -> None:
    gray = paper()
    cv2.line(gray, (110, 20), (110, 100), 30, 2)
    assert doubts(gray) == [(AmbiguityKind.JUNCTION, 110, 20), (AmbiguityKind.JUNCTION, 110, 100)]


def test_where_a_line_nearly_closes_is_told() -> None:
    gray = paper()
    gray[18:24, 100:102] = 255
    assert doubts(gray) == [(AmbiguityKind.GAP, 100, 20)]


def test_where_two_lines_have_become_one_is_told() -> None:
    gray = paper()
    cv2.line(gray, (137, 40), (137, 80), 30, 2)
    assert [each[0] for each in doubts(gray)] == [AmbiguityKind.MERGED]


def test_lines_of_one_pixel_that_run_side_by_side_are_told() -> None:
    ink = ink_of(
        "............", ".##########.", ".##########.", ".#........#.", ".#........#.", ".##########.", "............"
    )
    assert [each.kind for each in ambiguities(ink)] == [AmbiguityKind.MERGED]


def test_lines_a_pixel_apart_are_told() -> None:
    gray = paper()
    cv2.line(gray, (136, 40), (136, 80), 30, 2)
    assert AmbiguityKind.NARROW in [each[0] for each in doubts(gray)]


def found(gray: np.ndarray) -> tuple[np.ndarray, tuple[Ambiguity, ...]]:
    ink = thresholded(gray, 1.0, PictureOptions()).ink
    return ink, ambiguities(ink)


def hand_drawn(width: int, count: int = 60, upto: int = 60) -> np.ndarray:
    """A ring of short lines, each end of which is up to 2 px off."""
    gray = np.full((300, 400), 255, np.uint8)
    turn, off = np.arange(count) / count * 2 * np.pi, np.random.default_rng(2).uniform(-2, 2, (count, 2))
    points = np.stack([200 + 120 * np.cos(turn), 150 + 100 * np.sin(turn)], axis=1) + off
    cv2.polylines(gray, [np.rint(points[:upto]).astype(np.int32)], upto == count, 0, width)
    return gray


@pytest.mark.parametrize("width", [1, 2, 3, 4, 5, 8, 12])
@pytest.mark.parametrize("figure", ["rectangle", "exact", "circle", "slanted", "hand", "blurred"])
def test_clean_lines_of_any_width_leave_nothing_open(figure: str, width: int) -> None:
    gray = np.full((300, 400), 255, np.uint8)
    if figure == "rectangle":
        cv2.rectangle(gray, (50, 50), (350, 250), 0, width)
    elif figure == "exact":
        gray[50:250, 50:350] = 0
        gray[50 + width : 250 - width, 50 + width : 350 - width] = 255
    elif figure == "hand":
        gray = hand_drawn(width)
    elif figure == "slanted":
        cv2.polylines(gray, [np.array([(200, 30), (370, 160), (210, 270), (40, 140)], np.int32)], True, 0, width)
    else:
        cv2.circle(gray, (200, 150), 110, 0, width)
    if figure == "blurred" and width > 1:
        gray = cv2.GaussianBlur(gray, (3, 3), 0.7)
    assert found(gray)[1] == ()


@pytest.mark.parametrize("width", [1, 2, 3, 5, 8])
def test_two_lines_of_any_width_that_run_into_one_are_told_on_the_ink(width: int) -> None:
    gray = np.full((300, 400), 255, np.uint8)
    for left, right in ((60, 160), (160, 260)):
        gray[60:240, left:right] = 0
        gray[60 + width : 240 - width, left + width : right - width] = 255
    ink, places = found(gray)
    (merged,) = [each for each in places if each.kind is AmbiguityKind.MERGED]
    assert abs(merged.col - 160) <= width + 1
    assert 140 < merged.row < 160
    assert all(ink[int(each.row), int(each.col)] for each in places)


def plate(gap: int, *, island: bool) -> np.ndarray:
    """An outline of lines of 2 px with a gap in it."""
    gray = np.full((300, 400), 255, np.uint8)
    gray[50:252, 50:352] = 0
    gray[52:250, 52:350] = 255
    if island:
        cv2.circle(gray, (220, 160), 40, 0, 2)
    gray[49:55, 150 : 150 + gap] = 255
    return gray


@pytest.mark.parametrize("island", [False, True])
@pytest.mark.parametrize("gap", [1, 2])
def test_a_narrow_gap_comes_first_counts_and_lies_in_the_gap(gap: int, island: bool) -> None:
    ink, (place,) = found(plate(gap, island=island))
    assert (place.kind, place.counts) == (AmbiguityKind.GAP, True)
    assert not ink[int(place.row), int(place.col)]
    assert 150 <= place.col < 150 + gap
    assert place.where in ("column 150, row 50", "column 151, row 50", "column 150, row 51", "column 151, row 51")


@pytest.mark.parametrize("island", [False, True])
@pytest.mark.parametrize("gap", [3, 4, 40])
def test_a_line_that_encloses_nothing_is_told_with_its_ends(gap: int, island: bool) -> None:
    ink, (place,) = found(plate(gap, island=island))
    assert (place.kind, place.counts) == (AmbiguityKind.OPEN, True)
    ends = sorted([(place.col, place.row), *place.others])
    assert [round(col) for col, _ in ends] == pytest.approx([150, 150 + gap], abs=1)
    assert all(ink[int(row), int(col)] and 50 <= row < 52 for col, row in ends)


@pytest.mark.parametrize("width", [1, 2, 3, 6])
def test_a_hand_drawn_line_that_is_not_closed_is_told_with_its_ends(width: int) -> None:
    ink, (place,) = found(hand_drawn(width, upto=55))
    assert place.kind is AmbiguityKind.OPEN
    assert len(place.others) == 1
    assert ink[int(place.row), int(place.col)]


def test_every_end_of_a_forked_line_is_told_and_a_spot_has_none() -> None:
    gray = np.full((200, 200), 255, np.uint8)
    cv2.line(gray, (20, 100), (180, 100), 0, 2)
    cv2.line(gray, (100, 100), (100, 180), 0, 2)
    cv2.circle(gray, (40, 40), 4, 0, -1)
    _, (place,) = found(gray)
    ends = sorted([(place.col, place.row), *place.others])
    assert [x for end in ends for x in end] == pytest.approx([20, 100, 100, 180, 180, 100], abs=2)


def test_what_counts_comes_first() -> None:
    gray = plate(1, island=False)
    cv2.rectangle(gray, (100, 100), (200, 200), 0, 2)
    cv2.line(gray, (150, 100), (150, 200), 0, 2)
    cv2.line(gray, (250, 100), (250, 200), 0, 2)
    assert [each.kind for each in found(gray)[1]] == [
        AmbiguityKind.GAP,
        AmbiguityKind.OPEN,
        AmbiguityKind.JUNCTION,
        AmbiguityKind.JUNCTION,
    ]
