"""The tool in the picture, against the projection of its outline."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.ui.views.cut.camera import Camera, StandardView
from app.ui.views.cut.cell_colours import CutColourBy, cell_colours
from app.ui.views.cut.cell_picking import SectionPlane
from app.ui.views.cut.rendering.cut_frame import CutFrame
from app.ui.views.cut.rendering.cut_scene import CutScene
from app.ui.views.cut.tool_outline import DrawnTool, ToolPart, outline_of
from tests.ui.cut.pictures import INKS, LOOK, SIZE, flat_picture, seen

TOOLS = [
    Tool(1, 2.0, flute_length=3.0, stick_out=6.0, shank_diameter=1.2, holder=((0.0, 1.6), (2.0, 2.4), (4.0, 2.4))),
    Tool(1, 3.0, ToolKind.BALL, flute_length=3.0, overall_length=9.0),
    Tool(1, 3.0, ToolKind.BULL, corner_radius=0.5),
    Tool(1, 3.0, ToolKind.V, tip_angle=1.0),
    Tool(1, 3.0, ToolKind.DRILL),
    Tool(1, 3.0, ToolKind.TAPER, tip_angle=0.4, tip_diameter=1.0),
]


def painted(context, picture, camera, tool=None, tips=((0.0, 0.0, 0.0),), **more):
    """Pictures of a tool at one place after the other, painted by one scene."""
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.show_colours(cell_colours(picture, CutColourBy.METAL, INKS))
        scene.show_tool(DrawnTool(outline_of(tool), tool.flutes) if tool is not None else None)
        made = []
        for tip in tips:
            scene.place_tool(tip)
            scene.draw(CutFrame(camera, SIZE, LOOK, **more))
            made.append(scene.pixels().astype(int))
        scene.release()
    return made


def differs(one, other, most=6):
    return np.abs(one - other).max(axis=2) > most


def silhouette(tool, camera, tip, turns=720):
    """Where the projection of a tool's outline lies, (height, width) bool; filled ring by ring, no OpenGL."""
    import cv2

    mask, shift = np.zeros((SIZE[1], SIZE[0]), np.uint8), 4
    angles = np.linspace(0, 2 * np.pi, turns)
    points = np.vstack([stretch.points for stretch in outline_of(tool).stretches])
    for low, high in pairwise(points):
        for share in np.linspace(0, 1, 60):
            height, radius = low + share * (high - low)
            ring = np.array(tip) + np.column_stack(
                [radius * np.cos(angles), radius * np.sin(angles), np.full(turns, height)]
            )
            px = camera.project(ring, SIZE)[:, :2] - 0.5
            cv2.fillPoly(mask, [np.round(px * 2**shift).astype(np.int32)], 255, cv2.LINE_8, shift)
    return mask > 0


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.kind.value)
@pytest.mark.parametrize("moving", [False, True])
def test_its_silhouette_is_that_of_the_outline(context, tool, moving):
    import cv2

    picture, tip = flat_picture(np.full((32, 32), -9.0)), (4.0, 5.5, -5.0)
    camera = Camera(target=(5.0, 5.0, 0.0), scale=14.0)
    (with_it,) = painted(context, picture, camera, tool, [tip], budget=4096 * moving)
    (without,) = painted(context, picture, camera, budget=4096 * moving)
    got, expected = differs(with_it, without, 3), silhouette(tool, camera, tip)
    rim = np.ones((3, 3), np.uint8)
    sure, most = cv2.erode(expected.astype(np.uint8), rim), cv2.dilate(expected.astype(np.uint8), rim)
    assert expected.sum() > 1500
    assert np.mean(got[sure > 0]) > 0.999 and not np.any(got[most == 0])


