"""Ports of a computer on which drivers listen: none is given twice, on each computer anew."""

from __future__ import annotations

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.load import load_device
from cellc.compiler.link.ports import listened, port_shifts
from cellc.compiler.spec.devices import DeviceSpec


def robot(**connection: object) -> DeviceSpec:
    """Return a robot as a spec states it."""
    return DeviceSpec.model_validate({"model": "ur5e", "connection": {"host": "pc", **connection}})


def model() -> DeviceModel:
    """Return a robot that connects back to four ports, 50001 to 50004."""
    entry = load_device("ur5e").value
    assert entry is not None
    return entry.model


def literal() -> DeviceModel:
    """Return the same with its ports as plain numbers, so that nothing moves them."""
    facts = model()
    assert facts.control is not None
    assert facts.control.hardware.real is not None
    plain = {
        name: value.replace("{port_", "").replace("}", "")
        for name, value in facts.control.hardware.real.parameters.items()
    }
    real = facts.control.hardware.real.model_copy(update={"parameters": plain})
    hardware = facts.control.hardware.model_copy(update={"real": real})
    return facts.model_copy(update={"control": facts.control.model_copy(update={"hardware": hardware})})


def ports(devices: dict[str, tuple[DeviceSpec, DeviceModel]]) -> dict[str, tuple[int, ...]]:
    """Return the ports of each device."""
    shifts = port_shifts(devices)
    return {name: listened(facts, shifts[name]) for name, (_, facts) in devices.items()}


def test_a_lone_robot_has_the_ports_of_its_vendor() -> None:
    assert ports({"arm": (robot(), model())}) == {"arm": (50001, 50002, 50003, 50004)}


def test_two_models_with_the_same_ports_are_moved_apart() -> None:
    other = model().model_copy(update={"model": "another"})
    assert ports({"left": (robot(), model()), "right": (robot(), other)})["right"] == (50011, 50012, 50013, 50014)


def test_the_same_ports_are_free_on_another_computer() -> None:
    assert ports({"left": (robot(), model()), "right": (robot(host="other"), model())})["right"][0] == 50001


def test_ports_that_the_spec_states_are_taken_before_others_are_given() -> None:
    found = ports({"left": (robot(), model()), "right": (robot(first_port=50003), model())})
    assert found["right"] == (50003, 50004, 50005, 50006)
    assert not set(found["left"]) & set(found["right"])


def test_ports_that_are_plain_numbers_of_an_entry_stay_and_the_others_make_room() -> None:
    found = ports({"left": (robot(), model()), "right": (robot(), literal())})
    assert found["right"] == (50001, 50002, 50003, 50004)
    assert found["left"] == (50011, 50012, 50013, 50014)
