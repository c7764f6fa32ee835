"""What the panel asks for, and what is added to a scene, without a window."""

from __future__ import annotations

import re

import pytest

from app.formats.scene.edit import with_table, with_value
from app.formats.scene.toml import read_scene, sources_of
from app.model.curves import Arc, Circle, Line, Spline
from app.model.part import Entity, Part
from app.ui.views.surfaces.new_parts import (
    FROM_CURVES,
    KINDS,
    NEW_SCENE,
    new_passes,
    new_surface,
    new_tool,
    surface_from_curves,
)
from app.ui.views.surfaces.scene_fields import SceneFieldKind, passes_fields, scene_fields, surface_fields, tool_fields
from app.usecases.scene.compute import compute
from app.usecases.scene.drawn_sections import drawn_sections
from tests.conftest import ROOT

SAMPLES = ROOT / "resources" / "samples"
COMPOUND = (SAMPLES / "compound.toml").read_text()
BOX = (0.0, 0.0, -5.0, 100.0, 80.0, 26.0)


def scene(text: str):
    return read_scene("a.toml", text.encode())


def computed(text: str):
    return compute(scene(text), sources_of(lambda name: (SAMPLES / name).read_bytes()))


def with_all(text: str, place: tuple[str | int, ...], ask, value: object) -> str:
    for key, each in ask.changes(value).items():
        text = with_value(text, (*place, *key), getattr(each, "value", each))
    return text


@pytest.mark.parametrize("name", ["compound", "spheres", "torus", "die"])
def test_everything_that_is_asked_for_can_be_written_as_it_is(name: str) -> None:
    text = (SAMPLES / f"{name}.toml").read_text()
    found = scene(text)
    subjects = [(("surface", k), surface_fields(each)) for k, each in enumerate(found.surfaces)]
    subjects += [(("passes", k), passes_fields(each, found)) for k, each in enumerate(found.passes)]
    subjects += [(("tool", k), tool_fields(each)) for k, each in enumerate(found.tools)]
    subjects.append(((), scene_fields(found, BOX, (("linuxcnc", "LinuxCNC"),))))
    count = 0
    for place, asks in subjects:
        for ask in asks:
            if ask.kind not in (SceneFieldKind.TOLD, SceneFieldKind.HEADING) and ask.edits is None:
                assert scene(with_all(text, place, ask, ask.value)) == found, ask.name
                count += 1
    assert count > 20


def test_pitch_gives_way_to_a_scallop_and_comes_back() -> None:
    way = next(ask for ask in passes_fields(scene(COMPOUND).passes[0], scene(COMPOUND)) if ask.name == "Apart by")
    by_scallop = with_all(COMPOUND, ("passes", 0), way, "scallop")
    assert (scene(by_scallop).passes[0].pitch, scene(by_scallop).passes[0].scallop) == (None, 0.01)
    again = scene(with_all(by_scallop, ("passes", 0), way, "pitch")).passes[0]
    assert (again.pitch, again.scallop) == (1.0, None)


def test_a_box_gives_way_to_a_margin_and_comes_back_as_it_was_computed() -> None:
    asks = {ask.name: ask for ask in scene_fields(scene(COMPOUND), BOX, ())}
    by_margin = with_all(COMPOUND, (), asks["Given by"], "margin")
    assert scene(by_margin).stock.box is None
    assert scene(with_all(by_margin, (), asks["Given by"], "box")).stock.box == BOX
    assert scene(with_all(COMPOUND, (), asks["To"], (90.0, 70.0, 30.0))).stock.box == (*BOX[:3], 90.0, 70.0, 30.0)


def few_planes(text: str) -> str:
    """A scene that is soon computed."""
    return re.sub(r"^pitch = [\d.]+", "pitch = 25.0", text, flags=re.MULTILINE)


@pytest.mark.parametrize("kind", ["flat", "bull", "v", "taper"])
def test_a_tool_of_another_kind_has_a_shape_that_can_be(kind: str) -> None:
    ask = next(ask for ask in tool_fields(scene(COMPOUND).tools[0]) if ask.name == "Kind")
    made = scene(with_all(COMPOUND, ("tool", 0), ask, kind)).tools[0]
    assert made.kind.value == kind
    assert len(computed(few_planes(with_all(COMPOUND, ("tool", 0), ask, kind))).moves.moves) > 50


@pytest.mark.parametrize("kind", KINDS)
def test_what_is_added_is_computed_and_has_a_name_of_its_own(kind: str) -> None:
    text = with_table(COMPOUND, "surface", new_surface(kind, scene(COMPOUND), BOX))
    text = with_table(text, "surface", new_surface(kind, scene(text), BOX))
    assert [each.name for each in scene(text).surfaces[3:]] == [kind, f"{kind} 2"]
    result = computed(text)
    assert set(result.facets.facets.owner.tolist()) == {0, 1, 2, 3, 4}


def test_passes_and_tools_that_are_added_are_computed() -> None:
    text = with_table(COMPOUND, "tool", new_tool(scene(COMPOUND)))
    text = with_table(text, "passes", new_passes(scene(text)))
    assert (scene(text).tools[1].number, scene(text).passes[1].angle_deg) == (2, 90.0)
    assert len(computed(few_planes(text)).families) == 2


@pytest.mark.exhaustive
def test_a_new_scene_is_computed() -> None:
    result = computed(NEW_SCENE)
    assert len(result.families[0].planes.offsets) > 20
    assert {each.kind.value for each in result.scene.tools} == {"ball"}


def part() -> Part:
    arc = Arc((10.0, 0.0), (20.0, 10.0), (10.0, 10.0))
    spline = Spline(3, ((0.0, 30.0), (5.0, 36.0), (12.0, 28.0), (20.0, 31.0)), (0.0,) * 4 + (1.0,) * 4)
    return Part(
        (
            Entity(1, Line((0.0, 0.0), (10.0, 0.0))),
            Entity(2, arc),
            Entity(3, spline),
            Entity(4, Circle((50.0, 0.0), 5.0)),
        ),
        ("0",),
    )


def test_curves_of_a_drawing_are_taken_as_they_are_drawn() -> None:
    line_and_arc, spline = drawn_sections(part(), (1, 2, 3))
    assert spline.points == ((0.0, 30.0), (5.0, 36.0), (12.0, 28.0), (20.0, 31.0))
    assert (spline.degree, spline.weights) == (3, ())
    assert line_and_arc.points[0] == pytest.approx((0.0, 0.0))
    assert line_and_arc.points[-1] == pytest.approx((20.0, 10.0))
    assert min(line_and_arc.weights) < 1.0
    assert len(drawn_sections(part(), (4,))) == 1


@pytest.mark.exhaustive
@pytest.mark.parametrize("kind", FROM_CURVES)
def test_surfaces_of_drawn_curves(kind: str) -> None:
    curves = drawn_sections(part(), (1, 2, 3))
    text = with_table(NEW_SCENE, "surface", surface_from_curves(kind, curves, scene(NEW_SCENE)))
    assert scene(text).surfaces[1].shape.kind == kind
    assert (computed(text).facets.facets.owner == 1).sum() > 10
