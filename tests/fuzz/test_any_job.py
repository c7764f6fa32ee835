"""All kinds of operation on random shapes, exported for every control, cut by a second hand, and the verdicts.

Nothing here is the program's own but `make` and its findings: the text is read by a small reader, cut in closed forms
at points, and asked against the drawn shapes.
"""

from __future__ import annotations

import numpy as np
import pytest

from app.core.errors import HitofudeError
from app.formats.job.toml import read_job
from app.gcode.posts import post_names
from app.model.finding import FindingKind
from app.usecases.job.options import MakeOptions
from app.usecases.making.make import MakeResult, make
from tests.fuzz.any_job import FIELD, KINDS, AnyJob, any_job
from tests.fuzz.dense_heights import DenseHeights
from tests.fuzz.plain_nc import PlainReader

PITCH = 0.17
SLACK = 4e-3
"""mm of height."""
ROUNDED = 2e-3
"""mm sideways that the digits of a control and the path's tolerance may be off."""
LEFT = (FindingKind.LEFT_REACHABLE, FindingKind.SKIN, FindingKind.REGION_TOO_SMALL, FindingKind.NECK_TOO_NARROW)


def made_of(job: AnyJob) -> MakeResult:
    return make("part.draw", job.drawing.encode(), MakeOptions(job=read_job("job", job.tables.encode()).job))


def faults(job: AnyJob, made: MakeResult, pitch: float = PITCH) -> list[str]:
    """Return what the judge finds wrong with the program or with what is said of it."""
    found = []
    kinds = {each.kind for each in made.findings if each.counts}
    gouged = left = 0
    for k, work in enumerate(job.works):
        centre = k * FIELD
        heights = DenseHeights((centre - FIELD / 2, -FIELD / 2, centre + FIELD / 2, FIELD / 2), pitch, job.above)
        for file in made.files:
            tool = int(made.program.moves.tool[file.first])
            heights.cut(PlainReader(job.control, tool).read(file.nc.text), job.shapes)
        x, y = heights.points()
        wanted = work.judge(x - centre, y)
        steep = max([shape.fall for _, shape in work.tools])
        low = heights.z < wanted.lowest - SLACK - steep * ROUNDED
        high = heights.z > wanted.highest + SLACK + steep * ROUNDED
        gouged, left = gouged + int(low.sum()), left + int(high.sum())
        if low.any() and FindingKind.GOUGE not in kinds:
            row, column = np.argwhere(low)[0]
            deep = float((wanted.lowest - heights.z)[low].max())
            found.append(
                f"{work.kind}: {low.sum()} points cut too low, by {deep:.4f}, "
                f"({x[row, column]:.3f}, {y[row, column]:.3f})"
            )
        if high.any() and not kinds & set(LEFT):
            row, column = np.argwhere(high)[0]
            much = float((heights.z - wanted.highest)[high].max())
            found.append(
                f"{work.kind}: {high.sum()} points left, by {much:.4f}, ({x[row, column]:.3f}, {y[row, column]:.3f})"
            )
    told = {each.kind: each for each in made.findings if each.counts and (each.amount or 0.0) > 0.3}
    if FindingKind.LEFT_REACHABLE in told and not left:
        found.append(f"a false alarm: {told[FindingKind.LEFT_REACHABLE].text}")
    if FindingKind.GOUGE in told and not gouged:
        found.append(f"a false alarm: {told[FindingKind.GOUGE].text}")
    return found


def checked(seed: int, kinds: tuple[str, ...], control: str) -> None:
    job = any_job(seed, kinds, control)
    try:
        made = made_of(job)
    except HitofudeError as error:
        assert str(error).endswith("."), error
        return
    assert not faults(job, made), (job.drawing, job.tables)


@pytest.mark.parametrize(
    ("seed", "kinds", "control"),
    [
        (2, ("contour", "drill", "countersink"), "fanuc"),
        (3, ("slot",), "grbl"),
    ],
)
def test_some_jobs(seed: int, kinds: tuple[str, ...], control: str) -> None:
    checked(seed, kinds, control)


@pytest.mark.exhaustive
@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_on_two_controls(kind: str) -> None:
    """Together all kinds on all controls, several times over."""
    controls = list(post_names())
    first = list(KINDS).index(kind)
    for k in range(2):
        checked(100 + k, (kind, "pocket")[: 1 + k], controls[(first + 2 * k) % len(controls)])


OFF = [("pocket", -0.05), ("countersink", 0.05)]
MORE_OFF = [("pocket", 0.05), ("contour", -0.05), ("vcarve", -0.02), ("vcarve", 0.02), ("drill", -0.05)]


@pytest.mark.parametrize(
    ("kind", "deeper"), [*OFF, *(pytest.param(*each, marks=pytest.mark.exhaustive) for each in MORE_OFF)]
)
def test_the_judge_sees_what_is_off(kind: str, deeper: float, monkeypatch: pytest.MonkeyPatch) -> None:
    """The program is moved on purpose, as the judge reads it."""
    job = any_job(5, (kind,), "linuxcnc")
    made = made_of(job)
    assert not faults(job, made)
    own = PlainReader._to

    def moved(self: PlainReader, goal: tuple[float, float, float], rapid: bool) -> None:
        own(self, (goal[0], goal[1], goal[2] + deeper), rapid)

    monkeypatch.setattr(PlainReader, "_to", moved)
    assert faults(job, made)


def test_a_contour_round_another_part_is_not_asked_to_clear_a_pockets_corners() -> None:
    """The frame round W1 ends within the pocket W2: what its 2 mm tool would reach there, past the pocket's walls, was
    told as left within reach.
    """
    tables = (
        "[stock]\nthickness = 50\n[[tool]]\nnumber = 2\ndiameter = 2.0\n[[tool]]\nnumber = 3\ndiameter = 3.175\n"
        '[[operation]]\nkind = "contour"\nside = "outside"\ntool = 2\ncurves = ["layer:W1"]\n'
        '[[operation]]\nkind = "pocket"\ntool = 3\ncurves = ["layer:W2"]\n'
    )
    for x in (60.0, 62.0, 64.0, 66.0, 68.0, 70.0):
        drawing = f"layer W1\nrectangle 33,-4 51,9\nlayer W2\nrectangle {x},-5 {x + 12},5\n"
        made = make("part.draw", drawing.encode(), MakeOptions(job=read_job("job", tables.encode()).job))
        told = [each.text for each in made.findings if each.kind is FindingKind.LEFT_REACHABLE]
        assert told == [], x
