"""The Python door: what the command line does, from a script or a notebook.

`import hitofude` brings all of these names along, and loads what is behind them when one is first asked for.
"""

from __future__ import annotations

from ..core.errors import Cancelled, HitofudeError
from ..core.progress import Progress
from ..gcode.interpreter.dialect import Dialect
from ..model.adaptive_operation import AdaptiveOperation
from ..model.chamfer_operation import ChamferOperation, OpenSide
from ..model.contour_operation import ContourOperation
from ..model.curve_selectors import read_selectors
from ..model.entry import Entry, EntryKind, Lead, LeadKind, Tabs
from ..model.face_operation import FaceOperation, FacePattern
from ..model.finding import Finding, FindingKind
from ..model.hole_operations import (
    BoreOperation,
    CountersinkOperation,
    DrillOperation,
    ReamOperation,
    TapOperation,
    ThreadOperation,
)
from ..model.job import Copies, Job, OriginXY, OriginZ, Stock
from ..model.operation import CutParameters, CutterCompensation, Direction, Order, PocketOperation, RestOperation, Side
from ..model.part import Units
from ..model.read_options import DrawingOptions
from ..model.slot_operation import SlotOperation
from ..model.thread_sizes import ThreadSize
from ..model.tool import Tool, ToolMaterial
from ..model.tool_kind import ToolKind
from ..model.vcarve_operation import VcarveOperation
from ..simulation.engines import Engine
from ..toolpath.feeds.proposal import CutEngagement, FeedProposal
from ..usecases.advice import AdviceOptions, ToolAdvice
from ..usecases.batch.task import BatchResult, BatchRow, BatchVerdict
from ..usecases.better.result import BetterOptions
from ..usecases.cutting.cut import CutOptions
from ..usecases.cutting.ready_setup import SetupRequest
from ..usecases.cutting.setup_stock import box_stock
from ..usecases.examine import ExamineOptions
from ..usecases.inlay import InlayFit, InlayOptions
from ..usecases.job.machining import MachiningOptions
from ..usecases.job.options import MakeOptions, Stepover
from ..usecases.proposal.propose import ProposalOptions
from ..usecases.smoothing.result import OutputForm, SmoothOptions
from .calls import BatchPart, batch, better, check, cut, feeds, inlay, make, read, smooth, surface, tools
from .results import BetterText, CheckedProgram, CutMetal, MadeInlay, MadeProgram, MadeSurface, SmoothedText

__all__ = [
    "AdaptiveOperation",
    "AdviceOptions",
    "BatchPart",
    "BatchResult",
    "BatchRow",
    "BatchVerdict",
    "BetterOptions",
    "BetterText",
    "BoreOperation",
    "Cancelled",
    "ChamferOperation",
    "CheckedProgram",
    "ContourOperation",
    "Copies",
    "CountersinkOperation",
    "CutEngagement",
    "CutMetal",
    "CutOptions",
    "CutParameters",
    "CutterCompensation",
    "Dialect",
    "Direction",
    "DrawingOptions",
    "DrillOperation",
    "Engine",
    "Entry",
    "EntryKind",
    "ExamineOptions",
    "FaceOperation",
    "FacePattern",
    "FeedProposal",
    "Finding",
    "FindingKind",
    "HitofudeError",
    "InlayFit",
    "InlayOptions",
    "Job",
    "Lead",
    "LeadKind",
    "MachiningOptions",
    "MadeInlay",
    "MadeProgram",
    "MadeSurface",
    "MakeOptions",
    "OpenSide",
    "Order",
    "OriginXY",
    "OriginZ",
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
    "Tabs",
    "TapOperation",
    "ThreadOperation",
    "ThreadSize",
    "Tool",
    "ToolAdvice",
    "ToolKind",
    "ToolMaterial",
    "Units",
    "VcarveOperation",
    "batch",
    "better",
    "box_stock",
    "check",
    "cut",
    "feeds",
    "inlay",
    "make",
    "read",
    "read_selectors",
    "smooth",
    "surface",
    "tools",
]
