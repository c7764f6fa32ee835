"""V-carving: areas carved by a V cutter that goes along their medial axis and touches both walls at the surface."""

from __future__ import annotations

from ...model.operation import VcarveOperation
from ..registry import Way, register
from .paths import vcarve

register(VcarveOperation, Way(vcarve))
