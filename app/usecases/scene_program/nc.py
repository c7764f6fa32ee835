"""A computed scene as NC: written, read back, and every move of the written text proven against the surfaces."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np
import shapely.affinity
from numpy.typing import NDArray

from ...core.errors import GeometryError
from ...core.progress import NO_PROGRESS, Progress
from ...formats.machine_toml import DEFAULT_MACHINE, load_machine
from ...gcode.interpreter.options import ReadOptions
from ...gcode.interpreter.program import NcProgram
from ...gcode.interpreter.reader import read_program
from ...gcode.operation_notes import plain_numbers, spelled
from ...gcode.posts import Post, load_post
from ...gcode.timing.duration import duration
from ...gcode.writer.header import safe_name, shape_numbers, tool_words, unit_sign
from ...gcode.writer.write import NcFile, Remarks, write_moves
from ...model.finding import Finding, FindingKind
from ...model.motion import MotionKind, Motions
from ...model.motion_path import anchored
from ...model.tool import Tool
from ...simulation.cutter import cutter_of
from ...simulation.field.workpiece import Workpiece
from ...surfaces.cutter_contact.drop_cutter import drop_shape, shape_of
from ...surfaces.passes.path import ALLOWED
from ...surfaces.sections.compound import NO_SURFACE, BoundaryKind
from ..scene.compute import ComputedFamily, ComputedScene, job_of
from ..scene.plane_rules import ALONE
from .corner_reach import TipHeights
from .left import FamilyRequest, SceneLeft, left_findings, left_of
from .load import SceneBlank, SceneCut, scene_cut
from .reach import FamilyReach

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class WrittenScene:
    """A scene's program.

    Attributes:
        computed: what was written. post: in whose words.
        files: in the order of cutting: one, or one a tool where the control changes no tools.
        programs: each file, read back, its motions anchored.
        unproven: (k, 3) ends of moves, scene coordinates, that may go deeper into a surface than ALLOWED.
        loads: where tools take too much metal at a time.
        left: what they leave of what they reach.
    """

    computed: ComputedScene
    post: Post
    files: tuple[NcFile, ...]
    programs: tuple[NcProgram, ...]
    unproven: Floats
    loads: tuple[Finding, ...] = ()
    left: SceneLeft | None = None

    @property
    def time_s(self) -> float:
        """How long it takes on a usual machine, s."""
        machine = load_machine(DEFAULT_MACHINE)
        return sum(duration(program, machine).total for program in self.programs)

    def findings(self) -> tuple[Finding, ...]:
        """Return what is wrong with it, and with its scene."""
        return (
            *self.computed.findings,
            *(
                Finding(
                    FindingKind.GOUGE,
                    f"The move to ({x:.3f}, {y:.3f}, {z:.3f}) could not be proven to stay within {ALLOWED:g} mm of the "
                    "surfaces; make the chord tolerance larger, or check the surfaces there.",
                    x,
                    y,
                )
                for x, y, z in self.unproven.tolist()
            ),
            *self._left(),
            *self.loads,
        )

    def _left(self) -> Iterator[Finding]:
        """Yield what there is to say of what is left."""
        if self.left is not None:
            angles = [math.degrees(family.planes.angle) for family in self.computed.families]
            yield from left_findings(self.left, np.array(self.computed.origin), angles)


def write_scene_nc(computed: ComputedScene, progress: Progress = NO_PROGRESS) -> WrittenScene:
    """Write a computed scene, read it back, and prove it.

    Raises:
        HitofudeError: it has no passes, the control cannot do what is asked, or what was written differs from it.
        Cancelled: the job was asked to stop.
    """
    scene, moves = computed.scene, computed.moves.moves
    if not len(moves):
        raise GeometryError(
            f"{scene.name}: no passes are switched on, so there is nothing to write; add passes with a tool."
        )
    post = load_post(scene.post)
    tools = {family.tool.number: family.tool for family in computed.families}
    from_origin = replace(moves, end=moves.end - np.array(computed.origin))
    files = write_moves(from_origin, job_of(scene, tools), post, _remarks(computed, post), progress.part(0.0, 0.4))
    programs, unproven = [], [np.zeros((0, 3))]
    for k, file in enumerate(files):
        share = progress.part(0.4 + 0.5 * k / len(files), 0.4 + 0.5 * (k + 1) / len(files))
        share.step(0.0, "Reading the program back")
        program = read_program(file.nc.text.encode(), ReadOptions(dialect=post.dialect), share.part(0.0, 0.3))
        if program.error:
            raise GeometryError(f"{post.title}: what was written cannot be read back: {program.error.text}")
        motions = anchored(program.motions)
        _require_same(computed, file, motions)
        unproven.append(_unproven(computed, file, motions, share.part(0.3, 1.0)))
        programs.append(program)
    done = _cut(computed, files, programs, progress.part(0.9, 0.97))
    left = left_in(computed, done.workpiece, progress.part(0.97, 1.0))
    return WrittenScene(computed, post, files, tuple(programs), np.concatenate(unproven), done.findings, left)


def _cut(
    computed: ComputedScene, files: Sequence[NcFile], programs: Sequence[NcProgram], progress: Progress
) -> SceneCut:
    """Cut the program out of the stock; a file that names no tool has the one of its first move."""
    tools = {family.tool.number: family.tool for family in computed.families}
    numbers = computed.moves.moves.tool
    known = [tools | {0: tools[int(numbers[file.first])]} for file in files]
    block = SceneBlank(computed.stock, np.array(computed.origin), closest_passes(computed))
    return scene_cut(
        [replace(program, motions=anchored(program.motions)) for program in programs], known, block, progress
    )


def _require_same(computed: ComputedScene, file: NcFile, motions: Motions) -> None:
    """Refuse a text whose motions do not end where the moves do that it was written for."""
    lines = file.nc.lines
    last = np.append(lines[1:] != lines[:-1], True)
    ends = computed.moves.moves.end[file.first : file.first + len(lines)][last]
    rows = np.searchsorted(motions.line, lines[last], "right") - 1
    off = np.abs(motions.end[rows] + np.array(computed.origin) - ends).max(initial=0.0)
    if not off <= 0.6 * computed.grid:
        raise GeometryError(f"what was written is {off:.5f} mm from the path; please report this with the scene.")


def _unproven(computed: ComputedScene, file: NcFile, motions: Motions, progress: Progress) -> Floats:
    """Return the ends of motions that cannot be proven."""
    origin = np.array(computed.origin)
    chords = np.concatenate([motions.start + origin, motions.end + origin], axis=1)
    family = computed.moves.moves.operation[
        file.first + np.minimum(np.searchsorted(file.nc.lines, motions.line), len(file.nc.lines) - 1)
    ]
    top = float(computed.facets.facets.triangles[:, :, 2].max())
    low = np.minimum(chords[:, 2], chords[:, 5]) < top + max(
        (each.passes.stock_to_leave for each in computed.families), default=0.0
    )
    low &= np.isfinite(chords).all(axis=1) & ((motions.kind == MotionKind.LINE) | (motions.kind == MotionKind.RAPID))
    found = [np.zeros((0, 3))]
    for number, each in enumerate(computed.families):
        rows = np.flatnonzero(low & (family == number))
        proven = each.follower.proven(chords[rows], progress)
        found.append(chords[rows[~proven], 3:])
    return np.concatenate(found)


def _remarks(computed: ComputedScene, post: Post) -> Remarks:
    """Return what the program says: what it mills, and before each part of a pass on which surface it is."""

    def operation(number: int) -> str:
        return pass_words(computed.families[number])

    return Remarks(tuple(_head(computed, post)), tuple(_notes(computed)), operation, _provenance(computed))


def pass_words(family: ComputedFamily) -> str:
    """Return a family of passes in words."""
    passes, count = family.passes, len(family.planes.offsets)
    apart = f"pitch {passes.pitch:g} mm" if passes.pitch is not None else f"scallop {passes.scallop:g} mm"
    if passes.pitch == ALONE:
        apart = f"at {passes.angle_deg:.4g} degrees through {passes.through[0]:.4g}, {passes.through[1]:.4g}"
    name = f" {safe_name(passes.name)}" if passes.name else ""
    return (
        f"Passes{name} T{family.tool.number}: {count} planes, {apart}, {passes.strategy.value}, "
        f"stock to leave {passes.stock_to_leave:g} mm, chords {passes.chord_tolerance:g} mm"
    )


def _head(computed: ComputedScene, post: Post) -> list[str]:
    scene, box = computed.scene, computed.stock
    units = scene.out_units
    origin = ", ".join(f"{axis} {value:.4f}" for axis, value in zip("XYZ", computed.origin, strict=True))
    tools: dict[int, Tool] = {family.tool.number: family.tool for family in computed.families}
    return [
        f"Scene {safe_name(scene.name)}",
        f"Hitofude for {safe_name(post.title)}, lengths in {units.name.lower()}",
        "Stock " + " x ".join(f"{side:.3f}" for side in box.size) + " mm",
        f"Work origin is at {origin} mm of the scene",
        *(f"{tool_words(tool, units)}, {tool.spindle_speed:.0f} rpm" for tool in tools.values()),
        *(pass_words(family) for family in computed.families),
        *(
            f"Surface {number} {safe_name(surface.name)}"
            for number, surface in enumerate(scene.surfaces, 1)
            if surface.enabled
        ),
        f"Every chord is proven to go no deeper than {ALLOWED:.5f} mm into a surface; the control's blending comes on "
        "top",
    ]


def _notes(computed: ComputedScene) -> list[str]:
    """Return the comments that `hitofude cut` reads."""
    scene, box = computed.scene, computed.stock
    tools = {family.tool.number: family.tool for family in computed.families}
    notes = [
        "program=1",
        f"part={safe_name(scene.name)}",
        f"units={unit_sign(scene.out_units)}",
        f"origin_mm={plain_numbers(*computed.origin)}",
        f"stock_mm={plain_numbers(box.x0, box.y0, box.z0, box.x1, box.y1, box.z1)}",
    ]
    for tool in tools.values():
        notes.append(f"tool={tool.number},{tool.kind.value},{plain_numbers(tool.diameter, *shape_numbers(tool))}")
    fastest: dict[int, float] = {}
    for family in computed.families:  # passes may feed one tool in different ways
        fastest[family.tool.number] = max(family.tool.plunge_rate, fastest.get(family.tool.number, 0.0))
    notes += [f"plunge_mm_min={plain_numbers(number, rate)}" for number, rate in fastest.items()]
    notes += [f"surface={number},{spelled(surface.name)}" for number, surface in enumerate(scene.surfaces, 1)]
    return [f"hitofude: {note}" for note in notes]


def _provenance(computed: ComputedScene) -> dict[int, tuple[str, ...]]:
    """Return the comments before moves: on which surface the cutter comes to be, and at which boundary point."""
    found: dict[int, tuple[str, ...]] = {}
    surface = computed.moves.surface
    names = computed.names
    marks = _marks(computed)
    ends = computed.moves.moves.end
    last = NO_SURFACE
    for n in np.flatnonzero(np.append(True, surface[1:] != surface[:-1])).tolist():
        number = int(surface[n])
        if number == NO_SURFACE:
            last = NO_SURFACE
            continue
        said = f"Surface {number + 1} {safe_name(names[number])}"
        key = (int(computed.moves.moves.operation[n]), *np.round(ends[n - 1, :2], 3).tolist())
        if last != NO_SURFACE and key in marks:
            said += f", {marks[key]}"
        found[n] = (said,)
        last = number
    return found


def _marks(computed: ComputedScene) -> dict[tuple[object, ...], str]:
    """Return boundary points in words, by family and place."""
    found: dict[tuple[object, ...], str] = {}
    for number, family in enumerate(computed.families):
        marks = family.path.boundaries
        for n in range(len(marks)):
            i, j = sorted((int(marks.before[n]) + 1, int(marks.after[n]) + 1))
            x, y, z = marks.place[n].tolist()
            kind = BoundaryKind(int(marks.kind[n])).name.lower()
            near = np.round(np.round(marks.place[n, :2] / computed.grid) * computed.grid, 3).tolist()
            found[(number, *near)] = f"CR{i}{'-' if max(i, j) > 9 else ''}{j} {kind} at {x:.4f} {y:.4f} {z:.4f}"
    return found


TIP_ERROR = 1e-3
"""How near to the surfaces a tool is dropped to look at corners, mm: a tenth of what counts as left at all."""


def left_in(computed: ComputedScene, workpiece: Workpiece, progress: Progress = NO_PROGRESS) -> SceneLeft:
    """Return what a computed scene's program leaves within reach.

    Args:
        workpiece: after the cut of the program, program coordinates.

    Raises:
        Cancelled: the job was asked to stop.
    """
    facets = computed.facets.facets
    triangles = facets.triangles - np.array(computed.origin)
    requested = [_asked(computed, family) for family in computed.families]
    return left_of(workpiece, triangles, float(facets.error.max()), requested, progress)


def _asked(computed: ComputedScene, family: ComputedFamily) -> FamilyRequest:
    passes, tool = family.passes, family.tool
    x, y, z = computed.origin
    floor = computed.stock.z0 if passes.floor is None else max(passes.floor, computed.stock.z0)
    area = None if family.area is None else shapely.affinity.translate(family.area, -x, -y)
    requested = FamilyReach(cutter_of(tool), passes.stock_to_leave, floor - z, area)
    spacing = _spacing(family)
    short = passes.overrun is not None and passes.overrun < tool.radius
    return FamilyRequest(
        requested,
        family.planes.angle,
        spacing,
        passes.scallop,
        passes.chord_tolerance,
        short,
        _tips(computed, family),
    )


def _tips(computed: ComputedScene, family: ComputedFamily) -> TipHeights:
    """Return how low a family's cutter comes over the surfaces and what is left on them, program coordinates, and not
    less.
    """
    leave, origin = family.passes.stock_to_leave, np.array(computed.origin)
    shape = shape_of(family.tool, leave)

    def heights(places: Floats, progress: Progress) -> Floats:
        dropped = drop_shape(computed.facets.facets, shape, places + origin[:2], TIP_ERROR, progress)
        return np.asarray(dropped.height + leave + TIP_ERROR - origin[2])

    return heights


def closest_passes(computed: ComputedScene) -> float:
    """Return the spacing of the family whose passes lie closest, mm, > 0."""
    return min(_spacing(family) for family in computed.families)


def _spacing(family: ComputedFamily) -> float:
    """Return how far apart neighbouring passes are at most, mm; of one pass alone, the tool's diameter."""
    if family.passes.pitch is not None:
        return family.passes.pitch
    return float(np.diff(family.planes.offsets).max(initial=0.0)) or family.tool.diameter
