"""The operations that rules for layers make of a drawing."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

from ...core.errors import InputError
from ...core.options import option
from ...model.curve_selectors import OnLayer
from ...model.finding import Finding, FindingKind
from ...model.layer_names import known_layers
from ...model.layer_rules import LayerRule, depth_in
from ...model.operation import Operation
from ...model.part import Layer, Part
from .options import MakeOptions

_NAMED = 8
"""Layers that a sentence names."""


@dataclass(frozen=True)
class RuledOptions:
    """Options whose job has the operations that rules have made.

    Attributes:
        findings: layers that no rule takes, and rules that take none.
        lines: what was made of each layer, for people.
    """

    options: MakeOptions
    findings: tuple[Finding, ...] = ()
    lines: tuple[str, ...] = ()


def with_layer_rules(part: Part, options: MakeOptions) -> RuledOptions:
    """Return options with an operation for each layer that a rule takes, behind those that the job has, rule by rule.

    Raises:
        InputError: rules and a proposal are asked for, or no rule takes a layer of the drawing.
    """
    if not options.rules or options.job is None:
        return RuledOptions(options)
    if options.propose is not None:
        raise InputError(
            f"{option('propose')} does not go with rules for layers, which say the operations; leave one of the "
            "two away."
        )
    job, layers = options.job, _layers(part, options)
    made = [_Made(rule, layer) for rule in options.rules for layer in layers if rule.takes(layer)]
    known = [each for each in made if each.operation is not None]
    if not known:
        names = ", ".join(f"'{layer.name}'" for layer in layers[:_NAMED]) or "none that holds anything"
        raise InputError(
            f"{part.name}: no rule of the template makes an operation; the drawing's layers are {names}: change a "
            "rule's name or colour."
        )
    operations = tuple(each.operation for each in known if each.operation is not None)
    findings = (*_findings(made, layers, options.rules),)
    ruled = replace(options, job=replace(job, operations=(*job.operations, *operations)), rules=())
    return RuledOptions(ruled, findings, tuple(each.line for each in known))


def _layers(part: Part, options: MakeOptions) -> list[Layer]:
    """Return the layers that hold something, and may be machined."""
    assert options.job is not None
    held = {each.layer for each in part.entities}
    known = [layer.name for layer in part.layers]
    kept_out = known_layers((*options.machining.keep_out, *options.job.keep_out_layers), known)
    asked = options.layers or options.job.layer_names
    chosen = known_layers(asked, known)
    return [
        layer
        for layer in part.layers
        if layer.name in held
        and layer.visible
        and layer.name.casefold() not in kept_out
        and (not asked or layer.name.casefold() in chosen)
    ]


@dataclass(frozen=True)
class _Made:
    """A layer that a rule takes."""

    rule: LayerRule
    layer: Layer

    @property
    def operation(self) -> Operation | None:
        """The operation on it; None where its name should tell a depth and does not."""
        operation = self.rule.operation
        depth = depth_in(self.layer.name) if self.rule.depth_in_name else operation.cut.depth
        if depth is None:
            return None
        cut = replace(
            operation.cut, depth=depth, stepdown=min(operation.cut.stepdown, depth), curves=(OnLayer(self.layer.name),)
        )
        return replace(operation, cut=cut)

    @property
    def line(self) -> str:
        """What was made, in words."""
        operation = self.operation
        assert operation is not None
        return (
            f"  layer '{self.layer.name}': {operation.WORD} T{operation.cut.tool}, {operation.cut.depth:g} mm deep"
            f"{', as its name says' if self.rule.depth_in_name else ''}"
        )


def _findings(made: list[_Made], layers: list[Layer], rules: tuple[LayerRule, ...]) -> Iterator[Finding]:
    for each in made:
        if each.operation is None:
            text = (
                f"Layer '{each.layer.name}' is to tell its depth by its name, and does not; call it such as "
                f"'{each.layer.name} 4mm', or give the rule a depth."
            )
            yield Finding(FindingKind.LEFT_OUT, text)
    taken = {each.layer.name for each in made}
    free = [layer.name for layer in layers if layer.name not in taken]
    if free:
        more = f" and {len(free) - _NAMED} more" if len(free) > _NAMED else ""
        names = ", ".join(f"'{name}'" for name in free[:_NAMED])
        text = f"No rule takes {'the layer' if len(free) == 1 else 'the layers'} {names}{more}; nothing is done there."
        yield Finding(FindingKind.LEFT_OUT, text, counts=False, amount=float(len(free)))
    used = {id(each.rule) for each in made}
    for rule in rules:
        if id(rule) not in used:
            text = f"The rule for {rule.words} ({rule.operation.WORD}) takes no layer of this drawing."
            yield Finding(FindingKind.LEFT_OUT, text, counts=False)
