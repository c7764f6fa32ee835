"""The sentences that the program can say to the window, read out of its own source.

A sentence is an argument of a call that is known to end on the screen: the text of a finding, what a notice asks, what
the log is told, what a long job says while it runs, label and help of a parameter. Of an f-string the words are kept
and each value is a hole; where a sentence is put together of choices, each of them is one.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache, lru_cache
from itertools import chain, islice, product
from pathlib import Path

from app.core.options import on_command_line
from app.ui.framework.figures import TIMES

ROOT = Path(__file__).resolve().parents[2]
HOLE = "\0"
_MOST_CHOICES, _DEEPEST, _FEW = 24, 9, 6
_READS_LIKE_ONE = re.compile("^[A-Z\0]")
_CODE = re.compile(r"_|<|\{ |  |\w\(|\(\*|;;| \\{ |\w\.\w{2}|Ctrl\+|Alt\+|F3")
_WORD = re.compile(r"[A-Za-z]{2,}")


@dataclass(frozen=True, order=True)
class Sentence:
    """What may be said, a `HOLE` for each value in it, and where it stands."""

    text: str
    place: str


@dataclass(frozen=True)
class _Said:
    """Which arguments of a call are sentences: by place, by name."""

    places: tuple[int, ...]
    names: tuple[str, ...] = ()


CALLS = {
    "Finding": _Said((1,), ("text",)),
    "ask": _Said((0, 1), ("sentence",)),
    "note": _Said((1,), ("reply",)),
    "step": _Said((1,), ("text",)),
    "remark": _Said((0,)),
    "Reckoning": _Said((1, 2)),
    "said.emit": _Said((0,)),
    "failed.emit": _Said((0,)),
    "hovered.emit": _Said((0,)),
    "MissingHint": _Said((0, 1), ("sentence", "button")),
    "setText": _Said((0,)),
    "setToolTip": _Said((0,)),
    "setPlaceholderText": _Said((0,)),
    "setAccessibleName": _Said((0,)),
    "setWindowTitle": _Said((0,)),
    "show_waiting": _Said((0,)),
    "QLabel": _Said((0,)),
    "QPushButton": _Said((0,)),
    "muted": _Said((0,)),
    "heading": _Said((0,)),
    "Section": _Said((0,)),
    "LegendRow": _Said((0, 1), ("text",)),
    "StageNote": _Said((0, 1)),
}
"""What is called, by its last name (of `emit`: its last two), and which of its arguments are seen."""


_HEARD = re.compile(rf"\b({'|'.join(name for name in CALLS if '.' not in name)})\(")


def said_in(source: str, name: str, calls: dict[str, _Said] = CALLS) -> Iterator[Sentence]:
    """Yield the sentences of one file.

    Args:
        source: of Python. name: of the file, for the places.
        calls: what is called, and which of its arguments are seen.
    """
    tree = _parsed(source)
    answers = _answers(tree)
    for function in (tree, *(node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))):
        heard = [(call, calls[called]) for call in _own(function) if (called := _last_name(call.func)) in calls]
        names = {**_assigned(function), **answers} if heard else {}
        for call, said in heard:
            given = [call.args[at] for at in said.places if at < len(call.args)]
            given += [word.value for word in call.keywords if word.arg in said.names]
            for text in {text for each in given for text in texts_of(each, names)}:
                if any(letter.isalpha() for letter in text):
                    yield Sentence(text, f"{name}:{call.lineno}")


@lru_cache(1)
def _parsed(source: str) -> ast.Module:
    return ast.parse(source)


def _answers(tree: ast.Module) -> dict[str, list[ast.expr]]:
    """Return what the file's own functions answer where that is words, by their names with "()"."""
    found = dict[str, list[ast.expr]]()
    for function in tree.body:
        if isinstance(function, ast.FunctionDef) and getattr(function.returns, "id", "") == "str":
            names = _assigned(function)
            given = (node.value for node in ast.walk(function) if isinstance(node, ast.Return) and node.value)
            texts = {text for each in given for text in texts_of(each, names)}
            if all(len(_WORD.findall(text)) > 1 and "<" not in text for text in texts - {""}):
                found[f"{function.name}()"] = [ast.Constant(text) for text in sorted(texts)]
    return found


def _own(function: ast.AST) -> Iterator[ast.Call]:
    """Yield the calls in a function, but for those of functions within it."""
    waiting = list(ast.iter_child_nodes(function))
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.FunctionDef):
            continue
        if isinstance(node, ast.Call):
            yield node
        waiting += ast.iter_child_nodes(node)


