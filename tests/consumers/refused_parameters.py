"""What the real controller manager refuses in parameter files, or takes and suffers from; recorded with 5.16."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any
from xml.etree.ElementTree import fromstring

import yaml

from tests.consumers.declared import complaints, known_plugins
from tests.consumers.parameter_files import flat, matches
from tests.foreign_yaml import safe_load


def parameter_faults(
    text: str, description: str, namespace: str, active: tuple[str, ...], inactive: tuple[str, ...], distro: str
) -> list[str]:
    """Return the recorded classes of refusal and danger that a manager's parameter file falls into.

    Args:
        description: the description that this manager is given.
        active: controllers that one spawner activates, in order.
        inactive: those that are loaded beside them.
    """
    try:
        told = _sections(safe_load(text))
    except (yaml.YAMLError, ValueError, TypeError, AttributeError) as error:
        return [f"the node aborts: {error}"]
    manager = _of(told, f"{namespace}/controller_manager")
    found = list(_manager(manager, description))
    offered = interfaces(description)
    claims: dict[str, str] = {}
    for name in (*active, *inactive):
        values = _of(told, f"{namespace}/{name}")
        plugin = manager.get(f"{name}.type", "")
        found += _controller(name, plugin, values, manager, distro)
        needed = claimed(values)
        found += [f"{name}: {one} is not offered" for one in (*needed, *read(values)) if one not in offered]
        for one in needed if name in active else ():
            if one in claims:
                found.append(f"{one} of {name} is claimed by {claims[one]}")
            claims[one] = name
    return found


def _sections(loaded: Any, before: str = "") -> dict[str, dict[str, Any]]:
    """Return the parameters of each node key; keys without ``ros__parameters`` are namespaces."""
    found: dict[str, dict[str, Any]] = {}
    for key, section in loaded.items():
        name = f"{before}/{key.removeprefix('/')}"
        if "ros__parameters" in section:
            found[name] = dict(flat(section["ros__parameters"]))
            if any(
                isinstance(value, list) and len({type(item) for item in value}) > 1 for value in found[name].values()
            ):
                raise ValueError(f"list of mixed types in {name}")
        elif all(isinstance(value, dict) and value for value in section.values()):
            found |= _sections(section, name)
        else:
            raise ValueError(f"no ros__parameters in {name}")
    return found


def _of(told: Mapping[str, dict[str, Any]], node: str) -> dict[str, Any]:
    return {key: value for name, section in told.items() if matches(name, node) for key, value in section.items()}


def _manager(manager: Mapping[str, Any], description: str) -> Iterator[str]:
    rate = manager.get("update_rate")
    if type(rate) is not int or rate <= 0:
        yield f"update_rate {rate!r}: the node aborts"
    components = {tag.get("name") for tag in fromstring(description).findall("ros2_control")}
    for key, names in manager.items():
        if key.startswith("hardware_components_initial_state.") and isinstance(names, list):
            yield from (f"{key}: unknown component {name}" for name in names if name not in components)


def _controller(
    name: str, plugin: str, values: dict[str, Any], manager: Mapping[str, Any], distro: str
) -> Iterator[str]:
    if "type" in values:
        yield f"{name}: type in its own section"
    if plugin not in known_plugins(distro):
        yield f"{name}: no controller type '{plugin}'"
        return
    own = {key: value for key, value in values.items() if key not in ("type", "update_rate")}
    yield from (f"{name}: {complaint}" for complaint in complaints(distro, plugin, own))
    rate, cycle = values.get("update_rate", manager.get("update_rate")), manager.get("update_rate")
    if isinstance(rate, int) and isinstance(cycle, int) and rate and cycle % rate:
        yield f"{name}: update_rate {rate} does not divide {cycle}"


def claimed(values: Mapping[str, Any]) -> list[str]:
    """Return the command interfaces that a controller claims."""
    single = [values["interface_name"]] if "interface_name" in values else []
    kinds = values.get("command_interfaces", single)
    found = [f"{joint}/{kind}" for joint in values.get("joints", ()) for kind in kinds]
    found += [f"{values['joint']}/position"] if "joint" in values else []
    for gpio in values.get("gpios", ()):
        found += [f"{gpio}/{kind}" for kind in values.get(f"command_interfaces.{gpio}.interfaces", ())]
    return found


def read(values: Mapping[str, Any]) -> list[str]:
    """Return the state interfaces that a controller reads, marked as states."""
    names = [*values.get("joints", ()), *([values["joint"]] if "joint" in values else [])]
    found = [f"{name}/{kind} (state)" for name in names for kind in values.get("state_interfaces", ())]
    scaling = values.get("speed_scaling_interface_name") or values.get("speed_scaling.state_interface")
    return [*found, *([f"{scaling} (state)"] if scaling else [])]


def interfaces(description: str) -> set[str]:
    """Return every interface that the hardware of a description offers; states are marked."""
    return {
        f"{tag.get('name')}/{one.get('name')}" + (" (state)" if one.tag == "state_interface" else "")
        for component in fromstring(description).findall("ros2_control")
        for tag in component
        if tag.tag in ("joint", "gpio", "sensor")
        for one in tag
        if one.tag in ("command_interface", "state_interface")
    }
