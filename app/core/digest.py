"""A name for what a value says: the same in every process, another one wherever the value differs."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable, Mapping
from dataclasses import fields, is_dataclass
from enum import Enum

import numpy as np

from .toml_tables import Keyword


def sha256(data: bytes) -> str:
    """Return the SHA-256 of bytes, as 64 hexadecimal digits."""
    return hashlib.sha256(data).hexdigest()


def content_digest(*values: object) -> str:
    """Return the SHA-256 of values, as 64 hexadecimal digits.

    Args:
        values: plain ones, arrays, and collections and dataclasses of such; what is beside these is told by its
            attributes, if its class is this program's own.

    Raises:
        TypeError: one has no content that could be told, such as a file that is open.
    """
    hashed = hashlib.sha256()
    for value in values:
        _feed(value, hashed.update)
    return hashed.hexdigest()


def _feed(value: object, update: Callable[[bytes], None]) -> None:
    """Hash a value with its kind and its length before it, so that no two values run into the same bytes."""
    if isinstance(value, bytes | bytearray):
        update(b"B%d:" % len(value) + value)
    elif isinstance(value, Enum):
        _feed(("enum", type(value).__name__, value.name), update)
    elif isinstance(value, Keyword):
        _feed(("word", type(value).__name__, value.value), update)
    elif value is None or isinstance(value, bool | int | float | complex | str | os.PathLike):
        _feed(f"{type(value).__name__} {value!r}".encode("utf-8", "surrogatepass"), update)
    elif isinstance(value, np.ndarray | np.generic):
        _feed((str(value.dtype), value.shape, value.tobytes()), update)
    elif isinstance(value, Mapping):
        _feed(("mapping", *sorted((content_digest(key), content_digest(each)) for key, each in value.items())), update)
    elif isinstance(value, frozenset | set):
        _feed(("set", *sorted(map(content_digest, value))), update)
    elif isinstance(value, tuple | list):
        update(b"T%d:" % len(value))
        for each in value:
            _feed(each, update)
    else:
        _feed((type(value).__qualname__, _attributes(value)), update)


def _attributes(value: object) -> tuple[tuple[str, object], ...]:
    if is_dataclass(value) and not isinstance(value, type):
        return tuple((each.name, getattr(value, each.name)) for each in fields(value) if each.compare)
    if type(value).__module__.partition(".")[0] == __name__.partition(".")[0] and hasattr(value, "__dict__"):
        return tuple(sorted(vars(value).items()))
    raise TypeError(f"{type(value).__name__} has no content to be told by")
