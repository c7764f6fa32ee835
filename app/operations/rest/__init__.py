"""Rest machining: what the operations before have left."""

from __future__ import annotations

from ...model.operation import RestOperation
from ..registry import OperationMethod, register
from .paths import rest

register(RestOperation, OperationMethod(rest))
