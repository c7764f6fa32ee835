"""All stages of a drawing or a picture as files: a picture, the codes and the chain codes of every step."""

from __future__ import annotations

import io
import struct
import zlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..core.progress import NO_PROGRESS, Progress
from ..model.finding import Finding, worst_first
from ..raster.frame import STAGES_BYTES, BitmapFrame, PixelCode, Plane
from ..raster.steps import STEPS, StepState
from ..raster.trace import PixelChain
from ..usecases.job.options import MakeOptions
from ..usecases.making.bitmap_job import BitmapJob, bitmap_job
from ..usecases.making.report import as_values
from ..usecases.pixels.options import is_picture
from ..usecases.pixels.way import BitmapProgram, compute_on_bitmap
from .stage_picture import PALETTE, WRONG_COLOUR, keyed_png
from .stages import Variant, stages

Json = dict[str, Any]

TURNS = "turns"
"""Folder of the planes of steps that are done more than once."""

MOST_TURNS_PX = 1 << 31
"""Pixels of all planes in that folder together; more would take minutes and fill disks."""


@dataclass(frozen=True)
class StepTurn:
    """One time that a step was done.

    Attributes:
        number, region, turn: as of the `StepState`.
        text: its chain codes, a line each. picture: its codes, as `indexed_png`; b"" = not kept.
    """

    number: int
    region: int
    turn: int
    text: str
    picture: bytes


@dataclass(frozen=True)
class StagesRun:
    """What was computed for the files.

    Attributes:
        ready: the job and its pixels.
        made: its paths.
        last: of each step, in the text's order, the stage after its last time.
        turns: every time that any step was done.
    """

    ready: BitmapJob
    made: BitmapProgram
    variant: Variant
    last: tuple[StepState, ...]
    turns: tuple[StepTurn, ...]

    @property
    def findings(self) -> tuple[Finding, ...]:
        """Of the drawing or picture, and of the paths; those that count first."""
        return worst_first((*self.made.program.findings, *self.ready.findings))

    @property
    def frame(self) -> BitmapFrame:
        """The pixels' size and place."""
        return self.ready.part.frame

    @property
    def dashes(self) -> tuple[PixelChain, ...]:
        """The contour tool's paths, which the text draws dashed."""
        return next((stage.chains for stage in self.last if stage.number == 120), ())

    @property
    def wrong_pixels(self) -> int:
        """In how many pixels the fill errs."""
        return max((int(np.count_nonzero(stage.wrong)) for stage in self.last if stage.wrong is not None), default=0)

    @property
    def times(self) -> Counter[int]:
        """How often each step was done, by its number."""
        return Counter(turn.number for turn in self.turns)

    @property
    def all_turns(self) -> bool:
        """Whether the plane of every time is kept: they are not so large that it would take minutes."""
        return all(turn.picture for turn in self.turns)

    def text(self, number: int) -> str:
        """Return the chain codes of all times that a step was done, a line each."""
        return "".join(turn.text for turn in self.turns if turn.number == number)

    def report(self) -> Json:
        """Return everything that was found, as plain values."""
        frame, given_up = self.frame, self.made.given_up
        return {
            "bitmap": {"rows": frame.rows, "cols": frame.cols, "pitch_mm": frame.pitch, "x0": frame.x0, "y0": frame.y0},
            "variant": self.variant.value,
            "wrong_pixels": self.wrong_pixels,
            "given_up_mm": {"max": given_up.most_mm, "mean": given_up.mean_mm},
            "unsmoothed_paths": self.made.unsmoothed,
            "strokes": self.made.program.strokes,
            "codes": {code.name.lower(): int(code) for code in PixelCode},
            "colours": {code.name.lower(): PALETTE[code] for code in PixelCode} | {"wrong": WRONG_COLOUR},
            "steps": [_step(self, stage, file) for stage, file in zip(self.last, names(self.last), strict=True)],
            "findings": [as_values(each) for each in self.findings],
        }


