"""What a window remembers, read from outside: every value that its own objects hold and every state that its widgets
show.

Two windows with the same traces behave alike, so a window that shows those of a new one after a test may serve the next
test.
"""

from __future__ import annotations

import dataclasses
import enum
from collections import Counter, deque
from collections.abc import Iterable, Iterator, Mapping
from functools import cache, cached_property
from itertools import islice
from pathlib import Path
from types import FunctionType, MethodType

import numpy as np
import shiboken6
from PySide6.QtCore import QObject, SignalInstance
from PySide6.QtGui import QAction
from PySide6.QtWidgets import (
    QAbstractButton,
    QComboBox,
    QLabel,
    QLineEdit,
    QPlainTextEdit,
    QScrollBar,
    QStackedWidget,
    QTreeWidget,
    QWidget,
)

from app.core.toml_tables import Keyword
from app.ui.shell.window_controller import WindowController

_SIMPLE = (bool, int, float, str, bytes, Path, enum.Enum, type(None))
_CODE = {FunctionType, MethodType, type, SignalInstance}
_MISSING = object()
_UNTOLD = {
    "next_id",
    "_next_id",
    "_told",
    "revision",
    "_revision",
    "_threads",
    "__weakref__",
    "_began",
    "_since",
    "job_id",
    "_job_id",
    "_job",
    "_generation",
    "_taken",
    "_last",  # counters that only ever go on: nothing is decided by where they start
    "scene_ms",
    "_scene_view",
    "_outdated",
    "_way",
    "_opacity",
    "_turn",
    "due",  # how the last picture was painted, and moved to its place
}


class _Sort(enum.Enum):
    """What is looked at of a value, by its type."""

    SIMPLE = "itself"
    GROUP = "its parts, if any of them can change"
    MAPPING = "what it holds by keys"
    LIST = "what it holds in order"
    SET = "how many it holds"
    OURS = "its attributes"
    OTHER = "what Qt shows of it"


@cache
def _sort_of(kind: type) -> _Sort:
    dataclass = getattr(kind, "__dataclass_params__", None)
    if issubclass(
        kind, (*_SIMPLE, Keyword, np.ndarray)
    ):  # arrays are made anew, never written into, once they are shown
        return _Sort.SIMPLE
    if issubclass(kind, tuple) or (dataclass is not None and dataclass.frozen and dataclass.eq):
        return _Sort.GROUP
    for base, sort in ((Mapping, _Sort.MAPPING), ((list, deque), _Sort.LIST), ((set, frozenset), _Sort.SET)):
        if issubclass(kind, base):
            return sort
    ours = kind.__module__.startswith("app.") and not issubclass(kind, type)
    return _Sort.OURS if ours else _Sort.OTHER


def traces(wiring: WindowController) -> dict[str, object]:
    """Return every value by the way that leads to it, from the wiring and from the window."""
    return dict(_walk(wiring))


def _walk(wiring: WindowController, before: Mapping[str, object] | None = None) -> Iterator[tuple[str, object]]:
    """Yield every value and its way; `before` are those of an earlier walk, which need not be looked into again where
    they are the same, as they cannot change.
    """
    seen: set[int] = set()
    known = before or {}
    fixed: dict[int, bool] = {}
    waiting: deque[tuple[str, object]] = deque([("wiring", wiring), ("window", wiring.window_)])
    while waiting:
        way, value = waiting.popleft()
        if known.get(way, _MISSING) is value or _is_fixed(value, fixed):
            yield way, value
        elif id(value) not in seen:
            seen.add(id(value))
            if _is_seen(type(value)) and shiboken6.isValid(value):
                yield from _seen_of(way, value)
            for step, part in _parts(value):
                kind = type(part)
                if _sort_of(kind) is _Sort.SIMPLE:  # most are, and need not wait
                    yield way + step, part
                elif not _is_untold(kind) and id(part) not in seen:
                    waiting.append((way + step, part))


@cache
def _is_untold(kind: type) -> bool:
    """Tell whether there is nothing to say of a value, as of Qt's timers and layouts."""
    return _sort_of(kind) is _Sort.OTHER and not _is_seen(kind)


@cache
def _is_seen(kind: type) -> bool:
    return issubclass(kind, QWidget)


def _seen_of(way: str, value: object) -> Iterator[tuple[str, object]]:
    if isinstance(value, QWidget) and value.parent() is None:
        yield from _shown(way, value)
    if isinstance(value, QAbstractButton) and value.isCheckable():  # a form's choice is none of its attributes
        yield f"{way} checked", value.isChecked()


def fixed_values(owner: object) -> dict[str, object]:
    """Return those attributes of an object that hold what cannot change, by their names."""
    known: dict[int, bool] = {}
    return {name: value for name, value in vars(owner).items() if _is_fixed(value, known)}


def _is_fixed(value: object, known: dict[int, bool]) -> bool:
    """Tell whether nothing about a value can change, so that whoever holds it holds another one or the same; `known`
    are answers given before.
    """
    sort = _sort_of(type(value))
    if sort is _Sort.SIMPLE:
        return True
    if sort is not _Sort.GROUP:
        return False
    if id(value) not in known:
        known[id(value)] = all(_is_fixed(part, known) for _, part in _parts(value))
    return known[id(value)]


