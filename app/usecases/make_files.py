"""What is made of a drawing beside its NC program, as files: the report, a picture, the job."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from .making.make import MakeResult

_JOB_HEAD = "# A job file of Hitofude for {}: `hitofude make DRAWING -o OUT.ngc --job` this file."


def other_files(
    made: MakeResult, requested: Mapping[str, Path], drawing: bytes | None = None, language: str = "en"
) -> dict[str, bytes]:
    """Return the bytes of what was asked for beside the program, by what it is.

    Args:
        requested: names of files by what they are to hold: report, image (.svg or .png), sheet (.pdf or .html),
            write_job; others are passed over, but that of the program, output, stands on the sheet.
        drawing: its bytes, for the sheet; None where it is no file. language: of the sheet.
    """
    texts = {}
    if "report" in requested:
        texts["report"] = made.report.text().encode()
    if "write_job" in requested:
        from ..formats.job.write import job_lines

        texts["write_job"] = ("\n".join([_JOB_HEAD.format(made.job.part.name), *job_lines(made.job)]) + "\n").encode()
    if "image" in requested:
        from ..formats.plot.plot import plot
        from .making.picture import picture_of

        picture = picture_of(made.job.part.name, made.program, made.coverage)
        texts["image"] = plot(picture, requested["image"].suffix.lower())
    if "sheet" in requested:
        from ..formats.sheet.write import sheet_bytes
        from .sheet.made import made_sheet

        program = requested.get("output", requested["sheet"].with_suffix(".ngc"))
        sources = {} if drawing is None else {f"Drawing: {made.job.part.name}": drawing}
        sheet = made_sheet(made, program, sources)
        texts["sheet"] = sheet_bytes(sheet, requested["sheet"].suffix.lower(), language)
    return texts
