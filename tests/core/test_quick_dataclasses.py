"""Classes made quickly do what the library's own do."""

from __future__ import annotations

import dataclasses
import subprocess
import sys
from collections.abc import Callable, Iterator
from typing import Any, ClassVar

import pytest

from app.core.quick_dataclasses import make_dataclasses_quickly

pytestmark = pytest.mark.skipif(sys.version_info >= (3, 13), reason="the library itself compiles a class at once")
NAMES = ("_init_fn", "_repr_fn", "_frozen_get_del_attr", "_cmp_fn", "_hash_fn", "_is_type")
OWN = {name: getattr(dataclasses, name, None) for name in NAMES}
"""The library's functions, before anything is replaced."""


@pytest.fixture(autouse=True)
def _put_back() -> Iterator[None]:
    yield
    for name, function in OWN.items():
        setattr(dataclasses, name, function)


def empty(decorate: Callable[..., Any]) -> Any:
    @decorate
    class Value:
        pass

    return Value


def single(decorate: Callable[..., Any]) -> Any:
    @decorate
    class Value:
        a: Any = 1

    return Value


def several(decorate: Callable[..., Any]) -> Any:
    @decorate
    class Value:
        a: Any = 1
        b: Any = dataclasses.field(default="two", repr=False)
        c: Any = dataclasses.field(default=3.0, compare=False)
        d: Any = dataclasses.field(default_factory=tuple)
        count: ClassVar[int] = 4
        scale: dataclasses.InitVar[float] = 1.0

        def __post_init__(self, scale: float) -> None:
            assert scale == 1.0

        def rest(self) -> Any:
            return self.d

    return Value


def derived(decorate: Callable[..., Any]) -> Any:
    @decorate
    class Value(several(decorate)):  # type: ignore[misc]
        e: Any = 5

    return Value


HOW: tuple[dict[str, bool], ...] = (
    {},
    {"frozen": True},
    {"frozen": True, "slots": True},
    {"eq": False, "frozen": True},
    {"order": True},
    {"unsafe_hash": True},
    {"repr": False, "kw_only": True},
)
ASKED: tuple[Callable[[Any], Any], ...] = (
    lambda v: repr(v).split(" at 0x")[0],
    lambda v: hash(v) if type(v).__eq__ is not object.__eq__ else None,
    lambda v: v == dataclasses.replace(v),
    lambda v: v == 1,
    lambda v: v.__eq__(1),
    lambda v: v < dataclasses.replace(v),
    lambda v: v == dataclasses.replace(v, a=2),
    lambda v: v == dataclasses.replace(v, c=2),
    lambda v: setattr(v, "a", 7) or v.a,
    lambda v: setattr(v, "new", 7) or v.new,
    lambda v: delattr(v, "a"),
    lambda v: delattr(v, "nothing"),
    lambda v: sorted(vars(type(v))),
    lambda v: type(v)(1, 2, 3, 4, 5, 6, 7),
    lambda v: type(v)(nothing=1),
    lambda v: [each.name for each in dataclasses.fields(v)],
    lambda v: (type(v).__init__.__name__, type(v).__init__.__qualname__),
    lambda v: [(type(v).__dict__[n].__name__, type(v).__dict__[n].__qualname__) for n in ("__repr__",)],
    lambda v: [getattr(type(v), n).__qualname__ for n in ("__eq__", "__setattr__", "__delattr__", "__hash__")],
)


def answers(make: Callable[[Callable[..., Any]], Any], how: dict[str, bool]) -> list[Any]:
    kind = make(lambda cls: dataclasses.dataclass(**how)(cls))  # type: ignore[call-overload]
    found = []
    for ask in ASKED:
        try:
            found.append(ask(kind()))
        except Exception as error:
            found.append((type(error), str(error)))
    return found


@pytest.mark.parametrize("how", HOW, ids=["-".join(how) or "plain" for how in HOW])
@pytest.mark.parametrize("make", [empty, single, several, derived], ids=lambda make: make.__name__)
def test_they_answer_as_the_librarys_do(make: Callable[[Callable[..., Any]], Any], how: dict[str, bool]) -> None:
    expected = answers(make, how)
    make_dataclasses_quickly()
    assert dataclasses._hash_fn is not OWN["_hash_fn"]  # type: ignore[attr-defined]
    assert answers(make, how) == expected


def test_what_holds_itself_is_shown_once() -> None:
    make_dataclasses_quickly()
    kind = single(dataclasses.dataclass)
    value = kind()
    value.a = [value]
    assert repr(value).endswith("Value(a=[...])")


def test_a_class_below_begins_it_before_a_value_of_its_own_was_made() -> None:
    make_dataclasses_quickly()
    base = several(dataclasses.dataclass(frozen=True))

    class Below(base):  # type: ignore[misc]
        def __init__(self) -> None:
            super().__init__(a=7)

    assert (Below().a, Below().a, base().a, base(8).a) == (7, 7, 1, 8)


def test_importing_the_python_door_leaves_the_library_alone() -> None:
    code = f"import dataclasses, app; from app.api import calls; print([dataclasses.{NAMES[0]}.__module__])"
    told = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert told.stdout.strip() == "['dataclasses']"
