"""What a window remembers, read from outside: every value that its own objects hold and every state that its widgets
show.

Two windows with the same traces behave alike, so a window that shows those of a new one after a test may serve the next
test.
"""

from __future__ import annotations

import enum
from collections import Counter, deque
from collections.abc import Iterator, Mapping
from pathlib import Path
from types import FunctionType, MethodType

import numpy as np
from PySide6.QtCore import QObject
from PySide6.QtGui import QAction, QColor, QFont
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

from app.ui.shell.wiring import Wiring

_SIMPLE = (bool, int, float, str, bytes, Path, enum.Enum, type(None))
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
    "_generation",
    "_taken",
    "_last",  # counters that only ever go on: nothing is decided by where they start
    "scene_ms",
    "_scene_view",
    "_way",
    "_opacity",
    "_turn",
    "due",  # how the last picture was painted, and moved to its place
}


def traces(wiring: Wiring) -> dict[str, object]:
    """Return every value by the way that leads to it, from the wiring and from the window."""
    seen: dict[int, str] = {}
    found: dict[str, object] = {}
    waiting: deque[tuple[str, object]] = deque([("wiring", wiring), ("window", wiring.window_)])
    while waiting:
        way, value = waiting.popleft()
        if isinstance(value, _SIMPLE):
            found[way] = value
        elif id(value) not in seen:
            seen[id(value)] = way
            found.update(_shown(way, value))
            waiting.extend((f"{way}{step}", part) for step, part in _parts(value))
    return found


def _parts(value: object) -> Iterator[tuple[str, object]]:
    if isinstance(value, Mapping):
        yield ".len", len(value)
        for key, part in value.items():
            name = key if isinstance(key, str | int | enum.Enum) else type(key).__name__
            yield f"[{name}]", part
    elif isinstance(value, list | tuple | set | frozenset | deque):
        yield ".len", len(value)
        for k, part in enumerate(value if not isinstance(value, set | frozenset) else ()):
            yield f"[{k}]", part
    elif isinstance(value, np.ndarray):
        yield ".shape", str(value.shape)
    elif type(value).__module__.startswith("app.") and not isinstance(value, FunctionType | MethodType | type):
        for name in _names(value):
            part = getattr(value, name, None)
            if name not in _UNTOLD and not isinstance(part, FunctionType | MethodType | type):
                yield f".{name}", part


def _names(value: object) -> list[str]:
    slots = (name for kind in type(value).__mro__ for name in getattr(kind, "__slots__", ()))
    return list(dict.fromkeys([*getattr(value, "__dict__", {}), *slots]))


def _shown(way: str, value: object) -> Iterator[tuple[str, object]]:
    """Yield what a Qt object shows; of objects below it too, as many of them have no name in Python."""
    if not isinstance(value, QWidget) or value.parent() is not None:
        return
    for each, place in _below(value, way):
        yield from ((f"{place} {what}", state) for what, state in _states(each))


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
    return [
        f"{way}: {before.get(way, '—')!r} -> {after.get(way, '—')!r}"
        for way in sorted(before.keys() | after.keys())
        if not _alike(before.get(way, _MISSING), after.get(way, _MISSING))
    ]


_MISSING = object()


def _alike(a: object, b: object) -> bool:
    if isinstance(a, float) and isinstance(b, float):
        return a == b or (a != a and b != b)
    if isinstance(a, QColor | QFont):
        return bool(a == b)
    return type(a) is type(b) and a == b
