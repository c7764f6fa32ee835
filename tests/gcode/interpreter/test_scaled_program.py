"""G51 and G51.1: every place here was computed by hand."""

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ToolOffset
from app.gcode.interpreter.program import NcProgram
from app.model.motion import MotionKind
from app.usecases.smoothing.result import SmoothOptions
from app.usecases.smoothing.smooth import smooth
from tests.gcode.interpreter.programs import ends, read, told, warnings

HEAD = "G21 G90 G17\nG0 X0. Y0. Z0.\n"

WINDOW = "O1\nF20. S500\nG0 X1. Y1.\nG1 X2.\nY2.\nG3 X1. R0.5\nG1 Y1.\nG0 X0. Y0.\nM99\n"
"""A window with a round top, as Haas' manual explains scaling by one."""


def centres(program: NcProgram) -> list[tuple[float, float]]:
    arcs = program.motions.kind >= MotionKind.ARC_CW
    return [(float(x), float(y)) for x, y in np.round(program.motions.centre[arcs][:, :2], 9)]


@pytest.mark.parametrize(
    ("scale", "corners", "middle"),
    [
        ("G51 P2.", [(2, 2), (4, 2), (4, 4), (2, 4), (2, 2), (0, 0)], (3, 4)),
        ("G51 X1.5 Y1.5 P2.", [(0.5, 0.5), (2.5, 0.5), (2.5, 2.5), (0.5, 2.5), (0.5, 0.5), (-1.5, -1.5)], (1.5, 2.5)),
        ("G51 X1. Y1. P2.", [(1, 1), (3, 1), (3, 3), (1, 3), (1, 1), (-1, -1)], (2, 3)),
    ],
)
@pytest.mark.parametrize("dialect", [Dialect.HAAS, Dialect.FANUC])
def test_a_window_scaled_about_a_point(
    dialect: Dialect, scale: str, corners: list[tuple[float, float]], middle: tuple[float, float]
) -> None:
    text = f"%\nO9\n{HEAD}{scale}\nM98 P1\nG50\nG0 X5. Y6.\nM30\n{WINDOW}%\n"
    program = read(text, dialect)
    assert ends(program)[1:] == [(x, y, 0) for x, y in [*corners, (5, 6)]]
    assert centres(program) == [middle] and MotionKind.ARC_CCW in program.motions.kind


def test_increments_and_centres_are_scaled_without_the_centre() -> None:
    text = f"{HEAD}G51 X10. Y0. Z0. P0.5\nG1 X20. Y0. Z-2. F9.\nG91 X4. Z-2.\nG2 X4. Y-4. J-4.\nG90 G50\n"
    program = read(text + "G0 X1. Y1. Z1.\nM30\n", Dialect.HAAS)
    assert ends(program)[1:] == [(15, 0, -1), (17, 0, -2), (19, -2, -2), (1, 1, 1)]
    assert centres(program) == [(17, -2)] and program.motions.feed[1] == 9.0


def test_lengths_count_in_inch_and_in_least_increments() -> None:
    text = "G20 G90 G0 X0. Y0. Z0.\nG51 X0. Y0. Z0. P2.\nG0 X10000 Y1.\nM30\n"
    assert ends(read(text, Dialect.FANUC))[1] == pytest.approx((50.8, 50.8, 0))


@pytest.mark.parametrize(
    ("lines", "first", "last", "centre", "turns_over"),
    [
        ("G51.1 X10.", (19, 0), (17, 2), (17, 0), True),
        ("G51.1 Y1.", (1, 2), (3, 0), (3, 2), True),
        ("G51.1 X10. Y1.", (19, 2), (17, 0), (17, 2), False),
        ("G51.1 X10.\nG51.1 Y1.", (19, 2), (17, 0), (17, 2), False),
        ("G51.1 X10. Y1.\nG50.1 X0.", (1, 2), (3, 0), (3, 2), True),
    ],
)
@pytest.mark.parametrize("dialect", [Dialect.HAAS, Dialect.FANUC])
@pytest.mark.parametrize("arc", ["G2 X3. Y2. I2. J0.", "G2 X3. Y2. R2.", "G3 X3. Y2. I2. J0."])
def test_arcs_in_a_mirror_turn_the_other_way(
    dialect: Dialect,
    arc: str,
    lines: str,
    first: tuple[float, float],
    last: tuple[float, float],
    centre: tuple[float, float],
    turns_over: bool,
) -> None:
    """From (1, 0) round (3, 0) to (3, 2), a quarter clockwise or three quarters the other way."""
    program = read(f"{HEAD}{lines}\nG0 X1. Y0.\n{arc} F9.\nM30\n", dialect)
    assert [end[:2] for end in ends(program)[1:]] == [first, last] and centres(program) == [centre]
    assert (program.motions.kind[-1] == MotionKind.ARC_CW) == (("G2" in arc) != turns_over)


def test_holes_in_a_mirror() -> None:
    cycle = "G99 G81 X2. Y1. R1. Z-3. F9.\nG91 X5. K2\nG90 G80\n"
    text = f"{HEAD}G51.1 X0.\nG0 X1. Y1. Z5.\n{cycle}G50.1 X0.\nG0 X1. Y0.\nM30\n"
    found = [end for end in ends(read(text, Dialect.FANUC)) if end[2] == -3]
    assert found == [(-2, 1, -3), (-7, 1, -3), (-12, 1, -3)]


