"""The catalog tells of every real plugin what each moment of its life does, and read it where it says."""

from __future__ import annotations

import re

import pytest

from cellc.compiler.catalog.device_interfaces import HardwareFacts
from cellc.compiler.catalog.load import device_names, load_device
from cellc.contract.vocabulary import Distro, Moment, Motion, Need, Unmet
from tests.cells import built
from tests.oracles import here
from tests.vendors.oracle import RELEASES, Release, facts, lines_of

_LIFE = (Moment.INIT, Moment.CONFIGURE, Moment.ACTIVATE, Moment.CLAIM, Moment.RELEASE, Moment.DEACTIVATE, Moment.STOP)


def _real(name: str) -> HardwareFacts | None:
    device = load_device(name).value
    assert device is not None
    return None if device.model.control is None else device.model.control.hardware.real


_MOVED = {name: real for name in device_names() if (real := _real(name)) is not None}


@pytest.mark.parametrize("name", _MOVED)
def test_every_moment_of_a_real_plugin_is_told(name: str) -> None:
    assert set(_LIFE) <= set(_MOVED[name].effects)


@pytest.mark.parametrize("name", _MOVED)
def test_what_moves_or_lets_go_says_what_must_hold_before_it(name: str) -> None:
    for moment, effect in _MOVED[name].effects.items():
        if effect.motion is Motion.MOVES or effect.drops_part:
            assert effect.needs, moment


def test_a_need_is_answered_for_the_distribution_of_the_cell() -> None:
    claim = _MOVED["franka_fr3"].effects[Moment.CLAIM]
    assert claim.unmet(Need.BRAKES_OPEN, Distro.HUMBLE) is Unmet.ENDS_MANAGER
    assert claim.unmet(Need.BRAKES_OPEN, Distro.JAZZY) is Unmet.REFUSED
    assert claim.unmet(Need.BRAKES_OPEN, Distro.LYRICAL) is Unmet.UNKNOWN
    assert claim.unmet(Need.NO_FAULT, Distro.LYRICAL) is Unmet.CLEARS_FAULT


def test_a_cell_has_the_effects_of_its_own_distribution() -> None:
    arm = built("fr3_hand").graph.cell.device("arm")
    assert arm.control.hardware is not None
    assert arm.control.hardware.effects[Moment.CLAIM].needs[Need.BRAKES_OPEN] is Unmet.ENDS_MANAGER
    gripper = built("ur5e_pick").graph.cell.device("gripper").control.hardware
    assert gripper is not None
    assert (gripper.initial_state, gripper.direct_activation) == ("unconfigured", True)
    assert gripper.effects[Moment.ACTIVATE].motion is Motion.MOVES


@pytest.mark.parametrize("release", here(RELEASES), ids=str)
def test_what_the_vendor_s_source_calls_motion_is_motion_here(release: Release) -> None:
    told = facts(release, "hardware_interfaces").get("lifecycle", {})
    effects = _MOVED[release.device].effects if release.device in _MOVED else {}
    for moment, effect in effects.items():
        step = told.get(f"on_{moment}")
        if isinstance(step, dict) and "moves" in step:
            assert (effect.motion is not Motion.NONE) is step["moves"], moment


@pytest.mark.parametrize("release", here(RELEASES), ids=str)
def test_a_line_that_the_catalog_names_of_a_release_is_one_that_was_read(release: Release) -> None:
    read = "".join(release.text(file) for file in ("hardware_interfaces", "hardware_parameters", "nodes"))
    lines = {line for told in re.findall(r":([\d,]+)", read) for line in told.split(",")}
    for moment, effect in _MOVED[release.device].effects.items():
        named = {line for told in lines_of(effect.source, release) for line in told.split(",")}
        assert named <= lines, (moment, named - lines)
