"""Posts from their data files: those of the program and those of the user; what is wrong with one is said exactly.

A user's post is a file NAME.toml in the folder `posts` of the settings folder; it stands before one of the program's of
that name. With `extends = "linuxcnc"` it says only what differs from that post; where it is named like the post that it
extends, it extends the program's own.
"""

from __future__ import annotations

import re
import string
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any

from ...core.errors import InputError
from ...core.file_bytes import FileBytes
from ...core.resources import resource
from ...core.settings import config_folder
from ...core.toml_tables import read_tree, tables_of
from .post import NurbsForm, Post, ProgramLines

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
        InputError: there is no such post, or its file is not as app/gcode/posts/post.py says.
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