def test_a_cutter_goes_on_the_other_side_in_a_mirror() -> None:
    """1 mm left of a wall at X10 that goes up, and right of the same wall in the mirror, which goes up too."""
    text = HEAD + "{}\nG0 X5. Y0.\nG41 D1 G1 X10. Y5. F9.\nY20.\nG40 X0.\nM30\n"
    table = {1: ToolOffset(diameter=2.0)}
    plain, mirrored = (read(text.format(mode), Dialect.FANUC, tool_table=table) for mode in ("G50", "G51.1 X0."))
    assert ends(plain)[-2] == (9, 20, 0)
    assert ends(mirrored) == [(0, 0, 0)] + [(-x, y, z) for x, y, z in ends(plain)[1:]]


def test_factors_of_axes_and_of_mach3() -> None:
    text = HEAD + "G51 X0. Y0. Z0. I2. J-1. K1.\nG1 X3. Y3. Z-1. F9.\nM30\n"
    assert ends(read(text, Dialect.FANUC))[1] == (6, -3, -1)
    text = "G21 G90 G91.1\nG0 X1. Y0. Z0.\nG51 X2 Y2\nG0 X1. Y1.\nG2 X2. Y2. I1. F9.\nG50\nG0 X1. Y1.\nM30\n"
    program = read(text, Dialect.MACH3)
    assert ends(program)[1:] == [(2, 2, 0), (4, 4, 0), (1, 1, 0)] and centres(program) == [(4, 2)]


@pytest.mark.parametrize(
    ("lines", "words"),
    [
        ("G51 X0. Y0.", "one of the machine's settings"),
        ("G51 P0.", "must be greater than 0"),
        ("G51 X0. Y0. Z0. I2. J1. K1.\nG0 X1. Y0.\nG2 X2. Y1. I1. F9.", "two factors"),
        ("G51 P2.\nG51 P3.", "write G50 before"),
        ("G51 P2.\nG51.1 X0.", "together"),
        ("G51.1 X0.\nG51 P2.", "together"),
        ("G51.1 X0.\nG55", "is not followed"),
        ("G51.1 X0.\nG92 X0.", "is not followed"),
        ("G51.1 X0.\nG28 X0.", "is not followed"),
        ("G51.1 X0.\nG68 X0. Y0. R30.", "is not followed"),
        ("G68 X0. Y0. R30.\nG51.1 X0.", "write G69 before"),
        ("G51.1 X0.\nG51.1 X0.", "write G50.1 before"),
        ("G51.1", "needs the axis"),
        ("G91 G51.1 X0.", "under G91"),
        ("G0 G51 P2.", "a block of its own"),
        ("G51 P2.\nG50 X1.", "a block of its own"),
        ("G51 P2.\nG81 X1. Y1. Z-1. R1. F9.", "while Z is scaled"),
        ("G51.1 X0.\nG16\nG0 X5. Y30.", "is not followed"),
    ],
)
def test_what_controls_do_differently_is_refused(lines: str, words: str) -> None:
    assert words in told(HEAD + lines + "\n", Dialect.FANUC)


def test_what_other_controls_do_not_have() -> None:
    assert "no I, J or K" in told(HEAD + "G51 X0. I2.\n", Dialect.HAAS)
    assert "does not know G51.1" in told(HEAD + "G51.1 X0.\n", Dialect.MACH3)
    assert "write its centre" in told(HEAD + "G51 X2.Y2.\nG2 X1. Y1. R1. F9.\n", Dialect.MACH3)
    assert "does not know G51.1" in told("G21\nG51.1 X0.\n", Dialect.LINUXCNC)


def test_a_first_move_that_is_not_sure_is_told() -> None:
    head = "G21 G90 G17 G0 X5. Y5. Z1.\n"
    for lines in ("G51.1 X0.\nY9.", "G51.1 X0.\nG91 X9.", "G51.1 X0.\nX9.\nG50.1\nY3."):
        assert any("first move behind G51" in text for text in warnings(head + lines + "\nM30\n", Dialect.FANUC)), lines
    for lines in ("G51.1 X0.\nX9.\nG50.1\nX3.", "G51 P2.\nY9.\nG50\nX1. Y1.", "G51.1 X5.\nY9."):
        assert not warnings(head + lines + "\nM30\n", Dialect.FANUC), lines
    assert any("takes the machine's own" in text for text in warnings(head + "G51 X0. Y0. I2. J2.\n", Dialect.FANUC))
    assert any("in thousandths" in text for text in warnings(head + "G51 X0. Y0. P2000\n", Dialect.FANUC))


def test_a_program_of_a_card_is_called_or_missed() -> None:
    text = "%\nO9\nG21 G90 G0 X0. Y0. Z0.\nM198 P1\nM30\nO1\nG0 X7.\nM99\n%\n"
    assert ends(read(text, Dialect.FANUC))[-1] == (7, 0, 0)
    assert "no subroutine O2" in told(text.replace("P1\n", "P2\n"), Dialect.FANUC)


@pytest.mark.parametrize("mode", ["G51.1 X0.", "G51 X0. Y0. Z0. P2.", "G16"])
def test_smoothing_leaves_blocks_whose_words_are_no_coordinates(mode: str) -> None:
    points = "".join(f"G1 X{10 + 0.1 * k:.3f} Y{(0.2 * k) ** 2 / 10:.3f}\n" for k in range(60))
    text = f"G21 G90 G17\nG0 X10. Y0. Z0.\n{mode}\nG1 X10. Y0. F100.\n{points}M30\n"
    made = smooth("a.nc", text.encode(), SmoothOptions(dialect=Dialect.FANUC))
    assert made.data.endswith(text.encode()) and not made.pieces
