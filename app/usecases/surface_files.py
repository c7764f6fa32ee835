"""A scene from its text to the files that are made of it: NC program, plot, table of points, report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path

from ..core.errors import InputError
from ..core.options import option
from ..core.progress import NO_PROGRESS, Progress
from ..formats.scene.toml import read_scene, sources_of
from ..model.finding import Finding
from .better.improve import better as improve
from .better.report import findings as better_findings
from .better.report import lines as better_lines
from .better.report import report as better_report
from .better.result import BetterOptions, BetterProgram
from .scene.compute import ComputedScene, compute
from .scene.plot import PlotScene, plot_surface
from .scene.points import scene_points_csv
from .scene_program.loop import closed_loop
from .scene_program.nc import WrittenScene, write_scene_nc
from .scene_program.report import SurfaceReport, surface_report
from .scene_program.smooth import CurvesOverSurfaces, SmoothedScene, smooth_scene, standing_off


@dataclass(frozen=True)
class SceneOutputs:
    """What is to be made of a scene.

    Attributes:
        output, plot, points, report: files to make; None = that one is not.
        plotted: what of the scene the plot shows, and how.
        curves: how the program becomes curves that cannot gouge; None = it stays as it is.
        facets: how the program, whose surfaces are polyhedra, goes by their facets; None = it does not.
        loop: mm within which the program is made smooth and cut once more, which the report tells; None = it is not.
    """

    output: Path | None = None
    plot: Path | None = None
    points: Path | None = None
    report: Path | None = None
    plotted: PlotScene = field(default_factory=PlotScene)
    loop: float | None = None
    curves: CurvesOverSurfaces | None = None
    facets: BetterOptions | None = None


@dataclass(frozen=True, eq=False)
class MadeScene:
    """What was made of a scene.

    Attributes:
        report: all that was computed and proven.
        files: bytes by path; a plot may be several sheets, a program one file a tool.
        curves, better: what the program became, where that was asked for.
    """

    report: SurfaceReport
    files: dict[Path, bytes]
    curves: SmoothedScene | None = None
    better: BetterProgram | None = None

    @property
    def findings(self) -> tuple[Finding, ...]:
        """What is wrong with the scene, its program, and what that became."""
        more = () if self.curves is None else self.curves.findings()
        return (*self.report.findings, *more, *(() if self.better is None else better_findings(self.better)))

    @property
    def lines(self) -> tuple[str, ...]:
        """What was made, for people."""
        more = () if self.curves is None else self.curves.lines()
        return (*self.report.summary(), *more, *(() if self.better is None else better_lines(self.better)))

    @property
    def counts(self) -> bool:
        """Whether something was found that counts."""
        return any(finding.counts for finding in self.findings)


def scene_files(
    name: str, data: bytes, read: Callable[[str], bytes], outputs: SceneOutputs, progress: Progress = NO_PROGRESS
) -> MadeScene:
    """Compute a scene and make files of it.

    Args:
        name, data: of the scene's file.
        read: returns the bytes of a file that the scene names.

    Raises:
        HitofudeError: the scene cannot be read, computed, written or cut.
        Cancelled: the job was asked to stop.
    """
    scene, sources = read_scene(name, data), sources_of(read)
    asked = scene if outputs.curves is None else standing_off(scene, outputs.curves)
    computed = compute(asked, sources, progress.part(0.0, 0.5))
    as_nc = any(each is not None for each in (outputs.output, outputs.loop, outputs.curves, outputs.facets))
    written = write_scene_nc(computed, progress.part(0.5, 0.7)) if as_nc else None
    report, curves, better = surface_report(computed, written), None, None
    if written is not None and outputs.curves is not None:
        curves = smooth_scene(scene, written, outputs.curves, progress.part(0.7, 1.0))
        report.data["curves"] = curves.report()
    if written is not None and outputs.facets is not None:
        better = by_facets(written, outputs.facets, progress.part(0.7, 1.0))
        report.data["facets"] = better_report(better)
    if written is not None and outputs.loop is not None:
        report.data["loop"] = closed_loop(written, sources, outputs.loop, progress.part(0.7, 1.0))
    files: dict[Path, bytes] = {}
    if outputs.points is not None:
        files[outputs.points] = scene_points_csv(computed)
    if outputs.plot is not None:
        files |= plot_files(computed, outputs.plot, outputs.plotted)
    if written is not None and outputs.output is not None:
        files |= program_files(written, outputs.output, _new_texts(curves, better))
    if outputs.report is not None:
        files[outputs.report] = report.text().encode()
    return MadeScene(report, files, curves, better)


def plot_files(computed: ComputedScene, path: Path, plotted: PlotScene) -> dict[Path, bytes]:
    """Return a plot by the names of its sheets; the suffix tells the format."""
    sheets = plot_surface(computed, path.suffix, plotted)
    if len(sheets) == 1:
        return {path: sheets[0]}
    return {path.with_name(f"{path.stem}_{number}{path.suffix}"): sheet for number, sheet in enumerate(sheets, 1)}


def program_files(written: WrittenScene, path: Path, texts: tuple[bytes, ...] | None = None) -> dict[Path, bytes]:
    """Return the NC program, or the texts that it became, by the names of its files: one, or one a tool."""
    told = texts if texts is not None else tuple(file.nc.text.encode() for file in written.files)
    return {file.named(path): text for file, text in zip(written.files, told, strict=True)}


def _new_texts(curves: SmoothedScene | None, better: BetterProgram | None) -> tuple[bytes, ...] | None:
    """Return the texts in place of the program's own; None: there are none."""
    if better is not None:
        return (better.data,)
    return None if curves is None else tuple(done.data for done in curves.done)


def by_facets(written: WrittenScene, how: BetterOptions, progress: Progress = NO_PROGRESS) -> BetterProgram:
    """Return the program of a scene of polyhedra by their facets, as they are told across neighbouring passes (method
    D): over a smooth surface through the places where facets meet, its cut within the tolerance of the facets' own.

    Raises:
        InputError: several tools, passes that do not lie beside one another, or facets that tell of no smooth surface.
        HitofudeError: it cannot be computed. Cancelled: the job was asked to stop.
    """
    [file, *more] = written.files
    if more:
        raise InputError(f"{option('facets')} takes a program of one tool; switch the passes of the others off.")
    own = replace(how, post=written.computed.scene.post, dialect=written.post.dialect)
    return improve(f"{written.computed.scene.name}{file.suffix}", file.nc.text.encode(), own, progress=progress)
