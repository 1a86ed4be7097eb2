"""Parameters that two distributions declare differently, by the controllers and managers of a cell."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from cellc.compiler.catalog.catalog_model import ParameterFact
from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.load import load_controller_manager
from cellc.compiler.catalog.parameter_facts import ParameterFacts, is_named
from cellc.compiler.cell.cell import Cell
from cellc.contract.upgrade import UpgradeParameter
from cellc.contract.vocabulary import Distro
from cellc.tools.review.leaves import Leaf

NodeParameters: TypeAlias = Mapping[str, Mapping[str, Leaf]]
"""Parameters by full name of the node, dots for nesting."""
_BESIDE_DEFAULT = {
    "required": "required",
    "one_of": "values that it takes",
    "not_empty": "must not be empty",
    "read_only": "read only",
}


@dataclass(frozen=True, slots=True)
class Declaration:
    """What nodes of a kind declare, and the parameters that the cell gives them before and after."""

    nodes: tuple[str, ...]
    parameters: Mapping[str, ParameterFacts]
    before: Mapping[str, Leaf]
    after: Mapping[str, Leaf]
    written: frozenset[str]


def parameter_changes(
    cell: Cell, target: Distro, was: NodeParameters, now: NodeParameters
) -> tuple[UpgradeParameter, ...]:
    """Return every parameter of a cell that one of two distributions lacks, or declares otherwise.

    Args:
        was: what the cell gives its nodes on its own distribution.
        now: the same on the target.
    """
    return tuple(
        change for declaration in _declarations(cell, was, now) for change in _changes(declaration, cell.distro, target)
    )


def _declarations(cell: Cell, was: NodeParameters, now: NodeParameters) -> Iterator[Declaration]:
    facts = load_controller_manager().value
    assert facts is not None  # package data, held valid by the catalog's tests
    for manager in cell.managers:
        given = (was.get(manager.node, {}), now.get(manager.node, {}))
        yield Declaration((manager.node,), facts.parameters, *given, frozenset())
    kinds: dict[str, tuple[ControllerKind, list[str]]] = {}
    for controller in cell.controllers:
        if controller.declared is not None:
            kinds.setdefault(controller.kind, (controller.declared, []))[1].append(controller.full_name)
    every = tuple(name for _, names in kinds.values() for name in names)
    written = {controller.full_name: frozenset(controller.written_parameters) for controller in cell.controllers}
    if every:
        yield _of_nodes(every, facts.controller_parameters, was, now, written)
    for kind, names in kinds.values():
        yield _of_nodes(tuple(names), kind.parameters, was, now, written)


def _of_nodes(
    names: Sequence[str],
    parameters: Mapping[str, ParameterFacts],
    was: NodeParameters,
    now: NodeParameters,
    written: Mapping[str, frozenset[str]],
) -> Declaration:
    given = [{key: value for name in names for key, value in side.get(name, {}).items()} for side in (was, now)]
    return Declaration(
        tuple(names), parameters, given[0], given[1], frozenset().union(*(written[name] for name in names))
    )


def _changes(one: Declaration, before: Distro, after: Distro) -> Iterator[UpgradeParameter]:
    for name, facts in one.parameters.items():
        was, now = (facts.as_in(distro) if facts.declared_in(distro) else None for distro in (before, after))
        if now is None and was is not None:
            yield _vanished(one, name, was, after)
        elif now is not None and was is None:
            yield _change(one, name, "appears", "", None, _shown(now.default), _missing(one, name, now, after))
        elif now is not None and was is not None:
            yield from _differing(one, name, was, now, after)


def _vanished(one: Declaration, name: str, was: ParameterFacts, after: Distro) -> UpgradeParameter:
    by_hand = any(is_named(name, given) for given in one.written)
    question = f"`{name}` of {_names(one)}: {after} ignores it silently, and the spec states it" if by_hand else ""
    return _change(one, name, "vanishes", "", _shown(was.default), None, question)


def _differing(
    one: Declaration, name: str, was: ParameterFacts, now: ParameterFacts, after: Distro
) -> Iterator[UpgradeParameter]:
    if was.default != now.default:
        sides = _shown(was.default), _shown(now.default)
        question = (
            f"`{name}` of {_names(one)}: its default changes from {sides[0]} to {sides[1]}, and the cell states none"
        )
        yield _change(one, name, "changes", "default", *sides, question if _counts(one, name) else "")
    for key, what in _BESIDE_DEFAULT.items():
        old, new = getattr(was, key), getattr(now, key)
        if old != new:
            question = _missing(one, name, now, after) if key != "one_of" else _not_among(one, name, now, after)
            yield _change(one, name, "changes", what, _shown(old), _shown(new), question)


def _missing(one: Declaration, name: str, now: ParameterFacts, after: Distro) -> str:
    wanted = now.required and "<" not in name and not _given(one.after, name)
    return f"`{name}` of {_names(one)}: {after} requires it, and the cell states none" if wanted else ""


def _not_among(one: Declaration, name: str, now: ParameterFacts, after: Distro) -> str:
    for given, value in one.after.items():
        if is_named(name, given) and isinstance(value, str) and value not in now.one_of:
            return f"`{given}` of {_names(one)}: {after} takes {', '.join(now.one_of)}, and the cell states {value}"
    return ""


def _counts(one: Declaration, name: str) -> bool:
    """Whether a default decides anything: the cell states no other, and gives a joint something beside it."""
    group, _, _ = name.rpartition(".")
    beside = "<" not in group or any(is_named(f"{group}.<any>", given) for given in one.after)
    return beside and not _given(one.after, name)


def _given(parameters: Mapping[str, Leaf], name: str) -> bool:
    return any(is_named(name, given) for given in parameters)


def _change(
    one: Declaration,
    name: str,
    change: Literal["appears", "vanishes", "changes"],
    what: str,
    before: str | None,
    after: str | None,
    question: str,
) -> UpgradeParameter:
    stated = _given(one.before, name) or _given(one.after, name)
    return UpgradeParameter(
        nodes=one.nodes,
        parameter=name,
        change=change,
        what=what,
        before=before,
        after=after,
        stated=stated,
        question=question,
    )


def _names(one: Declaration) -> str:
    return ", ".join(one.nodes)


def _shown(value: ParameterFact | tuple[str, ...] | bool | None) -> str | None:
    if value is None:
        return None
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(str, value))}]"
    return str(value) if value != "" else '""'
