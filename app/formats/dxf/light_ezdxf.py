"""Has ezdxf imported without the grammar of its query language, which nothing here asks in, and without what reads
typefaces, until one is asked for: 0.07 s of every start.
"""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

_PARSER, _GRAMMAR = "ezdxf.queryparser", "pyparsing"
_TYPEFACES = "fontTools.ttLib"


class _LateParser:
    """Stands for the parser of queries until somebody asks it something."""

    def __getattr__(self, name: str) -> Any:
        if isinstance(getattr(sys.modules.get(_PARSER), "EntityQueryParser", None), _LateParser):
            del sys.modules[_PARSER]
        return getattr(import_module(_PARSER).EntityQueryParser, name)


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
    stand_ins = {_PARSER: parser, _GRAMMAR: grammar}
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
