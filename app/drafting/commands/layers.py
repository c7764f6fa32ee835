"""The commands that rename, order and remove layers."""

from __future__ import annotations

from dataclasses import dataclass, replace

from ...core.errors import InputError
from ...core.wording import counted
from ...model.curve_selectors import OnLayer
from ...model.job import Job
from ...model.part import Layer, Part
from ..expressions.arguments import Arguments
from .command import DraftingSession


@dataclass(frozen=True, slots=True)
class RenameLayer:
    """Give a layer another name, which none has yet."""

    layer: str
    to: str
    name: str = "Rename layer"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"Layer {self.layer} is {self.to} now."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session in which everything that named the layer names it anew.

        Raises:
            InputError: there is no such layer, or one has the new name.
        """
        part = session.part
        check_layer(part, self.layer)
        if any(layer.name == self.to for layer in part.layers):
            raise InputError(
                f"There is a layer {self.to} already; choose another name, or put the curves on it with layer."
            )
        layers = tuple(replace(layer, name=self.to) if layer.name == self.layer else layer for layer in part.layers)
        entities = tuple(replace(e, layer=self.to) if e.layer == self.layer else e for e in part.entities)
        notes = tuple(replace(n, layer=self.to) if n.layer == self.layer else n for n in part.notes)
        current = self.to if session.layer == self.layer else session.layer
        return replace(
            session,
            part=replace(part, layers=layers, entities=entities, notes=notes),
            layer=current,
            renamed=(*session.renamed, (self.layer, self.to)),
        )


@dataclass(frozen=True, slots=True)
class RemoveLayer:
    """Take a layer away, with all that is on it."""

    layer: str
    reply: str
    name: str = "Remove layer"

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session without the layer; where it was the current one, the first that is left is.

        Raises:
            InputError: there is no such layer, or no other.
        """
        part = session.part
        check_layer(part, self.layer)
        layers = tuple(layer for layer in part.layers if layer.name != self.layer)
        if not layers:
            raise InputError(f"{self.layer} is the only layer; make another with layer NAME first.")
        entities = tuple(e for e in part.entities if e.layer != self.layer)
        notes = tuple(n for n in part.notes if n.layer != self.layer)
        current = session.layer if session.layer != self.layer else layers[0].name
        left = replace(part, layers=layers, entities=entities, notes=notes, used_id=part.next_id() - 1)
        return replace(session, layer=current).with_part(left)


@dataclass(frozen=True, slots=True)
class OrderLayer:
    """Put a layer right before another, or right behind it."""

    layer: str
    beside: str
    behind: bool
    name: str = "Order layers"

    @property
    def reply(self) -> str:
        """A short sentence for the log."""
        return f"Layer {self.layer} comes {'after' if self.behind else 'before'} {self.beside} now."

    def carried_out(self, session: DraftingSession) -> DraftingSession:
        """Return the session with the layers in another order; what is on them stays as it is.

        Raises:
            InputError: there is no such layer, or both are one.
        """
        part = session.part
        moved, beside = check_layer(part, self.layer), check_layer(part, self.beside)
        if moved is beside:
            raise InputError(f"A layer comes before or after another one; {self.layer} is named twice.")
        layers = [layer for layer in part.layers if layer is not moved]
        layers.insert(layers.index(beside) + self.behind, moved)
        return replace(session, part=replace(part, layers=tuple(layers)))


LayerCommand = RenameLayer | OrderLayer | RemoveLayer


def check_layer(part: Part, name: str) -> Layer:
    """Return a layer of the part by its name.

    Raises:
        InputError: there is none; the sentence names those there are.
    """
    for layer in part.layers:
        if layer.name == name:
            return layer
    raise InputError(f"There is no layer {name}; the drawing has {', '.join(layer.name for layer in part.layers)}.")


def rename(words: Arguments, session: DraftingSession) -> RenameLayer:
    """Give a layer another name."""
    if not words.accept("layer"):
        raise words.wrong("Write rename layer NAME to NAME.")
    old = words.name("the name of a layer")
    if not words.accept("to"):
        raise words.wrong("Write to and the new name of the layer.")
    new = words.name("the new name").strip()
    if not new:
        raise words.wrong("The new name is empty; write a name.")
    return RenameLayer(old, new)


def order(words: Arguments, session: DraftingSession) -> OrderLayer:
    """Put a layer before or after another."""
    usage = "Write order layer NAME before NAME, or after NAME."
    if not words.accept("layer"):
        raise words.wrong(usage)
    layer = words.name("the name of a layer")
    way = words.accept("before", "after")
    if not way:
        raise words.wrong(usage)
    return OrderLayer(layer, words.name("the name of another layer"), way == "after")


def remove(words: Arguments, session: DraftingSession) -> RemoveLayer:
    """Take a layer away, with all that is on it."""
    if not words.accept("layer"):
        raise words.wrong("Write remove layer NAME; curves are taken away with delete.")
    name = words.name("the name of a layer")
    curves = sum(e.layer == name for e in session.part.entities)
    notes = sum(n.layer == name for n in session.part.notes)
    on_it = counted(curves, "curve") + (f" and {counted(notes, 'note')}" if notes else "")
    return RemoveLayer(name, f"Layer {name} removed, with {on_it} on it.")


def with_layer_renamed(job: Job, old: str, new: str) -> Job:
    """Return the job whose operations and keep-out areas call a layer by its new name."""

    def named(names: tuple[str, ...]) -> tuple[str, ...]:
        return tuple(new if name == old else name for name in names)

    operations = tuple(
        replace(
            o, cut=replace(o.cut, curves=tuple(OnLayer(new) if each == OnLayer(old) else each for each in o.cut.curves))
        )
        if OnLayer(old) in o.cut.curves
        else o
        for o in job.operations
    )
    return replace(
        job, operations=operations, layer_names=named(job.layer_names), keep_out_layers=named(job.keep_out_layers)
    )
