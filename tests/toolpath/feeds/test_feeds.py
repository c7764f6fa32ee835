"""Speed and feeds: the closed forms, each limit, and that every number says why."""

from __future__ import annotations

import math
from dataclasses import replace

import pytest

from app.formats.machine_toml import load_machine
from app.formats.tools.materials import read_materials, stock_material, stock_materials
from app.model.machine import LinearAxis, Machine, SpindleRange
from app.model.stock_material import StockMaterial
from app.model.tool import FeedRow, Tool, ToolMaterial
from app.model.tool_kind import ToolKind
from app.toolpath.feeds import mechanics
from app.toolpath.feeds.mechanics import Chip
from app.toolpath.feeds.proposal import LEAST_CHIP, MOST_DEFLECTION, POWER_SHARE, CutEngagement, proposed_feeds

PLAIN = StockMaterial("plain", "Plain", 30.0, 60 * math.pi, 0.01, 0.25, 1000.0, 0.0)
"""At 6 mm: 10,000 rpm, 0.06 mm a tooth, 1000 N/mm2 at any thickness."""

TOOL = Tool(1, 6.0, flutes=2)


def machine(low: float = 100.0, high: float = 30000.0, power: float = 0.0, feed: float = 1e5) -> Machine:
    axis = LinearAxis(-500.0, 500.0, 5000.0, 300.0)
    return Machine("Test mill", axis, axis, axis, SpindleRange(low, high, power), feed)


def test_speed_and_feed_in_closed_form() -> None:
    assert mechanics.spindle_speed(100.0, 10.0) == pytest.approx(1000 * 100 / (math.pi * 10))
    assert mechanics.feed_rate(10_000.0, 3, 0.05) == pytest.approx(1500.0)
    made = proposed_feeds(TOOL, PLAIN)
    assert (made.tool.spindle_speed, made.tool.feed_rate, made.tool.plunge_rate) == (10_000.0, 1200.0, 300.0)
    assert made.surface_speed == pytest.approx(60 * math.pi)
    assert made.row in made.tool.feeds, "what a library keeps"


@pytest.mark.parametrize(("degrees", "factor"), [(30.0, 2.0), (90.0, 1.0), (120.0, 1.0), (180.0, 1.0)])
def test_chips_are_thinner_than_fed_where_less_than_a_quarter_is_engaged(degrees: float, factor: float) -> None:
    made = proposed_feeds(TOOL, PLAIN, CutEngagement(1.0, math.radians(degrees)))
    assert mechanics.chip_thinning(math.radians(degrees)) == pytest.approx(factor)
    assert made.feed_per_tooth == pytest.approx(0.06 * factor)
    assert made.tool.feed_rate == pytest.approx(1200 * factor, abs=1.0)
    assert made.tool.plunge_rate == 300.0, "straight down no chip is thinner"


def test_width_and_angle_of_engagement_are_each_other_s_inverse() -> None:
    assert mechanics.engaged_width(6.0, math.pi / 2) == pytest.approx(3.0)
    assert mechanics.engaged_width(6.0, math.pi) == pytest.approx(6.0)
    for degrees in (20.0, 75.0, 140.0):
        angle = math.radians(degrees)
        assert mechanics.engaged_angle(6.0, mechanics.engaged_width(6.0, angle)) == pytest.approx(angle)


def test_the_mean_chip_holds_the_metal_that_is_fed() -> None:
    """A tooth's chip has the section that the feed sweeps: mean thickness times arc = feed times width."""
    for degrees in (25.0, 90.0, 180.0):
        angle = math.radians(degrees)
        arc = 3.0 * angle
        assert mechanics.mean_chip(0.05, angle) * arc == pytest.approx(0.05 * mechanics.engaged_width(6.0, angle))


