"""``config/controllers.yaml``: what the controller manager and its controllers are told.

ROS parameter file, one for each controller manager (``config/<manager>.controllers.yaml`` where there are several). The
manager learns the rate and the plugin of each controller, then each controller gets its own section. Left out: what is
no parameter but a matter of launching, such as which controllers are active.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.cell.control import Controller, ControllerManager
from cellc.cell.interface import ParameterValue
from cellc.deploy.files import controllers_file
from cellc.formats.header import Header
from cellc.formats.parameter_file import NodeParameters, parameter_file
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield the parameter file of each controller manager."""
    for manager in graph.cell.managers:
        yield Artifact(controllers_file(graph.cell, manager), parameter_file(header, _sections(manager)))


def _sections(manager: ControllerManager) -> Iterator[NodeParameters]:
    yield NodeParameters(f"{manager.namespace}/controller_manager", manager.path, _of_manager(manager))
    for controller in manager.controllers:
        yield _of_controller(manager, controller)


def _of_manager(manager: ControllerManager) -> dict[str, ParameterValue]:
    # An update_rate with a decimal point makes the manager abort.
    rate: dict[str, ParameterValue] = {"update_rate": round(manager.update_rate_hz)}
    return rate | {f"{controller.name}.type": controller.plugin for controller in manager.controllers}


def _of_controller(manager: ControllerManager, controller: Controller) -> NodeParameters:
    return NodeParameters(f"{manager.namespace}/{controller.name}", controller.path, controller.parameters)
