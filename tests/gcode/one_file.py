"""A program that is one file, written."""

from app.core.progress import NO_PROGRESS, Progress
from app.gcode.posts import Post
from app.gcode.writer.write import NcText, write_files
from app.model.job import Job
from app.model.moves import Program


def write_program(program: Program, job: Job, post: Post, progress: Progress = NO_PROGRESS) -> NcText:
    """Return the only file's text."""
    (file,) = write_files(program, job, post, progress)
    return file.nc