def test_power_is_metal_removed_times_specific_force() -> None:
    cut = Chip(depth=2.0, angle=math.pi, feed_per_tooth=0.06, rpm=10_000.0)
    assert mechanics.milling_power(cut, TOOL, PLAIN) == pytest.approx(2 * 6 * 1200 / 60 / 1000 * 1000)  # mm3/s x J/mm3
    harder = replace(PLAIN, force_exponent=0.25)
    ratio = mechanics.milling_power(cut, TOOL, harder) / mechanics.milling_power(cut, TOOL, PLAIN)
    assert ratio == pytest.approx(mechanics.mean_chip(0.06, math.pi) ** -0.25)


def test_deflection_is_that_of_a_bar_and_of_a_stepped_one() -> None:
    bar = replace(TOOL, stick_out=30.0, tool_material=ToolMaterial.HSS)
    inertia = math.pi * (0.8 * 6) ** 4 / 64
    assert mechanics.deflection(100.0, bar) == pytest.approx(100 * 30**3 / (3 * 210e3 * inertia))
    stepped = replace(bar, flute_length=12.0, shank_diameter=8.0)
    stiff = math.pi * 8.0**4 / 64
    n = 200_000  # unit load along the bar: the integral of M^2 / (E I)
    places = [(k + 0.5) * 30 / n for k in range(n)]
    dense = sum(100 * x * x / (210e3 * (inertia if x < 12 else stiff)) for x in places) * 30 / n
    assert mechanics.deflection(100.0, stepped) == pytest.approx(dense, rel=1e-6)
    assert mechanics.deflection(100.0, TOOL) == 0.0, "not known"


def test_each_limit_holds_and_says_so() -> None:
    slow = proposed_feeds(TOOL, PLAIN, machine=machine(high=5000.0))
    assert slow.tool.spindle_speed == 5000.0
    assert "turns at 100 to 5000" in slow.reason("spindle_speed")
    fast = proposed_feeds(TOOL, PLAIN, machine=machine(low=12_000.0))
    assert fast.tool.spindle_speed == 12_000.0
    assert "thinner tool" in fast.reason("spindle_speed")
    lame = proposed_feeds(TOOL, PLAIN, machine=machine(low=8000.0, feed=480.0))
    assert (lame.tool.spindle_speed, lame.tool.feed_rate) == (8000.0, 480.0)
    assert lame.feed_per_tooth == pytest.approx(0.03)
    lowered = proposed_feeds(TOOL, PLAIN, machine=machine(feed=600.0))
    assert (lowered.tool.spindle_speed, lowered.feed_per_tooth) == (5000.0, pytest.approx(0.06))


@pytest.mark.parametrize("exponent", [0.0, 0.3])
def test_weak_spindles_and_slender_tools_get_thinner_chips_to_the_very_limit(exponent: float) -> None:
    material = replace(PLAIN, force_exponent=exponent)
    weak = proposed_feeds(TOOL, material, CutEngagement(3.0), machine(power=200.0))
    assert weak.power == pytest.approx(POWER_SHARE * 200.0, rel=1e-6)
    assert any(each.held and each.key == "power" for each in weak.reasons)
    slender = proposed_feeds(replace(TOOL, stick_out=40.0), material, CutEngagement(3.0))
    assert slender.deflection == pytest.approx(MOST_DEFLECTION, rel=1e-6)
    strong = proposed_feeds(TOOL, material, CutEngagement(3.0), machine(power=20_000.0))
    assert strong.feed_per_tooth == pytest.approx(0.06)
    assert "within 80 %" in strong.reason("power")


def test_what_rubs_is_told() -> None:
    made = proposed_feeds(replace(TOOL, diameter=1.0, stick_out=40.0), PLAIN, CutEngagement(3.0))
    assert made.rubs
    assert made.feed_per_tooth < LEAST_CHIP
    assert "rub" in made.reason("feed_per_tooth")