def _step(run: StagesRun, stage: StepState, file: str) -> Json:
    values, counts = np.unique(stage.plane, return_counts=True)
    pixels = {PixelCode(int(v)).name.lower(): int(n) for v, n in zip(values, counts, strict=True)}
    return {
        "number": stage.number,
        "name": stage.name,
        "sentence": stage.sentence,
        "file": file,
        "times": run.times[stage.number],
        "chains": run.text(stage.number).count("\n"),
        "pixels": pixels,
    }


def run_stages(
    name: str,
    data: bytes,
    requested: tuple[MakeOptions, Variant],
    progress: Progress = NO_PROGRESS,
) -> StagesRun:
    """Compute a drawing or a picture on pixels, and look at every step.

    Args:
        name: of the file; its suffix tells the format.
        data: its bytes.
        requested: tools, operations and bitmap; the rules of the fill.

    Raises:
        HitofudeError: it cannot be used, or nothing in it can be cut.
        Cancelled: the job was asked to stop.
    """
    options, variant = requested
    progress.step(0.0, f"Reading {name}")
    ready = bitmap_job(name, data, options)
    ready.part.frame.ask_memory(STAGES_BYTES, is_picture(name))
    made = compute_on_bitmap(ready.job, ready.part, progress.part(0.1, 0.8))
    last: dict[int, StepState] = {}
    turns: list[StepTurn] = []
    for stage in stages(ready.job, ready.part, made.paths, variant):
        progress.step(0.9, stage.name)
        last[stage.number] = stage
        kept = (len(turns) + 1) * stage.plane.size <= MOST_TURNS_PX
        turns.append(
            StepTurn(stage.number, stage.region, stage.turn, stage.text, indexed_png(stage.plane) if kept else b"")
        )
    return StagesRun(ready, made, variant, tuple(last[number] for number in STEPS if number in last), tuple(turns))


def names(last: tuple[StepState, ...]) -> list[str]:
    """Return the files' names without suffix, so that they sort in the text's order."""
    return [f"{k:02d}_{stage.number}" for k, stage in enumerate(last, 1)]


def stage_files(run: StagesRun, progress: Progress = NO_PROGRESS) -> dict[str, bytes]:
    """Return the files by name: .png, .npy, .txt where a step has chain codes, and TURNS/….png of steps done more than
    once.
    """
    files: dict[str, bytes] = {}
    for k, (stage, name) in enumerate(zip(run.last, names(run.last), strict=True)):
        progress.step(k / len(run.last), "Writing pictures")
        codes = io.BytesIO()
        np.save(codes, stage.plane)
        files[f"{name}.png"], files[f"{name}.npy"] = keyed_png(stage, run.frame.pitch, run.dashes), codes.getvalue()
        text = run.text(stage.number)
        if text:
            files[f"{name}.txt"] = text.encode("ascii")
        files.update(_turn_files(run, stage.number, name))
    return files


def _turn_files(run: StagesRun, number: int, name: str) -> Iterator[tuple[str, bytes]]:
    """Yield name and bytes of each time that a step was done, if it was more than one."""
    if run.times[number] > 1 and run.all_turns:
        for turn in run.turns:
            if turn.number == number:
                yield f"{TURNS}/{name}_r{turn.region}_t{turn.turn:03d}.png", turn.picture


def indexed_png(plane: Plane) -> bytes:
    """Return a plane (rows, cols) as a PNG picture whose palette indices are the codes, a point each."""
    lines = np.pad(plane, ((0, 0), (1, 0)))
    palette = bytes.fromhex("".join(PALETTE[code][1:] for code in PixelCode))
    head = struct.pack(">IIBBBBB", plane.shape[1], plane.shape[0], 8, 3, 0, 0, 0)
    chunks = ((b"IHDR", head), (b"PLTE", palette), (b"IDAT", zlib.compress(lines.tobytes(), 1)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(_chunk(*chunk) for chunk in chunks)


def _chunk(name: bytes, data: bytes) -> bytes:
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
