"""What the spec says of clocks and of the network reaches the contract, in SI."""

from __future__ import annotations

import json

import pytest

from cellc.contract.contract import Contract, ContractClock
from cellc.contract.entities import SimulatedNetwork
from tests.cells import CORPUS, compiled


@pytest.fixture(scope="module")
def contract() -> Contract:
    """The contract of a cell with figures for its clocks and its network."""
    spec = CORPUS / "valid" / "simulated_network_and_clocks.yaml"
    return Contract.model_validate(json.loads(compiled(spec).texts["contract.json"]))


def test_every_host_and_every_device_with_its_own_clock_has_one(contract: Contract) -> None:
    assert contract.clocks == {
        "control_pc": ContractClock(
            domain="ros", synchronized_by="chrony", max_offset_s=0.001, offset_s=0.0002, drift=5e-6
        ),
        "camera": ContractClock(
            domain="camera", synchronized_by="global_time", max_offset_s=0.002, offset_s=-0.0015, drift=-20e-6
        ),
    }


def test_nodes_and_controllers_read_the_clock_of_their_host(contract: Contract) -> None:
    own = {name for name, clock in contract.clock_of.items() if clock == "camera"}
    assert own == {"camera"}
    for node in ("task", "move_group", "perception", "robot_state_publisher", "joint_states", "arm_trajectory", "arm"):
        assert contract.clock_of[node] == "control_pc"


def test_network_of_a_topic_is_in_seconds_and_shares(contract: Contract) -> None:
    figures = SimulatedNetwork(latency_s=0.002, jitter_s=0.001, loss=0.005, reordering=0.001)
    assert contract.interfaces["/object_pose"].simulated == figures
    assert contract.interfaces["/tf"].simulated is None
