"""Parameters of controllers and programs that the spec writes, each with its declaration and what is beside it.

Values of which the catalog says what they spoil are found here, too.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping

from cellc.compiler.catalog.load import load_program_parameters
from cellc.compiler.catalog.parameter_facts import DiscouragedValue, ParameterFacts, is_named, named_part
from cellc.compiler.catalog.programs import ProgramParameters
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.control import Controller
from cellc.compiler.cell.interface import Node, ParameterValue
from cellc.compiler.graph.claims import written_parameters
from cellc.contract.diagnostics import YamlPath
from cellc.contract.frozen import dataclass

_RATE = "update_rate"
_OF_EVERY_NODE = ("use_sim_time", "start_type_description_service")
_OVERRIDES = "qos_overrides."
_PLACEHOLDER = re.compile(r"<[a-z_]+>")


@dataclass(frozen=True, slots=True)
class StatedParameter:
    """A parameter that the spec writes for a controller or a node of a known program.

    Args:
        owner: the controller or node.
        key: its name as it is declared, with ``<joint>`` for any; that which is written where nothing declares it.
        facts: its declaration in the distribution of the cell; None where nothing declares it.
        stated: all that its owner gets.
        declared: all that its owner declares.
        controller: its owner, where that is a controller.
    """

    path: YamlPath
    owner: str
    name: str
    value: ParameterValue
    key: str
    facts: ParameterFacts | None
    stated: Mapping[str, ParameterValue]
    declared: Mapping[str, ParameterFacts]
    controller: Controller | None = None
    rate_hz: float | None = None

    def items(self) -> Iterator[tuple[YamlPath, ParameterValue]]:
        """Yield each item of a list with its place, or the value itself."""
        if isinstance(self.value, tuple):
            yield from (((*self.path, index), item) for index, item in enumerate(self.value))
        else:
            yield self.path, self.value

    def beside(self, name: str) -> object:
        """Return the value of another parameter of the owner, with its prefix or without; or the controller's rate."""
        if name == _RATE and self.rate_hz is not None:
            return self.rate_hz
        if name not in self.declared:
            name = f"{self.key.rpartition('.')[0]}.{name}"
        part = named_part(self.key, self.name)
        written = name if part is None else _PLACEHOLDER.sub(part, name)
        return self.stated.get(written, self.declared[name].default if name in self.declared else None)

    def worse(self) -> DiscouragedValue | None:
        """Return what the catalog says against the value, if it says something."""
        rows = () if self.facts is None else self.facts.discouraged
        return next((row for row in rows if self._applies(row) and row.holds(self.value, self.beside)), None)

    def _applies(self, row: DiscouragedValue) -> bool:
        if not row.commands:
            return True
        claims = () if self.controller is None else self.controller.all_claims
        kinds = {claim.rpartition("/")[2] for claim in claims}
        if self.controller is not None and self.name in self.controller.vendor_parameters:
            return False  # its vendor has reasons
        return row.commands[0] in kinds and kinds <= set(row.commands)


def stated_parameters(cell: Cell) -> Iterator[StatedParameter]:
    """Yield them for the controllers of the spec, then for its nodes."""
    rates = {manager.name: manager.update_rate_hz for manager in cell.managers}
    for parameter in written_parameters(cell):
        controller = parameter.controller
        declared = {} if controller.declared is None else controller.declared.parameters_in(cell.distro)
        key, facts = _declaration(declared, parameter.name)
        stated, rate = controller.parameters, controller.update_rate_hz or rates[controller.manager]
        yield StatedParameter(
            parameter.path,
            controller.name,
            parameter.name,
            parameter.value,
            key,
            facts,
            stated,
            declared,
            controller,
            rate,
        )
    for node in cell.nodes:
        if node.parameters and cell.states(*node.path, "parameters"):
            yield from _of_node(cell, node)


def _of_node(cell: Cell, node: Node) -> Iterator[StatedParameter]:
    declared = program_parameters(cell, node)
    for name, value in node.parameters.items() if declared else ():
        key, facts = _declaration(declared, name)
        path = (*node.path, "parameters", name)
        if cell.states(*path):
            yield StatedParameter(path, node.name, name, value, key, facts, node.parameters, declared)


def unchecked_parameters(cell: Cell) -> Iterator[tuple[str, tuple[str, ...]]]:
    """Yield the full names of nodes and controllers with the parameters of the spec that the catalog does not know."""
    for node in cell.nodes:
        if not of_program(node) and (names := _written(cell, node.path, node.parameters)):
            yield node.full_name, names
    for controller in cell.controllers:
        if controller.declared is None and (names := _written(cell, controller.path, controller.parameters)):
            yield controller.full_name, names


def _written(cell: Cell, path: YamlPath, parameters: Mapping[str, ParameterValue]) -> tuple[str, ...]:
    return tuple(name for name in parameters if cell.states(*path, "parameters", name) and not is_of_every_node(name))


def is_of_every_node(name: str) -> bool:
    """Whether rclcpp or rclpy declares a parameter for every node."""
    return name in _OF_EVERY_NODE or name.startswith(_OVERRIDES)


def of_program(node: Node) -> tuple[ProgramParameters, ...]:
    """Return what the catalog says of the parameters of a node's program, of every distribution."""
    table = load_program_parameters().value
    rows = () if table is None else table.programs
    return tuple(row for row in rows if node.package == row.package and node.executable in row.executables)


def program_parameters(cell: Cell, node: Node) -> Mapping[str, ParameterFacts]:
    """Return what the program of a node declares in the distribution of the cell."""
    return {
        f"{row.prefix}{name}": facts.as_in(cell.distro)
        for row in of_program(node)
        if not row.only or cell.distro in row.only
        for name, facts in row.parameters.items()
        if facts.declared_in(cell.distro)
    }


def _declaration(declared: Mapping[str, ParameterFacts], name: str) -> tuple[str, ParameterFacts | None]:
    """Return the declaration of a written name, with the name that it is declared by."""
    if name in declared:
        return name, declared[name]
    return next(((key, facts) for key, facts in declared.items() if is_named(key, name)), (name, None))