def test_a_row_of_the_tool_goes_before_the_material_s_figures() -> None:
    own = replace(TOOL, feeds=(FeedRow("Plain", 30 * math.pi, 0.02, 0.5), FeedRow("wood", 400.0, 0.05)))
    made = proposed_feeds(own, PLAIN)
    assert (made.tool.spindle_speed, made.tool.feed_rate, made.tool.plunge_rate) == (5000.0, 200.0, 100.0)
    assert "the tool's own row" in made.reason("surface_speed")
    assert {row.material for row in made.tool.feeds} == {"Plain", "wood"}


def test_kinds_and_edges_count() -> None:
    assert proposed_feeds(replace(TOOL, tool_material=ToolMaterial.HSS), PLAIN).row.surface_speed == 30.0
    drill = proposed_feeds(Tool(1, 6.0, ToolKind.DRILL), PLAIN)
    assert drill.row.surface_speed == 30.0, "drills are taken to be of high-speed steel"
    assert drill.tool.plunge_rate == drill.tool.feed_rate
    assert proposed_feeds(Tool(1, 6.0, ToolKind.BALL), PLAIN).feed_per_tooth == pytest.approx(0.048)


def test_every_material_gives_sound_feeds_on_every_machine_and_says_why() -> None:
    materials = stock_materials()
    assert {each.word for each in materials} >= {
        *("softwood", "hardwood", "plywood", "mdf", "acrylic", "pom"),
        *("aluminium", "brass", "mild steel", "stainless steel"),
    }
    for material in materials:
        assert material.speed_source and material.chip_source and material.force_source
        for name in ("router", "bench_mill", "vmc"):
            mill = load_machine(name)
            assert mill.spindle.power > 0
            for diameter in (1.0, 3.0, 6.0, 12.0):
                tool = Tool(1, diameter, flutes=3, stick_out=4 * diameter)
                made = proposed_feeds(tool, material, CutEngagement(diameter / 4), mill)
                assert mill.spindle.low <= made.tool.spindle_speed <= mill.spindle.high
                assert made.tool.feed_rate <= mill.largest_feed
                assert made.power <= POWER_SHARE * mill.spindle.power * (1 + 1e-9)
                assert made.deflection <= MOST_DEFLECTION * (1 + 1e-9)
                keys = {"surface_speed", "feed_per_tooth", "spindle_speed", "power", "feed_rate", "plunge_rate"}
                assert {each.key for each in made.reasons} >= keys
                assert all("\n" not in each.text for each in made.reasons), "one line each"


def test_fits_of_force_agree_with_the_tables_that_they_are_of() -> None:
    for word, thin, thick in (("mild steel", 2200, 1580), ("stainless steel", 2030, 1710), ("brass", 1150, 630)):
        material = stock_material(word)
        for thickness, told in ((0.1, thin), (0.6, thick)):
            assert material.cutting_force * thickness**-material.force_exponent == pytest.approx(told, rel=0.02)


def test_materials_are_found_by_any_spelling_and_the_user_s_go_first(monkeypatch, tmp_path) -> None:
    assert stock_material("Mild-Steel").word == stock_material("MILD STEEL").word == "mild steel"
    mine = (
        'format = 1\n[[material]]\nword = "brass"\ntitle = "My brass"\nhss_speed = 10\ncarbide_speed = 20\n'
        "chip_share = 0.01\nplunge_share = 0.2\ncutting_force = 500\nforce_exponent = 0.2\n"
    )
    monkeypatch.setattr("app.formats.tools.materials.config_folder", lambda: tmp_path)
    (tmp_path / "materials.toml").write_text(mine)
    assert stock_material("brass").carbide_speed == 20.0
    assert stock_material("aluminium").carbide_speed == 250.0
    with pytest.raises(Exception, match=r"m:\d+: material\[1\]\.hss_speed is -1"):
        read_materials("m", mine.replace("hss_speed = 10", "hss_speed = -1").encode())
    with pytest.raises(Exception, match="'cheese' is no material; use softwood"):
        stock_material("cheese")
