"""Where the compiled lane keeps what is in force: places of its whole numbers, of its reals, and of the records that it
makes.
"""

from __future__ import annotations

OFFSET, LINE, COUNT, MOTION = range(4)
"""Of the text the next byte and line; motions there are; the G word in force (0 to 3, 73, 80 to 89), -1 = another."""
PLANE, ABSOLUTE, ARC_ABSOLUTE, SPINDLE, FLOOD, MIST, TOOL, RETRACT, SELECTED = range(4, 13)
"""As `ModalState` has them, and the T number that M6 takes."""
STATE, STATES, EVENTS, CHANGES, UNROLLED = range(13, 18)
"""The row of the state in force; how many states and events are new; how often a parameter changed; motions of
cycles.
"""
LINES_LEFT, ROWS, MOST_UNROLLED, LONGEST = range(18, 22)
"""Lines to do; motions there may be; motions of cycles there may be; bytes of a line."""
LINUXCNC, COMPUTES, TOOL_CHANGES, EXTENDED = range(22, 26)
"""Whether the control is LinuxCNC; knows expressions as it does; changes tools; knows G97, G98, G99."""
WORK_OFFSET, UNITS, LENGTH_FREE, SURFACE = range(26, 30)
"""A hundred times the G codes of work offset and units in force; whether no tool length is, and constant surface
speed.
"""
CYCLE, CYCLED = range(30, 32)
"""The cycle in force (0 = none); whether one was done here."""
KNOWN = 32
"""Six: see `Control.known`."""
INTS = KNOWN + 6

FEED, SPEED, SCALE, BARE, DWELL_WHOLE, DWELL_POINT = range(6)
"""mm/min (NaN = not said), S, mm a unit, mm a unit of numbers without a point, seconds of a unit of P likewise."""
CYCLE_Z, CYCLE_R, CYCLE_P, CYCLE_Q, INITIAL = range(6, 11)
"""Words that stay in a cycle, program units, NaN = none; the height at which its run began."""
PLACE, SHIFT = 11, 14
"""Three each: where the point is, and what is added to absolute coordinates, mm."""
REALS = SHIFT + 3

STATE_FIELDS = (PLANE, ABSOLUTE, ARC_ABSOLUTE, SPINDLE, FLOOD, MIST, TOOL, RETRACT)
"""What a row of the new states holds, and then the speed."""
DWELL, TOOL_CHANGE, STOP, OPTIONAL_STOP = range(4)
"""Kinds of a row of events: kind, motions before it, line, value."""
