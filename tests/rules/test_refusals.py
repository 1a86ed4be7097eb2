"""What a controller manager can refuse is found by a check before, or cannot come from a spec, for a reason.

The refusals are read from the code of the mock's manager, which has them from the real one: a new one fails here until
it has an entry. The pages of the codes show a spec that is reported.
"""

from __future__ import annotations

import ast
import shutil
from collections.abc import Iterator
from pathlib import Path

import pytest

from cellc.compiler.pages import all_codes
from tests.cells import ROOT, diagnose
from tests.rules.examples import BASE, Example, diagnose_example

_CONTROL = ROOT / "cellc" / "mock" / "control"
_REFUSING = {"_refuse", "_RefusedError", "DescriptionError", "ManagerAbortedError", "ConfigureError"}
_COMPLAINING = {"_start_complaint", "_stop_complaint", "activation_error"}
FOUND: dict[str, str] = {
    "After configuring, controller '{}' is in state 'unconfigured' , expected inactive.": (
        "missing-controller-parameter"
    ),
    "Could not deactivate controller with name '{}' because preceding controller with name '{}' is active and is not "
    "requested to be deactivated.": "unprovided-command-interface",
    "Exception thrown while initializing controller manager parameters: {}": "refused-update-rate",
    "Hardware name {} is duplicated. Please provide a unique 'name' in the URDF.": "component-named-twice",
    "Joint '{}' has mimic attribute not set to false: Activated mimic joints cannot have command interfaces.": (
        "commanded-follower"
    ),
    "Loader for controller '{}' (type '{}') not found.": "unknown-controller-kind",
    "Mimic joint '{}' not found in <ros2_control> tag": "follower-without-leader",
    "Controller with name '{}' can not be deactivated since it is not active.": "impossible-switch",
    "Controller with name '{}' is already active.": "impossible-switch",
    "{} active but it is requested to be deactivated.": "unprovided-command-interface",
    "{} inactive and it is not requested to be activated.": "unprovided-command-interface",
    "{} is currently claimed by another controller.": "double-claim-after-switch",
    "{} is not available.": "unprovided-command-interface",
    "{} will be used by another controller that is being activated.": "double-claim",
    "'sensor_name' or at least one 'interface_names.[force|torque].[x|y|z]' parameter has to be specified.": (
        "missing-controller-parameter"
    ),
    "both 'sensor_name' and any of 'interface_names.force.[x|y|z]' or 'interface_names.torque.[x|y|z]' parameters "
    "cannot be set.": "conflicting-parameters",
    "Unable to activate controller '{}' since the state interface '{}' is not available.": "unknown-sensor",
}
"""Refusal → the code that a check reports instead. A reference interface, as of a chain, is none that hardware has."""
_ASKED = "cellc asks for this in the right order, and a person who does not sees the answer"
_WRITTEN = "cellc writes the file that is read, and the catalog is tested with it"
FREE: dict[str, str] = {
    "Controller '{}' can not be configured from '{}' state.": _ASKED,
    "A controller named '{}' was already loaded inside the controller manager": _ASKED,
    "Controller '{}' cannot be cleaned-up from '{}' state.": _ASKED,
    "Controller with name '{}' is in '{}' state. The controller needs to be configured to be in 'inactive' state "
    "before it can be checked and activated.": _ASKED,
    "Could not clean-up controller with name '{}' because no controller with this name exists": _ASKED,
    "Could not configure controller with name '{}' because no controller with this name exists": _ASKED,
    "Could not unload controller with name '{}' because it is still active": _ASKED,
    "Could not unload controller with name '{}' because no controller with this name exists": _ASKED,
    "Failed to activate controller : {}": "says the reason of another refusal again",
    "No state interfaces found to publish. Error initializing joint data. JointStateBroadcaster will not run.": (
        "hardware of the catalog and of own devices has states, or nothing that a manager could read"
    ),
    "System hardware component '{}' from plugin '{}' failed to initialize.": _WRITTEN,
    "Caught exception of type : N9pluginlib20LibraryLoadExceptionE while loading hardware: According to the loaded "
    "plugin descriptions the class {} with base class type hardware_interface::{}Interface does not exist. (cellc "
    "executes {} alone.)": "the mock loads what the catalog names as its mock; the plugin of the robot is not there",
    "Discrepancy between robot description file (urdf) and actually exported HW interfaces.": _WRITTEN,
    "Exception thrown while initializing controller manager parameters: expected [integer] got [double]": _WRITTEN,
    "Joint '{}' has no mimic information in the URDF.": _WRITTEN,
    "Joint '{}' is of type 'fixed'. Fixed joints do not make sense in ros2_control.": "fixed joints get no interfaces",
    "Joint '{}' not found in URDF": "names of `control.joints` are compared with the description when it is read",
    "The 'type' param was not defined for '{}'.": "the spec has no controller without a type",
    "cannot store a negative time point in rclcpp::Time": "a rate must be above zero to be read",
    "failed to initialize rcl: Couldn't parse params file: '--params-file controllers.yaml'. Error: {}": _WRITTEN,
    "no 'ros2_control' tag found in the URDF": "a manager without hardware is not written",
}
"""Refusal → why no spec leads to it."""


