"""A scene from its text to the files that are made of it: NC program, plot, table of points, report."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

from ..core.progress import NO_PROGRESS, Progress
from ..formats.scene.toml import read_scene, sources_of
from .surface import ComputedScene, compute
from .surface_loop import closed_loop
from .surface_nc import WrittenScene, write_scene_nc
from .surface_plot import PlotScene, plot_surface
from .surface_points import scene_points_csv
from .surface_report import SurfaceReport, surface_report


@dataclass(frozen=True)
class SceneOutputs:
    """What is to be made of a scene.

    Attributes:
        output, plot, points, report: files to make; None = that one is not.
        plotted: what of the scene the plot shows, and how.
        loop: mm within which the program is made smooth and cut once more, which the report tells; None = it is not.
    """

    output: Path | None = None
    plot: Path | None = None
    points: Path | None = None
    report: Path | None = None
    plotted: PlotScene = field(default_factory=PlotScene)
    loop: float | None = None


@dataclass(frozen=True, eq=False)
class MadeScene:
    """What was made of a scene.

    Attributes:
        report: all that was computed and proven.
        files: bytes by path; a plot may be several sheets, a program one file a tool.
    """

    report: SurfaceReport
    files: dict[Path, bytes]

    @property
    def counts(self) -> bool:
        """Whether something was found that counts."""
        return any(finding.counts for finding in self.report.findings)


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
    computed = compute(scene, sources, progress.part(0.0, 0.5))
    as_nc = outputs.output is not None or outputs.loop is not None
    written = write_scene_nc(computed, progress.part(0.5, 0.7)) if as_nc else None
    report = surface_report(computed, written)
    if written is not None and outputs.loop is not None:
        report.data["loop"] = closed_loop(written, sources, outputs.loop, progress.part(0.7, 1.0))
    files: dict[Path, bytes] = {}
    if outputs.points is not None:
        files[outputs.points] = scene_points_csv(computed)
    if outputs.plot is not None:
        files |= plot_files(computed, outputs.plot, outputs.plotted)
    if written is not None and outputs.output is not None:
        files |= program_files(written, outputs.output)
    if outputs.report is not None:
        files[outputs.report] = report.text().encode()
    return MadeScene(report, files)


def plot_files(computed: ComputedScene, path: Path, plotted: PlotScene) -> dict[Path, bytes]:
    """Return a plot by the names of its sheets; the suffix tells the format."""
    sheets = plot_surface(computed, path.suffix, plotted)
    if len(sheets) == 1:
        return {path: sheets[0]}
    return {path.with_name(f"{path.stem}_{number}{path.suffix}"): sheet for number, sheet in enumerate(sheets, 1)}


def program_files(written: WrittenScene, path: Path) -> dict[Path, bytes]:
    """Return the NC program by the names of its files: one, or one a tool."""
    return {file.named(path): file.nc.text.encode() for file in written.files}
