"""The terminal by itself: its characters, its display, and the patterns by which one bit tells steps apart."""

import numpy as np
import pytest

from app.raster.frame import PixelCode
from app.raster.steps import StepState
from app.raster.trace import PixelChain, trace
from app.ui.views.session1986.glyphs import CELL, line_bits, spoken, wrapped
from app.ui.views.session1986.screen import (
    BOTTOM,
    COLUMNS,
    HEAD_PX,
    MARGIN_PX,
    PAGE_LINES,
    TALK_LINES,
    TOP,
    TerminalScreen,
    card,
)
from app.ui.views.session1986.stills import DASH, GAP, still_of

CHARACTERS = "".join(chr(code) for code in range(32, 96))


def square() -> np.ndarray:
    plane = np.zeros((400, 400), np.uint8)
    plane[100:201, 100:301] = PixelCode.CONTOUR
    plane[101:200, 101:300] = PixelCode.EMPTY
    return plane


def test_no_two_characters_look_alike_and_all_keep_their_distance() -> None:
    cells = line_bits(CHARACTERS).reshape(CELL, 64, CELL).transpose(1, 0, 2)
    assert len({cell.tobytes() for cell in cells}) == 64
    assert not cells[:, -1].any() and not cells[:, :, -1].any()
    assert not cells[0].any() and all(cell.any() for cell in cells[1:])


def test_what_the_terminal_lacks_is_said_in_what_it_has() -> None:
    assert spoken("ä 3 µm, 90° … x≤y") == "? 3 UM, 90 DEG ... X<=Y"
    assert line_bits("字").tobytes() == line_bits("?").tobytes()
    assert wrapped("one two three", 7) == ["ONE TWO", "THREE"]
    assert wrapped("abcdefgh", 3) == ["ABC", "DEF", "GH"]


def test_the_dialogue_never_runs_into_the_picture() -> None:
    screen = TerminalScreen(prompt="A QUESTION?", typed="9" * 120)
    for k in range(40):
        screen.say(f"line {k} " + "and more of it " * 5)
    screen.picture[:] = True
    bits = screen.bits()
    assert bits[TOP:BOTTOM].all()
    screen.picture[:] = False
    assert not screen.bits()[TOP:BOTTOM].any()
    last = line_bits(screen.asked()[-1])
    row = BOTTOM + 3 + 9 * (TALK_LINES - 1)
    assert np.array_equal(bits[row : row + CELL, MARGIN_PX : MARGIN_PX + last.shape[1]], last), (
        "what is typed is always seen"
    )


def test_the_head_is_dark_on_light() -> None:
    head = TerminalScreen(head=("130 FILLED", "1986")).bits()[:HEAD_PX]
    assert 0.7 < head.mean() < 1


def test_a_page_scrolls_back_to_its_first_line_and_no_further() -> None:
    screen = TerminalScreen(page=[f"N{k}" for k in range(200)], prompt="?")
    end = screen.bits()
    screen.scroll(1000)
    first = line_bits("N0")
    assert np.array_equal(
        screen.bits()[HEAD_PX + 4 : HEAD_PX + 4 + CELL, MARGIN_PX : MARGIN_PX + first.shape[1]], first
    )
    assert screen.up == 200 + 1 - PAGE_LINES
    screen.scroll(-1000)
    assert np.array_equal(screen.bits(), end)


def test_the_cross_hair_turns_points_over() -> None:
    screen = TerminalScreen(hair=(50, 60))
    screen.picture[50, 10] = True
    bits = screen.bits()
    assert bits[50, 11] and not bits[50, 10] and bits[100, 60] and not bits[50, 60]
    assert not bits[BOTTOM + 1 :, 60].any()


def test_the_key_card_fits() -> None:
    lit = np.argwhere(card())
    assert lit[:, 0].min() >= TOP and lit[:, 0].max() < BOTTOM and lit[:, 1].max() < COLUMNS * CELL


def test_the_contour_tool_s_path_is_dashed() -> None:
    chains, _ = trace(square())
    picture = still_of(StepState(120, square()), chains[:1]).picture
    assert not (picture & (square() == 0)).any()
    share = picture.sum() / (square() != 0).sum()
    assert share == pytest.approx(DASH / (DASH + GAP), abs=0.02)


def test_one_bit_tells_left_processed_and_paths_apart() -> None:
    plane = square()
    plane[120:180, 120:180], plane[120:180, 200:260] = PixelCode.CONTOUR, PixelCode.PROCESSED
    plane[150, 110:290] = PixelCode.RING
    picture = still_of(StepState(147, plane)).picture
    assert picture[121:149, 120:180].mean() == pytest.approx(1 / 2, abs=0.02)
    assert picture[121:149, 200:260].mean() == pytest.approx(1 / 16, abs=0.02)
    assert picture[150, 110:290].all()
    assert picture[121:149, 182:198].mean() == 0


@pytest.mark.parametrize(("number", "code"), [(206, PixelCode.R), (404, PixelCode.VERTEX)])
def test_marks_stand_out_as_blocks(number: int, code: PixelCode) -> None:
    plane = np.zeros((400, 400), np.uint8)
    plane[200, 200] = plane[12, 399] = code
    picture = still_of(StepState(number, plane)).picture
    assert picture[199:202, 199:202].all() and picture.sum() == 9 + 6


@pytest.mark.parametrize("directions", [[0] * 99, [2] * 99, [7] * 99, [5] * 99, [7, 6] * 50, [0, 1, 0, 0] * 25])
def test_a_path_that_is_still_to_be_smoothed_is_dotted_whichever_way_it_runs(directions: list[int]) -> None:
    chain = PixelChain((200, 200), np.array(directions, np.uint8))
    plane = np.zeros((400, 400), np.uint8)
    plane[tuple(chain.pixels().T)] = PixelCode.CONTOUR
    picture = still_of(StepState(402, plane), smoothed=[chain]).picture
    assert picture.sum() == pytest.approx(50, abs=1)
    plane = plane.copy()
    plane[tuple(chain.pixels()[:50].T)] = PixelCode.LONG_LINE
    assert still_of(StepState(403, plane), smoothed=[chain]).picture.sum() == pytest.approx(75, abs=1)


def test_a_still_names_step_region_and_turn() -> None:
    still = still_of(StepState(304, square(), region=2, turn=3))
    assert (still.number, still.name) == (304, "Mark it processed  AREA 2  TURN 3")
    assert still_of(StepState(130, square())).hold_ms > still.hold_ms
