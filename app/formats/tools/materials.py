"""Materials of stock: those in `resources/materials.toml`, and the user's own in a file of that name beside the
settings.
"""

from __future__ import annotations

from dataclasses import dataclass

from ...core.errors import InputError
from ...core.resources import resource
from ...core.settings import config_folder
from ...core.toml_tables import QUOTED, brief, known_words, read_tables
from ...model.stock_material import StockMaterial

FORMAT = 1
_RANGES = {
    "format": (1.0, float(FORMAT)),
    **{f"material.{key}": (1e-3, 1e5) for key in ("hss_speed", "carbide_speed", "cutting_force")},
}


@dataclass(frozen=True, slots=True)
class _MaterialsFile:
    format: int
    material: tuple[StockMaterial, ...] = ()


def read_materials(name: str, data: bytes) -> tuple[StockMaterial, ...]:
    """Return the materials of a TOML text, in its order.

    Raises:
        InputError: file, line and key, what is wrong and what is expected.
    """
    return read_tables(_MaterialsFile, name, data, _RANGES).material


def stock_materials() -> tuple[StockMaterial, ...]:
    """Return every material: those that ship, replaced by the user's own of the same word, then his others.

    Raises:
        InputError: the user's file cannot be read.
    """
    paths = [resource("materials.toml")]
    own = config_folder() / "materials.toml"
    paths += [own] * own.is_file()
    found: dict[str, StockMaterial] = {}
    for path in paths:
        try:
            data = path.read_bytes()
        except OSError as error:
            raise InputError(f"Cannot read {path}: {error.strerror}; correct it, or take it away.") from error
        found |= {_plain(each.word): each for each in read_materials(path.name, data)}
    return tuple(found.values())


def stock_material(word: str) -> StockMaterial:
    """Return a material by its word or its title, in any case.

    Raises:
        InputError: there is none of that name; it names those that there are.
    """
    materials = stock_materials()
    for each in materials:
        if _plain(word) in (_plain(each.word), _plain(each.title)):
            return each
    known = known_words(word, [each.word for each in materials])
    raise InputError(
        f"'{brief(word, QUOTED)}' is no material; use {known}, or add it to materials.toml beside your settings."
    )


def _plain(word: str) -> str:
    return " ".join(word.replace("-", " ").replace("_", " ").split()).casefold()
