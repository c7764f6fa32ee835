"""Passes over random solids: cut by a second hand they go into none of them, whatever the file is like; and what is
wrong with a solid is said.
"""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from app.cli.main import main
from app.surfaces.meshes.holes import holes
from tests.fuzz.any_solid import DEEP, WIDE, HillySolid, written
from tests.fuzz.dense_heights import DenseHeights, Shape
from tests.fuzz.plain_nc import PlainReader

SCENE = """
name = "part"
stock = { box = [-4, -4, -12, 28, 22, 0.5] }
[[tool]]
number = 1
kind = "KIND"
diameter = 4.0
feed_rate = 900
plunge_rate = 300
[[surface]]
name = "part"
shape = { kind = "mesh", file = "FILE" }
[[passes]]
tool = 1
pitch = 1.7
"""
KINDS = ("stl", "ascii.stl", "obj", "ply", "3mf")
SLACK = 2e-3
"""mm; digits, chords and cells that share a height."""


def told(folder: Path, data: bytes, name: str, tool: str = "ball") -> tuple[int, dict[str, Any], str]:
    """Return the exit status, the report and the NC text of `surface` on one file."""
    folder.mkdir(exist_ok=True)
    (folder / name).write_bytes(data)
    (folder / "s.toml").write_text(SCENE.replace("FILE", name).replace("KIND", tool))
    out, report = folder / "s.ngc", folder / "r.json"
    for path in (out, report):
        path.unlink(missing_ok=True)
    status = main(["surface", str(folder / "s.toml"), "-o", str(out), "--report", str(report), "--quiet"])
    text = out.read_text() if out.exists() else ""
    return status, json.loads(report.read_text()) if report.exists() else {}, text


def counted(report: dict[str, Any]) -> set[str]:
    return {finding["kind"] for finding in report.get("findings", []) if finding["counts"]}


def deepest(solid: HillySolid, text: str, tool: str) -> float:
    """Return how deep the program goes into the solid, mm, by a second hand."""
    heights = DenseHeights((0.0, 0.0, WIDE, DEEP), 0.13, 0.5)
    heights.cut(PlainReader("linuxcnc", 1).read(text), {1: Shape(2.0, 0.0, tool == "ball")})
    x, y = heights.points()
    inside = (x < WIDE) & (y < DEEP)
    return float((solid.height(x, y) - heights.z)[inside].max())


def fault(seed: int, folder: Path) -> str:
    """Return what is wrong with what is made of a random solid."""
    rng = np.random.default_rng(seed)
    solid, tool, kind = HillySolid(seed), ("ball", "flat")[seed % 2], KINDS[seed % len(KINDS)]
    triangles = solid.triangles()
    status, report, text = told(folder, written(triangles, kind), f"part.{kind}", tool)
    if status not in (0, 1):
        return f"status {status}"
    deep = deepest(solid, text, tool)
    if deep > SLACK and "gouge" not in counted(report):
        return f"{deep:.4f} mm deep, and nothing said"
    if deep < SLACK / 2 and "gouge" in counted(report):
        return "a false alarm: gouge"
    if {"hole", "size", "beyond_stock"} & counted(report):
        return f"a false alarm: {counted(report)}"
    other = triangles[rng.permutation(len(triangles))][:, ::-1]  # inside out, in another order
    status, report, again = told(folder, written(other, "stl"), "other.stl", tool)
    if status not in (0, 1) or (deepest(solid, again, tool) > SLACK and "gouge" not in counted(report)):
        return f"inside out: status {status}, {deepest(solid, again, tool):.4f} mm deep"
    return ""


@pytest.mark.parametrize("seed", [0, *(pytest.param(seed, marks=pytest.mark.exhaustive) for seed in range(1, 10))])
def test_a_random_solid_is_not_gouged(seed: int, tmp_path: Path) -> None:
    assert fault(seed, tmp_path) == ""


def spoilt(solid: HillySolid, way: str, seed: int) -> np.ndarray:
    """Return its triangles spoilt in a way that has to be said."""
    triangles, top = solid.triangles(), len(solid.top())
    chosen = np.random.default_rng(seed).integers(top)
    if way == "open":
        return np.delete(triangles, chosen, axis=0)
    return triangles / 1000 if way == "metres" else triangles + [40.0, 0.0, 0.0]


@pytest.mark.exhaustive
@pytest.mark.parametrize(("way", "kind"), [("open", "hole"), ("metres", "size"), ("beside", "beyond_stock")])
@pytest.mark.parametrize("seed", range(3))
def test_what_is_wrong_with_a_solid_is_said(way: str, kind: str, seed: int, tmp_path: Path) -> None:
    solid = HillySolid(seed)
    status, report, _ = told(tmp_path, written(spoilt(solid, way, seed), "stl"), "part.stl")
    assert status == 2 or kind in counted(report), (status, counted(report))


def test_the_judge_sees_a_gouge(tmp_path: Path) -> None:
    solid = HillySolid(0)
    _, _, text = told(tmp_path, written(solid.triangles(), "stl"), "part.stl")
    solid.z += 0.01
    assert deepest(solid, text, "ball") > SLACK


def test_a_hole_at_the_edge_of_a_solid_is_said() -> None:
    """Two of its three edges are the upper ends of upright walls, which are on neither side of it."""
    solid = HillySolid(2)
    (hole,) = holes(np.delete(solid.triangles(), np.argmin(solid.top().mean(axis=1)[:, 0]), axis=0))
    assert hole.edges == 3
    for k in range(len(solid.top())):
        assert len(holes(np.delete(solid.triangles(), k, axis=0))) == 1, k
    assert holes(solid.triangles()) == holes(solid.top()) == holes(solid.triangles()[len(solid.top()) :]) == ()
