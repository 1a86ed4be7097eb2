"""Nothing that is emitted is what the real controller manager was seen to refuse or to suffer from."""

from __future__ import annotations

from typing import Any

import pytest

from tests.consumers.matrix import build, every_build
from tests.consumers.refused_description import description_faults
from tests.consumers.refused_parameters import parameter_faults
from tests.consumers.starting import activated, processes
from tests.foreign_yaml import safe_load
from tests.oracles import RECORDED

CASES = RECORDED / "controller_manager" / "cases"
_MOCK = {"mock_components/GenericSystem"}
# The type string that a driver's package registers, by what its URDF and pluginlib description say: ros2_control.md.
_REAL = {
    "ur_robot_driver/URPositionHardwareInterface",
    "robotiq_driver/RobotiqGripperHardwareInterface",
    "franka_hardware/FrankaHardwareInterface",
    "kortex_driver/KortexMultiInterfaceHardware",  # ros2_kortex@1fdbef3, kortex_driver/hardware_interface_plugin.xml
    "openarm_hardware/OpenArmHW",  # openarm_ros2@492b307, openarm_hardware/openarm_hardware.xml
}
# Recorded as coming up, and still wrong: ignored without a word, or changed with a warning.
_ACCEPTED_AND_DANGEROUS = {"owntype_spawner_p", "u_dup_iface", "unc_bad", "y_extra_param", "y_upd_nondiv"}
# The same files as the base case: given to the wrong process, or with goals that do not fit.
_NOT_IN_THE_FILES = {"no_cm_params", "goal_out_of_limits", "goal_too_fast"}


def _recorded(case: str) -> tuple[list[str], dict[str, Any]]:
    """Return what the checker says of a recorded case, and what was observed."""
    folder = CASES / case
    observed = safe_load((folder / "observed.yaml").read_text(encoding="utf-8"))
    flags = observed["flags"]
    description = (folder / "cell.urdf").read_text(encoding="utf-8")
    faults = description_faults(description, _MOCK)
    if not faults or not any("not well formed" in fault for fault in faults):
        faults += parameter_faults(
            (folder / "controllers.yaml").read_text(encoding="utf-8").replace("\t", "  "),
            description,
            flags["namespace"],
            tuple(flags["spawned"]),
            tuple(flags["spawned_inactive"]),
            "kilted",
        )
    return faults, observed


def _cases() -> list[str]:
    return sorted(path.name for path in CASES.iterdir()) if CASES.is_dir() else []


@pytest.mark.parametrize("case", _cases())
def test_checker_knows_the_recorded_answers(case: str) -> None:
    faults, observed = _recorded(case)
    states = [state["active"] for name, state in observed["controllers"].items()]
    came_up = observed["manager_survives"] and all(states) and bool(states)
    expected_fault = not came_up or case in _ACCEPTED_AND_DANGEROUS
    assert bool(faults) is (expected_fault and case not in _NOT_IN_THE_FILES), faults


def test_checker_was_held_against_all_recorded_cases() -> None:
    assert len(_cases()) == 46


@every_build
@pytest.mark.parametrize("target", ["mock", "real"])
def test_no_emitted_description_is_refused_or_dangerous(cell: str, distro: str, target: str) -> None:
    texts = build(cell, distro).texts
    plugins = _MOCK if target == "mock" else _REAL
    descriptions = [path for path in texts if path.endswith(f".{target}.urdf")]
    assert descriptions
    for path in descriptions:
        assert description_faults(texts[path], plugins) == [], path


@every_build
@pytest.mark.parametrize("target", ["mock", "real"])
def test_no_emitted_parameter_file_is_refused_or_dangerous(cell: str, distro: str, target: str) -> None:
    started = processes(cell, distro, target)
    said = {
        f"{process.namespace}/robot_description": process.values["robot_description"][0]
        for process in started
        if process.executable == "robot_state_publisher"
    }
    spawned = [process.arguments for process in started if process.executable == "spawner"]
    for manager in (process for process in started if process.executable == "ros2_control_node"):
        name = f"{manager.namespace}/controller_manager"
        own = [one for line in spawned if line[line.index("-c") + 1] == name for one in line[: line.index("-c")]]
        active = tuple(activated(cell, distro, target, name))
        inactive = tuple(one for one in own if one not in active)
        text = build(cell, distro).texts[manager.files[0]]
        topic = manager.remaps["~/robot_description"]
        assert active
        assert parameter_faults(text, said[topic], manager.namespace, active, inactive, distro) == []
