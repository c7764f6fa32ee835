"""Names of layers: which one of a drawing a name means."""

from app.formats.drawing_account import on_layers
from app.model.curves import Line
from app.model.layer_names import known_layers, spelled, typed_pattern
from app.model.part import Entity, Layer, Part


class CountedName(str):
    """A name that counts how often one of its kind is folded."""

    __slots__ = ()
    folded = 0

    def casefold(self) -> str:
        CountedName.folded += 1
        return super().casefold()


def folds(count: int) -> int:
    """Return how often names of layers are folded to find so many of them, by names and in a part."""
    CountedName.folded = 0
    names = [f"layer_x0020_{number}" for number in range(count)]
    layers = [CountedName(f"Layer {number}") for number in range(count)]
    lines = tuple(Entity(number + 1, Line((0, 0), (1, 0)), name) for number, name in enumerate(layers))
    assert len(known_layers(names, layers)) == count
    assert len(on_layers(Part(lines, tuple(map(Layer, layers))), tuple(names), "x.dxf").entities) == count
    return CountedName.folded


def test_looking_for_many_layers_grows_as_their_number() -> None:
    assert folds(40) == 2 * folds(20)


def test_names_mean_layers_as_the_drawing_spells_them() -> None:
    found = spelled(["a_X0020_B", "a_x0020_b", "A B", "c"], ["A b", "d"])
    assert found == {"a_X0020_B": None, "a_x0020_b": "A b", "A B": "A b", "c": None}


def test_letters_that_are_written_as_numbers_are_themselves_in_a_pattern() -> None:
    assert typed_pattern("A_x2A__x0020_*") == "A[*] *"
    assert typed_pattern("_x5B_?_x3F__xD83D__xDE00_") == "[[]?[?]\U0001f600"
