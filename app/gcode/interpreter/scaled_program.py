"""G51 and G50, which scale a program about a point, and G51.1 and G50.1, which mirror it along its axes: as Fanuc, Haas
and Mach3 have them, as far as each control's own manual says it clearly.

Both are done to the words of a block, in program coordinates: what follows them counts from where they lead.
"""

from __future__ import annotations

from .block import Block
from .codes import AXES, CYCLES, ROTARY, ModalGroup
from .control import Control
from .dialect import Dialect
from .offsets import Place, place_of
from .program import BlockFault
from .program_scale import ProgramScale

MIRROR, UNMIRROR = "G51.1", "G50.1"

_LARGEST = 999.999
"""Factor, as Haas and Fanuc have it."""

_FACTOR_OF_WHOLE = 1e-3
"""What a factor without a decimal point counts in on Fanuc, unless a parameter says hundredths of that."""

_STAYS = 1e-9
"""mm that a place may move and still be where it was."""

_ZERO_MOVES = frozenset({"G10", "G52", "G92", "G92.1", "G92.2", "G92.3"})

_TO_THE_MACHINE = ("G28", "G30", "G53")

_FOLLOWED = frozenset({"G0", "G1", "G2", "G3", "G80"}) | CYCLES - {"G76", "G87"}
"""Motions whose words are known to be scaled, or not."""

_OTHER_SIDE = {"G41": "G42", "G42": "G41"}


def mirror(control: Control, block: Block) -> None:
    """Obey G51.1 and G50.1, and take their axis words; G50.1 without any ends all mirroring.

    Raises:
        BlockFault: it is no axis, one that is mirrored already, or stands where controls take it differently.
    """
    code = block.codes[ModalGroup.MIRRORING]
    at = dict(control.axis_words(block))
    before = control.scale
    if code == UNMIRROR:
        named = frozenset(at) or before.mirrored
        after = before.unmirrored(named & before.mirrored)
    else:
        _check_start(control, block, code)
        if not at:
            raise BlockFault("G51.1 needs the axis that it mirrors along, such as X0.", letter="g")
        if before.mirrored & at.keys():
            raise BlockFault("G51.1 along an axis that is mirrored already; write G50.1 before.", letter="g")
        after = before.mirrored_at(at)
    _take(control, block, after)


def scale(control: Control, block: Block) -> None:
    """Obey G51 and G50, and take their words.

    Raises:
        BlockFault: a factor is missing or out of range, or G51 stands where controls take it differently.
    """
    if block.codes[ModalGroup.SCALING] == "G50":
        if control.scale.scaled:
            _check_alone(block, "G50", AXES)
            _take(control, block, ProgramScale())
        return
    mach3 = control.options.dialect is Dialect.MACH3
    if control.scale.scaled and not mach3:
        raise BlockFault("G51 while the program is scaled already; write G50 before.", letter="g")
    _check_start(control, block, "G51")
    after = _scale_of_mach3(block) if mach3 else control.scale.about(_centre(control, block), _factors(control, block))
    _take(control, block, after)


def _take(control: Control, block: Block, after: ProgramScale) -> None:
    """Put another scale in force: axes may then not be where the control takes them to be."""
    if control.side:
        raise BlockFault("scaling and mirroring change while cutter compensation is on; write G40 before.", letter="g")
    here = control.program_place
    moved = zip(control.scale.of(here), after.of(here), strict=True)
    control.astray |= {axis for axis, (old, new) in enumerate(moved) if abs(old - new) > _STAYS}
    control.scale = after
    control.spelling_changed()
    for letter in AXES + ROTARY + "ijkp":
        block.values.pop(letter, None)


def _check_alone(block: Block, code: str, words: str = "") -> None:
    if ModalGroup.MOTION in block.codes or block.codes.get(ModalGroup.ONCE) or block.has(words):
        raise BlockFault(f"{code} beside a motion is not followed; write it in a block of its own.", letter="g")


def _check_start(control: Control, block: Block, code: str) -> None:
    _check_alone(block, code)
    if control.offsets.turn or (ModalGroup.TURNING in block.codes and block.codes[ModalGroup.TURNING] == "G68"):
        raise BlockFault(f"{code} while the program is turned (G68); write G69 before.", letter="g")
    if (control.scale.scaled and code == MIRROR) or (control.scale.mirrored and code == "G51"):
        raise BlockFault("scaling and mirroring together are not followed; write one of them out.", letter="g")
    if not control.modal.absolute and block.has(AXES):
        raise BlockFault(f"{code} under G91 means another centre on each control; write it under G90.", letter="g")


def _scale_of_mach3(block: Block) -> ProgramScale:
    """Return the scale of Mach3: X, Y and Z are factors, about the program's zero."""
    if not block.has(AXES):
        raise BlockFault("G51 needs a factor; write X, Y or Z.", letter="g")
    factors = [block.values.get(letter, 1.0) for letter in AXES]
    if not all(0.0 < value <= _LARGEST for value in factors):
        raise BlockFault(f"a factor of G51 must be greater than 0 and no more than {_LARGEST}.", letter="xyz")
    return ProgramScale().about((0.0, 0.0, 0.0), place_of(factors))


def _centre(control: Control, block: Block) -> Place:
    """Return what the program is scaled about, program coordinates, mm; the tool's place where no word says it."""
    place = list(control.program_place)
    for axis, value in control.axis_words(block):
        place[axis] = value
    return place_of(place)


