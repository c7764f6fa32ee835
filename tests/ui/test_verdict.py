"""The verdict's line: measured figures only, the worst finding first."""

import pytest

from app.model.finding import Finding, FindingKind
from app.ui.framework.figures import clock, counted, grouped
from app.ui.framework.verdict import VerdictLevel, figures, short, verdict_summary, worst_first

CLEAN = {
    "gouge": {"count": 0, "max_mm": 0.0},
    "left": {"reachable_mm2": 0.0},
    "strokes": 2,
    "time_s": 252.4,
    "moves": {"G1": 5},
}
GOUGE = Finding(FindingKind.GOUGE, "Cut 0.12 mm into the part.", 41.2, 8.0, amount=0.12)
OPEN = Finding(FindingKind.OPEN_CONTOUR, "Contour 3 is open.", 1.0, 2.0, amount=0.5)
CORNER = Finding(FindingKind.LEFT_UNREACHABLE, "Corners stay.", 0.0, 0.0, counts=False)


def test_clean_program_shows_its_figures():
    assert verdict_summary((CORNER,), CLEAN).text == "✓ 0 gouge · 0 left · 2 strokes · 4:12"
    assert verdict_summary((CORNER,), CLEAN).level is VerdictLevel.OK


def test_places_out_of_reach_are_counted():
    left = {"reachable_mm2": 0.0, "out_of_reach_places": 15}
    assert figures({"left": left}) == "0 left · 15 places out of reach"
    assert figures({"left": {**left, "out_of_reach_places": 1}}) == "0 left · 1 place out of reach"
    assert figures({"left": {**left, "out_of_reach_places": 0}}) == "0 left"


def test_what_was_not_measured_is_not_said():
    assert figures({"strokes": 1}) == "1 stroke"


@pytest.mark.parametrize(("area", "said"), [(0.1234, "0.123 mm²"), (65.74, "65.7 mm²"), (2735.4, "2\u2009735 mm²")])
def test_area_left_is_said_in_plain_figures(area, said):
    left = Finding(FindingKind.LEFT_REACHABLE, "Left.", 1.0, 2.0, amount=area)
    assert short(left) == f"material left {said} at (1.0, 2.0)"


def test_worst_finding_stands_first():
    shown = verdict_summary((OPEN, CORNER, GOUGE), CLEAN)
    assert shown.level is VerdictLevel.BAD
    assert shown.text == "Gouge 0.120 mm at (41.2, 8.0) · 1 more"
    assert worst_first((CORNER, OPEN, GOUGE)) == (GOUGE, OPEN, CORNER)


def test_finding_of_the_drawing_is_amber():
    assert verdict_summary((OPEN,), CLEAN).level is VerdictLevel.REMARK


def test_program_without_moves_is_never_green():
    assert verdict_summary((), CLEAN | {"moves": {"G0": 0, "G1": 0}}).level is VerdictLevel.REMARK


def test_figures_for_people():
    assert grouped(12000.5, 1) == "12\u2009000.5"
    assert [clock(s) for s in (5, 252.4, 3725)] == ["0:05", "4:12", "1:02:05"]
    assert [counted(1, "pass", "passes"), counted(3, "pass", "passes")] == ["1 pass", "3 passes"]


@pytest.mark.parametrize("kind", FindingKind)
def test_every_kind_of_finding_has_its_place_and_its_name(kind):
    finding = Finding(kind, "Something.", 1.0, 2.0, amount=0.5)
    assert worst_first((finding, CORNER)) and len(short(finding)) > 5


def test_the_badges_tip_says_what_the_time_is_made_of():
    data = {"moves": {"cut": 1}, "time_s": 100.0, "time_parts_s": {"cut": 60.0, "rapid": 5.0, "wait": 35.0}}
    assert verdict_summary((), data).tip == "Cutting and rapids 1:05, tool changes and waiting 0:35"
