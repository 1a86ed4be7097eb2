"""A graph of ROS nodes in memory, behind the calls that the program of the bring-up makes; and that program, loaded.

States change as the real ones do: a controller is activated where its manager lists it, a managed node where it is
known. What is asked for is noted in order.
"""

from __future__ import annotations

import itertools
import subprocess
from collections.abc import Callable
from dataclasses import dataclass, field
from types import ModuleType, SimpleNamespace
from typing import Any

from tests.consumers.matrix import build


def program(cell: str = "ur5e_pick", distro: str = "jazzy") -> Any:
    """Return the generated program as a module; nothing of ROS is imported by it before it joins a graph."""
    module = ModuleType("bring_up_of_a_test")
    module.__file__ = "scripts/bring_up"
    exec(compile(build(cell, distro).texts["scripts/bring_up"], "scripts/bring_up", "exec"), module.__dict__)
    told: Any = module
    # What is installed has a program of its own: here it is as pinned.
    told.subprocess = SimpleNamespace(**(vars(subprocess) | {"run": lambda *_, **__: _AS_PINNED}))
    return told


_AS_PINNED = SimpleNamespace(returncode=0, stdout="what is installed is what is pinned")


@dataclass
class StandIn:
    """One graph.

    Args:
        module: the program, whose `UnansweredError` says that nobody is there.
        on_spin: called with the number of times that it was spun, so that the world may go on.
    """

    module: Any
    nodes_: dict[str, str] = field(default_factory=dict)
    twice: list[str] = field(default_factory=list)
    controllers: dict[str, str] = field(default_factory=dict)
    hardware: dict[str, str] = field(default_factory=dict)
    messages: dict[str, Any] = field(default_factory=dict)
    servers: set[str] = field(default_factory=set)
    frames: set[str] = field(default_factory=set)
    plugins: str = "<plugin>mock_components/GenericSystem</plugin>"
    refuses: set[str] = field(default_factory=set)
    silent: int = 0
    silent_for: dict[str, float] = field(default_factory=dict)
    log: list[str] = field(default_factory=list)
    on_spin: Callable[[int], None] = lambda _: None
    on_message: Callable[[str, Any], None] = lambda *_: None
    _spins: Any = field(default_factory=lambda: itertools.count(1))

    def spin(self, seconds: float) -> None:
        self.on_spin(next(self._spins))

    def leave(self) -> None:
        self.log.append("leave")

    def nodes(self) -> list[str]:
        return [*self.nodes_, *self.twice]

    def serves(self, name: str) -> bool:
        return name.removesuffix("/_action/send_goal") in self.servers

    def heard(self, topic: str, kind: str) -> Any:
        return self.messages.get(topic)

    def silent_s(self, topic: str) -> float:
        return self.silent_for.get(topic, 0.0)

    def connects(self, parent: str, child: str) -> bool:
        return {parent, child} <= self.frames

    def ask(self, kind: str, name: str, answer_s: float = 3.0, /, **fields: Any) -> Any:
        node, _, service = name.rpartition("/")
        if service.startswith("acknowledge_"):
            device = service.removeprefix("acknowledge_")
            self.log += [] if device in self.refuses else [f"acknowledge {device}"]
            return SimpleNamespace(success=device not in self.refuses, message="a proof is missing")
        answer = getattr(self, f"_{service}", None)
        if answer is None or (node not in self.nodes_ and node != "/controller_manager"):
            raise self.module.UnansweredError(f"no service {name}")
        return answer(node, **fields)

    def _get_state(self, node: str) -> Any:
        return SimpleNamespace(current_state=SimpleNamespace(label=self.nodes_[node]))

    def _change_state(self, node: str, transition: Any) -> Any:
        if node in self.refuses:
            return SimpleNamespace(success=False)
        self.nodes_[node] = {1: "inactive", 3: "active"}[transition.id]
        self.log.append(f"{node} {self.nodes_[node]}")
        return SimpleNamespace(success=True)

    def _list_controllers(self, node: str) -> Any:
        return SimpleNamespace(controller=[SimpleNamespace(name=n, state=s) for n, s in self.controllers.items()])

    def _list_hardware_components(self, node: str) -> Any:
        listed = [SimpleNamespace(name=n, state=SimpleNamespace(label=s)) for n, s in self.hardware.items()]
        return SimpleNamespace(component=listed)

    def _set_hardware_component_state(self, node: str, name: str, target_state: Any) -> Any:
        self.hardware[name] = target_state.label
        self.log.append(f"activate {name}")
        return SimpleNamespace(ok=True)

    def _switch_controller(self, node: str, **fields: Any) -> Any:
        start, stop = fields["activate_controllers"], fields["deactivate_controllers"]
        active = {name for name, state in self.controllers.items() if state == "active"}
        if self.refuses & {*start, *stop} or {*start} & active - {*stop}:
            return SimpleNamespace(ok=False)
        self.controllers.update(dict.fromkeys(stop, "inactive"))
        self.controllers.update(dict.fromkeys(start, "active"))
        self.log += [f"deactivate {one}" for one in stop] + [f"activate {one}" for one in start]
        if self.silent:  # done, and nobody hears of it
            self.silent -= 1
            raise self.module.UnansweredError("an answer was lost")
        return SimpleNamespace(ok=True)

    def _get_parameters(self, node: str, names: list[str]) -> Any:
        return SimpleNamespace(values=[SimpleNamespace(string_value=self.plugins)])


def messages_of(module: Any) -> None:
    """Let the program make messages without ROS: a class that holds what it is given."""
    module._loaded = lambda kind: SimpleNamespace
