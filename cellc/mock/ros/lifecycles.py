"""The state of managed nodes that are played, as `ros2 lifecycle get` asks for it."""

from __future__ import annotations

import json
from collections.abc import Collection

from cellc.contract.bring_up import Transition
from cellc.mock.plant import Plant
from cellc.mock.ros.bridge import Bridge, Received
from cellc.mock.ros.graph import Graph
from cellc.mock.ros.managers import state_message

_GET_STATE = "lifecycle_msgs/srv/GetState"


class LifecycleServices:
    """Says in which state the managed nodes are that the bring-up asks for transitions."""

    def __init__(self, plant: Plant, bridge: Bridge, tested: Collection[str]) -> None:
        """Bind the nodes; nothing is offered yet.

        Args:
            tested: full names of the nodes that are not played.
        """
        asked = (step.request for step in plant.bring_up)
        managed = (request.node for request in asked if isinstance(request, Transition))
        self._nodes = [node for node in dict.fromkeys(managed) if node not in tested]
        self._plant, self._bridge = plant, bridge
        self._served: dict[int, str] = {}

    def offer(self, graph: Graph) -> None:
        """Offer the services."""
        for node in self._nodes:
            self._served[graph.serve(node, f"{node}/get_state", _GET_STATE)] = node

    def take(self, received: Received) -> bool:
        """Take a request, where it is one of these services."""
        node = self._served.get(received.channel)
        if node is None:
            return False
        state = state_message(self._plant.lifecycles.get(node, "unconfigured"))
        self._bridge.answer(json.loads(received.data)["number"], {"current_state": state})
        return True
