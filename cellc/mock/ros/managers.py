"""The services of the controller managers, for command line tools and for nodes under test.

Names are those that a manager has for its controllers: where several managers share one, the contract has full names.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict
from functools import partial

from pydantic import BaseModel, ConfigDict, ValidationError

from cellc.contract.frozen import dataclass
from cellc.mock.control import ControllerManager, ServiceResponse, Strictness
from cellc.mock.control.manager.settings import NODE_NAME
from cellc.mock.errors import MockError
from cellc.mock.plant import Plant
from cellc.mock.ros.bridge import Bridge, Received
from cellc.mock.ros.graph import Graph

_KINDS = {
    "list_controllers": "ListControllers",
    "list_controller_types": "ListControllerTypes",
    "list_hardware_components": "ListHardwareComponents",
    "list_hardware_interfaces": "ListHardwareInterfaces",
    "load_controller": "LoadController",
    "configure_controller": "ConfigureController",
    "unload_controller": "UnloadController",
    "switch_controller": "SwitchController",
    "set_hardware_component_state": "SetHardwareComponentState",
}
"""By the names of the services: https://control.ros.org/jazzy/doc/ros2_control/controller_manager/doc/userdoc.html"""
_STATES = {"unconfigured": 1, "inactive": 2, "active": 3, "finalized": 4}
"""Numbers of lifecycle_msgs/msg/State."""
_BASES = ("controller_interface::ControllerInterface", "controller_interface::ChainableControllerInterface")
"""Of a type whose controllers cannot be chained, and of one whose can."""
Answer = Mapping[str, object]
"""Fields of a response."""


class _State(BaseModel):
    id: int = 0
    label: str = ""


class _Request(BaseModel):
    """What the requests have in their fields; each has some of them."""

    model_config = ConfigDict(frozen=True, extra="ignore")

    name: str = ""
    activate_controllers: tuple[str, ...] = ()
    deactivate_controllers: tuple[str, ...] = ()
    strictness: int = 0
    target_state: _State = _State()


@dataclass(frozen=True, slots=True)
class _Served:
    """A service of a manager.

    Attributes:
        manager: its name in the contract.
        keys: names of its controllers in the contract, by those that the manager has for them.
    """

    service: str
    manager: str
    control: ControllerManager
    keys: Mapping[str, str]

    def answer(self, asked: _Request) -> Answer:
        """Carry out a request, as the manager does."""
        match self.service:
            case "list_controllers":
                return {"controller": [self._named(asdict(each)) for each in self.control.list_controllers()]}
            case "list_controller_types":
                found = {each.type: each.is_chainable for each in self.control.list_controllers()}
                return {"types": list(found), "base_classes": [_BASES[chained] for chained in found.values()]}
            case "list_hardware_components":
                listed = self.control.list_hardware_components()
                return {"component": [{**asdict(each), "state": state_message(each.state)} for each in listed]}
            case "list_hardware_interfaces":
                return asdict(self.control.list_hardware_interfaces())
            case "load_controller":
                return _ended(self.control.load_controller(self._key(asked.name)))
            case "configure_controller":
                return _ended(self.control.configure_controller(self._key(asked.name)))
            case "unload_controller":
                return _ended(self.control.unload_controller(self._key(asked.name)))
            case "switch_controller":
                known = asked.strictness in Strictness.__members__.values()
                strictness = Strictness(asked.strictness) if known else Strictness.UNSPECIFIED
                activate, deactivate = map(self._keys, (asked.activate_controllers, asked.deactivate_controllers))
                return _ended(self.control.switch_controllers(activate, deactivate, strictness))
            case _:
                wanted = next((label for label, number in _STATES.items() if number == asked.target_state.id), "")
                state = wanted or asked.target_state.label
                response = self.control.set_hardware_component_state(asked.name, state)
                return {"ok": response.ok, "state": state_message(response.state)}

    def _key(self, name: str) -> str:
        return self.keys.get(name, name)

    def _keys(self, names: tuple[str, ...]) -> list[str]:
        return [self._key(name) for name in names]

    def _named(self, state: dict[str, object]) -> Answer:
        names = {key: name for name, key in self.keys.items()}
        return {**state, "name": names.get(str(state["name"]), state["name"])}


class ManagerServices:
    """Serves what the managers of a plant are asked for."""

    def __init__(self, plant: Plant, bridge: Bridge) -> None:
        """Bind the managers; nothing is offered yet."""
        self._plant, self._bridge = plant, bridge
        self._served: dict[int, _Served] = {}

    def offer(self, graph: Graph) -> str:
        """Offer the services; return why they are not offered, or nothing."""
        for name, manager in self._plant.contract.managers.items():
            node = f"{manager.namespace.rstrip('/')}/{NODE_NAME}"
            keys = {each.full_name.rpartition("/")[2]: key for key, each in manager.controllers.items()}
            for service, kind in _KINDS.items():
                try:
                    channel = graph.serve(node, f"{node}/{service}", f"controller_manager_msgs/srv/{kind}")
                except MockError as error:
                    return str(error)
                self._served[channel] = _Served(service, name, self._plant.control.managers[name], keys)
        return ""

    def take(self, received: Received) -> bool:
        """Take a request, where it is one of these services, at the present instant of the run."""
        served = self._served.get(received.channel)
        if served is None:
            return False
        said = json.loads(received.data)
        self._plant.simulation.at(self._plant.now_ns, partial(self._answer, served, said["number"], said["request"]))
        return True

    def _answer(self, served: _Served, number: int, request: Mapping[str, object]) -> None:
        if not self._plant.network.answers(served.manager):
            return
        try:
            answer = served.answer(_Request.model_validate(request))
        except ValidationError:
            answer = {"ok": False}
        due_ns = self._plant.now_ns + (served.control.period_ns if served.service == "switch_controller" else 0)
        self._plant.simulation.at(due_ns, partial(self._bridge.answer, number, answer))


def _ended(response: ServiceResponse) -> Answer:
    return {"ok": response.ok, "message": response.message}


def state_message(label: str) -> Answer:
    """Return the fields of a lifecycle_msgs/msg/State."""
    return {"id": _STATES.get(label, 0), "label": label or "unknown"}