def _last_name(function: ast.expr) -> str:
    if isinstance(function, ast.Attribute):
        return f"{_last_name(function.value)}.emit" if function.attr == "emit" else function.attr
    return getattr(function, "id", "")


def _assigned(function: ast.AST) -> dict[str, list[ast.expr]]:
    """Return what names of a function stand for, where they are given a text."""
    found = dict[str, list[ast.expr]]()
    for node in ast.walk(function):
        if isinstance(node, ast.Assign):
            pairs: list[tuple[ast.expr, ast.expr]] = [(target, node.value) for target in node.targets]
            while pairs:
                target, value = pairs.pop()
                if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
                    pairs += zip(target.elts, value.elts, strict=False)
                elif isinstance(target, ast.Name):
                    found.setdefault(target.id, []).append(value)
    return found


_HELPERS: dict[str, Callable[..., str]] = {
    "option": on_command_line,
    "in_plane": lambda *_: f"({HOLE}, {HOLE})",
}
"""Functions that spell a part of many sentences, with what they make of the texts that they are given."""


def texts_of(node: ast.expr, names: dict[str, list[ast.expr]], depth: int = 0) -> list[str]:
    """Return all that an expression of texts can be; what is no text of its own is a `HOLE`."""
    if depth > _DEEPEST:
        return [HOLE]
    match node:
        case ast.Constant(value=str(text)):
            return [text]
        case ast.JoinedStr(values=values):
            parts = [texts_of(each, names, depth + 1) for each in values]
            return ["".join(each) for each in islice(product(*parts), _MOST_CHOICES)]
        case ast.Call(func=ast.Name(id=word), args=args) if word in _HELPERS:
            parts = [texts_of(each, names, depth + 1) for each in args]
            return [_HELPERS[word](*each) for each in islice(product(*parts), _MOST_CHOICES)]
        case ast.FormattedValue(value=value, format_spec=spec) if spec is None and isinstance(
            value, ast.IfExp | ast.Constant | ast.Name | ast.BinOp | ast.Call
        ):
            found = texts_of(value, names, depth + 1)
            return found if not isinstance(value, ast.Name) or len(found) <= _FEW else [HOLE]
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            pairs = product(texts_of(left, names, depth + 1), texts_of(right, names, depth + 1))
            return [a + b for a, b in islice(pairs, _MOST_CHOICES)]
        case ast.BinOp(left=left, op=ast.Mult()) if isinstance(left, ast.Constant) and isinstance(left.value, str):
            return ["", left.value]
        case ast.IfExp(body=body, orelse=other):
            return [*texts_of(body, names, depth + 1), *texts_of(other, names, depth + 1)]
        case ast.BoolOp(values=values):
            return [text for each in values for text in texts_of(each, names, depth + 1)]
        case ast.Call(func=ast.Name(id=name)) if f"{name}()" in names:
            found = (text for each in names[f"{name}()"] for text in texts_of(each, names, depth + 1))
            return list(islice(found, _MOST_CHOICES))
        case ast.Name(id="TIMES"):
            return [TIMES]
        case ast.Name(id=name) if name in names:
            found = (text for each in names[name] for text in texts_of(each, names, depth + 1))
            return list(islice(found, _MOST_CHOICES))
        case _:
            return [HOLE]


def written_in(source: str, name: str) -> Iterator[Sentence]:
    """Yield what of a file reads like a sentence, wherever it stands: a capital, some words, no code; docstrings and
    errors are left out.
    """
    tree = _parsed(source)
    unseen = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Raise | ast.Assert | ast.JoinedStr):
            unseen |= {id(part) for part in ast.walk(node) if part is not node}
    for node in ast.walk(tree):
        if id(node) not in unseen and isinstance(node, ast.JoinedStr | ast.Constant):
            for text in texts_of(node, {}):
                if _READS_LIKE_ONE.match(text) and not _CODE.search(text) and len(_WORD.findall(text)) >= 3:
                    yield Sentence(text, f"{name}:{node.lineno}")


@cache
def sentences() -> tuple[Sentence, ...]:
    """Return what the program can say, each sentence once, in the order of the alphabet."""
    found = dict[str, Sentence]()
    for path in sorted((ROOT / "app").rglob("*.py")):
        if "cli" in path.parts or "api" in path.parts:
            continue
        source, name = path.read_text(encoding="utf-8"), path.relative_to(ROOT).as_posix()
        if "ui" not in path.parts and not _HEARD.search(source):
            continue
        written = written_in(source, name) if "ui" in path.parts and "session1986" not in path.parts else ()
        for said in chain(said_in(source, name), written):
            found.setdefault(said.text, said)
    return tuple(sorted(found.values()))
