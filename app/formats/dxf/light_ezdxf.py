"""Has ezdxf imported without the grammar of its query language, which nothing here asks in: 0.03 s of every start."""

from __future__ import annotations

import sys
from importlib import import_module
from types import ModuleType
from typing import Any

_PARSER, _GRAMMAR = "ezdxf.queryparser", "pyparsing"


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
    sys.modules[_PARSER], sys.modules[_GRAMMAR] = parser, grammar
    try:
        import_module("ezdxf")
    finally:
        if sys.modules.get(_GRAMMAR) is grammar:
            del sys.modules[_GRAMMAR]
