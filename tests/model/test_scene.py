"""Scenes refuse what cannot be machined, in words."""

import math
from collections.abc import Callable

import pytest

from app.core.errors import ParameterError
from app.model.scene import Passes, Scene, SceneOutline, SceneStock, Surface
from app.model.scene_curves import CurveForm, SectionCurve
from app.model.scene_shapes import (
    BicubicShape,
    BilinearShape,
    BsplineShape,
    ConeShape,
    CylinderShape,
    LoftShape,
    MeshShape,
    PlaneShape,
    RevolvedShape,
    SphereShape,
    TorusShape,
)
from app.model.tool import Tool
from app.model.tool_kind import ToolKind

ZERO, X = (0.0, 0.0, 0.0), (1.0, 0.0, 0.0)
BALL = SphereShape(ZERO, 1.0)
LINE = SectionCurve(((0.0, 0.0), (1.0, 0.0)))
GRID = tuple(tuple((float(i), float(j), 0.0) for j in range(4)) for i in range(4))
WRONG: dict[str, Callable[[], object]] = {
    "axis begins and ends at 0, 0, 0; give two places": lambda: CylinderShape(ZERO, ZERO, 1.0),
    "radii are 0 and 0 mm; use 0 or more, and not 0 for both": lambda: ConeShape(ZERO, X, 0.0, 0.0),
    "minor radius is 3 mm; it must be less than the major one, 3 mm": lambda: TorusShape(ZERO, 3.0, 3.0),
    "A torus's axis has no length": lambda: TorusShape(ZERO, 3.0, 1.0, ZERO),
    "edges 1, 0, 0 and 1, 0, 0 are parallel or have no length": lambda: PlaneShape(ZERO, X, X),
    "corners are 3; give 4": lambda: BilinearShape((ZERO, X, ZERO)),
    "rows have 4, 4, 4 points; give 4 rows of 4": lambda: BicubicShape(GRID[:3]),
    "rows have different numbers of points": lambda: BsplineShape((GRID[0], GRID[1][:3], GRID[2], GRID[3])),
    "degree_u is 4 with 4 points; use 1 to 3, or more points": lambda: BsplineShape(GRID, 4),
    "knots_v are 3; give 8 that do not fall, or none": lambda: BsplineShape(GRID, knots_v=(0.0, 0.5, 1.0)),
    "knots_u are not clamped; repeat the first and the last one 4 times": lambda: BsplineShape(
        GRID, knots_u=tuple(map(float, range(8)))
    ),
    "weights are not all greater than 0": lambda: BsplineShape(GRID, weights=((0.0,) * 4,) * 4),
    "weights are not as many as the points": lambda: BsplineShape(GRID, weights=((1.0,) * 4,) * 3),
    "A loft's sections are 1; give 2 or more": lambda: LoftShape((LINE,)),
    "A loft's sections are 2; give 3 or more": lambda: LoftShape((LINE, LINE), closed=True),
    "A turn goes from 0 to 361 degrees": lambda: RevolvedShape(LINE, turn_deg=(0.0, 361.0)),
    "file is 'a.doc'; it must be an .stl, .obj, .ply or .3mf file": lambda: MeshShape("a.doc"),
    "centre holds a number that is too large": lambda: SphereShape((1e7, 0.0, 0.0), 1.0),
    "A sphere's radius holds a number that is too large": lambda: SphereShape(ZERO, math.inf),
    "A sphere's centre holds a number": lambda: SphereShape((math.nan, 0.0, 0.0), 1.0),
    "either points or a drawing": SectionCurve,
    "all have two coordinates, or all three": lambda: SectionCurve(((0.0, 0.0), (1.0, 0.0, 0.0))),
    "Two neighbouring points of a section curve are alike, 0, 0": lambda: SectionCurve(((0.0, 0.0), (0.0, 0.0))),
    "A closed section curve has 2 points; it needs 3 or more": lambda: SectionCurve(
        ((0.0, 0.0), (1.0, 0.0)), closed=True
    ),
    "Weights belong to control points": lambda: SectionCurve(((0.0, 0.0), (1.0, 0.0)), weights=(1.0, 1.0)),
    "one greater than 0 each": lambda: SectionCurve(((0.0, 0.0), (1.0, 0.0)), CurveForm.CONTROL, weights=(1.0, -1.0)),
    "An axis has no length": lambda: SectionCurve(((0.0, 0.0), (1.0, 0.0)), x_axis=ZERO),
    "An outline is given in one way": SceneOutline,
    "give exactly one of them": lambda: SceneOutline(circle=(0.0, 0.0, 1.0), drawing="a.dxf"),
    "An outline has 2 corners": lambda: SceneOutline(outline=((0.0, 0.0), (1.0, 0.0))),
    "A circle's radius is 0 mm": lambda: SceneOutline(circle=ZERO),
    "A rectangle is x0, y0, x1, y1": lambda: SceneOutline(rectangle=(1.0, 0.0, 0.0, 1.0)),
    "An outline holds a number that is too large": lambda: SceneOutline(circle=(math.nan, 0.0, 1.0)),
    "The place of passes is out of range": lambda: Passes(1, pitch=1.0, floor=math.nan),
    "out of range; stay within 1e+06 mm and degrees": lambda: Passes(1, pitch=1.0, through=(math.inf, 0.0)),
    "each greater than its partner": lambda: SceneStock((0.0, 0.0, -math.inf, 1.0, 1.0, 0.0)),
    "A surface has no name": lambda: Surface(" ", BALL),
    "The placement of a is out of range": lambda: Surface("a", BALL, move=(math.nan, 0.0, 0.0)),
    "Two surfaces are named a": lambda: Scene(surfaces=(Surface("a", BALL), Surface("a", BALL))),
    "Safe Z is 1 mm and retract Z 2 mm": lambda: Scene(safe_z=1.0, retract_z=2.0),
    "Passes need either a pitch or a scallop height": lambda: Passes(1),
    "Pitch is 0 mm": lambda: Passes(1, pitch=0.0),
    "Chord tolerance is nan mm": lambda: Passes(1, pitch=1.0, chord_tolerance=math.nan),
    "Stock to leave is -1 mm": lambda: Passes(1, pitch=1.0, stock_to_leave=-1.0),
    "Feed rate is 0 mm/min": lambda: Passes(1, pitch=1.0, feed_rate=0.0),
    "The first line of passes has no length": lambda: Passes(1, pitch=1.0, line=(1.0, 1.0, 1.0, 1.0)),
    "Passes have a line, and an angle or a place beside it": lambda: Passes(
        1, pitch=1.0, angle_deg=1.0, line=(0.0, 0.0, 1.0, 1.0)
    ),
    "The stock is a box": lambda: SceneStock((0.0, 0.0, 0.0, 1.0, 1.0, 0.0)),
    "The stock's margin is -1 mm": lambda: SceneStock(margin=-1.0),
    "The scene has no tool T3": lambda: Scene().tool(3),
    "T1 is a drill, which cannot cut sideways": lambda: Scene(tools=(Tool(1, 6.0, ToolKind.DRILL),)).tool(1),
}


@pytest.mark.parametrize("words", WRONG)
def test_what_is_wrong_is_said(words: str) -> None:
    with pytest.raises(ParameterError) as caught:
        WRONG[words]()
    assert words in str(caught.value)
    assert str(caught.value).endswith(".")


def test_the_first_plane_by_angle_or_by_line() -> None:
    by_angle = Passes(1, pitch=1.0, angle_deg=90.0, through=(3.0, 4.0))
    by_line = Passes(1, pitch=1.0, line=(3.0, 4.0, 3.0, 9.0))
    assert (by_angle.angle, by_angle.origin) == (math.pi / 2, (3.0, 4.0))
    assert (by_line.angle, by_line.origin) == (math.pi / 2, (3.0, 4.0))
