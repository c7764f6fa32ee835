"""What `smooth` wrote, held against what it was given: from both texts alone, at a million places of each program.

Nothing of our reader, curves or judge is asked, only what the certificate states: no place of a curve is farther from
the moves that it stands for than the bound of its stretch, and no place of these farther from the curve.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from app.gcode.posts import load_post
from app.usecases.smoothing.report import report
from app.usecases.smoothing.result import OutputForm, SmoothedProgram, SmoothOptions
from app.usecases.smoothing.smooth import smooth
from tests.usecases.written_curves import Floats, along, in_order, long, moves_of, off, spread

HEAD = "G21 G90 G17 G94 G40 G49 G80\nT1 M6\nS8000 M3\nG0 X{:.4f} Y{:.4f} Z5\nG1 Z{:.4f} F200\n"
TAIL = "G0 Z5\nM5\nM2\n"
PLACES = 500_000
"""Of the curves, and as many of the moves, per program."""
WALK = 2000
EXACT, CHORDS = 1e-9, 1e-6
"""mm; what float64 may add, and how far a chord from one place of the curve to the next may be from it."""

WAYS = {
    "lines": (OutputForm.LINES, "linuxcnc"),
    "arcs": (OutputForm.ARCS, "linuxcnc"),
    "knots": (OutputForm.NURBS, "fanuc"),
    "biarcs": (OutputForm.NURBS, "linuxcnc"),
}


def program(points: Floats) -> bytes:
    lines = "".join(f"X{x:.4f} Y{y:.4f} Z{z:.4f}\n" for x, y, z in points[1:])
    return (HEAD.format(*points[0]) + "G1 F900 " + lines + TAIL).encode()


def flat(x: Floats, y: Floats) -> Floats:
    return np.column_stack([x, y, np.full(len(x), -1.0)])


def ring(angle: Floats, radius: float | Floats = 20.0) -> Floats:
    return flat(radius * np.cos(angle), radius * np.sin(angle))


def bulge() -> Floats:
    """Points of two bends, and one long chord between: a curve by the points alone swings out beside it."""
    t = np.linspace(0, 1.4, 60)
    one = flat(6 * np.sin(t) - 6 * math.sin(1.4), 6 - 6 * np.cos(t) - 6 + 6 * math.cos(1.4))
    way = np.array([math.cos(1.4), math.sin(1.4), 0])
    return np.vstack([one, one[-1] + 5 * way + (one[::-1] - one[-1]) * [-1, -1, 0]])


def tiny_beside_long() -> Floats:
    """Crumbs of 2 um, now along and now across, between chords of 8 mm that hardly bend."""
    places = []
    for k in range(30):
        angle = 0.02 * k
        at = np.array([400 * math.sin(angle), 400 - 400 * math.cos(angle)])
        way = np.array([math.cos(angle), math.sin(angle)])
        side = np.array([-way[1], way[0]])
        places += [at, at + 0.002 * (way if k % 2 else side)]
    x, y = np.array(places).T
    return flat(x, y)


def zigzag() -> Floats:
    """Teeth as high as the tolerance, then three times, then ten."""
    x = np.arange(600) * 0.1
    high = np.repeat([0.02, 0.06, 0.2], 200)
    return flat(x, high * (np.arange(600) % 2))


def repeated() -> Floats:
    return np.repeat(ring(np.linspace(0, 3, 200)), np.where(np.arange(200) % 7, 1, 3), axis=0)


def reversal() -> Floats:
    """Out, straight back over itself, and out again along a bend that ends in another one."""
    x = np.concatenate([np.linspace(0, 20, 80), np.linspace(20, 5, 60)[1:], np.linspace(5, 30, 90)[1:]])
    back = np.linspace(0, math.pi, 120)[1:]
    bend = flat(30 + 4 * np.sin(back), 4 - 4 * np.cos(back))
    return np.vstack([flat(x, 0 * x), bend, bend[-2:60:-1]])


def eight() -> Floats:
    t = np.linspace(0, math.tau, 500)
    return flat(20 * np.sin(t), 12 * np.sin(2 * t))


def closed() -> Floats:
    t = np.linspace(0, math.tau, 700)
    return ring(t, 14 + 2 * np.sin(5 * t) + np.sin(13 * t))


def helix() -> Floats:
    t = np.linspace(0, 6 * math.pi, 900)
    return np.column_stack([8 * np.cos(t), 8 * np.sin(t), -1 - 0.4 * t])


def twisted() -> Floats:
    """A space curve in no plane."""
    t = np.linspace(0, math.tau, 700)
    return np.column_stack([20 * np.cos(t), 15 * np.sin(2 * t), -3 + 2 * np.sin(3 * t)])


def noisy() -> Floats:
    """A wave with noise of a third of the tolerance."""
    x = np.linspace(0, 60, 900)
    noise = np.random.default_rng(8).uniform(-0.006, 0.006, (900, 3)) * [1, 1, 0]
    return flat(x, 5 * np.sin(x / 5)) + noise


def quantised() -> Floats:
    """A circle on a grid of 10 um."""
    return np.round(ring(np.linspace(0, math.tau, 800)), 2)


def dense() -> Floats:
    """Chords of 10 um, two bends."""
    t = np.arange(0, 2.4, 0.01 / 8)
    one = ring(t, 8.0)
    return np.vstack([one, 2 * one[-1] - one[-2::-1]])


ADVERSARIES: dict[str, tuple[Callable[[], Floats], float]] = {
    "bulge": (bulge, 0.02),
    "crumbs": (tiny_beside_long, 0.02),
    "zigzag": (zigzag, 0.02),
    "repeated": (repeated, 0.02),
    "reversal": (reversal, 0.02),
    "eight": (eight, 0.02),
    "closed": (closed, 0.02),
    "helix": (helix, 0.02),
    "twisted": (twisted, 0.02),
    "noisy": (noisy, 0.02),
    "quantised": (quantised, 0.02),
    "dense": (dense, 0.01),
}


def held(data: bytes, tolerance: float, way: str, middle: float | None = None) -> SmoothedProgram:
    """Smooth, and hold the written text against the given one."""
    form, post = WAYS[way]
    control = load_post(post)
    done = smooth("in.nc", data, SmoothOptions(tolerance, form, middle, post=control, dialect=control.dialect))
    stated = report(done)["tolerance"]["proven_mm"]
    assert stated == done.bound <= (middle or tolerance)
    old, new = data.decode(), done.data.decode()
    given, written = moves_of(old), moves_of(new)
    pairs = paired(old.splitlines(), new.splitlines(), done)
    whole = sum(long(done.pieces[k].points) for k in pairs)
    for k, (first, last) in pairs.items():
        piece, stretch = done.pieces[k], done.pieces[k].stretch
        moves = [move for move in given if stretch.first_line <= move.line <= stretch.last_line]
        points = np.vstack([moves[0].start, *(move.end for move in moves)])
        made = [move for move in written if first <= move.line <= last]
        assert not any(move.rapid for move in made)
        assert len(made) <= len(moves)
        share = long(points) / whole
        curve, polyline = along(made, math.ceil(PLACES * share)), spread(points, math.ceil(PLACES * share))
        assert piece.judgement is not None
        bound = piece.judgement.bound
        assert bound <= stated
        assert np.abs(curve[0] - points[0]).max() <= EXACT
        assert np.abs(curve[-1] - points[-1]).max() <= 5.1e-4, "as near as the control's last decimal"
        out, missed = float(off(curve, polyline).max()), float(off(polyline, curve).max())
        assert out <= bound + EXACT, "the curve leaves the tube"
        assert missed <= bound + CHORDS, "the curve leaves out some of the moves"
        assert middle is None or off(points, curve).max() <= tolerance + CHORDS, (
            "only between the points there is more room"
        )
        one, two = along(made, math.ceil(WALK * share)), spread(points, math.ceil(WALK * share))
        step = max(np.sqrt((np.diff(places, axis=0) ** 2).sum(axis=1)).max() for places in (one, two))
        assert in_order(one, two, bound + step), "the curve does not run in the order of the moves"
    return done


def paired(old: list[str], new: list[str], done: SmoothedProgram) -> dict[int, tuple[int, int]]:
    """Return the first and last line of each stretch that was written anew, and hold all other lines against the old
    ones.
    """
    lines, stop, end = {}, len(old), len(new)
    for k in reversed(range(len(done.pieces))):
        piece = done.pieces[k]
        if piece.judgement is None:
            continue
        kept = stop - piece.stretch.last_line
        assert new[end - kept : end] == old[stop - kept : stop]
        last = end - kept
        lines[k] = (last - piece.blocks[1] + 1, last)
        stop, end = piece.stretch.first_line - 1, last - piece.blocks[1]
    notes = end - stop
    assert any(new[:k] + new[k + notes : end] == old[:stop] for k in range(stop + 1)), (
        "what is before the first stretch"
    )
    return dict(reversed(lines.items()))


MAY_STAY = {("zigzag", "lines"), ("crumbs", "knots")}


def assert_anew(done: SmoothedProgram, name: str, way: str) -> None:
    """What stays as it was proves nothing."""
    anew = any(piece.judgement for piece in done.pieces)
    assert anew or (name, way) in MAY_STAY


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("adversary", ADVERSARIES)
def test_no_adversary_gets_the_curve_beyond_the_stated_bound(adversary: str, way: str) -> None:
    points, tolerance = ADVERSARIES[adversary]
    assert_anew(held(program(points()), tolerance, way), adversary, way)


def rounded_chords() -> Floats:
    """A circle in 40 chords, whose middles are 0.06 mm off it."""
    return ring(np.linspace(0, math.tau, 41))


def thinned() -> Floats:
    """A wave in few chords."""
    x = np.linspace(0, 60, 80)
    return flat(x, 5 * np.sin(x / 5))


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("points", [rounded_chords, thinned, lambda: helix()[::8]], ids=["circle", "wave", "helix"])
def test_in_a_barrel_there_is_more_room_between_the_points_and_only_there(
    points: Callable[[], Floats], way: str
) -> None:
    done = held(program(points()), 0.01, way, 0.07)
    assert way == "lines" or any(piece.judgement for piece in done.pieces)
    assert way != "arcs" or done.bound > 0.01, "the room is used"


@pytest.mark.parametrize("way", WAYS)
def test_a_real_engraving_keeps_to_the_stated_bound(data: Path, way: str) -> None:
    assert_anew(held((data / "nc" / "jsdc.gcode").read_bytes(), 0.05, way), "engraving", way)


@pytest.mark.parametrize("way", WAYS)
def test_a_piece_of_a_real_drop_cutter_program_keeps_to_the_stated_bound(data: Path, way: str) -> None:
    lines = (data / "nc" / "test_pycam.ngc").read_text().splitlines()
    assert_anew(held("\n".join([*lines[:47], *lines[4990:7500], "M2", ""]).encode(), 0.02, way), "drop cutter", way)


def test_the_oracle_sees_what_it_must_see() -> None:
    """A circle driven the other way is near everywhere and in the wrong order; one of 1 um more is too far away."""
    there = ring(np.linspace(0, math.tau, 2000))
    assert off(there[::-1], there).max() < EXACT
    assert in_order(there, there[::3], 0.3) and not in_order(there[::-1], there, 0.3)
    text = "G0 X20 Y0 Z-1\nG3 X20 Y0 I-20 J0\nG1 X20.001 Y0\nG3 X20.001 Y0 I-20.001 J0\n"
    _, one, _, two = moves_of(text)
    assert off(along([one], 3000), there).max() < 3e-5 < 9.6e-4 < off(along([two], 3000), there).max()
