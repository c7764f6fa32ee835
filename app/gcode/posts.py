"""Posts from their data files: those of the program and those of the user; what is wrong with one is said exactly.

A user's post is a file NAME.toml in the folder `posts` of the settings folder; it stands before one of the program's of
that name. With `extends = "linuxcnc"` it says only what differs from that post; where it is named like the post that it
extends, it extends the program's own.
"""

from __future__ import annotations

import re
import string
from dataclasses import dataclass, fields, is_dataclass, replace
from enum import Enum
from pathlib import Path
from typing import Any

from ..core.errors import InputError
from ..core.file_bytes import FileBytes
from ..core.resources import resource
from ..core.settings import config_folder
from ..core.toml_tables import read_tree, tables_of
from ..model.part import Units
from .interpreter.dialect import Dialect

LETTERS = ("N", "G", "X", "Y", "Z", "I", "J", "F")

EVERYWHERE = frozenset({"units", "blending", "program"})

WITH_TOOL = EVERYWHERE | {
    "tool",
    "speed",
    "spindle_on",
    "dwell_s",
    "dwell_ms",
    "coolant_on",
    "coolant_off",
    "preselect",
}

COUNTS = frozenset({"program", "tool", "speed", "dwell_ms"})

FIELDS = {"tool": WITH_TOOL | {"clearance"}, "leave": WITH_TOOL}

_COMPENSATION = {
    "left": frozenset({"tool"}),
    "right": frozenset({"tool"}),
    "off": frozenset[str](),
    "register": frozenset({"tool", "radius", "diameter"}),
}

RANGES = {
    "decimals": (0, 6),
    "comments.width": (60, 250),
    "numbers.start": (0, 99999),
    "numbers.step": (1, 1000),
    "arcs.largest_sweep_deg": (60, 359),
    "arcs.smallest_radius_mm": (1e-6, 1),
    "arcs.largest_radius_mm": (10, 1e9),
    "arcs.radius_mismatch_mm": (0.0005, 10),
    "blending.tolerance_mm": (0, 10),
    "spindle.dwell_s": (0, 600),
    "program.number": (1, 7999),
    "drilling.peck_gap_mm": (0, 10),
    "drilling.chip_gap_mm": (0, 10),
}


def post_names() -> tuple[str, ...]:
    """Return the names of all posts, the user's among them, sorted."""
    return tuple(sorted(_own_posts().keys() | _user_posts().keys()))


def post_titles() -> dict[str, str]:
    """Return the title of every post by its name; a damaged one tells that it cannot be used."""
    return {name: _title(name) for name in post_names()}


def load_post(name: str) -> Post:
    """Return the post of this name.

    Raises:
        InputError: there is no such post, or its file is not as app/gcode/posts.py says.
    """
    path = _found(name, ())
    if path is None:
        raise InputError(f"There is no post {name!r}; choose one of {', '.join(post_names())}.")
    return read_post(path)


def comes_with_program(post: Post) -> bool:
    """Tell whether a post is one of the program's own, word for word, rather than the user's."""
    return any(post == read_post(path) for path in _own_posts().values())


def read_post(path: Path) -> Post:
    """Return the post in a file.

    Raises:
        InputError: the text is no TOML, or a key is missing, unknown, of the wrong kind or out of its range; or it
            extends a post that there is not, or itself.
    """
    data = _bytes(path)
    post: Post = tables_of(Post, _tree(path, ()), FileBytes(path.name, data), RANGES)
    _check_signs(replace(post, title=""), f"{path.name}: ")
    _check_words(post, path.name)
    _check_nurbs(post, path.name)
    _check_templates(post, path.name)
    return post


def _own_posts() -> dict[str, Path]:
    return {path.stem: path for path in resource("posts").glob("*.toml")}


def _user_posts() -> dict[str, Path]:
    return {path.stem: path for path in (config_folder() / "posts").glob("*.toml")}


def _title(name: str) -> str:
    """Return the title of a post."""
    try:
        return load_post(name).title
    except InputError:
        return f"{name} (cannot be used)"


def _found(name: str, seen: tuple[Path, ...]) -> Path | None:
    """Return the file of a post, the user's before the program's own, but none of those that are seen already."""
    return next(
        (posts[name] for posts in (_user_posts(), _own_posts()) if name in posts and posts[name] not in seen), None
    )