def _text(node: ast.expr) -> str:
    if isinstance(node, ast.JoinedStr):
        return "".join(str(part.value) if isinstance(part, ast.Constant) else "{}" for part in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else ""


def _refusals(file: Path) -> Iterator[str]:
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and node.args:
            name = node.func.attr if isinstance(node.func, ast.Attribute) else getattr(node.func, "id", "")
            yield _text(node.args[0]) if name in _REFUSING else ""
        if isinstance(node, ast.FunctionDef) and node.name in _COMPLAINING:
            returned = (
                part.value for part in ast.walk(node) if isinstance(part, ast.Return) and part.value is not None
            )
            yield from map(_text, returned)


def test_every_refusal_of_a_manager_has_an_entry() -> None:
    goals = {"acceptance.py", "motion.py"}  # what a goal is refused for is said to its client
    files = [file for file in _CONTROL.rglob("*.py") if file.name not in goals]
    assert {text for file in files for text in _refusals(file)} - {""} == {*FOUND, *FREE}


def test_entries_name_codes_or_reasons() -> None:
    assert set(FOUND.values()) <= set(all_codes())
    assert not FOUND.keys() & FREE.keys()


@pytest.mark.parametrize("listed", ["{mirror_joint: {state: [position]}}", "{}"])
def test_a_follower_without_its_leader_is_found(listed: str, tmp_path: Path) -> None:
    diagnose_example(Example("yaml", "{}"), tmp_path)
    shutil.copytree(BASE / "demo_gripper", tmp_path / "demo_gripper", dirs_exist_ok=True)
    device = tmp_path / "demo_gripper" / "device.yaml"
    text = device.read_text(encoding="utf-8")
    whole = "{finger_joint: {command: [position], state: [position, velocity]}}"
    assert whole in text
    device.write_text(text.replace(whole, listed), encoding="utf-8")
    found = [
        diagnostic for diagnostic in diagnose(tmp_path / "cell.yaml") if diagnostic.code == "follower-without-leader"
    ]
    assert [diagnostic.yaml_path for diagnostic in found] == [("devices", "gripper", "model")] * (listed != "{}")


@pytest.mark.parametrize(
    ("method", "parent", "reported"),
    [
        ("charuco, eye in hand", "world", True),
        ("charuco, eye-in-hand", "arm/tool0", False),
        ("charuco, eye_on_base", "arm/tool0", True),
        ("charuco, eye to hand", "arm/tool0", True),
        ("charuco, eye_on_base", "world", False),
        ("charuco", "world", False),
    ],
)
def test_an_eye_moves_with_the_hand_in_which_it_was_measured(
    method: str, parent: str, reported: bool, tmp_path: Path
) -> None:
    text = f"calibrations: {{hand_eye: {{method: '{method}'}}}}\ndevices: {{camera: {{mount: {{parent: {parent}}}}}}}\n"
    codes = {diagnostic.code for diagnostic in diagnose_example(Example("yaml", text), tmp_path)}
    assert ("hand-eye-of-another-kind" in codes) is reported
