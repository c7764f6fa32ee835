"""The only place that imports numba, and only when a kernel is wanted: it takes longer than many a command."""

from __future__ import annotations

import hashlib
import io
import pickle
import sys
import threading
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import cache
from importlib import import_module
from importlib.machinery import ModuleSpec
from types import FunctionType, ModuleType
from typing import Any

import numpy as np


class _ImportBlocker:
    """Hides libraries from the imports of one thread."""

    def __init__(self, *libraries: str) -> None:
        self._libraries, self._thread = libraries, threading.get_ident()

    def find_spec(
        self, name: str, path: Sequence[str] | None = None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Refuse these libraries, and leave all others to whoever comes next."""
        if name.split(".")[0] in self._libraries and threading.get_ident() == self._thread:
            raise ImportError(f"{name} is not needed here")
        return None


@contextmanager
def _light() -> Iterator[None]:
    """Let numba do without scipy, which it would import for linear algebra that no kernel uses, without yaml, in
    which it would read settings from the folder that a command is given in, and without colours for its own errors:
    0.16, 0.02 and 0.003 s of every start.
    """
    hidden = _ImportBlocker("scipy", "yaml", "colorama")
    sys.meta_path.insert(0, hidden)
    try:
        yield
    finally:
        sys.meta_path.remove(hidden)


@cache
def _numba() -> Any:
    plugins = _no_plugins()
    with _light():
        import numba
    numba.core.entrypoints = plugins
    _know_plain_arrays(numba)
    put_masked_arrays_off()
    return numba


def _know_plain_arrays(numba: Any) -> None:
    """Let numba tell the type of an array without looking whether it is one of numpy's masked ones, which would import
    these: 0.03 s of the first call.
    """
    typeof = numba.core.typing.typeof
    of_any = typeof.typeof_impl.dispatch(np.ndarray)

    def of_array(value: Any, context: Any) -> Any:
        if type(value) is not np.ndarray or value.dtype.hasobject or value.dtype.fields is not None:
            return of_any(value, context)
        layout, dtype = typeof.numpy_support.map_layout(value), typeof.numpy_support.from_dtype(value.dtype)
        return numba.types.Array(dtype, value.ndim, layout, readonly=not value.flags.writeable)

    typeof.typeof_impl.register(np.ndarray, of_array)


def _no_plugins() -> ModuleType:
    """Stand in for numba's look for extensions among all installed packages, of which no kernel needs one: it reads
    mail headers first.
    """
    plugins = ModuleType("numba.core.entrypoints")
    vars(plugins)["init_all"] = lambda: None
    return sys.modules.setdefault(plugins.__name__, plugins)


@cache
def _compiler() -> None:
    """Load what compiling needs, which the machine code of kernels does not."""
    with _light():
        from numba.core.registry import cpu_target

        cpu_target.target_context.refresh()
        cpu_target.typing_context.refresh()


@cache
def versions() -> tuple[str, ...]:
    """Return names for compiler and processor: first of this one, for which machine code is compiled, then of plainer
    ones, whose machine code runs here as well; that of any other is of no use.
    """
    import llvmlite.binding as llvm

    own = _numba().core.registry.cpu_target.target_context.codegen().magic_tuple()
    levels = plainer_processors(own[0], llvm.get_host_cpu_features())
    return tuple(dict.fromkeys(map(_version, (own, *((own[0], level, "") for level in levels)))))


def _version(processor: tuple[str, str, str]) -> str:
    """Return the name for this compiler and a processor: triple, name and features, as LLVM has them."""
    numba = _numba()
    import llvmlite

    text = repr((sys.version_info[:3], numba.__version__, llvmlite.__version__, processor, numba.config.OPT))
    return hashlib.sha256(text.encode()).hexdigest()[:12]


def dispatcher(function: FunctionType, counts: bool, called_from_python: bool) -> Any:
    """Return numba's object for a function, nothing compiled yet.

    Args:
        function: as it was written.
        counts: whether it counts who holds an array.
        called_from_python: False: only kernels call it, so that it needs no door for Python.
    """
    return _numba().njit(
        nogil=True, error_model="numpy", _nrt=counts, no_cfunc_wrapper=True, no_cpython_wrapper=not called_from_python
    )(function)


def compile_to(made: Any, signature: str) -> Callable[[], bytes]:
    """Compile for a signature and no other, and return what gives the machine code as bytes.

    Raises:
        numba.core.errors.NumbaError: it cannot be compiled.
    """
    _compiler()
    made.compile(signature)
    made.disable_compile()
    (compiled,) = made.overloads.values()
    serialize = _numba().core.serialize
    return lambda: bytes(serialize.dumps(compiled._reduce()))


def load_for_callers(made: Any, code: bytes) -> None:
    """Give a dispatcher what `compile_to` once gave, so that kernels that are compiled now can call it.

    Raises:
        Exception: whatever code that does not fit runs into.
    """
    from numba.core.compiler import CompileResult

    _compiler()
    compiled = CompileResult._rebuild(made.targetctx, *pickle.loads(code))
    made.targetctx.insert_user_function(compiled.entry_point, compiled.fndesc, [compiled.library])
    made.add_overload(compiled)
    made.disable_compile()


class _MachineCode:
    """Machine code alone, without the code of LLVM that other kernels are linked with: a third of the time to load."""

    def __init__(self, codegen: Any, code: bytes) -> None:
        import llvmlite.binding as llvm

        self.codegen = codegen
        codegen._engine._ee.add_object_file(llvm.ObjectFileRef.from_data(code))
        codegen._engine.finalize_object()

    def get_pointer_to_function(self, name: str) -> int:
        """Return the address of a function in it."""
        return int(self.codegen._engine.get_function_address(name))


class _Unpickler(pickle.Unpickler):
    """Makes the environments of compiled functions without importing what these were written in: 0.15 s for one sorted
    array.
    """

    def find_class(self, module: str, name: str) -> Any:
        """Return what a name of a module stands for."""
        if (module, name) == ("numba.core.environment", "_rebuild_env"):
            return _environment
        return super().find_class(module, name)


def _environment(module: str, constants: list[Any], name: str) -> Any:
    """Return the environment of a function, whose globals are for code that goes back to Python; kernels never do."""
    from numba.core.environment import Environment, lookup_environment

    known = lookup_environment(name)
    if known is not None:
        return known
    made = Environment({"__name__": module})
    made.consts[:] = constants
    made.env_name = name
    Environment._memo[name] = made
    return made


def load(made: Any, code: bytes) -> None:
    """Give a dispatcher what `compile_to` once gave, so that Python can call it.

    Raises:
        Exception: whatever code that does not fit runs into.
    """
    from numba.core.compiler import CompileResult

    with _light():  # which what is unpickled may import too
        library, function, environment, signature, *_, reloaded, environments = _Unpickler(io.BytesIO(code)).load()
    for each in reloaded:
        each()
    context = made.targetctx
    # what counts who holds an array; without effect but for the first time
    _numba().core.runtime.nrt.rtsys.initialize(context)
    machine_code = _MachineCode(context.codegen(), library[2][0])
    for each in environments:
        context.codegen().set_env(each.env_name, each)
    entry = context.get_executable(machine_code, function, environment)
    made.add_overload(
        CompileResult(
            target_context=context,
            typing_context=None,
            library=machine_code,
            environment=environment,
            entry_point=entry,
            fndesc=function,
            type_annotation="",
            signature=signature,
            objectmode=False,
            lifted=(),
            typing_error=None,
            call_helper=None,
            metadata=None,
            reload_init=reloaded,
            referenced_envs=environments,
        )
    )
    made.disable_compile()


# Has numpy do without its masked arrays until somebody wants one: `np.unique` asks whether it was given one, for which
# 0.03 s of every start would go by.


_MASKED = "numpy.ma"


class _LateMaskedArrays(ModuleType):
    """Stands for the module until somebody asks it for more than whether an array is masked: none is, unmade."""

    def is_masked(self, values: object) -> bool:
        """Return whether any value of an array is masked."""
        return hasattr(values, "_mask") and bool(self.__getattr__("is_masked")(values))

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if sys.modules.get(_MASKED) is self:
            sys.modules.pop(_MASKED, None)
        vars(np)["ma"] = made = import_module(_MASKED)  # which another thread may be importing: this waits for it
        return getattr(made, name)


def put_masked_arrays_off() -> None:
    """Let the module be imported when somebody wants one; it stays where it already was."""
    if _MASKED not in sys.modules:
        late = _LateMaskedArrays(_MASKED)
        late.__path__ = [f"{folder}/ma" for folder in np.__path__]  # its parts can be imported by their names
        sys.modules[_MASKED] = vars(np)["ma"] = late


# Plainer processors than the one of this machine, whose machine code runs here as well.
#
# The levels of x86-64 are those of the psABI of System V: what every processor of a level has, named as LLVM names it.


_LEVEL_2 = ("cmov", "cx8", "cx16", "fxsr", "popcnt", "sahf", "sse", "sse2", "sse3", "sse4.1", "sse4.2", "ssse3")

_LEVEL_3 = (*_LEVEL_2, "avx", "avx2", "bmi", "bmi2", "f16c", "fma", "lzcnt", "movbe", "xsave")

LEVELS = {"x86-64-v3": _LEVEL_3, "x86-64-v2": _LEVEL_2}
"""What a processor has to have, by LLVM's name of the level; the best first."""


def plainer_processors(triple: str, features: Mapping[str, bool]) -> tuple[str, ...]:
    """Return the names of levels whose machine code runs on a processor, the best first.

    Args:
        triple: of LLVM, such as x86_64-unknown-linux-gnu. features: of the processor, by LLVM's names; those that are
            not there it has not.
    """
    if not triple.startswith("x86_64"):
        return ()
    return tuple(name for name, needed in LEVELS.items() if all(features.get(each, False) for each in needed))
