"""Has ezdxf imported without the grammar of its query language, which nothing here asks in, and without what reads
typefaces and its table of hatch patterns, until one is asked for: 0.08 s of every start.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

_PARSER, _GRAMMAR = "ezdxf.queryparser", "pyparsing"
_TYPEFACES = "fontTools.ttLib"
_PATTERNS = "ezdxf.tools.pattern"


class _LateParser:
    """Stands for the parser of queries until somebody asks it something."""

    def __getattr__(self, name: str) -> Any:
        if isinstance(getattr(sys.modules.get(_PARSER), "EntityQueryParser", None), _LateParser):
            del sys.modules[_PARSER]
        return getattr(import_module(_PARSER).EntityQueryParser, name)


class _LatePatterns(ModuleType):
    """Stands for the module of hatch patterns, which parses a table of them, until somebody asks it something."""

    def __getattr__(self, name: str) -> Any:
        if name.startswith("__"):
            raise AttributeError(name)
        if sys.modules.get(_PATTERNS) is self:
            del sys.modules[_PATTERNS]
        return getattr(import_module(_PATTERNS), name)


class _NeverRaisedError(Exception):
    """Stands for the error that the grammar raises, where the library catches it without asking a query."""


def load_ezdxf() -> None:
    """Import the library, the whole before its parts: else, while another thread imports it too, parts are found half
    made.
    """
    if "ezdxf" in sys.modules or _GRAMMAR in sys.modules:
        import_module("ezdxf")
        return
    parser, grammar = ModuleType(_PARSER), ModuleType(_GRAMMAR)
    vars(parser)["EntityQueryParser"], vars(grammar)["ParseException"] = _LateParser(), _NeverRaisedError
    stand_ins = {_PARSER: parser, _GRAMMAR: grammar, _PATTERNS: _LatePatterns(_PATTERNS)}
    if _TYPEFACES not in sys.modules:
        stand_ins[_TYPEFACES] = ModuleType(_TYPEFACES)
        vars(stand_ins[_TYPEFACES]).update(TTFont=_typeface, TTLibError=_NeverRaisedError)
    sys.modules.update(stand_ins)
    try:
        import_module("ezdxf")
    finally:
        for name in (_GRAMMAR, _TYPEFACES):
            if name in stand_ins and sys.modules.get(name) is stand_ins[name]:
                del sys.modules[name]


def _typeface(*arguments: Any, **options: Any) -> Any:
    """Stand for the class of typefaces where the library keeps it, until it is called the first time."""
    reader, manager = import_module(_TYPEFACES), import_module("ezdxf.fonts.font_manager")
    vars(manager).update(TTFont=reader.TTFont, TTLibError=reader.TTLibError)
    return reader.TTFont(*arguments, **options)
