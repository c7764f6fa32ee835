"""Facing: what stands above Z 0 is taken off the whole stock."""

from __future__ import annotations

from ...model.face_operation import FaceOperation
from ..registry import OperationMethod, register
from .paths import face, face_proof

register(FaceOperation, OperationMethod(face, proof=face_proof))
