"""The real hardware component of each cell against what the plugin of the pinned release reads, demands and exports."""

from __future__ import annotations

import pytest

from tests.oracles import here
from tests.vendors.oracle import demands, exports, facts, parameters, update_rate
from tests.vendors.packages import CASES, Case, RealTarget, real_target

every_case = pytest.mark.parametrize("case", here(CASES), ids=str)


def _given(target: RealTarget) -> dict[str, str]:
    return {param.get("name", ""): param.text or "" for param in target.component.findall("hardware/param")}


@every_case
def test_the_plugin_is_the_vendor_s(case: Case) -> None:
    plugin = real_target(case).component.findtext("hardware/plugin")
    assert plugin == facts(case.release, "hardware_parameters")["plugin"]


@every_case
def test_every_parameter_that_the_plugin_requires_is_given(case: Case) -> None:
    given = _given(real_target(case))
    required = {name for name, told in parameters(case.release).items() if told["required"] is True}
    assert required - set(given) == set()


@every_case
def test_no_parameter_is_given_that_the_plugin_does_not_read(case: Case) -> None:
    assert set(_given(real_target(case))) - set(parameters(case.release)) == set()


@every_case
def test_no_parameter_with_a_default_is_written_empty(case: Case) -> None:
    # The reader of ros2_control writes "text not specified in the ... tag" for each of them.
    read = parameters(case.release)
    assert [name for name, value in _given(real_target(case)).items() if not value and not read[name]["required"]] == []


@every_case
def test_every_interface_of_the_description_is_one_that_the_plugin_exports(case: Case) -> None:
    target = real_target(case)
    for side in ("command", "state"):
        exported = exports(case.release, side, target.prefix)
        for part in target.component:
            if part.tag in ("joint", "sensor", "gpio"):
                name = "<joint>" if part.tag == "joint" else part.get("name", "")
                stated = {element.get("name", "") for element in part.findall(f"{side}_interface")}
                assert stated <= exported.get(name, set()), (part.get("name"), side)


@every_case
def test_every_interface_that_the_cell_counts_on_is_one_that_the_plugin_exports(case: Case) -> None:
    # Those that no description lists, too.
    target = real_target(case)
    hardware = target.cell.device(target.device).control.hardware
    assert hardware is not None
    for group in (*hardware.sensors, *hardware.gpios):
        for side, names in (("command", group.command_interfaces), ("state", group.state_interfaces)):
            assert set(names) <= exports(case.release, side, target.prefix).get(group.name, set()), (group.name, side)


@every_case
def test_everything_that_a_controller_claims_or_reads_of_the_device_is_exported(case: Case) -> None:
    target = real_target(case)
    device = target.cell.device(target.device)
    joints = {joint.name for joint in device.joints}
    groups = {name for side in ("command", "state") for name in exports(case.release, side, target.prefix)}
    for controller in target.cell.controllers:
        for side, names in (("command", controller.claims("real")), ("state", controller.state_interfaces)):
            exported = exports(case.release, side, target.prefix)
            for name in names:
                owner, _, interface = name.partition("/")
                if owner in joints or owner in groups:
                    assert interface in exported.get("<joint>" if owner in joints else owner, set()), name


@every_case
def test_joints_stand_in_the_order_and_with_the_interfaces_that_the_plugin_demands(case: Case) -> None:
    target = real_target(case)
    joints = {
        joint.get("name", "").removeprefix(target.prefix): tuple(
            tuple(element.get("name") for element in joint.findall(f"{side}_interface"))
            for side in ("command", "state")
        )
        for joint in target.component.findall("joint")
    }
    told = demands(case.release)
    assert tuple(joints) == told.joints
    for command, state in joints.values():
        assert set(told.command) <= set(command) <= {*told.command, *told.further_command}
        assert set(told.state) <= set(state)
        assert not told.exactly or len(state) == len(told.state)


@every_case
def test_the_manager_turns_at_a_rate_that_the_vendor_gives_for_the_device(case: Case) -> None:
    rate = update_rate(case.release)
    target = real_target(case)
    (manager,) = target.cell.managers
    assert rate is None or manager.update_rate_hz == rate
