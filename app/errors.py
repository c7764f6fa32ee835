"""Errors that reach the user as one sentence: what is wrong, where, and what to do."""


class HitofudeError(Exception):
    """Base of every error that the program raises on purpose; its text is shown to the user as it is."""


class ParameterError(HitofudeError, ValueError):
    """A parameter is out of its range. The text names the parameter, its value with unit, and the range."""


class InputError(HitofudeError):
    """A file or a typed text cannot be used. The text names the place (file:line, entity, coordinates)."""


class GeometryError(HitofudeError):
    """A shape cannot be worked on as it is drawn. The text names the contour and coordinates."""


class Cancelled(HitofudeError):
    """The user asked a job to stop; nothing it was computing is kept."""

    def __init__(self) -> None:
        super().__init__("Cancelled.")
