"""STEP faces against closed forms; without Open CASCADE, a sentence on what to install."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from app.core.errors import InputError
from app.formats.scene.toml import read_scene, sources_of
from app.surfaces.patches.step_faces import step_triangles
from app.usecases.scene.compute import compute
from tests.conftest import ROOT

PLATE = (ROOT / "tests" / "data" / "meshes" / "dome.step").read_bytes()
SCENE = """
[[tool]]
number = 1
diameter = 6
kind = "ball"
[[surface]]
name = "dome"
shape = { kind = "step", file = "dome.step" }
[[passes]]
tool = 1
through = [0, 15]
pitch = 4
"""


@pytest.fixture
def occ():
    return pytest.importorskip("OCP", reason="the extra 'step' (Open CASCADE) is not installed")


def test_without_the_library_it_is_told_what_to_install(monkeypatch) -> None:
    for name in [each for each in sys.modules if each.split(".")[0] == "OCP"]:
        monkeypatch.delitem(sys.modules, name)
    monkeypatch.setitem(sys.modules, "OCP", None)
    with pytest.raises(InputError, match=r"dome\.step: .* -m pip install 'cadquery-ocp"):
        step_triangles("dome.step", PLATE, (), 0.01)


@pytest.mark.parametrize("tolerance", [0.05, 0.002])
def test_every_corner_is_on_the_body_and_every_triangle_as_near_as_asked(occ, tolerance: float) -> None:
    """A plate of 40 by 30 by 5 mm from the origin, and on it half a ball of radius 10 about (20, 15, 5)."""
    triangles = step_triangles("dome.step", PLATE, (), tolerance)
    assert triangles.reshape(-1, 3).min(axis=0) == pytest.approx([0, 0, 0], abs=1e-9)
    assert triangles.reshape(-1, 3).max(axis=0) == pytest.approx([40, 30, 15], abs=tolerance)
    ball = triangles[triangles[:, :, 2].min(axis=1) > 5.001]
    assert np.linalg.norm(ball.reshape(-1, 3) - [20, 15, 5], axis=1) == pytest.approx(10.0, abs=1e-9)
    shares = np.random.default_rng(1).dirichlet([1, 1, 1], 40)
    inner = np.einsum("kc,ncd->nkd", shares, ball).reshape(-1, 3)
    assert (10 - np.linalg.norm(inner - [20, 15, 5], axis=1)).max() <= tolerance * 1.05
    area = (
        0.5
        * np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1).sum()
    )
    assert area == pytest.approx(2 * 40 * 30 + 2 * (40 + 30) * 5 - np.pi * 100 + 2 * np.pi * 100, rel=tolerance / 5)


def test_faces_by_their_numbers(occ) -> None:
    every = step_triangles("dome.step", PLATE, (), 0.05)
    count = 7
    assert sum(len(step_triangles("dome.step", PLATE, (k,), 0.05)) for k in range(1, count + 1)) == len(every)
    with pytest.raises(InputError, match=f"dome.step has {count} faces, so none with number 8; use 1 to {count}"):
        step_triangles("dome.step", PLATE, (8,), 0.05)


@pytest.mark.parametrize("data", [b"", b"nothing of the kind", PLATE[: len(PLATE) // 2]])
def test_what_cannot_be_read_is_told(occ, data: bytes) -> None:
    with pytest.raises(InputError, match=r"dome\.step: "):
        step_triangles("dome.step", data, (), 0.01)


def test_a_scene_of_step_faces_is_machined(occ) -> None:
    computed = compute(read_scene("a.toml", SCENE.encode()), sources_of(lambda name: PLATE))
    ends = computed.moves.moves.end[computed.moves.surface == 0]
    centre = ends + [0, 0, 3.0]
    off = np.linalg.norm(centre - [20, 15, 5], axis=1) - 13.0
    assert off[ends[:, 2] > 6].min() > -0.006  # what triangles within 0.005 mm can miss
    assert ends[:, 2].max() == pytest.approx(15.0, abs=0.01)
