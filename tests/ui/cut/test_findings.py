"""The places of a real cut in a list, the verdict in words, and how much of the area is how far from the part."""

from dataclasses import replace

import numpy as np
import pytest

from app.ui.framework.verdict import VerdictLevel, VerdictSummary
from app.ui.views.cut.findings import FindingColour, certified, findings_of, level_of, sentences_of, title_of
from app.verify.judgement import Certificate
from tests.ui.cut.real_cut import TOOL, real_shown


@pytest.fixture(scope="module")
def shown():
    return real_shown()


def test_every_place_is_listed_what_counts_first_with_its_line(shown):
    entries = findings_of(shown)
    kinds = [entry.colour for entry in entries]
    assert FindingColour.ACCIDENT in kinds and FindingColour.GOUGE in kinds and FindingColour.UNREACHABLE in kinds
    counts = [entry.counts for entry in entries]
    assert counts == sorted(counts, reverse=True)
    rapid = next(entry for entry in entries if entry.colour is FindingColour.ACCIDENT)
    assert rapid.line == 9 and rapid.title.startswith("Rapid, 1.000 deep")
    hole = next(entry for entry in entries if entry.colour is FindingColour.GOUGE and entry.line == 13)
    assert hole.place == pytest.approx((33.0, 15.0, -2.05), abs=0.2)
    assert shown.texts[0].line(hole.line - 1).startswith("G1 Z-2.05")
    assert "line 13" in hole.words


def test_a_shank_and_a_holder_in_metal_are_places_with_their_lines():
    held = replace(TOOL, flute_length=1.0, shank_diameter=4.0, stick_out=1.5, holder=((0.0, 5.0), (20.0, 5.0)))
    found = {entry.title.split(",")[0]: entry for entry in findings_of(real_shown(tool=held))}
    assert found["Holder"].title == "Holder, 0.550 deep"
    assert found["Shank"].title == "Shank, 1.000 deep"
    assert all(found[name].counts and found[name].colour is FindingColour.ACCIDENT for name in ("Holder", "Shank"))
    assert found["Shank"].line == 6 and found["Shank"].motion >= 0
    assert np.hypot(found["Holder"].place[0] - 33.0, found["Holder"].place[1] - 15.0) <= 5.0


def test_motions_know_their_file_and_lines_their_motion(shown):
    motion = shown.motion_of_line(13, (33.0, 15.0, -2.05))
    assert shown.picture.moves.line[motion] == 13 and shown.file_of(motion) == 0 and shown.row_in_file(motion) == motion
    assert shown.motion_of_line(0, None) == -1 and shown.motion_of_line(999, None) == -1


def test_the_verdict_counts_what_is_wrong_and_promises_nothing_then(shown):
    assert level_of(shown) is VerdictLevel.BAD
    assert title_of(shown) == f"{sum(entry.counts for entry in findings_of(shown))} places to look at"
    assert "worst gouge" in sentences_of(shown) and "No point" not in sentences_of(shown)


def test_without_a_part_nothing_is_said_of_gouges():
    alone = real_shown(part=False)
    assert "Nobody has said what the part is" in sentences_of(alone)
    assert alone.histogram is None
    assert {entry.colour for entry in findings_of(alone)} == {FindingColour.ACCIDENT}


def test_areas_of_the_histogram_are_those_of_the_cells(shown):
    made, picture = shown.histogram, shown.picture
    cell, deviation = picture.pitch**2, picture.deviation
    assert made.gouge == pytest.approx(np.sum(deviation < -picture.tolerance) * cell, rel=0.01)
    assert made.beyond == pytest.approx(np.sum(picture.unreachable) * cell, rel=0.01)
    assert made.left == pytest.approx(
        np.sum((deviation > picture.tolerance) & ~picture.unreachable) * cell, abs=2 * cell
    )
    assert len(made.borders) == len(made.areas) + 1 and np.all(np.diff(made.borders) > 0)
    assert made.right > 50.0
    assert float(made.areas.sum()) == pytest.approx(made.gouge + made.right + made.left)


def test_the_heading_is_the_badges_verdict(shown):
    told = VerdictSummary(VerdictLevel.REMARK, "Crossing contours")
    assert (title_of(shown, told), level_of(shown, told)) == ("Crossing contours", VerdictLevel.REMARK)
    assert title_of(shown, VerdictSummary(VerdictLevel.OK, "✓")) == title_of(shown)


def test_a_bound_as_large_as_the_depth_is_no_bound():
    assert "No point" not in certified(Certificate(10.0, 0.1, 0.05), 10.0)
    assert "No point" not in certified(Certificate(1.2, 0.1, 0.1), 10.0), "twelve cells are a wall that was missed"
    assert "No point is cut deeper than 0.100 mm" in certified(Certificate(0.1, 0.1, 0.05), 10.0)
