"""Dataclasses that are made in a sixth of the time.

Before Python 3.13 the library compiles the text of each method of each class by itself: of 2,500 methods that a command
needs that is a quarter of its start. All but `__init__` and the comparisons of order are closures here, which do the
same without a text of their own. An `__init__` needs one, and has it when the first value of its class is made: of most
classes that a command imports, it makes none.
"""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Sequence
from operator import attrgetter
from reprlib import recursive_repr
from typing import Any

Fields = Sequence["dataclasses.Field[Any]"]
Method = Callable[..., Any]

_REPLACED = ("_init_fn", "_repr_fn", "_frozen_get_del_attr", "_cmp_fn", "_hash_fn", "_is_type")
"""Functions of the library that make methods, and the one that looks for special types among the annotations."""

_SPECIAL_TYPES = ("ClassVar", "InitVar", "KW_ONLY")
"""Names in an annotation, alone or behind a module's, that make its field unlike others."""


def make_dataclasses_quickly() -> None:
    """Have the classes of all modules that are imported from now on made without compiling; a program does so, no
    library.

    Where the Python is newer, or its library has other functions, nothing is changed.
    """
    if sys.version_info >= (3, 13) or not all(callable(getattr(dataclasses, name, None)) for name in _REPLACED):
        return
    library = vars(dataclasses)
    compiled, initializing, is_type = library["_cmp_fn"], library["_init_fn"], library["_is_type"]

    def compared(name: str, op: str, own: str, other: str, globals: dict[str, Any]) -> Method:
        return _equal(own) if name == "__eq__" else compiled(name, op, own, other, globals=globals)

    def special(annotation: str, *rest: Any) -> bool:
        return any(name in annotation for name in _SPECIAL_TYPES) and is_type(annotation, *rest)

    made = {"_repr_fn": _shown, "_frozen_get_del_attr": _frozen, "_cmp_fn": compared, "_hash_fn": _hashed}
    made |= {"_init_fn": lambda *what: _late(lambda: initializing(*what)), "_is_type": special}
    for name, function in made.items():
        setattr(dataclasses, name, function)


def _late(compiled: Callable[[], Method]) -> Method:
    """Return an `__init__` that is compiled at its first call, and from then on is the class's own."""

    def first(self: Any, *values: Any, **named: Any) -> None:
        made = _named("__init__", compiled())
        made.__qualname__ = first.__qualname__
        for each in type(self).__mro__:
            if each.__dict__.get("__init__") is first:
                each.__init__ = made  # type: ignore[misc]  # of the class that it was made for: `first` was found there
        made(self, *values, **named)

    return _named("__init__", first)


def _values_of(names: Sequence[str]) -> Callable[[Any], tuple[Any, ...]]:
    """Return a function that gives the values of fields as a tuple."""
    if len(names) > 1:
        return attrgetter(*names)
    return (lambda self: (getattr(self, names[0]),)) if names else lambda self: ()


def _named(name: str, method: Method) -> Method:
    method.__name__ = name
    return method


def _shown(fields: Fields, globals: dict[str, Any]) -> Method:
    names = [each.name for each in fields]

    def shown(self: Any) -> str:
        values = ", ".join([f"{name}={getattr(self, name)!r}" for name in names])
        return f"{self.__class__.__qualname__}({values})"

    return recursive_repr()(_named("__repr__", shown))


def _equal(own: str) -> Method:
    """Return the comparison of the fields in a text such as `(self.a,self.b,)`."""
    values = _values_of([each.removeprefix("self.") for each in own.strip("()").split(",") if each])

    def equal(self: Any, other: Any) -> Any:
        return values(self) == values(other) if other.__class__ is self.__class__ else NotImplemented

    return _named("__eq__", equal)


def _hashed(fields: Fields, globals: dict[str, Any]) -> Method:
    values = _values_of([each.name for each in fields])
    return _named("__hash__", lambda self: hash(values(self)))


def _frozen(cls: Any, fields: Fields, globals: dict[str, Any]) -> tuple[Method, Method]:
    names = frozenset(each.name for each in fields)

    def held(self: Any, name: str, value: Any) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot assign to field {name!r}")
        super(cls, self).__setattr__(name, value)

    def kept(self: Any, name: str) -> None:
        if type(self) is cls or name in names:
            raise dataclasses.FrozenInstanceError(f"cannot delete field {name!r}")
        super(cls, self).__delattr__(name)

    return _named("__setattr__", held), _named("__delattr__", kept)