def _parts(value: object) -> Iterator[tuple[str, object]]:
    sort = _sort_of(type(value))
    if sort is _Sort.MAPPING:
        yield ".len", len(value)
        for key, part in value.items():
            name = key if isinstance(key, str | int | float | enum.Enum) else type(key).__name__
            yield f"[{name}]", part
    elif sort is _Sort.LIST or isinstance(value, tuple):
        yield ".len", len(value)
        for k, part in enumerate(value):
            yield f"[{k}]", part
    elif sort is _Sort.SET:
        yield ".len", len(value)
    elif sort is _Sort.GROUP or sort is _Sort.OURS:
        for name in _names(value):
            if name not in _UNTOLD and type(part := getattr(value, name, None)) not in _CODE:
                yield f".{name}", part


def _names(value: object) -> Iterable[str]:
    slots, own, derived = _slots(type(value)), getattr(value, "__dict__", {}), _derived(type(value))
    names = dict.fromkeys([*own, *slots]) if slots else own
    return [name for name in names if name not in derived] if derived else names


@cache
def _derived(kind: type) -> frozenset[str]:
    """Return the names of what a class works out of the rest when it is first asked for: remembered by who was asked,
    and the same whether or not anybody asked.
    """
    return frozenset(
        name for base in kind.__mro__ for name, made in vars(base).items() if isinstance(made, cached_property)
    )


@cache
def _slots(kind: type) -> tuple[str, ...]:
    return tuple(name for base in kind.__mro__ for name in getattr(base, "__slots__", ()))


def _shown(way: str, root: QWidget) -> Iterator[tuple[str, object]]:
    """Yield what a window shows; of objects below it too, as many of them have no name in Python."""
    for each, place in _below(root, way):
        for what, state in _states(each):
            yield f"{place} {what}", state


def _below(root: QObject, way: str) -> Iterator[tuple[QObject, str]]:
    """Yield an object and what it holds; what a hidden widget holds is set anew before it is shown."""
    yield root, f"<{way}>"
    if isinstance(root, QWidget) and root.isHidden() and root.parent() is not None:
        return
    count: Counter[str] = Counter()  # by kind: what is raised comes last among its parent's children
    for child in root.children():
        kind = type(child).__name__
        count[kind] += 1
        yield from _below(child, f"{way}/{kind}{count[kind]}")


def _states(each: QObject) -> Iterator[tuple[str, object]]:
    if isinstance(each, QWidget):
        yield "hidden", each.isHidden()
        yield "enabled", each.isEnabled()
        yield "tip", each.toolTip()
    if isinstance(each, QAction):
        yield "action", (each.text(), each.isEnabled(), each.isChecked(), each.shortcut().toString())
    elif isinstance(each, QAbstractButton):
        yield "button", (each.text(), each.isChecked())
    elif isinstance(each, QLineEdit):
        yield "edit", (each.text(), each.placeholderText(), each.isReadOnly())
    elif isinstance(each, QComboBox):
        yield "combo", (each.currentText(), each.count())
    elif isinstance(each, QLabel):
        yield "label", each.text()
    elif isinstance(each, QPlainTextEdit):
        yield "text", each.toPlainText()
    elif isinstance(each, QStackedWidget):
        yield "page", each.currentIndex()
    elif isinstance(each, QScrollBar):
        yield "scrolled", each.value()
    elif isinstance(each, QTreeWidget):
        yield "rows", each.topLevelItemCount()


def differences(before: dict[str, object], after: dict[str, object]) -> list[str]:
    """Return a line for each value that is not what it was."""
    return list(_differing(before, after.items()))


def left_in(wiring: WindowController, before: dict[str, object], most: int = 100) -> list[str]:
    """Return a line for each value of a window that is not what it was; after so many nobody looks for more."""
    return list(islice(_differing(before, _walk(wiring, before)), most))


def _differing(before: dict[str, object], after: Iterable[tuple[str, object]]) -> Iterator[str]:
    met = set()
    for way, value in after:
        met.add(way)
        if not _alike(before.get(way, _MISSING), value):
            yield f"{way}: {before.get(way, '—')!r} -> {value!r}"
    yield from (f"{way}: {value!r} -> '—'" for way, value in before.items() if way not in met)


def _alike(a: object, b: object) -> bool:
    if a is b:
        return True
    if type(a) is not type(b):
        return False
    if isinstance(a, float) and isinstance(b, float):
        return a == b or (a != a and b != b)
    if isinstance(a, np.ndarray) and isinstance(b, np.ndarray):
        return a.shape == b.shape and a.dtype == b.dtype and a.tobytes() == b.tobytes()
    if isinstance(a, tuple) and isinstance(b, tuple):
        return len(a) == len(b) and all(map(_alike, a, b))
    if dataclasses.is_dataclass(a) and dataclasses.is_dataclass(b):
        return all(_alike(getattr(a, each.name), getattr(b, each.name)) for each in dataclasses.fields(a))
    return bool(a == b)
