"""The operations of a job file: the keys of each kind are its parameters, as `app.model.fields` declares them."""

from __future__ import annotations

from collections.abc import Iterator

from ...core.wording import together
from ...model.curve_selectors import on_layers
from ...model.fields import built, declared_of, parameters_of
from ...model.operation import Operation
from ...model.operation_kinds import ALIASES, OPERATION_KINDS, OperationAlias, declared, parameters
from .tables import JobTable, read_texts, reader_of, word


def operations_of(tables: list[JobTable], kept: bool = False) -> Iterator[Operation]:
    """Yield the operations that tables [[operation]] describe.

    Args:
        tables: one each.
        kept: a key may be there that has no effect on an operation of this kind.

    Raises:
        InputError: a key is missing, unknown, out of its range, or has no effect.
    """
    for table in tables:
        given = tuple(table.values)
        called = str(table.values.get("kind")).strip().lower()
        also = {other: alias.kind for other, alias in ALIASES.items() if other not in OPERATION_KINDS}
        table.take("kind", word(OPERATION_KINDS, "kind of operation", also))
        for key, placed in declared().items():
            table.take(key, reader_of(placed))
        _take_layers(table)
        table.done(", ".join(("kind", *declared())))
        for key in ("kind", "tool"):
            if key not in table.taken:
                raise table.error(key, f"is missing in this [[{table.path}]]; add {key} = …")
        kind: type[Operation] = table.taken.pop("kind")
        if called in also:
            _take_alias(table, ALIASES[called], given)
        _refuse_strange_keys(table, kind, given, kept)
        operation = table.text.built(table.path, table.index, lambda kind=kind, taken=table.taken: built(kind, taken))  # type: ignore[misc]
        if not kept:
            _refuse_idle_values(table, operation, given)
        yield operation


def _take_alias(table: JobTable, alias: OperationAlias, given: tuple[str, ...]) -> None:
    """Put in what the other word for a kind says."""
    if alias.key in given and table.taken[alias.key] is not alias.value:
        raise table.error(alias.key, f'is told by the kind already; take it out, or write kind = "{alias.kind}"')
    table.taken[alias.key] = alias.value


def _take_layers(table: JobTable) -> None:
    """Read layers, as an operation named them before it could name curves."""
    if "layers" in table.values and "curves" in table.taken:
        raise table.error("layers", 'goes into curves, as "layer:NAME"; take it out')
    table.take("layers", lambda value: on_layers(read_texts(value)), "curves")


def _refuse_strange_keys(table: JobTable, kind: type[Operation], given: tuple[str, ...], kept: bool) -> None:
    known = {"kind", "layers", *(declared_of(kind) if kept else parameters_of(kind))}
    for key in given:
        if key not in known:
            raise table.error(
                key,
                f"belongs to {together(each.WORD for each in parameters()[key].kinds)} operations; "
                f"remove it from this {kind.WORD} operation",
            )


def _refuse_idle_values(table: JobTable, operation: Operation, given: tuple[str, ...]) -> None:
    """Refuse what would have an effect only together with something else; its default may stand anywhere."""
    for key, placed in parameters_of(type(operation)).items():
        needs = placed.parameter.needs
        if key in given and needs is not None and table.taken[key] != placed.default and not needs.holds(operation):
            raise table.error(key, f"has no effect without {needs.with_}; {needs.remedy}, or take it out")