def _bytes(path: Path) -> bytes:
    """Return a post's file."""
    try:
        return path.read_bytes()
    except OSError as error:
        raise InputError(f"{path.name} cannot be read: {error.strerror}.") from error


def _tree(path: Path, seen: tuple[Path, ...]) -> dict[str, Any]:
    """Return what a post's file says, laid over the post that it extends."""
    tree = read_tree(path.name, _bytes(path))
    if "extends" not in tree:
        return tree
    name = tree.pop("extends")
    base = _found(name, (*seen, path)) if isinstance(name, str) else None
    if base is None:
        raise InputError(
            f"{path.name}: extends is {name!r}; expected is the name of another post: {', '.join(post_names())}."
        )
    return _laid_over(_tree(base, (*seen, path)), tree)


def _laid_over(below: dict[str, Any], above: dict[str, Any]) -> dict[str, Any]:
    """Return two trees of tables as one; where both have a key, the upper one says."""
    both = {
        key: _laid_over(below[key], above[key])
        for key in above
        if isinstance(above[key], dict) and isinstance(below.get(key), dict)
    }
    return below | above | both


def _check_signs(table: Any, place: str) -> None:
    """Check that every text but the title is one line of ASCII, as programs are."""
    for field in fields(table):
        value = getattr(table, field.name)
        texts = value if isinstance(value, tuple) else (value,) if isinstance(value, str) else ()
        if is_dataclass(value):
            _check_signs(value, f"{place}{field.name}.")
        for text in texts:
            if not (text.isascii() and text.isprintable()):
                raise InputError(
                    f"{place}{field.name} has {text!r}; programs are lines of ASCII, so other signs cannot stand here."
                )


def _check_words(post: Post, file: str) -> None:
    """Check what a single key cannot tell: letters, the four motions, like digits for the two axes of the plane."""
    order = post.words.order
    odd = next((each for n, each in enumerate(order) if each not in LETTERS or each in order[:n]), None)
    missing = [letter for letter in LETTERS if letter not in order]
    if odd is not None or missing:
        what = f"lacks {', '.join(missing)}" if odd is None else f"has {odd!r}{' twice' * (odd in LETTERS)}"
        raise InputError(f"{file}: words.order {what}; expected is each of {', '.join(LETTERS)} once.")
    if len(post.words.motion) != 4:
        raise InputError(
            f"{file}: words.motion has {len(post.words.motion)} texts; expected are rapid, line, clockwise and "
            "counter-clockwise arc."
        )
    for name, digits in (("mm", post.decimals.mm), ("inch", post.decimals.inch)):
        if digits.X != digits.Y or digits.I != digits.J or digits.I < digits.X or digits.Z < digits.X:
            raise InputError(
                f"{file}: decimals.{name} must be alike for X and Y, and for I and J, and I and Z not less than X."
            )


def _check_nurbs(post: Post, file: str) -> None:
    """Check that a form of NURBS has its word."""
    if (post.nurbs.form is NurbsForm.NONE) != (not post.nurbs.word):
        raise InputError(
            f"{file}: nurbs.word is {post.nurbs.word!r} for the form {post.nurbs.form.value!r}; expected is a G word, "
            "or '' for the form 'none'."
        )


def _check_templates(post: Post, file: str) -> None:
    """Check that templates name only fields that there are."""
    _check_template(post.blending.blend, frozenset({"blend"}), f"{file}: blending.blend")
    _check_template(post.drilling.wait, frozenset({"dwell_s", "dwell_ms"}), f"{file}: drilling.wait")
    for key, known in _COMPENSATION.items():
        _check_template(getattr(post.compensation, key), known, f"{file}: compensation.{key}")
    _check_template(post.drilling.tap_start, frozenset({"tool", "speed"}), f"{file}: drilling.tap_start")
    for field in fields(ProgramLines):
        if field.name != "number":
            for template in getattr(post.program, field.name):
                _check_template(template, FIELDS.get(field.name, EVERYWHERE), f"{file}: program.{field.name}")


def _check_template(template: str, known: frozenset[str], place: str) -> None:
    """Check the fields of one template, and that it can be filled in."""
    try:
        used = {name: spec for _, name, spec, _ in string.Formatter().parse(template) if name is not None}
    except ValueError as error:
        raise InputError(f"{place}: {template!r} has a brace without its partner.") from error
    if used.keys() - known:
        raise InputError(
            f"{place}: {{{min(used.keys() - known)}}} in {template!r} is not known; expected are "
            f"{', '.join(sorted(known))}."
        )
    if any(spec and (name not in COUNTS or not re.fullmatch("0[1-9]", spec)) for name, spec in used.items()):
        raise InputError(
            f"{place}: {template!r} cannot be filled in; only {', '.join(sorted(COUNTS & known))} can have zeros "
            "before, as in {program:04}."
        )


