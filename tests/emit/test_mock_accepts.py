"""The mock's controller manager takes the emitted files as the real one would."""

from __future__ import annotations

import json

import pytest

from cellc.contract.vocabulary import Distro
from cellc.mock import control
from tests.cells import DISTROS
from tests.emit.cells import CELLS, artifacts_of, contract_data


@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("cell", CELLS)
def test_every_controller_becomes_active(cell: str, distro: str) -> None:
    artifacts = artifacts_of(cell, distro)
    contract = contract_data(artifacts["contract.json"])
    (manager,) = contract["managers"].values()
    machine = control.ControllerManager(
        artifacts[contract["files"]["urdf_mock"]],
        artifacts[contract["files"]["parameters"]["control"]],
        distro=Distro(distro),
        plugin_behaviors=contract["plugin_behaviors"],
    )
    later = [one["request"] for one in json.loads(artifacts["config/bring_up.json"])["mock"] if "request" in one]
    for request in later:
        if request["kind"] == "hardware":
            assert machine.set_hardware_component_state(request["component"], "active").ok
    spawned = machine.spawn(list(manager["controllers"]))
    assert spawned.ok, (spawned, machine.log.lines())
