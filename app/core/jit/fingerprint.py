"""What a kernel's machine code depends on, as one digest: its code, its signature, and every constant and kernel that
it names.

A digest of the content needs no file times and no list of versions: a kernel that has not changed is found again after
an update, and one whose inner kernel or constant changed, in whatever file, is not.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any, Protocol, runtime_checkable

import numpy as np


@runtime_checkable
class Fingerprinted(Protocol):
    """Something that brings its own digest, as kernels do."""

    @property
    def digest(self) -> str:
        """Hexadecimal."""


def digest(text: str, function: FunctionType) -> str:
    """Return 32 hexadecimal digits for a function and all that it names.

    Args:
        text: what else its machine code depends on, such as the signature.
        function: as it was written.

    Raises:
        TypeError: it names a value that this does not know how to tell from another.
    """
    summed = hashlib.sha256(text.encode())
    for part in _code_parts(function.__code__):
        summed.update(part)
    for name in sorted(named_globals(function)):
        summed.update(name.encode() + b"=")
        for part in _value_parts(function.__globals__[name], name):
            summed.update(part)
    return summed.hexdigest()[:32]


def named_globals(function: FunctionType) -> frozenset[str]:
    """Return the names that a function's code uses and that its module defines; attributes of the same name are among
    them.
    """
    return frozenset(
        name for code in _codes(function.__code__) for name in code.co_names if name in function.__globals__
    )


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)


def _code_parts(code: CodeType) -> Iterator[bytes]:
    for each in _codes(code):
        constants = [constant for constant in each.co_consts if not isinstance(constant, CodeType)]
        yield each.co_code
        yield repr((constants, each.co_names, each.co_varnames, each.co_freevars, each.co_argcount)).encode()


def _value_parts(value: Any, name: str) -> Iterator[bytes]:
    if isinstance(value, Fingerprinted):
        yield value.digest.encode()
    elif isinstance(value, np.ndarray):
        yield repr((value.dtype.str, value.shape)).encode()
        yield np.ascontiguousarray(value).tobytes()
    elif isinstance(value, tuple):
        yield f"{type(value).__qualname__}(".encode()
        for item in value:
            yield from _value_parts(item, name)
        yield b")"
    elif isinstance(value, ModuleType):
        yield value.__name__.encode()
    elif isinstance(value, FunctionType):
        yield digest(value.__qualname__, value).encode()
    elif isinstance(value, type | BuiltinFunctionType | np.ufunc):
        yield f"{getattr(value, '__module__', '')}.{value.__name__}".encode()
    elif value is None or isinstance(value, bool | int | float | complex | str | bytes | np.generic):
        yield f"{type(value).__name__} {value!r}".encode()
    else:
        raise TypeError(
            f"{name} is a {type(value).__name__}: a kernel may name numbers, tuples, arrays, modules and other kernels"
        )