# What there is to know about a control's dialect: the shape of a post's data file.


class ArcCentre(Enum):
    """What the I and J words of an arc count from."""

    INCREMENTAL = "incremental"
    ABSOLUTE = "absolute"


class NurbsForm(Enum):
    """How the control is told of a NURBS.

    NONE: not at all. BEZIER: planar polynomial pieces of degree 3, four control points each, without knots (LinuxCNC).
    KNOTS: every control point with its knot and its weight, the last knots alone (Fanuc).
    """

    NONE = "none"
    BEZIER = "bezier"
    KNOTS = "knots"


class Coolant(Enum):
    """What the coolant does while a tool cuts."""

    NONE = "none"
    FLOOD = "flood"
    MIST = "mist"


@dataclass(frozen=True, slots=True)
class UnitWords:
    """G words of the length units."""

    mm: str
    inch: str


@dataclass(frozen=True, slots=True)
class WordRules:
    """How a block is spelled.

    Attributes:
        order: letters of a motion block in the order of writing.
        motion: G words of rapid, line, clockwise arc, counter-clockwise arc.
        modal_motion: leave the G word out where it is that of the block before.
        trailing_zeros: write every decimal, "X10.0000"; else only those that count, and the point: "X10.".
        feed_point: F has a decimal point always: controls that count whole numbers in thousandths need it.
    """

    order: tuple[str, ...]
    motion: tuple[str, ...]
    modal_motion: bool
    trailing_zeros: bool
    feed_point: bool


@dataclass(frozen=True, slots=True)
class WordDecimals:
    """Digits after the decimal point of each word; every word but F keeps its point.

    Attributes:
        X, Y, Z: positions, out units; X and Y alike.
        I, J: arc centres, out units; alike.
        F: feed rate, out units a minute.
    """

    X: int
    Y: int
    Z: int
    I: int  # noqa: E741 - the word's own letter
    J: int
    F: int


@dataclass(frozen=True, slots=True)
class Decimals:
    """Digits of each word, by the program's units."""

    mm: WordDecimals
    inch: WordDecimals


@dataclass(frozen=True, slots=True)
class CommentRules:
    """How a comment is marked.

    Attributes:
        open, close: what stands before and behind; close may be "".
        width: longest text between the two, characters; longer text goes on in another comment.
        capitals: the control knows capital letters alone.
        signs: what it takes beside letters and digits; a comma stands for any other.
    """

    open: str
    close: str
    width: int
    capitals: bool
    signs: str


@dataclass(frozen=True, slots=True)
class Numbers:
    """N words: whether, from where, and how far apart."""

    use: bool
    start: int
    step: int


@dataclass(frozen=True, slots=True)
class Arcs:
    """Which arcs the control takes.

    Attributes:
        centre: what I and J count from.
        largest_sweep_deg: longer arcs are split into equal pieces, in [60, 359]; full circles always are.
        smallest_radius_mm, largest_radius_mm: arcs of other radii become lines.
        radius_mismatch_mm: the control refuses arcs whose two radii differ by more.
    """

    centre: ArcCentre
    largest_sweep_deg: float
    smallest_radius_mm: float
    largest_radius_mm: float
    radius_mismatch_mm: float


@dataclass(frozen=True, slots=True)
class BlendingWords:
    """How the control may round corners.

    Attributes:
        tolerance_mm: the farthest it may leave the path where it blends; where no word says so, what its own setting is
            taken as. 0: it never leaves the path.
        blend: template of the block that says so, with the field {blend} in out units; without the field, or "", the
            control blends by its own setting, if it does.
        exact: block that forbids it, or "" where the control has none.
    """

    tolerance_mm: float
    blend: str
    exact: str


@dataclass(frozen=True, slots=True)
class SpindleRules:
    """How long the spindle takes to reach its speed, s."""

    dwell_s: float


@dataclass(frozen=True, slots=True)
class CoolantWords:
    """What the coolant does, and its M words."""

    use: Coolant
    flood: str
    mist: str
    off: str


