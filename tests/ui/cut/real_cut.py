"""A small program, cut for real: a slot down to -2, a deeper hole, and a rapid that goes through metal."""

from dataclasses import replace

import numpy as np

from app.drafting.document import Document
from app.gcode.interpreter.reader import read_program
from app.model.motion_path import anchored
from app.model.operation import CutParameters, PocketOperation
from app.model.stock_box import StockBox
from app.model.tool import Tool
from app.model.tool_kind import ToolKind
from app.operations.compute import regions_of
from app.simulation.field.workpiece import BoxStock
from app.ui.views.cut.cell_colours import CutColourBy
from app.ui.views.cut.shown_cut import ProgramFile, shown_cut
from app.usecases.cutting.cut import CutOptions, CutSetup, cut
from app.verify.parts import FlatPart

TEXT = """G21 G17 G90 G54
T1 M6
S8000 M3
G0 X10 Y15 Z5
G1 Z-2 F200
G1 X30 F400
G0 Z5
G0 X10 Y5
G0 Z-1
G0 X14
G0 Z5
G0 X33 Y15
G1 Z-2.05 F200
G0 Z5
M2
"""
STOCK = StockBox(0.0, 0.0, -10.0, 40.0, 30.0, 0.0)
TOOL = Tool(1, diameter=4.0, kind=ToolKind.FLAT)


def program(text=TEXT):
    """The text, read, with known places all along."""
    read = read_program(text.encode())
    return replace(read, motions=anchored(read.motions))


def slot_part():
    """What the slot should be: 4 mm wide and 2 mm deep, round the middle line, with square ends that the tool does not
    reach.
    """
    document = Document()
    document.run("rect 8,13 32,17")
    job = replace(document.job, tools=(TOOL,), operations=(PocketOperation(CutParameters(1, 2.0, 2.0)),))
    return FlatPart(job, regions_of(job)[0])


def real_cut(cells=256, part=True, tool=TOOL):
    """The program, cut."""
    setup = CutSetup((program(),), {1: tool}, BoxStock(STOCK), slot_part() if part else None)
    return cut(setup, CutOptions(cells))


def real_shown(cells=256, part=True, colour=CutColourBy.METAL, tool=TOOL):
    """The program, cut and prepared for the view."""
    return shown_cut(real_cut(cells, part, tool), (ProgramFile("slot.ngc", TEXT.encode()),), colour)


def detailed_heights(window, cells=256):
    """What the engine says of a window."""
    setup = CutSetup((program(),), {1: TOOL}, BoxStock(STOCK))
    return np.asarray(cut(setup, CutOptions(cells, window)).cut.heights)
