"""What a file is told to be by its name, where a film wants an NC program."""

from __future__ import annotations

from ...core.errors import InputError
from ...formats.readers import known_format
from ...usecases.pixels.options import is_picture
from ...usecases.scene.solid_files import is_solid


def ensure_program(name: str) -> None:
    """Refuse what is no NC program before its first line is taken for a faulty one.

    Raises:
        InputError: the name is that of a drawing, a picture, a solid or a scene.
    """
    kinds = {
        "a drawing": known_format(name) is not None,
        "a picture": is_picture(name),
        "a solid": is_solid(name),
        "a scene or a job": name.lower().endswith(".toml"),
    }
    kind = next((kind for kind, so in kinds.items() if so), None)
    if kind is not None:
        raise InputError(
            f"{name} is {kind}, and this text is shown on an NC program: compute it, and take the program that comes "
            "of it."
        )
