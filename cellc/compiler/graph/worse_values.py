"""Values of parameters that a controller or program takes and of which the catalog says what they spoil."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

from cellc.compiler.catalog.controller_kind import is_named
from cellc.compiler.catalog.load import load_programs
from cellc.compiler.catalog.programs import DiscouragedValue
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.graph.claims import written_parameters
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass


@dataclass(frozen=True, slots=True)
class WorseValue:
    """A parameter of the spec with such a value.

    Args:
        owner: the controller or node.
        does: what it does with the value, as the end of a sentence.
        default: what it has without the line; None where that is not known, or no better.
    """

    path: YamlPath
    name: str
    owner: str
    value: ParameterValue
    does: str
    default: ParameterValue | None = None


def worse_values(cell: Cell) -> Iterator[WorseValue]:
    """Yield them for the controllers of the spec, then for its nodes."""
    for parameter in written_parameters(cell):
        kind = parameter.controller.declared
        facts = None if kind is None else kind.parameter(parameter.name, cell.distro)
        does = None if facts is None else _does(facts.discouraged, parameter.value)
        if facts is not None and does is not None:
            default = None if _does(facts.discouraged, facts.default) else facts.default
            owner = parameter.controller.name
            yield WorseValue(parameter.path, parameter.name, owner, parameter.value, does, default)
    table = load_programs().value
    known = () if table is None else table.parameters
    for node in (node for node in cell.nodes if node.parameters):
        of_program = [
            facts
            for facts in known
            if node.package == facts.package
            and node.executable in facts.executables
            and (not facts.only or cell.distro in facts.only)
        ]
        for name, value in node.parameters.items() if of_program else ():
            path = (*node.path, "parameters", name)
            rows = (row for facts in of_program if is_named(facts.name, name) for row in facts.discouraged)
            does = _does(rows, value)
            if does is not None and cell.states(*path):
                yield WorseValue(path, name, node.name, value, does)


def _does(rows: Iterable[DiscouragedValue], value: object) -> str | None:
    return next((row.does for row in rows if row.holds(value)), None)
