"""The decorator: a kernel knows its signature and its code, and is loaded or compiled when it is first called."""

from __future__ import annotations

import hashlib
import threading
from collections.abc import Callable, Iterator
from functools import cached_property, update_wrapper
from types import BuiltinFunctionType, CodeType, FunctionType, ModuleType
from typing import Any, ClassVar, Protocol, runtime_checkable

import numpy as np

from ..errors import HitofudeError
from . import numba_loader
from .store import Store, store

Compiled = Callable[..., Any]
"""A kernel as its callers see it: its types are those of its signature, which mypy does not read."""

REGISTERED: list[Kernel] = []
"""All kernels of the modules that were imported so far, in the order of import: what a command may want."""

_COMPILING = threading.RLock()


class Kernel:
    """A function compiled for one signature.

    Importing its module costs nothing; the first call finds the machine code in the store, or has it compiled. A name
    that begins with an underscore is called by kernels alone.

    Attributes:
        signature: in numba's words.
        counts: whether it counts who holds an array.
        compile_missing: has a kernel compiled that is not in the store; set by the package, for what compiles knows
            kernels.
    """

    compile_missing: ClassVar[Callable[[Kernel], None]]

    def __init__(self, function: FunctionType, signature: str, counts: bool) -> None:
        update_wrapper(self, function)
        self.function, self.signature, self.counts = function, signature, counts
        self._for_callers: Any = None
        self._call: Compiled = self._first_call

    def __call__(self, *arguments: Any) -> Any:
        """Run it."""
        return self._call(*arguments)

    def load(self) -> None:
        """Have it ready before its first call, which may be on a thread that must not wait.

        Raises:
            HitofudeError: it cannot be compiled.
        """
        self._call = self._ready()

    def __repr__(self) -> str:
        return f"<kernel {self.name}>"

    @property
    def name(self) -> str:
        """The module's name, a colon, its own."""
        return f"{self.function.__module__}:{self.function.__name__}"

    @property
    def inner(self) -> bool:
        """Whether only kernels call it."""
        return self.function.__name__.startswith("_")

    @cached_property
    def digest(self) -> str:
        """Of all that its machine code depends on but compiler and processor."""
        return digest(f"{self.name} {self.signature} {self.counts} {self.inner}", self.function)

    @cached_property
    def entry(self) -> str:
        """The name of its entry in the store."""
        return f"{self.name.partition('.')[2].replace(':', '.')}-{self.digest[:20]}"

    @cached_property
    def callees(self) -> tuple[Kernel, ...]:
        """The kernels that it names."""
        named = (self.function.__globals__[name] for name in sorted(named_globals(self.function)))
        return tuple(value for value in named if isinstance(value, Kernel) and value is not self)

    @property
    def _numba_type_(self) -> Any:
        """How numba sees it in the code of another kernel: ready to be called."""
        return self.for_callers()._numba_type_

    def for_callers(self) -> Any:
        """Return numba's object for it, loaded or compiled here, that kernels can be linked with.

        Raises:
            HitofudeError: it cannot be compiled.
        """
        with _COMPILING:
            if self._for_callers is None:
                self._for_callers = self._loaded(numba_loader.load_for_callers) or self._compiled()
            return self._for_callers

    def _ready(self) -> Any:
        """Return numba's object for it, loaded or compiled here, that Python can call."""
        with _COMPILING:
            return self._for_callers or self._loaded(numba_loader.load) or self.for_callers()

    def _loaded(self, load: Callable[[Any, bytes], None]) -> Any:
        """Return it as it is in the store; None where it is not there, or not whole."""
        code = _store().read(self.entry)
        if code is None:
            return None
        made = self._dispatcher()
        try:
            load(made, code)
        except Exception:  # whole by its check sum, but of no use: whatever numba says, it is compiled anew
            _store().drop(self.entry)
            return None
        return made

    def _compiled(self) -> Any:
        """Compile it on this thread and keep it in the store."""
        with _COMPILING:
            made = self._dispatcher()
            try:
                code = numba_loader.compile_to(made, self.signature)
            except Exception as error:
                cause = " ".join(str(error).split())[:200]
                raise HitofudeError(
                    f"{self.name} cannot be compiled, so what needs it will not work: {type(error).__name__}: {cause}"
                ) from error
            if _store().folder is not None:
                _store().write(self.entry, code())
            return made

    def _dispatcher(self) -> Any:
        return numba_loader.dispatcher(self.function, self.counts, called_from_python=not self.inner)

    def _first_call(self, *arguments: Any) -> Any:
        if self.inner:
            raise TypeError(
                f"{self.name} is called by kernels alone; name it without underscore to call it from Python"
            )
        if not _store().has(self.entry) and self._for_callers is None:
            Kernel.compile_missing(self)
        self._call = self._ready()
        return self._call(*arguments)


def _store() -> Store:
    return store(numba_loader.versions())


def kernel(signature: str, counts: bool = True) -> Callable[[Compiled], Compiled]:
    """Have a function compiled for the given numba signature; it releases the GIL.

    Args:
        signature: such as "float64(float64[:, ::1], int64)".
        counts: whether it counts who holds an array, as it must if it makes one. Where an array goes through a short
            loop and a call or two, counting takes longer than these; its caller holds it anyhow.
    """

    def registered(function: Compiled) -> Compiled:
        assert isinstance(function, FunctionType)
        made = Kernel(function, signature, counts)
        REGISTERED.append(made)
        return made

    return registered


# What a kernel's machine code depends on, as one digest: its code, its signature, and every constant and kernel that
# it names.
#
# A digest of the content needs no file times and no list of versions: a kernel that has not changed is found again
# after an update, and one whose inner kernel or constant changed, in whatever file, is not.


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
