"""Chamfers: edges broken along contours by the flank of a cone or the round of a ball."""

from __future__ import annotations

from ...model.chamfer_operation import ChamferOperation
from ..registry import OperationMethod, register
from .paths import chamfer

register(ChamferOperation, OperationMethod(chamfer))
