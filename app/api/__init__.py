"""The Python door: what the command line does, from a script or a notebook.

`import hitofude` brings all of these names along, and loads what is behind them when one is first asked for.
"""

from __future__ import annotations

from ..core.errors import Cancelled, HitofudeError
from ..core.progress import Progress
from ..gcode.interpreter.dialect import Dialect
from ..model.adaptive_operation import AdaptiveOperation
from ..model.chamfer_operation import ChamferOperation
from ..model.contour_operation import ContourOperation
from ..model.curve_selectors import read_selectors
from ..model.face_operation import FaceOperation
from ..model.finding import Finding, FindingKind
from ..model.hole_operations import BoreOperation, CountersinkOperation, ReamOperation, TapOperation, ThreadOperation
from ..model.job import Job, Stock
from ..model.operation import CutParameters, DrillOperation, PocketOperation, RestOperation, Side
from ..model.part import Units
from ..model.slot_operation import SlotOperation
from ..model.tool import Tool, ToolKind
from ..model.vcarve_operation import VcarveOperation
from ..usecases.batch.task import BatchResult, BatchRow, BatchVerdict
from ..usecases.cutting.cut import CutOptions
from ..usecases.cutting.ready_setup import SetupRequest
from ..usecases.cutting.setup_stock import box_stock
from ..usecases.examine import ExamineOptions
from ..usecases.inlay import InlayFit, InlayOptions
from ..usecases.job.machining import MachiningOptions
from ..usecases.job.options import MakeOptions, Stepover
from ..usecases.proposal.propose import ProposalOptions
from ..usecases.smoothing.result import OutputForm, SmoothOptions
from .calls import BatchPart, batch, check, cut, inlay, make, read, smooth, surface
from .results import CheckedProgram, CutMetal, MadeInlay, MadeProgram, MadeSurface, SmoothedText

__all__ = [
    "AdaptiveOperation",
    "BatchPart",
    "BatchResult",
    "BatchRow",
    "BatchVerdict",
    "BoreOperation",
    "Cancelled",
    "ChamferOperation",
    "CheckedProgram",
    "ContourOperation",
    "CountersinkOperation",
    "CutMetal",
    "CutOptions",
    "CutParameters",
    "Dialect",
    "DrillOperation",
    "ExamineOptions",
    "FaceOperation",
    "Finding",
    "FindingKind",
    "HitofudeError",
    "InlayFit",
    "InlayOptions",
    "Job",
    "MachiningOptions",
    "MadeInlay",
    "MadeProgram",
    "MadeSurface",
    "MakeOptions",
    "OutputForm",
    "PocketOperation",
    "Progress",
    "ProposalOptions",
    "ReamOperation",
    "RestOperation",
    "SetupRequest",
    "Side",
    "SlotOperation",
    "SmoothOptions",
    "SmoothedText",
    "Stepover",
    "Stock",
    "TapOperation",
    "ThreadOperation",
    "Tool",
    "ToolKind",
    "Units",
    "VcarveOperation",
    "batch",
    "box_stock",
    "check",
    "cut",
    "inlay",
    "make",
    "read",
    "read_selectors",
    "smooth",
    "surface",
]
