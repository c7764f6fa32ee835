"""Edits of a scene's text: what is changed is changed, everything else stays letter by letter."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.core.errors import InputError
from app.formats.scene.edit import line_of, with_table, with_table_moved, with_value, without_table
from app.formats.scene.toml import read_scene
from tests.conftest import ROOT

SAMPLES = ROOT / "resources" / "samples"
COMPOUND = (SAMPLES / "compound.toml").read_text()
INCHES = (
    'units = "in"\n\n[[surface]]\nname = "ball"\nshape = { kind = "sphere", centre = [0, 0, 0], radius = 1 }  # round\n'
)


def scene(text: str):
    return read_scene("a.toml", text.encode())


def changed_lines(before: str, after: str) -> list[str]:
    return [line for line in after.splitlines() if line not in before.splitlines()]


def test_one_value_changes_one_line_and_keeps_its_remark() -> None:
    text = with_value(COMPOUND, ("passes", 0, "pitch"), 2.5)
    assert scene(text).passes[0].pitch == 2.5
    (line,) = changed_lines(COMPOUND, text)
    assert line.startswith("pitch = 2.5 ")
    assert line.endswith("# from plane to plane; or scallop = 0.01, the height of the ridges between passes")
    assert len(text.splitlines()) == len(COMPOUND.splitlines())


def test_a_key_that_is_not_there_is_added_and_taken_away() -> None:
    text = with_value(COMPOUND, ("surface", 1, "move"), (1.0, 0.0, 2.25))
    assert scene(text).surfaces[1].move == (1.0, 0.0, 2.25)
    assert changed_lines(COMPOUND, text) == ["move = [1, 0, 2.25]"]
    assert scene(with_value(text, ("surface", 1, "move"), None)) == scene(COMPOUND)


def test_a_value_within_a_shape() -> None:
    text = with_value(COMPOUND, ("surface", 1, "shape", "turn_deg"), (-40.0, 40.0))
    assert scene(text).surfaces[1].shape.turn_deg == (-40.0, 40.0)
    assert len(changed_lines(COMPOUND, text)) == 1


def test_a_table_that_is_not_there_is_made() -> None:
    text = with_value(
        "[[surface]]\nname = 'a'\nshape = { kind = 'sphere', centre = [0, 0, 0], radius = 1 }\n",
        ("stock", "margin"),
        2.0,
    )
    assert scene(text).stock.margin == 2.0


def test_inches_stay_inches() -> None:
    text = with_value(INCHES, ("surface", 0, "shape", "radius"), 50.8)
    assert "radius = 2 }  # round" in text
    assert scene(text).surfaces[0].shape.radius == pytest.approx(50.8)
    assert scene(INCHES).surfaces[0].shape.radius == pytest.approx(25.4)
    turned = with_value(INCHES, ("surface", 0, "rotate_deg"), (0, 0, 30))
    assert scene(turned).surfaces[0].rotate_deg == (0.0, 0.0, 30.0)


def test_tables_are_added_and_taken_away() -> None:
    more = with_table(
        COMPOUND, "surface", {"name": "hole", "shape": {"kind": "sphere", "centre": (1.0, 2.0, 3.5), "radius": 4.0}}
    )
    assert [each.name for each in scene(more).surfaces] == ["12a left flank", "12b dome", "12c right flank", "hole"]
    assert scene(more).surfaces[3].shape.centre == (1.0, 2.0, 3.5)
    assert scene(without_table(more, "surface", 3)) == scene(COMPOUND)
    fewer = without_table(COMPOUND, "surface", 0)
    assert [each.name for each in scene(fewer).surfaces] == ["12b dome", "12c right flank"]
    none = without_table(COMPOUND, "passes", 0)
    assert scene(none).passes == ()
    assert scene(with_table(none, "passes", {"tool": 1, "pitch": 4.0})).passes[0].pitch == 4.0


@given(st.lists(st.tuples(st.integers(0, 2), st.sampled_from([-1, 1])), max_size=6))
def test_moving_tables_is_moving_surfaces(steps: list[tuple[int, int]]) -> None:
    text, names = COMPOUND, ["12a left flank", "12b dome", "12c right flank"]
    for number, way in steps:
        text = with_table_moved(text, "surface", number, way)
        if 0 <= number + way < 3:
            names.insert(number + way, names.pop(number))
    found = scene(text)
    assert [each.name for each in found.surfaces] == names
    assert sorted(found.surfaces, key=lambda each: each.name) == list(scene(COMPOUND).surfaces)
    assert (found.passes, found.tools, found.stock) == (
        scene(COMPOUND).passes,
        scene(COMPOUND).tools,
        scene(COMPOUND).stock,
    )


def test_lines_of_tables() -> None:
    lines = COMPOUND.splitlines()
    assert [lines[line_of(COMPOUND, "surface", k)] for k in range(3)] == [
        f'name = "{n}"' for n in ("12a left flank", "12b dome", "12c right flank")
    ]
    assert line_of(COMPOUND, "surface", 9) == 1


def test_what_is_not_there_is_told() -> None:
    with pytest.raises(InputError, match="no surface 9"):
        without_table(COMPOUND, "surface", 8)
    with pytest.raises(InputError, match="no passes 3 pitch"):
        with_value(COMPOUND, ("passes", 2, "pitch"), 1.0)
    with pytest.raises(InputError, match="correct it first"):
        with_value(COMPOUND + "\n[", ("passes", 0, "pitch"), 1.0)