def _factors(control: Control, block: Block) -> Place:
    """Return the factors of P, or of Fanuc's I, J and K.

    Raises:
        BlockFault: none is there, so that a setting of the machine counts, or one is out of range.
    """
    own = block.has("ijk")
    if own and (block.has("p") or control.options.dialect is Dialect.HAAS):
        raise BlockFault("G51 takes its factor by P, and no I, J or K beside it.", letter="ijk")
    if not own and not block.has("p"):
        raise BlockFault("G51 without a factor counts with one of the machine's settings; write P.", letter="g")
    letters = "ijk" if own else "ppp"
    factors = [_factor(control, block, letter) for letter in letters]
    if own and not all(letter in block.values for letter in letters):
        control.warn("an axis that G51 names no factor for takes the machine's own; 1 is taken.", "g")
    return place_of(factors)


def _factor(control: Control, block: Block, letter: str) -> float:
    value = block.values.get(letter)
    if value is None:
        return 1.0
    if letter in block.whole and control.options.dialect is Dialect.FANUC:
        value *= _FACTOR_OF_WHOLE
        control.warn("a factor of G51 without a decimal point counts in thousandths here.", letter)
    if not 0.0 < abs(value) <= _LARGEST or (letter == "p" and value < 0.0):
        raise BlockFault(f"a factor of G51 must be greater than 0 and no more than {_LARGEST}.", letter=letter)
    return value


def turn_sides_over(control: Control, block: Block) -> None:
    """Let G41 be G42 and G42 be G41 where one axis of X and Y is mirrored."""
    code = block.codes.get(ModalGroup.RADIUS)
    if code in _OTHER_SIDE and control.scale.turns_over(0, 1):
        block.codes[ModalGroup.RADIUS] = _OTHER_SIDE[code]


def spell_scaled(control: Control, block: Block) -> None:
    """Put in the place of a block's words what they come to under G51 and G51.1.

    Raises:
        BlockFault: controls do differently what the block asks for, or their manuals do not say.
    """
    once = block.codes.get(ModalGroup.ONCE)
    _warn_of_first_move(control, block, once)
    if control.scale.plain:
        return
    _check_scaled(control, block, once)
    motion = block.codes.get(ModalGroup.MOTION, control.motion)
    if motion in ("G2", "G3"):
        _spell_arc(control, block)
    for axis, value in list(control.axis_words(block)):
        if control.scale.changes(axis):
            shift = control.scale.shifts[axis] if control.modal.absolute else 0.0
            _put(control, block, AXES[axis], control.scale.factors[axis] * value + shift)


def _check_scaled(control: Control, block: Block, once: str | None) -> None:
    code = once or block.codes.get(ModalGroup.OFFSET) or block.codes.get(ModalGroup.TURNING)
    if once in _ZERO_MOVES or ModalGroup.OFFSET in block.codes or block.codes.get(ModalGroup.TURNING) == "G68":
        raise BlockFault(f"{code} while the program is scaled or mirrored is not followed.", letter="g")
    named = [axis for axis, letter in enumerate(AXES) if letter in block.values]
    if once in _TO_THE_MACHINE and any(control.scale.changes(axis) for axis in named or range(3)):
        raise BlockFault(f"{once} while the program is scaled or mirrored is not followed.", letter="g")
    motion = block.codes.get(ModalGroup.MOTION, control.motion)
    if motion not in _FOLLOWED and (named or ModalGroup.MOTION in block.codes):
        raise BlockFault(f"{motion} while the program is scaled or mirrored is not followed.", letter="g")
    if motion in CYCLES and (control.scale.changes(2) or control.polar):
        raise BlockFault("a canned cycle while Z is scaled or mirrored is not followed.", letter="g")
    if control.polar and block.has("xy"):
        raise BlockFault("G16 while the program is scaled or mirrored is not followed.", letter="xy")


def _spell_arc(control: Control, block: Block) -> None:
    """Scale an arc's centre or radius."""
    u, v, _ = control.modal.plane.axes
    scale_ = control.scale
    if abs(scale_.factors[u]) != abs(scale_.factors[v]):
        raise BlockFault("an arc under two factors of G51 is no arc, and controls differ in what they do.", letter="g")
    if block.has("r"):
        if control.options.dialect is Dialect.MACH3:
            raise BlockFault("R of an arc under G51 is not followed; write its centre.", letter="r")
        _put(control, block, "r", (control.length(block, "r") or 0.0) * abs(scale_.factors[u]))
    for axis in (u, v):
        value = control.length(block, "ijk"[axis])
        if value is not None:
            shift = scale_.shifts[axis] if control.modal.arc_absolute else 0.0
            _put(control, block, "ijk"[axis], scale_.factors[axis] * value + shift)


def _put(control: Control, block: Block, letter: str, value: float) -> None:
    block.values[letter] = value / control.unit
    block.whole.discard(letter)


def _warn_of_first_move(control: Control, block: Block, once: str | None) -> None:
    """Tell of a move along axes that are not where the scale takes them to be, unless it says where all of them go."""
    named = {axis for axis, letter in enumerate(AXES) if letter in block.values}
    if once in _TO_THE_MACHINE:
        control.astray -= named or {0, 1, 2}
        return
    if not control.astray or not named or once in _ZERO_MOVES:
        return
    if not control.modal.absolute or not control.astray <= named:
        control.warn(
            "the first move behind G51, G50, G51.1 or G50.1 is known for sure only where it says all axes under G90.",
            "g",
        )
    control.astray.clear()
