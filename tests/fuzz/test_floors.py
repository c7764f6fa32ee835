"""Drawings that meet in nasty ways, and mutated ones, through all of `make`: no crash, no clean verdict that the judge
finds wrong.
"""

from __future__ import annotations

import numpy as np
import pytest

from app.core.errors import HitofudeError
from app.formats.readers import read_drawing
from app.gcode.interpreter.reader import read_program
from app.model.curves import Circle, Curve
from app.model.finding import FindingKind
from app.model.job import Job
from app.model.part import Entity, Part
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, export, make
from tests.fuzz.apart import case
from tests.fuzz.judge import wrong_floor
from tests.fuzz.readers import reader
from tests.geometry.meeting_shapes import any_case, lattice


def part_of(curves: list[Curve]) -> Part:
    return Part().with_entities(tuple(Entity(number, curve) for number, curve in enumerate(curves, 1)))


def fault_of(made: MakeResult, curves: list[Curve]) -> str:
    """Return what the judge finds wrong with a clean verdict.

    Curves on one another are two contours by the even-odd rule and one for `make`, which tells it: no judge is asked
    then.
    """
    if not (made.clean and made.files) or any(finding.kind is FindingKind.OVERLAP for finding in made.findings):
        return ""
    program = read_program("\n".join(file.nc.text for file in made.files).encode())
    radii = {tool.number: tool.radius for tool in made.job.tools}
    return wrong_floor(curves, program, radii, made.job.operations[0].cut.depth)


def meeting(seed: tuple[int, int], few: bool = True) -> list[Curve]:
    chance = np.random.default_rng(seed)
    return [curve for shape in (any_case if few else lattice)(chance) for curve in shape.primitives]


@pytest.mark.filterwarnings("error::RuntimeWarning")
@pytest.mark.parametrize(
    "seeds", [(0, 2), *(pytest.param((first, 40), marks=pytest.mark.exhaustive) for first in range(1, 9))]
)
def test_drawings_that_meet_in_any_way(seeds: tuple[int, int]) -> None:
    for k in range(seeds[1]):
        curves = meeting((seeds[0], k))
        try:
            made = export(Job(part_of(curves)))
        except HitofudeError:
            continue
        assert fault_of(made, curves) == "", (seeds, k)


@pytest.mark.exhaustive
@pytest.mark.parametrize("seed", range(40))
def test_lattices_of_drawings_that_meet(seed: int) -> None:
    curves = meeting((77, seed), few=False)
    try:
        made = export(Job(part_of(curves)))
    except HitofudeError:
        return
    assert fault_of(made, curves) == ""


@pytest.mark.exhaustive
@pytest.mark.parametrize("kind", ["dxf", "svg"])
def test_mutated_drawings(kind: str) -> None:
    source = reader(kind)
    for number in range(200):
        data = case(source, number)
        try:
            curves = [entity.curve for entity in read_drawing(f"d.{kind}", data).part.entities]
            made = make(f"d.{kind}", data, MakeOptions())
        except HitofudeError:
            continue
        hidden = not all(layer.visible for layer in made.job.part.layers)
        assert hidden or fault_of(made, curves) == "", number


def test_the_judge_sees_what_is_cut_outside_and_what_is_left() -> None:
    drawn: list[Curve] = [Circle((0.0, 0.0), 15.0)]
    made = export(Job(part_of(drawn)))
    assert made.clean and fault_of(made, drawn) == ""
    assert "left although the tool fits" in fault_of(made, [Circle((0.0, 0.0), 18.0)])
    assert "cut outside of the drawing" in fault_of(made, [Circle((0.0, 0.0), 14.0)])
    assert "cut outside of the drawing" in fault_of(made, [*drawn, Circle((0.0, 0.0), 5.0)])
