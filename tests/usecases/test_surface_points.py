"""The table of a compound surface reads back to the last bit."""

from __future__ import annotations

import csv
import io
import math
from functools import cache

import numpy as np
import pytest

from app.formats.scene.toml import read_scene, sources_of
from app.surfaces.sections.compound import (
    NO_SURFACE,
    BoundaryKind,
    BoundaryPoints,
    CompoundSurface,
    CuttingPlanes,
    SectionRun,
)
from app.usecases.scene.compute import ComputedScene, compute
from app.usecases.scene.points import COLUMNS, ToolSurface, points_csv, scene_points_csv
from tests.conftest import ROOT

SAMPLES = ROOT / "resources" / "samples"


@cache
def the_compound() -> ComputedScene:
    scene = read_scene("compound.toml", (SAMPLES / "compound.toml").read_bytes())
    return compute(scene, sources_of(lambda name: (SAMPLES / name).read_bytes()))


def rows_of(data: bytes) -> list[dict[str, str]]:
    assert data.endswith(b"\r\n")
    reader = csv.DictReader(io.StringIO(data.decode(), newline=""), strict=True)
    assert tuple(reader.fieldnames or ()) == COLUMNS
    rows = list(reader)
    assert not any(None in row or None in row.values() for row in rows)
    return rows


def floats(rows: list[dict[str, str]], *columns: str) -> np.ndarray:
    return np.array([[float(row[column] or "nan") for column in columns] for row in rows])


def test_points_and_boundary_points_come_back_exactly() -> None:
    computed = the_compound()
    compound, names = computed.families[0].surface, computed.names
    rows = rows_of(points_csv([ToolSurface(compound, 1)], names))
    points, marks = [row for row in rows if row["kind"] == "point"], [row for row in rows if row["kind"] != "point"]
    assert rows == points + marks
    np.testing.assert_array_equal(floats(points, "x", "y", "z"), np.concatenate([run.points for run in compound.runs]))
    owner = np.concatenate([np.append(run.owner, run.owner[-1]) for run in compound.runs])
    assert [(int(row["surface"]) - 1, row["name"]) for row in points] == [(k, names[k]) for k in owner.tolist()]
    found = compound.boundaries
    np.testing.assert_array_equal(floats(marks, "x", "y", "z"), found.place)
    np.testing.assert_array_equal(floats(marks, "end_x", "end_y", "end_z"), found.end)
    np.testing.assert_array_equal(floats(marks, "u", "v", "to_u", "to_v"), np.hstack([found.before_at, found.after_at]))
    assert [(row["surface"], row["to_surface"], row["kind"]) for row in marks[:2]] == [
        ("1", "2", "crossing"),
        ("2", "3", "crossing"),
    ]
    assert [int(row["point"]) for row in marks] == list(range(1, len(found) + 1))
    assert {row["tool"] for row in rows} == {"1"}
    assert scene_points_csv(computed) == points_csv([ToolSurface(compound, 1)], names)


def test_parameters_that_are_told_are_those_of_the_surface_there() -> None:
    computed = the_compound()
    surface = computed.families[0].surface
    known = {
        (curve.plane, curve.owner, *point): at
        for curve in surface.curves
        for point, at in zip(curve.points.tolist(), curve.parameters.tolist(), strict=True)
    }
    points = [
        row
        for row in rows_of(points_csv([ToolSurface(surface)], computed.names))
        if row["kind"] == "point" and row["u"]
    ]
    told = [
        (row, known.get((int(row["pass"]) - 1, int(row["surface"]) - 1, *(float(row[c]) for c in "xyz"))))
        for row in points
    ]
    assert sum(at is not None for _, at in told) > 100
    for row, at in told:
        assert at is None or [float(row["u"]), float(row["v"])] == at


def test_hostile_names_ends_and_meshes() -> None:
    names = ('a "quoted", name', "two\nlines", "floor")
    nan, tenth = np.full((2, 2), math.nan), 0.1 + 0.2
    points = np.array([[0.0, -0.0, tenth], [1e-300, 1e22, 1 / 3], [math.pi, 2, 3]])
    marks = BoundaryPoints(
        np.array([0, 0]),
        np.array([0, 1]),
        np.array([1, NO_SURFACE]),
        points[:2],
        points[1:],
        nan,
        nan,
        np.array([BoundaryKind.JUMP, BoundaryKind.EDGE], np.uint8),
    )
    compound = CompoundSurface(
        CuttingPlanes((0.0, 0.0), 0.0, (0.0,)),
        (SectionRun(0, points, np.array([0, 1])), SectionRun(0, points[:2], np.array([1]))),
        marks,
    )
    rows = rows_of(points_csv([ToolSurface(compound)], names))
    assert [(row["kind"], row["run"], row["point"], row["name"]) for row in rows[:5]] == [
        ("point", "1", "1", names[0]),
        ("point", "1", "2", names[1]),
        ("point", "1", "3", names[1]),
        ("point", "2", "1", names[1]),
        ("point", "2", "2", names[1]),
    ]
    read = floats(rows[:3], "x", "y", "z")
    assert read.tobytes() == points.tobytes()
    assert [row["u"] for row in rows] == [""] * 7
    assert [(row["kind"], row["to_name"], row["to_surface"]) for row in rows[5:]] == [
        ("jump", names[1], "2"),
        ("edge", "", ""),
    ]


@pytest.mark.exhaustive
def test_a_hundred_thousand_points() -> None:
    points = np.random.default_rng(4).normal(size=(100_000, 3))
    compound = CompoundSurface(
        CuttingPlanes((0.0, 0.0), 0.0, (0.0,)),
        (SectionRun(0, points, np.zeros(99_999, np.int64)),),
        BoundaryPoints.none(),
    )
    data = points_csv([ToolSurface(compound)], ("one",))
    assert data.count(b"\r\n") == 100_001
