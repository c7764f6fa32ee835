"""What is done with one part of a batch: the use case of its command, and every failure as a verdict."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING

import numpy as np

from ...core.errors import Cancelled, HitofudeError
from ...core.memory import MemoryShortError, within
from ...core.options import option
from ...core.progress import NO_PROGRESS, Progress
from ...model.finding import Finding
from ..job.options import MakeOptions
from ..make_files import other_files
from ..making.make import MakeResult, make
from .task import BatchResult, BatchRow, BatchTask, BatchVerdict
from .thumbnail import motions_picture, part_picture

if TYPE_CHECKING:
    from ..examine import ExaminedProgram, ExamineOptions
    from ..smoothing.result import SmoothOptions


def work(task: BatchTask, progress: Progress = NO_PROGRESS) -> BatchResult:
    """Return what became of a part; whatever goes wrong with it is its verdict.

    Raises:
        Cancelled: by progress.
    """
    try:
        with within(task.memory):
            return _done(task, progress)
    except Cancelled:
        raise
    except MemoryShortError as error:
        return _without_files(task, BatchVerdict.FAILED, str(error))
    except HitofudeError as error:
        return _without_files(task, BatchVerdict.REFUSED, str(error))
    except MemoryError:
        sentence = f"The memory that a part may take ran out; use fewer {option('jobs')}."
        return _without_files(task, BatchVerdict.FAILED, sentence)
    except Exception as error:
        sentence = f"This should not have happened ({type(error).__name__}: {error}); please report it with the file."
        return _without_files(task, BatchVerdict.FAILED, sentence)


def _without_files(task: BatchTask, verdict: BatchVerdict, sentence: str) -> BatchResult:
    return BatchResult(BatchRow(task.name, verdict, findings=(sentence,), counting=1), {})


def _done(task: BatchTask, progress: Progress) -> BatchResult:
    if isinstance(task.options, MakeOptions):
        return _made(task, task.options, progress)
    from ..smoothing.result import SmoothOptions  # each process imports what its parts take, and no more

    if isinstance(task.options, SmoothOptions):
        return _smoothed(task, task.options, progress)
    return _checked(task, task.options, progress)


def _beside(task: BatchTask) -> dict[str, PurePosixPath]:
    """Return the files that are wanted beside the program, by what they hold."""
    base, extras = PurePosixPath(task.output), task.extras
    wanted = {"report": ".json"} if extras.report else {}
    wanted |= {"image": extras.image} if extras.image else {}
    wanted |= {"sheet": extras.sheet} if extras.sheet else {}
    return {what: base.with_suffix(suffix) for what, suffix in wanted.items()}


def _made(task: BatchTask, options: MakeOptions, progress: Progress) -> BatchResult:
    made = make(_file_name(task), task.data, options, progress)
    named = {what: Path(path) for what, path in _beside(task).items()} | {"output": Path(task.output)}
    others = other_files(made, named, task.data, task.extras.language)
    files = {named[what].as_posix(): data for what, data in others.items()}
    for file in made.files:
        files[file.named(Path(task.output)).as_posix()] = file.nc.text.encode("ascii")
    return BatchResult(made_row(task.name, made), files)


def made_row(name: str, made: MakeResult) -> BatchRow:
    """Return what the table tells of a made program.

    Args:
        name: of the part.
    """
    report = made.report.data
    left = report["left"]
    return BatchRow(
        name,
        BatchVerdict.CLEAN if made.clean else BatchVerdict.FINDINGS,
        time_s=report["time_s"],
        length_mm=sum(report["length_mm"].values()),
        findings=_sentences(made.findings),
        counting=_counting(made.findings),
        picture=part_picture(made.program),
        left_mm2=None if left is None else left["reachable_mm2"] + left["unreachable_mm2"],
    )


def _sentences(findings: Sequence[Finding]) -> tuple[str, ...]:
    return tuple(each.text for each in findings)


def _counting(findings: Sequence[Finding]) -> int:
    return sum(each.counts for each in findings)


def _checked(task: BatchTask, options: ExamineOptions, progress: Progress) -> BatchResult:
    from ..examine import examine

    examined = examine(_file_name(task), task.data, options, progress)
    problems = tuple(each.message(examined.name) for each in examined.problems)
    files = {path.as_posix(): examined.text().encode() for path in _beside(task).values()}
    return BatchResult(_row_of(task, examined, problems, len(problems)), files)


def _smoothed(task: BatchTask, options: SmoothOptions, progress: Progress) -> BatchResult:
    from ..examine import ExamineOptions, examine
    from ..smoothing.report import findings as smooth_findings
    from ..smoothing.report import report_text
    from ..smoothing.smooth import smooth

    done = smooth(_file_name(task), task.data, options, progress.part(0.0, 0.9))
    reading = ExamineOptions(dialect=done.dialects[1], units=options.units)
    after = examine(_file_name(task), done.data, reading, progress.part(0.9, 1.0))
    found = smooth_findings(done)
    files = {path.as_posix(): report_text(done).encode() for path in _beside(task).values()}
    return BatchResult(_row_of(task, after, _sentences(found), _counting(found)), {**files, task.output: done.data})


def _row_of(task: BatchTask, examined: ExaminedProgram, sentences: tuple[str, ...], counting: int) -> BatchRow:
    length = examined.report()["length_mm"]
    return BatchRow(
        task.name,
        BatchVerdict.FINDINGS if counting else BatchVerdict.CLEAN,
        time_s=float(np.nan_to_num(examined.time.total)),
        length_mm=length["cut"] + length["rapid"],
        findings=sentences,
        counting=counting,
        picture=motions_picture(examined.program.motions),
    )


def _file_name(task: BatchTask) -> str:
    return task.file or PurePosixPath(task.name).name
