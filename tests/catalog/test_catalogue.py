"""Every entry of the catalog loads, binds, and agrees with what it was written from."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from cellc.compiler.catalog.compiled import CATALOG
from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.device_interfaces import counted
from cellc.compiler.catalog.effects import EffectFacts
from cellc.compiler.catalog.load import (
    CatalogDevice,
    controller_kinds,
    device_names,
    load_controller_kind,
    load_controller_manager,
    load_device,
    load_device_folder,
    load_distros,
    load_message_types,
    load_packages,
    load_planners,
    load_programs,
    load_qos_profiles,
    load_releases,
)
from cellc.compiler.catalog.parameter_facts import ParameterFacts
from cellc.contract.vocabulary import OF_ONE_DEVICE, Distro, Need, Unmet
from tests.catalog.declarations import upstream_parameters
from tests.cells import ROOT, catalog_facts, there

PLACEHOLDERS = {
    *("device", "prefix", "bare_prefix", "prefix_namespace", "stem"),
    *("address", "port", "host_address", "carrier_address", "username", "password"),
    *("played_by", "thresholds", "carrier", "load", "joint_stiffness", "cartesian_stiffness"),
    *("tool_voltage", "tool_baud_rate", "tool_parity", "tool_stop_bits", "tool_port"),
    *("gripper_max_speed", "gripper_max_force", "gripper_closed"),
    *("tool_rx_idle_chars", "tool_tx_idle_chars", "tool_tcp_port"),
}
ARMS = ("franka_fr3", "ur5e", "ur10e", "ur18", "ur30")


def _device(name: str) -> CatalogDevice:
    outcome = load_device(name)
    assert outcome.diagnostics == ()
    return there(outcome.value)


def _kind(name: str) -> ControllerKind:
    outcome = load_controller_kind(name)
    assert outcome.diagnostics == ()
    return there(outcome.value)


@pytest.mark.parametrize("name", device_names())
def test_device_loads_under_its_own_name(name: str) -> None:
    device = _device(name)
    assert device.model.model == name
    assert device.description.roots() == (device.model.base,)


@pytest.mark.parametrize("name", device_names())
def test_device_text_uses_known_placeholders_only(name: str) -> None:
    for placeholder in re.findall(r"\{([a-z_:]+)\}", json.dumps(catalog_facts(name), ensure_ascii=False)):
        kind = placeholder.removeprefix("controller_")
        own = kind != placeholder and kind in _device(name).model.controllers
        assert own or placeholder in PLACEHOLDERS or placeholder.startswith("share:")


@pytest.mark.parametrize("name", device_names())
def test_device_speaks_of_known_types_profiles_and_kinds(name: str) -> None:
    model = _device(name).model
    types, profiles = there(load_message_types().value), there(load_qos_profiles().value)
    for topic in model.topics:
        assert types.kind_of(topic.type) == "topic"
        assert not isinstance(topic.qos, str) or topic.qos in profiles.profiles
    for service in model.services:
        assert types.kind_of(service.type) == "service"
    for action in model.actions:
        assert types.kind_of(action.type) == "action"
    released = {row.distro for row in model.versions if row.part == "driver"}
    for controller in model.controllers.values():
        assert controller.behavior in (*controller_kinds(), *OF_ONE_DEVICE)
        # A controller of the vendor exists where its driver is released, one of ros2_controllers everywhere.
        assert set(controller.plugins) in (set(Distro), released)


@pytest.mark.parametrize("name", ARMS)
def test_every_moving_joint_of_an_arm_has_acceleration_and_jerk(name: str) -> None:
    arm = _device(name)
    for joint in arm.description.joints:
        if joint.movable:
            assert arm.model.limits.acceleration_of(joint.name) is not None
            assert arm.model.limits.jerk_of(joint.name) is not None


@pytest.mark.parametrize("name", ARMS)
def test_home_lies_within_the_limits(name: str) -> None:
    arm = _device(name)
    assert arm.model.home is not None
    assert set(arm.model.home) == {joint.name for joint in arm.description.joints if joint.movable}
    for name, position in arm.model.home.items():
        joint = there(arm.description.joint(name))
        assert joint.limit is not None
        assert there(joint.limit.lower) <= position.si <= there(joint.limit.upper)


@pytest.mark.parametrize("load", [load_device, load_controller_kind])
@pytest.mark.parametrize("name", ["ur5", "joint_trajectry", "", "../devices/ur5e", "ur.family"])
def test_name_that_is_not_listed_is_refused(load: Callable[[str], object], name: str) -> None:
    with pytest.raises(KeyError):
        load(name)


def test_device_of_the_user_with_a_wrong_value_is_reported_on_its_line(tmp_path: Path) -> None:
    text = (CATALOG / "devices/realsense/d400.family.yaml").read_text(encoding="utf-8")
    lines = (
        ("summary: own\n" + text)
        .replace('"{model}"', "own")
        .replace("rate: 30 Hz\n      qos", "rate: 30 mm\n      qos", 1)
        .splitlines()
    )
    (tmp_path / "device.yaml").write_text("\n".join(lines), encoding="utf-8")
    (found,) = load_device_folder(tmp_path, tmp_path).diagnostics
    assert found.code == "catalog-entry-invalid"
    assert "30 mm" in lines[found.span.line - 1]


@pytest.mark.parametrize("text", ["", "# nothing\n", "\n\n"])
def test_device_of_the_user_that_holds_no_data_is_reported_at_its_first_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "device.yaml").write_text(text, encoding="utf-8")
    (found,) = load_device_folder(tmp_path, tmp_path).diagnostics
    assert (found.code, found.span.line, found.span.column) == ("empty-file", 1, 1)


def test_device_of_the_user_with_a_frame_that_its_description_lacks_is_reported(tmp_path: Path) -> None:
    facts = (
        "format: 1\nmodel: box\nvendor: own\nsummary: a box\nkind: camera\nas_of: 2026-07-01\nsources: [own]\n"
        "description: {file: box.urdf}\nbase: base_link\nframes: {lens: lense}\npackages: {}\n"
    )
    (tmp_path / "device.yaml").write_text(facts, encoding="utf-8")
    urdf = '<robot name="box"><link name="base_link"/><link name="lens"/></robot>'
    (tmp_path / "box.urdf").write_text(urdf, encoding="utf-8")
    (found,) = load_device_folder(tmp_path, tmp_path).diagnostics
    assert (found.span.line, found.help) == (10, "did you mean `lens`?")


_OWN = "format: 1\nmodel: own\nvendor: nobody\nsummary: a link\nkind: arm\nas_of: 2026-07-01\nsources: [none]\n"


def test_description_that_is_not_there_is_reported_where_it_is_named(tmp_path: Path) -> None:
    text = f"{_OWN}description: {{file: b.urdf}}\nbase: a\nframes: {{a: a}}\npackages: {{}}\n"
    (tmp_path / "device.yaml").write_text(text, encoding="utf-8")
    (found,) = load_device_folder(tmp_path, tmp_path).diagnostics
    assert (found.code, found.span.file, found.span.line) == ("xacro-file-not-found", f"{tmp_path}/device.yaml", 8)


@pytest.mark.parametrize("name", ["a\\n", "a b", "a//b", "${a}"])
def test_a_name_of_a_device_of_the_user_is_one_word_without_a_line_break(tmp_path: Path, name: str) -> None:
    text = f'{_OWN}description: {{file: a.urdf}}\nbase: a\nframes: {{"{name}": a}}\npackages: {{}}\n'
    (tmp_path / "device.yaml").write_text(text, encoding="utf-8")
    (tmp_path / "a.urdf").write_text('<robot name="a"><link name="a"/></robot>', encoding="utf-8")
    (found,) = load_device_folder(tmp_path, tmp_path).diagnostics
    assert found.code in ("catalog-entry-invalid", "substitution-in-text")
    assert found.span.line == 10


def test_the_name_of_a_hardware_component_is_a_name_of_ros(tmp_path: Path) -> None:
    hardware = "{mock: {plugin: mock_components/GenericSystem, source: none}}"
    control = f"{{component: 'a %0A b', hardware: {hardware}, joints: {{}}}}"
    text = f"{_OWN}description: {{file: a.urdf}}\nbase: a\nframes: {{a: a}}\npackages: {{}}\ncontrol: {control}\n"
    (tmp_path / "device.yaml").write_text(text, encoding="utf-8")
    (found,) = load_device_folder(tmp_path, tmp_path).diagnostics
    assert (found.code, found.span.line, found.yaml_path) == ("catalog-entry-invalid", 12, ("control", "component"))


def test_tables_load() -> None:
    for load in (
        load_distros,
        load_controller_manager,
        load_message_types,
        load_packages,
        load_qos_profiles,
        load_releases,
    ):
        outcome = load()
        assert outcome.diagnostics == ()
        assert outcome.value is not None


def test_every_driver_of_the_catalogue_is_known_to_reach_hardware() -> None:
    facts = [_device(name).model for name in device_names()]
    drivers = {device.packages.driver for device in facts} | {node.package for device in facts for node in device.nodes}
    components = [device.control.hardware.real for device in facts if device.control is not None]
    plugins = {component.plugin.partition("/")[0] for component in components if component is not None}
    table = there(load_distros().value)
    assert set(table.hardware_packages) == {*drivers, *plugins, "controller_manager"} - {None}


def test_reader_of_system_default_is_best_effort_on_fast_dds_alone() -> None:
    table = there(load_qos_profiles().value)
    readers = {rmw: ends.reader.reliability for rmw, ends in table.system_default.items()}
    assert readers == {
        "rmw_fastrtps_cpp": "best_effort",
        "rmw_cyclonedds_cpp": "reliable",
        "rmw_zenoh_cpp": "reliable",
    }


@pytest.mark.parametrize("distro", Distro)
@pytest.mark.parametrize("kind", controller_kinds())
def test_parameters_are_those_that_upstream_declares(kind: str, distro: Distro) -> None:
    upstream = upstream_parameters(kind, distro)
    ours = {name: facts for name, facts in _kind(kind).parameters.items() if facts.declared_in(distro)}
    assert set(ours) == set(upstream)
    for name, facts in ours.items():
        assert facts.type == upstream[name]["type"], name
        assert _default(facts, distro) == _comparable(upstream[name].get("default_value")), name


def _default(facts: ParameterFacts, distro: Distro) -> Any:
    variant = facts.differs.get(distro)
    if variant is not None and "default" in variant.model_fields_set:
        return _comparable(variant.default)
    return _comparable(facts.default)


def _comparable(value: Any) -> Any:
    return repr(list(value)) if isinstance(value, (list, tuple)) else repr(value)


def test_every_package_that_the_catalog_names_and_that_a_cell_needs_is_known() -> None:
    table = there(load_packages().value)
    facts = [_device(name).model for name in device_names()]
    parts = [part for device in facts for part in device.packages.model_dump().values()]
    named = {part for part in parts if isinstance(part, str)} | set(_packages_of(parts))
    named |= {node.package for device in facts for node in device.nodes}
    named |= {package for kind in controller_kinds() for package in _packages_of(_kind(kind).model_dump())}
    for loaded in (load_distros(), load_message_types(), load_planners(), load_programs(), load_controller_manager()):
        named |= set(_packages_of(there(loaded.value).model_dump()))
    types = there(load_message_types().value)
    distros = there(load_distros().value)
    named |= {name.split("/")[0] for name in types.types} | set(distros.hardware_packages)
    named |= {name for distro in distros.distros.values() for name in (*distro.packages, *distro.rmw)}
    for manifest in Path("generated").glob("*/package.xml"):
        named |= set(re.findall(r"_depend[^>]*>([^<]+)<", manifest.read_text(encoding="utf-8")))
    of_users = {name for name in named if name and name.startswith("cell_")}
    possible = {name for name in named - of_users if name and re.fullmatch("[a-z][a-z0-9_]+", name)}
    assert len(possible) > 80
    assert [name for name in sorted(possible) if not table.has(name)] == []


def _packages_of(value: object) -> Iterator[str]:
    if isinstance(value, dict):
        yield from (one for key, one in value.items() if key == "package" and isinstance(one, str))
        yield from (name for item in value.values() for name in _packages_of(item))
    elif isinstance(value, (list, tuple)):
        yield from (name for item in value for name in _packages_of(item))


def test_numbers_are_written_out() -> None:
    assert list(counted(["gpio/in_[0..2]", "gpio/mode"])) == ["gpio/in_0", "gpio/in_1", "gpio/in_2", "gpio/mode"]


def test_number_of_a_stranger_is_not_counted_up_to() -> None:
    # Written out it was more than the memory of the machine.
    assert list(counted(["a_[0..99999999999]"])) == ["a_[0..99999999999]"]


@pytest.mark.parametrize(
    ("told", "distro", "becomes"),
    [
        ("refused", "humble", Unmet.REFUSED),
        ({"humble": "refused", "jazzy": "ends_program"}, "humble", Unmet.REFUSED),
        ({"humble": "refused", "jazzy": "ends_program"}, "jazzy", Unmet.ENDS_PROGRAM),
        ({"humble": "refused"}, "kilted", Unmet.UNKNOWN),
    ],
)
def test_unmet_need(told: Any, distro: str, becomes: Unmet) -> None:
    facts = {"motion": "none", "does": "nothing", "source": "made up", "needs": {"program_stopped": told}}
    assert EffectFacts.model_validate(facts).unmet(Need.PROGRAM_STOPPED, Distro(distro)) is becomes


_REPOSITORY = re.compile(r"github\.com/[\w.-]+/[\w-]+")


def test_every_repository_that_the_catalog_cites_has_its_license() -> None:
    catalog = ROOT / "cellc" / "compiler" / "catalog"
    files = [file for file in catalog.rglob("*.yaml") if "symptoms" not in file.parts]  # those cite threads
    cited = {name for file in files for name in _REPOSITORY.findall(file.read_text(encoding="utf-8"))}
    lines = (ROOT / "NOTICE").read_text(encoding="utf-8").splitlines()
    named = {line.split()[0]: line.split(maxsplit=1)[1] for line in lines if _REPOSITORY.match(line.strip())}
    assert len(cited) > 5
    assert cited <= named.keys()
    assert not [name for name, license_text in named.items() if "UNKNOWN" in license_text]
