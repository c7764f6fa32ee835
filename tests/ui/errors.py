"""The errors that the program can raise, read out of its own source: what the window may have to show in Japanese.

Counted are the texts of every error class of ours, wherever one is made, and what is handed to a function whose error
is raised at once (`raise table.error(key, "is missing; …")`). Errors of the command line and of Python itself are left
out: the window never shows them.
"""

from __future__ import annotations

import ast
import builtins
import re
from collections.abc import Iterable, Iterator, Mapping
from functools import cache

from tests.ui.sentences import HOLE, ROOT, Sentence, _assigned, texts_of

BASE, OF_PYTHON = "HitofudeError", {*dir(builtins), "ArgumentTypeError", "FrozenInstanceError", "_ValueError"}
ELSEWHERE = ("cli", "api")
_WITHIN = re.compile("(is|are|has|goes|belongs|must|needs) ")
"""How what stands behind the name of a key begins."""
_WORDS = re.compile(rf"[A-Za-z][\w{HOLE}'-]* [\w{HOLE}'#\"({{-]")
"""Two words at least: a sentence, or a part of one; a word alone is the name of something."""
_CLASS = re.compile(r"^class (\w+)\(([^)]*)\)", re.MULTILINE)


def error_classes(texts: Iterable[str]) -> set[str]:
    """Return the names of all classes that are errors of ours."""
    derived = [(name, set(re.split(r"[\s,.]+", bases))) for text in texts for name, bases in _CLASS.findall(text)]
    found, before = {BASE}, 0
    while len(found) > before:
        before = len(found)
        found |= {name for name, bases in derived if found & bases}
    return found


def errors_in(text: str, name: str, classes: set[str]) -> Iterator[Sentence]:
    """Yield the texts of the errors of one file."""
    module = ast.parse(text)
    constants = _constants(module)
    for function, calls in _made(module, classes).items():
        names = constants | _assigned(function)
        for call in calls:
            for given in (*call.args, *(word.value for word in call.keywords)):
                for said in texts_of(given, names):
                    if _WORDS.search(said):
                        yield Sentence(f"{HOLE} {said}" if _WITHIN.match(said) else said, f"{name}:{call.lineno}")


def _constants(module: ast.Module) -> dict[str, list[ast.expr]]:
    """Return what the names of a file stand for that are given a text once and for all."""
    given = [node for node in module.body if isinstance(node, ast.Assign)]
    return {
        _name(node.targets[0]): [node.value] for node in given if isinstance(node.value, ast.Constant | ast.JoinedStr)
    }


def _made(module: ast.Module, classes: set[str]) -> dict[ast.AST, list[ast.Call]]:
    """Return the calls that make an error, by the innermost function that they are in."""
    found: dict[ast.AST, list[ast.Call]] = {}
    waiting: list[tuple[ast.AST, ast.AST]] = [(module, module)]
    while waiting:
        node, function = waiting.pop()
        if isinstance(node, ast.Call) and _name(node.func) in classes:
            found.setdefault(function, []).append(node)
        elif isinstance(node, ast.Raise) and isinstance(node.exc, ast.Call):
            made = _name(node.exc.func)
            if made not in classes and made not in OF_PYTHON:
                found.setdefault(function, []).append(node.exc)
        within = node if isinstance(node, ast.FunctionDef) else function
        waiting += [(each, within) for each in ast.iter_child_nodes(node)]
    return found


def _name(node: ast.expr) -> str:
    return getattr(node, "attr", getattr(node, "id", ""))


def errors_of(texts: Mapping[str, str]) -> tuple[Sentence, ...]:
    """Return what can go wrong in some files, each sentence once, in the order of the alphabet.

    Args:
        texts: of Python, by their files' names.
    """
    classes, found = error_classes(texts.values()), dict[str, Sentence]()
    heard = re.compile(rf"\braise |\b({'|'.join(classes)})\(")
    for name, text in texts.items():
        for said in errors_in(text, name, classes) if heard.search(text) else ():
            found.setdefault(said.text, said)
    return tuple(sorted(found.values()))


@cache
def errors_of_the_program() -> tuple[Sentence, ...]:
    """Return what can go wrong in the whole program, but for the command line."""
    paths = sorted(path for path in (ROOT / "app").rglob("*.py") if not set(ELSEWHERE) & set(path.parts))
    return errors_of({path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8") for path in paths})
