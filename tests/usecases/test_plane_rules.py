"""Cutting planes that are not parallel: a fan through one place, planes square on a guide."""

from __future__ import annotations

import math
from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from app.core.errors import InputError, ParameterError
from app.core.resources import resource
from app.formats.scene.toml import read_scene, sources_of
from app.model.scene import Passes, Scene, Strategy
from app.usecases.scene.compute import compute
from app.usecases.scene.plane_rules import expanded
from app.usecases.scene_program.nc import write_scene_nc
from tests.scene_text import write_scene


def scene(*rows: str) -> Scene:
    text = resource("samples", "compound.toml").read_text()
    head = text.partition("[[passes]]")[0]
    return read_scene("s.toml", (head + "[[passes]]\ntool = 1\n" + "\n".join(rows) + "\n").encode())


def nothing(name: str) -> bytes:
    raise InputError(f"there is no {name}")


def test_parallel_passes_stay_as_they_are() -> None:
    passes = Passes(1, pitch=2.0, angle_deg=30)
    assert expanded(passes) == (passes,)


def test_a_fan_goes_through_its_place_by_even_angles_and_turns_back() -> None:
    planes = expanded(Passes(1, through=(50.0, 40.0), fan_deg=(0.0, 180.0, 20.0)))
    assert [each.through for each in planes] == [(50.0, 40.0)] * 9, "half a turn on, the first plane comes again"
    assert [each.angle_deg % 180 for each in planes] == pytest.approx([20.0 * k for k in range(9)])
    ways = [math.cos(math.radians(a.angle_deg - b.angle_deg)) for a, b in pairwise(planes)]
    assert all(way == pytest.approx(-math.cos(math.radians(20))) for way in ways), "every other one goes back"
    assert all(
        each.angle_deg == pytest.approx(20.0 * k)
        for k, each in enumerate(expanded(Passes(1, fan_deg=(0, 170, 20), strategy=Strategy.ONE_WAY)))
    )


def test_planes_stand_square_on_their_guide_a_pitch_apart() -> None:
    guide = tuple((30 * math.cos(t), 30 * math.sin(t)) for t in np.linspace(0, math.pi, 400).tolist())
    planes = expanded(Passes(1, guide=guide, pitch=5.0))
    assert len(planes) == math.floor(math.pi * 30 / 5.0) + 1
    for k, each in enumerate(planes):
        turn = 5.0 * k / 30
        assert np.allclose(each.through, [30 * math.cos(turn), 30 * math.sin(turn)], atol=0.01)
        radial = math.cos(math.radians(each.angle_deg) - turn)
        inner = 0 < k < len(planes) - 1
        assert abs(radial) == pytest.approx(1.0, abs=1e-4 if inner else 5e-3), "the plane is along the radius"


@pytest.mark.parametrize(
    "wrong",
    [
        {"fan_deg": (0.0, 90.0, 10.0), "pitch": 1.0},
        {"fan_deg": (0.0, 90.0, 0.0)},
        {"fan_deg": (90.0, 0.0, 10.0)},
        {"fan_deg": (0.0, 90.0, 10.0), "angle_deg": 3.0},
        {"guide": ((0.0, 0.0),), "pitch": 1.0},
        {"guide": ((0.0, 0.0), (0.0, 0.0)), "pitch": 1.0},
        {"guide": ((0.0, 0.0), (9.0, 0.0))},
        {"guide": ((0.0, 0.0), (9.0, 0.0)), "pitch": 1.0, "through": (1.0, 1.0)},
    ],
)
def test_rules_that_do_not_go_together_are_refused(wrong: dict[str, object]) -> None:
    with pytest.raises(ParameterError):
        Passes(1, **wrong)  # type: ignore[arg-type]


def test_a_scene_keeps_its_rule_when_it_is_written() -> None:
    for rows in (("through = [50, 40]", "fan_deg = [0, 170, 10]"), ("guide = [[5, 10], [90, 75]]", "pitch = 6")):
        read = scene(*rows)
        again = read_scene("s.toml", write_scene(read))
        assert again.passes == read.passes


@pytest.mark.parametrize(
    ("rows", "count"),
    [
        (("through = [50, 40]", "fan_deg = [0, 150, 50]", "overrun = 0"), 4),
        (("guide = [[10, 20], [90, 60]]", "pitch = 30", "overrun = 0"), 3),
    ],
)
def test_the_compound_surface_is_followed_on_every_plane_and_proven(rows: tuple[str, ...], count: int) -> None:
    done = compute(scene(*rows), sources_of(nothing))
    assert len(done.families) == count
    for family in done.families:
        [offset] = family.planes.offsets
        assert offset == pytest.approx(0.0, abs=1e-9)
        x, y = family.passes.through
        across = np.array([-math.sin(family.planes.angle), math.cos(family.planes.angle)])
        for run in family.surface.runs:
            assert np.abs((run.points[:, :2] - [x, y]) @ across).max() < 1e-6, "in its plane"
    assert len(write_scene_nc(done).unproven) == 0
    assert replace(done.families[0].passes, name="").name == ""