def test_the_metal_under_it_can_be_judged_and_cutting_part_shank_and_holder_are_told_apart(context):
    tool, tip = TOOLS[0], (5.0, 5.0, -1.0)
    stripes = flat_picture(np.where(np.arange(64) % 16 < 8, -1.0, -4.0) * np.ones((64, 1)))
    camera = seen(stripes, StandardView.TOP)
    (with_it,) = painted(context, stripes, camera, tool, [tip])
    (without,) = painted(context, stripes, camera)
    under = silhouette(tool, camera, tip) & ~silhouette(Tool(1, 1.0, stick_out=9.0), camera, tip)
    assert np.corrcoef(with_it[under].mean(axis=1), without[under].mean(axis=1))[0, 1] > 0.9
    front = seen(flat_picture(np.full((32, 32), -9.9)), StandardView.FRONT)
    (image,) = painted(context, flat_picture(np.full((32, 32), -9.9)), front, tool, [(5.0, 5.0, -7.0)])
    heights = {ToolPart.CUTTING: 1.5, ToolPart.SHANK: 4.5, ToolPart.HOLDER: 9.0}
    places = front.project(np.array([[5.0, 5.0, -7.0 + height] for height in heights.values()]), SIZE)
    cutting, shank, holder = (image[round(y), round(x) - 3] for x, y, _ in places)
    assert cutting[1] > 1.5 * cutting[0], "the first tool's colour is green"
    assert np.ptp(shank[:2]) < 25 and shank.sum() > holder.sum() + 60


def test_what_another_part_hides_does_not_shine_through(context):
    picture, tool = flat_picture(np.full((32, 32), -5.0)), TOOLS[0]
    camera = seen(picture, StandardView.TOP)
    (above,) = painted(context, picture, camera, tool, [(5.0, 5.0, -5.0)])
    (other,) = painted(
        context, picture, camera, replace(tool, diameter=1.0, shank_diameter=2.0, flute_length=1.0), [(5.0, 5.0, -5.0)]
    )
    assert np.array_equal(above, other)


def test_another_place_needs_no_more_than_a_place(context):
    picture, tool = flat_picture(np.full((32, 32), -1.0)), TOOLS[1]
    camera = seen(picture, StandardView.TOP)
    one, other = painted(context, picture, camera, tool, [(3.0, 3.0, -1.0), (3.0 + 64 / camera.scale, 3.0, -1.0)])
    assert np.any(one != other)
    inner = slice(80, 160)
    shifted = np.roll(one[inner], 64, axis=1)
    alike = silhouette(tool, camera, (3.0 + 64 / camera.scale, 3.0, -1.0))[inner]
    assert np.abs(shifted - other[inner]).max(axis=2)[alike].mean() < 2


def test_it_is_seen_however_far_it_stands_off_and_a_section_leaves_it_whole(context):
    picture, tool = flat_picture(np.full((32, 32), -1.0)), TOOLS[1]
    camera = Camera(target=(5.0, 5.0, 200.0), scale=14.0)
    (bare,) = painted(context, picture, camera)
    for section in (None, SectionPlane((1.0, 0.0), 2.0)):
        (high,) = painted(context, picture, camera, tool, [(5.0, 5.0, 198.0)], section=section)
        assert differs(high, bare).sum() > 1500


def test_behind_metal_it_shows_faintly(context):
    heights = np.full((64, 64), -8.0)
    heights[:16] = 0.0
    picture, tool = flat_picture(heights), Tool(1, 3.0, flute_length=3.0, overall_length=5.0)
    camera = seen(picture, StandardView.FRONT)
    (hidden,) = painted(context, picture, camera, tool, [(5.0, 6.0, -7.0)])
    (bare,) = painted(context, picture, camera)
    change = np.abs(hidden - bare).max(axis=2)
    assert np.count_nonzero(change > 3) > 300 and change.max() < 60


def test_no_tool_leaves_the_picture_as_it_was(context):
    picture = flat_picture(np.full((32, 32), -1.0))
    camera = seen(picture, StandardView.ISOMETRIC)
    with context:
        scene = CutScene(context)
        scene.show_picture(picture)
        scene.show_colours(cell_colours(picture, CutColourBy.METAL, INKS))
        kept = []
        for tool in (None, DrawnTool(outline_of(TOOLS[0])), None):
            scene.show_tool(tool)
            scene.place_tool((5.0, 5.0, -1.0))
            scene.draw(CutFrame(camera, SIZE, LOOK))
            kept.append(scene.pixels().copy())
        scene.release()
    assert np.array_equal(kept[0], kept[2]) and not np.array_equal(kept[0], kept[1])
