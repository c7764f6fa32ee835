"""Scenes as NC: every control, every unit, several tools; what was written is read back, and what is wrong in it is
found.
"""

import re
import threading
from dataclasses import replace

import numpy as np
import pytest

from app.core.errors import Cancelled, HitofudeError
from app.core.progress import Progress
from app.formats.scene.toml import sources_of
from app.gcode.posts import load_post, post_names
from app.model.finding import FindingKind
from app.model.job import OriginXY, OriginZ
from app.model.part import Units
from app.model.scene import Boundary, CentreLimit, Passes, Scene, Surface
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.surfaces.sections.compound import NO_SURFACE
from app.usecases.scene.compute import ComputedScene, compute
from app.usecases.scene_program import nc as surface_nc
from app.usecases.scene_program.nc import write_scene_nc
from tests.surfaces.scenes import ball, plane
from tests.surfaces.surface_places import no_data

SOURCES = sources_of(no_data)
SCENE = Scene(
    "two",
    (Surface("table", plane(0, 0, 30, 20)), Surface("dome", ball(15, 10, -3, 8))),
    tools=(Tool(1, 6.0, ToolKind.BALL), Tool(2, 3.0, ToolKind.BULL, corner_radius=0.5)),
    passes=(Passes(1, pitch=4.0), Passes(2, pitch=4.0, angle_deg=90)),
)
FEW = (Passes(1, pitch=9.0), Passes(2, pitch=9.0, angle_deg=90))
"""Passes of both tools, where their number has no part in what is tested."""


def computed(**changes: object) -> ComputedScene:
    return compute(replace(SCENE, **changes), SOURCES)  # type: ignore[arg-type]


@pytest.mark.parametrize("post", post_names())
@pytest.mark.parametrize("units", [Units.MM, Units.INCH])
def test_every_control_reads_back_what_is_proven(post: str, units: Units) -> None:
    scene = replace(SCENE, passes=FEW, post=post, out_units=units, origin_xy=OriginXY.CENTRE, origin_z=OriginZ.TOP)
    try:
        done = write_scene_nc(compute(scene, SOURCES))
    except HitofudeError as error:
        assert "inch" in str(error) or "exact" in str(error)
        return
    assert {finding.kind for finding in done.findings()} <= {
        FindingKind.LEFT_REACHABLE,
        FindingKind.RIDGE,
    } and done.time_s > 0
    assert len(done.files) == (2 if load_post(post).file_per_tool else 1)
    written = sum(len(set(file.nc.lines.tolist())) for file in done.files)
    assert written >= 0.9 * len(done.computed.moves.moves)
    low = min(float(np.nanmin(program.motions.end[:, 2])) for program in done.programs)
    assert low + done.computed.origin[2] == pytest.approx(0.0, abs=0.002 if units is Units.INCH else 2e-4)


def test_a_program_that_goes_too_deep_is_found_out(monkeypatch: pytest.MonkeyPatch) -> None:
    made = computed(passes=(Passes(1, pitch=4.0),))
    moves = made.moves.moves
    deeper = np.array(moves.end)
    row = int(np.argmax(np.where(made.moves.surface == 1, deeper[:, 2], -np.inf)))
    deeper[row, 2] -= 0.01
    done = write_scene_nc(replace(made, moves=replace(made.moves, moves=replace(moves, end=deeper))))
    assert len(done.unproven) in (1, 2)
    (x, y, _), finding = done.unproven[0], done.findings()[0]
    assert finding.counts and (finding.x, finding.y) == (x, y) and abs(x - deeper[row, 0]) < 1.0
    monkeypatch.setattr(surface_nc, "write_moves", lambda *given: _shifted(given))
    with pytest.raises(HitofudeError, match="from the path"):
        write_scene_nc(made)


def _shifted(given: tuple[object, ...]) -> object:
    from app.gcode.writer.write import write_moves

    moves, *rest = given
    return write_moves(replace(moves, end=moves.end + [0.0, 0.0, 0.001]), *rest)  # type: ignore[attr-defined, call-overload]


