"""Rapids of controls that may move each axis at its own rate are looked at along the bent way too."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from app.gcode.interpreter.dialect import Dialect
from app.gcode.interpreter.options import ReadOptions
from app.gcode.interpreter.reader import read_program
from app.model.finding import Finding, FindingKind
from app.model.motion_path import anchored
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.simulation.field.workpiece import BoxStock
from app.usecases.cutting.cut import CutOptions, CutSetup, cut
from app.verify import accidents

PLATE = BoxStock(StockBox(0, 0, -10, 60, 40, 0))
HEAD = "O1\nG21 G90 G94 G17\nT1 M6\nS3000 M3\nG0 X5. Y5. Z5.\n"
SLOT = "G1 Z-3. F300.\nX45. Y25.\n"


def rapids(body: str, dialect: Dialect = Dialect.FANUC) -> list[Finding]:
    """Rapids in metal that a cut of a mill of 6 mm tells."""
    read = read_program(f"{HEAD}{body}M30\n".encode(), ReadOptions(dialect=dialect))
    assert read.error is None
    setup = CutSetup((replace(read, motions=anchored(read.motions)),), {1: Tool(1, 6.0)}, PLATE)
    found = cut(setup, CutOptions(cells=120)).findings
    return [finding for finding in found if finding.kind is FindingKind.RAPID_IN_MATERIAL]


@pytest.mark.parametrize("dialect", [Dialect.FANUC, Dialect.HAAS])
def test_a_rapid_back_through_a_slanting_slot_leaves_it_where_axes_go_by_themselves(dialect: Dialect) -> None:
    """Straight it goes where the mill was; both axes at one rate it comes to Y5 at X25, 20 mm beside the end."""
    (told,) = rapids(f"{SLOT}G0 X5. Y5.\nZ5.\n", dialect)
    assert told.counts and told.line == 8
    assert told.amount == pytest.approx(3.0, abs=1e-4)
    assert "each axis at its own rate" in told.text


@pytest.mark.parametrize("dialect", [Dialect.LINUXCNC, Dialect.MACH3])
def test_controls_whose_rapids_are_straight_are_told_nothing(dialect: Dialect) -> None:
    assert not rapids(f"{SLOT}G0 X5. Y5.\nZ5.\n", dialect)


@pytest.mark.parametrize(
    "body",
    [
        f"{SLOT}G0 Z5.\nX5. Y5.\n",
        "G1 Z-3. F300.\nX45.\nG0 X5.\nZ5.\n",
        "G1 Z-3. F300.\nX25. Y25.\nG0 X5. Y5.\nZ5.\n",
        "G0 X50. Y20. Z0.\nX5. Y5. Z8.\n",
        f"{SLOT}X25. Y5.\nX5.\nX45. Y25.\nG0 X5. Y5.\nZ5.\n",
    ],
    ids=["above", "along an axis", "as far along both", "on the top", "cleared on both ways"],
)
def test_rapids_that_are_safe_on_both_ways_are_none(body: str) -> None:
    assert not rapids(body)


def test_a_descent_is_bent_too() -> None:
    """Down into the far end of a slope: Z is there long before X, and the tool goes on in the metal."""
    slope = "G0 X10.\nG1 Z-0.5 F300.\nX45. Z-4.\nG0 Z5.\nX5.\n"
    assert [each.line for each in rapids(f"{slope}G0 X45. Z-3.\nZ5.\n")] == [11]
    assert not rapids(f"{slope}G0 X45. Z-3.\nZ5.\n", Dialect.LINUXCNC)


def test_a_rapid_that_meets_metal_straight_is_told_once() -> None:
    (told,) = rapids("G1 Z-3. F300.\nG0 X65. Y25.\nZ5.\n")
    assert "do not run this program" in told.text


def test_many_are_counted(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(accidents, "NAMED", 1)
    found = rapids(f"{SLOT}G0 X5. Y5.\nG0 X45. Y25.\nG0 X5. Y5.\nG0 Z5.\n")
    assert [each.amount for each in found] == [pytest.approx(3.0, abs=1e-4), 2.0]
    assert "2 more rapids" in found[1].text


def _farthest(ways: list[np.ndarray], slots: list[np.ndarray]) -> float:
    """How far points of the ways lie from the slots' middles, at most: own steps of 0.05 mm."""
    points = np.concatenate([_steps(way) for way in ways])
    middles = np.concatenate([_steps(slot) for slot in slots])
    return float(np.sqrt(((points[:, None] - middles[None]) ** 2).sum(axis=2)).min(axis=1).max())


def _steps(way: np.ndarray) -> np.ndarray:
    lengths = np.abs(np.diff(way, axis=0)).max(axis=1)
    legs = [
        a + np.linspace(0.0, 1.0, int(long / 0.05) + 2)[:, None] * (b - a)
        for a, b, long in zip(way, way[1:], lengths, strict=False)
    ]
    return np.concatenate(legs)


@pytest.mark.parametrize("seed", range(8))
def test_what_is_told_of_random_rapids_is_what_own_steps_find(seed: int) -> None:
    """A slot, a second one, and a rapid from its end to the first one's begin: straight, and bent at 45 degrees."""
    random = np.random.default_rng(seed)
    a, b = random.uniform(5, (55, 35), 2), random.uniform(5, (55, 35), 2)
    c = a + (b - a) * random.uniform(0.0, 1.0) + random.uniform(-1.0, 1.0, 2) * (seed % 2)
    a, b, c = (np.round(each, 3) for each in (a, b, c))
    text = "".join(f"X{x:.3f} Y{y:.3f}\n" for x, y in (b, c))
    told = rapids(f"G0 X{a[0]:.3f} Y{a[1]:.3f}\nG1 Z-3. F300.\n{text}G0 X{a[0]:.3f} Y{a[1]:.3f}\nZ5.\n")
    way = a - c
    corner = c + np.clip(way, -np.abs(way).min(), np.abs(way).min())
    slots = [np.array([a, b]), np.array([b, c])]
    off = _farthest([np.array([c, a])], slots), _farthest([np.array([c, corner, a])], slots)
    if off[0] > 0.7:
        assert "do not run" in told[0].text
    elif off[0] < 0.02 and off[1] > 0.3:
        assert [("each axis" in each.text, each.line) for each in told] == [(True, 10)]
    elif max(off) < 1e-3:
        assert not told
