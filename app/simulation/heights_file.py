"""Fields of heights as files: NPY with the heights, JSON with where they lie."""

from __future__ import annotations

import io
import json
import math

import numpy as np
from numpy.lib import format as npy

from ..core.errors import InputError, ParameterError
from ..core.options import option
from .engines import Engine
from .field.workpiece import Grid, HeightStock, Workpiece

_QUOTED = 60
"""So many letters of what is wrong are shown."""
_FARTHEST = 1e6
"""mm; nothing of a work piece is farther away."""


def heights_files(workpiece: Workpiece, engine: Engine = Engine.CPU) -> tuple[bytes, bytes]:
    """Return the NPY file, float32 (rows, cols) with row 0 at the lowest Y, and its JSON file, lengths in mm."""
    out, grid = io.BytesIO(), workpiece.grid
    np.save(out, workpiece.heights)
    where = {"x0": grid.x0, "y0": grid.y0, "pitch": grid.pitch, "floor": workpiece.floor, "engine": engine.value}
    return out.getvalue(), (json.dumps(where, indent=1) + "\n").encode()


def _ensure_whole(name: str, data: bytes) -> None:
    """Refuse a file whose header is damaged, or promises another number of heights than are there: numpy takes memory
    for them all.

    Raises:
        InputError: it is so.
    """
    what = f"{name}: this is no field of heights"
    stream = io.BytesIO(data)
    try:
        version = npy.read_magic(stream)
        shape, _, kind = (npy.read_array_header_1_0 if version == (1, 0) else npy.read_array_header_2_0)(stream)
        promised = math.prod(shape) * kind.itemsize
    except Exception as error:  # Python itself reads the header: its tokenizer and parser raise whatever they meet
        said = (str(error).splitlines() or [type(error).__name__])[0][:_QUOTED]
        raise InputError(
            f"{what}, for its header is damaged ({said}); write it again with {option('heights')}."
        ) from None
    rest = len(data) - stream.tell()
    if min(shape, default=1) < 0 or promised != rest:
        size = " x ".join(str(count)[:_QUOTED] for count in shape[:4])
        raise InputError(
            f"{what}, for its header promises {size} numbers of {kind.itemsize} bytes and {rest} bytes follow; "
            f"write it again with {option('heights')}."
        )


def read_heights(name: str, heights: bytes, where: bytes) -> HeightStock:
    """Return what an earlier set-up has left.

    Args:
        name: of the NPY file, for errors.
        heights: the NPY file. where: the JSON file beside it; without a floor the lowest height is the floor.

    Raises:
        InputError: one of them is not what it should be.
    """
    _ensure_whole(name, heights)
    try:
        field = np.load(io.BytesIO(heights), allow_pickle=False)
        told = json.loads(where)
        place = [float(told[key]) for key in ("x0", "y0", "pitch")]
        if (
            field.ndim != 2
            or not np.issubdtype(field.dtype, np.floating)
            or not field.size
            or not (np.abs(field) <= _FARTHEST).all()
        ):
            raise ValueError(f"the heights are no table of numbers up to {_FARTHEST:g} mm")
        floor = float(told.get("floor", field.min()))
        if not all(abs(length) <= _FARTHEST for length in (*place, floor)):
            raise ValueError(f"a length in it is no number up to {_FARTHEST:g} mm")
        grid = Grid(place[0], place[1], place[2], *field.shape)
    except (
        ValueError,
        KeyError,
        TypeError,
        AttributeError,
        EOFError,
        OSError,
        OverflowError,
        RecursionError,
        ParameterError,
    ) as error:
        raise InputError(
            f"{name}: this is no field of heights with x0, y0 and pitch in its JSON file ({str(error)[:_QUOTED]}); "
            f"write it again with {option('heights')}."
        ) from error
    return HeightStock(Workpiece(grid, np.ascontiguousarray(field, np.float32), floor))
