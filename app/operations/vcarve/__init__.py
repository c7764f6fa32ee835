"""V-carving: areas carved by a V cutter that goes along their medial axis and touches both walls at the surface."""

from __future__ import annotations

from ...model.vcarve_operation import VcarveOperation
from ..registry import OperationMethod, register
from .paths import vcarve

register(VcarveOperation, OperationMethod(vcarve))
