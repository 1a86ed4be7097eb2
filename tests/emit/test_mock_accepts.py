"""The mock's controller manager takes the emitted files as the real one would."""

from __future__ import annotations

import pytest

from cellc.mock import control
from cellc.vocabulary import Distro
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
        artifacts["config/controllers.yaml"],
        distro=Distro(distro),
        plugin_behaviours=contract["plugin_behaviours"],
    )
    spawned = machine.spawn(list(manager["controllers"]))
    assert spawned.ok, (spawned, machine.log.lines())
