"""Scenes are made surface by surface: meshes, trims, placements, and what is said where it fails."""

from pathlib import Path

import numpy as np
import pytest

from app.core.errors import Cancelled, GeometryError, InputError
from app.formats.scene.toml import read_scene, sources_of
from app.model.curves import Circle
from app.model.scene import KeptSide, Scene, Surface, Trim
from app.model.scene_shapes import MeshShape, PlaneShape, SphereShape
from app.surfaces.patches.build import build, build_surface
from tests.surfaces.surface_places import NO_FILES, anywhere

PLANE = PlaneShape((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 50.0, 0.0))
STL = b"""solid one
facet normal 0 0 1
outer loop
vertex 0 0 1
vertex 2 0 1
vertex 0 3 1
endloop
endfacet
endsolid one
"""
OBJ = b"v 0 0 1\nv 2 0 1\nv 0 3 1\nf 1 2 3\n"
PLY = (
    b"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    b"property list uchar int vertex_indices\nend_header\n0 0 1\n2 0 1\n0 3 1\n3 0 1 2\n"
)
FRAME = b"rect 0,0 40,30\ncircle 20,15 5\nline 60,0 70,0\n"


@pytest.mark.parametrize(("name", "data"), [("a.stl", STL), ("a.OBJ", OBJ), ("a.ply", PLY)])
def test_a_mesh_is_scaled_then_turned_then_moved(name: str, data: bytes) -> None:
    surface = Surface("mesh", MeshShape(name, 10.0), rotate_deg=(0.0, 0.0, 90.0), move=(1.0, 0.0, 0.0))
    made = build_surface(surface, sources_of(lambda _: data))
    assert made.splines == ()
    assert made.triangles is not None
    assert made.triangles.tolist() == [[[1, 0, 10], [1, 20, 10], [-29, 0, 10]]]


@pytest.mark.parametrize("data", [b"", b"solid x\nendsolid x\n", b"\x00" * 90, b"hello"])
def test_a_broken_mesh_is_an_error_that_names_the_file(data: bytes) -> None:
    with pytest.raises(InputError, match=r"^a\.stl: .*export (it|the solid) again.*\.$"):
        build_surface(Surface("mesh", MeshShape("a.stl")), sources_of(lambda _: data))


def test_a_missing_file_is_told_by_who_reads_it() -> None:
    with pytest.raises(InputError, match=r"^a\.stl: there is no such file\.$"):
        build_surface(Surface("mesh", MeshShape("a.stl")), NO_FILES)


def test_trims_are_regions_with_exact_arcs() -> None:
    trims = (
        Trim(circle=(50.0, 25.0, 10.0)),
        Trim(rectangle=(0.0, 0.0, 20.0, 10.0), keep=KeptSide.OUTSIDE),
        Trim(outline=((0.0, 0.0), (0.0, 9.0), (9.0, 0.0))),
        Trim(drawing="frame.draw"),
    )
    circle, rectangle, outline, drawn = build_surface(
        Surface("a", PLANE, trims=trims), sources_of(lambda _: FRAME)
    ).trims
    assert circle.regions[0].boundary.primitives == (Circle((50.0, 25.0), 10.0),)
    assert [each.keep for each in (circle, rectangle)] == [KeptSide.INSIDE, KeptSide.OUTSIDE]
    assert len(rectangle.regions[0].boundary.primitives) == 4
    corners = [each.start for each in outline.regions[0].boundary.primitives]
    assert sum(a[0] * b[1] - a[1] * b[0] for a, b in zip(corners, corners[1:] + corners[:1], strict=True)) == 81
    (region,) = drawn.regions
    assert [each.radius for each in region.islands[0].primitives if isinstance(each, Circle)] == [5.0]


def test_a_layer_without_a_closed_contour_cannot_trim() -> None:
    surface = Surface("lid", PLANE, trims=(Trim(drawing="frame.draw"),))
    with pytest.raises(
        GeometryError,
        match=r"^Surface lid: frame\.draw has no closed contour there; close one, or name another layer\.$",
    ):
        build_surface(surface, sources_of(lambda _: b"line 0,0 10,0\n"))


@pytest.mark.parametrize("outline", [((0.0, 0.0), (5.0, 0.0), (9.0, 0.0)), ((1.0, 1.0), (1.0, 1.0), (1.0, 1.0))])
def test_an_outline_without_an_area_is_told(outline: tuple[tuple[float, float], ...]) -> None:
    with pytest.raises(GeometryError, match=r"^Surface lid: An outline holds no area; give it some\.$"):
        build_surface(Surface("lid", PLANE, trims=(Trim(outline=outline),)), NO_FILES)


def test_a_mesh_of_several_objects_is_taken_whole() -> None:
    data = b"o one\n" + OBJ + b"o two\nv 5 5 5\nv 6 5 5\nv 5 6 5\nf 4 5 6\n"
    made = build_surface(Surface("mesh", MeshShape("a.obj")), sources_of(lambda _: data))
    assert made.triangles is not None
    assert made.triangles.shape == (2, 3, 3)


def test_trims_are_of_the_placed_surface() -> None:
    surface = Surface("a", PLANE, move=(100.0, 0.0, 0.0), trims=(Trim(circle=(120.0, 25.0, 10.0)),))
    made = build_surface(surface, NO_FILES)
    assert made.trims[0].regions[0].boundary.primitives == (Circle((120.0, 25.0), 10.0),)
    assert anywhere(made.splines[0])[:, 0].min() == 100


def test_surfaces_are_made_in_order_with_progress_that_can_be_cancelled() -> None:
    scene = Scene("two", (Surface("ball", SphereShape((0.0, 0.0, 0.0), 5.0)), Surface("floor", PLANE)))
    told: list[str] = []

    class Telling:
        def step(self, fraction: float, text: str = "") -> None:
            told.append(text)
            if len(told) > 2:
                raise Cancelled

    made = build(scene, NO_FILES, Telling())  # type: ignore[arg-type]
    assert [each.surface.name for each in made] == ["ball", "floor"]
    assert told == ["Making ball", "Making floor"]
    with pytest.raises(Cancelled):
        build(scene, NO_FILES, Telling())  # type: ignore[arg-type]


@pytest.mark.parametrize(("name", "count"), [("compound", 3), ("spheres", 3), ("torus", 1), ("die", 10)])
def test_samples_are_made(samples: Path, name: str, count: int) -> None:
    scene = read_scene(f"{name}.toml", (samples / f"{name}.toml").read_bytes())
    made = build(scene, NO_FILES)
    assert len(made) == count
    assert scene.stock.box is not None
    low, high = np.array(scene.stock.box).reshape(2, 3)
    points = np.concatenate([anywhere(spline, 500) for each in made for spline in each.splines])
    assert (points[:, :2] >= low[:2] - 1e-6).all()
    assert (points[:, :2] <= high[:2] + 1e-6).all()
    assert points[:, 2].max() <= high[2] + 1e-6