@dataclass(frozen=True, slots=True)
class ProgramLines:
    """Blocks round the motion, as templates; a block whose text comes out empty is left out.

    Fields: {units} {blending} {program} in every block; in `tool` and `leave` also {tool} {speed} {dwell_s} {dwell_ms}
    {coolant_on} {coolant_off} {preselect}; in `tool` {clearance}. {program} is the program's number: the digits at the
    end of the part's name where they are one from 1 to 7999, else `number`. "{program:04}" puts zeros before it; so it
    goes with {tool}, {speed} and {dwell_ms}. {preselect} is the T word of the tool that comes next, and after the last
    one that of the first; nothing where the program has one tool. A block with {clearance} is the rapid to clearance
    height, as in "G0 G43 H{tool} Z{clearance}".

    Attributes:
        number: of the program, where the part's name has none.
        top: above the header's comments, such as "%" and an O word, which get no N word.
        start: before the first tool.
        tool: change to a tool, its length, spindle on; the tool stands at clearance.
        leave: after the last move of a tool, at clearance height.
        home: goes to the machine's own home along Z; before each tool change, the first one too, and at the end.
        end: behind everything.
    """

    number: int
    top: tuple[str, ...]
    start: tuple[str, ...]
    tool: tuple[str, ...]
    leave: tuple[str, ...]
    home: tuple[str, ...]
    end: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class DrillingWords:
    """Canned cycles; "" where the control has none, or does it in a way that only its own settings tell.

    Attributes:
        drill: down at feed, up at rapid rate.
        peck: the same in steps of Q, each followed by a rapid up to R and down again to `peck_gap_mm` above the last
            one.
        chip_break: the same in steps of Q, each followed by a rapid up by `chip_gap_mm`.
        dwell: as drill, with a wait at the bottom, whose P is that of `wait`. wait: template of a wait, fields
            {dwell_s}, {dwell_ms}.
        feed_out: down at feed, up to R at feed.
        tap: down at feed, up at the same feed with the spindle turning back; "" = the control cannot.
        tap_left: the same with the spindle turning counter-clockwise on the way in.
        tap_start: template of the block before either, fields {tool}, {speed}; "" = none.
        tap_to_initial: it taps out to R and goes up from there at rapid rate, if it is to; else it taps all the way
        out.
        to_initial, to_r: whether holes end at the height where the first one began, or at R.
        cancel: ends the cycle.
        peck_gap_mm, chip_gap_mm: what the control's own settings are.
    """

    drill: str
    peck: str
    chip_break: str
    dwell: str
    wait: str
    feed_out: str
    tap: str
    tap_start: str
    tap_to_initial: bool
    to_initial: str
    to_r: str
    cancel: str
    peck_gap_mm: float
    chip_gap_mm: float
    tap_left: str = ""


@dataclass(frozen=True, slots=True)
class NurbsWords:
    """How a NURBS is written: its form, the G word that begins it, the block that ends it, "" where the next G word
    does.
    """

    form: NurbsForm
    word: str
    end: str


@dataclass(frozen=True, slots=True)
class CompensationWords:
    """Blocks that let the control offset the path by what stands in the tool's register; "" = it cannot.

    Attributes:
        left, right: templates with the field {tool}: the tool is at the left of the contour, at its right.
        off: block that ends it.
        register: comment for the operator: what stands in the register of a tool by whose whole radius the control
            offsets, with the fields {tool} {radius} {diameter}, lengths with their unit.
    """

    left: str = ""
    right: str = ""
    off: str = ""
    register: str = "Register D{tool}: radius {radius}, or diameter {diameter} where the control takes that"


@dataclass(frozen=True, slots=True)
class Post:
    """One control's dialect.

    Attributes:
        title: the control's name for people.
        extension: of its program files, with the dot.
        dialect: in which its programs are read.
        file_per_tool: it changes no tools, so each tool has a program of its own.
    """

    title: str
    extension: str
    dialect: Dialect
    file_per_tool: bool
    units: UnitWords
    words: WordRules
    decimals: Decimals
    comments: CommentRules
    numbers: Numbers
    arcs: Arcs
    blending: BlendingWords
    spindle: SpindleRules
    coolant: CoolantWords
    program: ProgramLines
    drilling: DrillingWords
    nurbs: NurbsWords
    compensation: CompensationWords = CompensationWords()

    def digits(self, units: Units) -> WordDecimals:
        """Return the digits of each word in a program of these units."""
        return self.decimals.inch if units is Units.INCH else self.decimals.mm