def test_comments_tell_the_surface_and_the_boundary_point_at_its_place() -> None:
    done = write_scene_nc(computed(passes=(Passes(1, pitch=4.0),)))
    (file,) = done.files
    lines = file.nc.text.splitlines()
    # the first one of each line
    row_of = dict(reversed([(line, row) for row, line in enumerate(file.nc.lines.tolist())]))
    marks = 0
    for number, line in enumerate(lines, 1):
        found = re.match(r"\(Surface (\d) (table|dome), CR12 crossing at (\S+) (\S+) (\S+)\)", line)
        if found:
            marks += 1
            next_row = next(row_of[n] for n in range(number, len(lines) + 1) if n in row_of)
            x, y = float(found[3]), float(found[4])
            before = done.computed.moves.moves.end[next_row - 1]
            assert before[:2] == pytest.approx([x, y], abs=1e-3)
            assert done.computed.moves.surface[next_row] == int(found[1]) - 1
    assert marks == len(done.computed.families[0].path.boundaries) > 4


def test_the_order_of_surfaces_changes_nothing_but_their_numbers() -> None:
    twice = Surface("another table", plane(0, 0, 30, 20))
    one = computed(surfaces=(*SCENE.surfaces, twice), passes=FEW)
    other = computed(surfaces=(twice, *SCENE.surfaces[::-1]), passes=FEW)
    assert np.array_equal(one.moves.moves.end, other.moves.moves.end)
    # NO_SURFACE is the last
    names = [np.array([*each.names, "none"])[each.moves.surface].tolist() for each in (one, other)]
    assert names[0] == names[1] and "another table" in names[0]


def test_a_floor_and_a_boundary_hold() -> None:
    inside = (Boundary(rectangle=(5, 3, 25, 17), centre=CentreLimit.INSIDE),)
    made = computed(passes=(Passes(1, pitch=2.0, floor=2.0, boundary=inside),))
    cut = made.moves.moves.end[made.moves.surface != NO_SURFACE]
    assert cut[:, 2].min() == pytest.approx(2.0, abs=1e-4)
    assert (cut[:, 0].min(), cut[:, 0].max()) == pytest.approx((8.0, 22.0), abs=1e-3)
    assert cut[:, 1].min() >= 6.0 - 1e-3 and cut[:, 1].max() <= 14.0 + 1e-3
    assert made.names[int(made.moves.surface[made.moves.surface != NO_SURFACE].max())] == "floor"


def test_stock_to_leave_is_left() -> None:
    made = computed(passes=(Passes(1, pitch=2.0, stock_to_leave=0.5),))
    cut = made.moves.moves.end[made.moves.surface != NO_SURFACE]
    assert cut[:, 2].min() == pytest.approx(0.5, abs=2e-4)
    assert np.linalg.norm(cut + [0, 0, 3.0] - [15, 10, -3], axis=1).min() >= 8 + 3 + 0.5 - 1e-4


def test_scallops_are_no_higher_than_asked() -> None:
    made = computed(passes=(Passes(1, scallop=0.02),), surfaces=SCENE.surfaces[:1])
    step = np.diff(made.families[0].planes.offsets).max()
    assert (
        step == pytest.approx(2 * np.sqrt(2 * 3 * 0.02 - 0.02**2), rel=0.02)
        and step <= 2 * np.sqrt(2 * 3 * 0.02 - 0.02**2) + 1e-9
    )


def test_computing_can_be_cancelled_and_tells_how_far_it_is() -> None:
    told: list[float] = []
    made = compute(SCENE, SOURCES, Progress(lambda share, text: told.append(share)))
    assert told == sorted(told) and told[-1] >= 0.9 and len(told) > 20
    for work in (lambda progress: compute(SCENE, SOURCES, progress), lambda progress: write_scene_nc(made, progress)):
        stop, told = threading.Event(), []

        def show(share: float, text: str, stop: threading.Event = stop, told: list[float] = told) -> None:
            told.append(share)
            if share > 0.3:
                stop.set()

        with pytest.raises(Cancelled):
            work(Progress(show, stop))
        assert max(told) < 0.9


def test_a_scene_without_passes_has_nothing_to_write() -> None:
    with pytest.raises(HitofudeError, match="no passes"):
        write_scene_nc(computed(passes=()))
