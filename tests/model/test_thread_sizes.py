"""Threads against the tables of their standards, and against the geometry that they are defined by."""

from __future__ import annotations

import math

import pytest

from app.model.thread_sizes import ThreadForm, ThreadSize

TABLES = {  # major, pitch, pitch diameter, core of the nut, core of the bolt: ISO 724, ASME B1.1, ISO 228-1
    "M3": (3.0, 0.5, 2.675, 2.459, 2.387),
    "M6": (6.0, 1.0, 5.350, 4.917, 4.773),
    "M12": (12.0, 1.75, 10.863, 10.106, 9.853),
    "M20x1.5": (20.0, 1.5, 19.026, 18.376, 18.160),
    "1/4-20 UNC": (6.35, 1.27, 5.525, 4.976, 4.792),
    "10-32 UNF": (4.826, 0.79375, 4.310, 3.967, 3.852),
    "G1/4": (13.157, 1.337, 12.301, 11.445, 11.445),
    "G1": (33.249, 2.309, 31.770, 30.291, 30.291),
}


@pytest.mark.parametrize("name", TABLES)
def test_the_tables_of_the_standards(name: str) -> None:
    thread = ThreadSize(name)
    found = (thread.major, thread.pitch, thread.pitch_diameter, thread.nut_core, thread.bolt_core)
    assert found == pytest.approx(TABLES[name], abs=1.5e-3)


def test_every_thread_is_sound() -> None:
    words = [each.value for each in ThreadSize]
    assert len(set(words)) == len(words)
    for each in ThreadSize:
        assert 0 < each.bolt_core <= each.nut_core < each.pitch_diameter < each.major
        assert each.nut_core <= each.tap_drill < each.pitch_diameter
        slope = math.tan(math.radians(each.form.value / 2))
        # at the pitch diameter, tooth and gap are half a pitch wide: the crest's flat and the flank make it so
        flat = each.pitch / 2 - (each.major - each.pitch_diameter) * slope
        share = 1 / 8 if each.form is ThreadForm.ISO else 1 / 6
        assert flat == pytest.approx(each.pitch * share, rel=1e-4)
        assert 0.35 * each.pitch < (each.major - each.nut_core) / 2 < 0.7 * each.pitch


@pytest.mark.parametrize(
    ("name", "drill"),  # ISO 2306
    [("M1.6", 1.25), ("M2", 1.6), ("M2.5", 2.05), ("M3", 2.5), ("M8", 6.8), ("M12", 10.2), ("M10x1.25", 8.8)],
)
def test_the_drill_before_a_tap_is_the_handbook_s(name: str, drill: float) -> None:
    assert ThreadSize(name).tap_drill == drill


def test_no_core_is_less_than_what_a_tool_is_taken_to_have() -> None:
    from app.model.tool_kind import ToolKind, ToolShape, core_radius

    for each in ThreadSize:
        if "UN" not in each.value:
            assert core_radius(ToolShape(each.major / 2)) * 2 <= each.nut_core
    assert ToolKind.TAP.threads and ToolKind.THREAD_MILL.threads and not ToolKind.DRILL.threads
