"""What the tool connector of a robot gives, what forwards its serial line, and the gripper that hangs on it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from cellc.compiler.catalog.device_model import DeviceModel, GripperFacts
from cellc.compiler.catalog.robot_facts import PlugFacts, ToolConnectorFacts, ToolSerialFacts
from cellc.compiler.cell.device import Gripper
from cellc.compiler.cell.robot import HostProgram, Plug, ToolConnector, ToolFacts, ToolSerial
from cellc.compiler.link.names import Placeholders
from cellc.compiler.link.quantities import si
from cellc.compiler.spec.devices import DeviceSpec, GripSpec
from cellc.compiler.spec.tool import ToolSerialSpec


def tool_connector(facts: DeviceModel, written: DeviceSpec) -> ToolConnector | None:
    """Return what the connector at the tool frame supplies; None where the spec says nothing."""
    connector = written.tool_connector
    if connector is None:
        return None
    serial = None if connector.serial is None else _serial(connector.serial, _line(facts, written))
    return ToolConnector(voltage_v=connector.voltage.si, serial=serial)


def tool_parameters(facts: DeviceModel, written: DeviceSpec, known: Placeholders) -> dict[str, str]:
    """Return what the real plugin gets of the serial line of the tool connector."""
    line = _line(facts, written)
    return {} if line is None else {name: known.fill(value) for name, value in line.parameters.items()}


def host_programs(device: str, facts: DeviceModel, written: DeviceSpec, known: Placeholders) -> tuple[HostProgram, ...]:
    """Return the program that makes a device node of the serial line, where one is used."""
    line = _line(facts, written)
    if line is None:
        return ()
    forward = HostProgram(
        name=f"{device}_tool_serial",
        package=line.forward.package,
        program=line.forward.program,
        arguments=tuple(map(known.fill, line.forward.arguments)),
        system=line.forward.system,
    )
    return (forward,)


def gripper_words(facts: DeviceModel) -> dict[str, str]:
    """Return placeholders for the data of a gripper in the units of plugins: rad or m, m/s, N."""
    gripper = facts.gripper
    if gripper is None:
        return {}
    speed, force, closed = f"{gripper.max_speed.si:.3f}", f"{gripper.max_force.si:g}", f"{gripper.closed.si:g}"
    return {"gripper_max_speed": speed, "gripper_max_force": force, "gripper_closed": closed}


def tool_words(facts: DeviceModel, written: DeviceSpec) -> Iterator[tuple[str, str]]:
    """Yield placeholders for what the spec says of a tool connector, and of the robot whose connector is used."""
    connector, line = written.tool_connector, _line(facts, written)
    if written.connection is not None and written.connection.through is not None:
        yield "carrier", written.connection.through
    if connector is None:
        return
    yield "tool_voltage", f"{connector.voltage.si:g}"
    if connector.serial is None or line is None:
        return
    serial = _serial(connector.serial, line)
    yield "tool_baud_rate", str(serial.baud_rate)
    yield "tool_parity", line.parities.get(connector.serial.parity, connector.serial.parity)
    yield "tool_stop_bits", str(serial.stop_bits)
    yield "tool_port", serial.port
    for name in ("rx_idle_chars", "tx_idle_chars", "tcp_port"):
        yield f"tool_{name}", f"{getattr(serial, name):g}"


def tool_conditions(written: DeviceSpec, way: str) -> Iterator[str]:
    """Yield what is so of a device by its tool connector, or by that of another."""
    if written.connection is not None and written.connection.through is not None:
        yield "through_tool"
    if written.tool_connector is not None:
        yield "tool_power" if written.tool_connector.serial is None else f"tool_serial_{way}"


def tool_facts(facts: ToolConnectorFacts | None) -> ToolFacts | None:
    """Return what the tool connector of a robot can give."""
    if facts is None:
        return None
    voltages, line = tuple(voltage.si for voltage in facts.voltages), facts.serial
    if line is None:
        return ToolFacts(voltages_v=voltages)
    idle = {"rx_idle_chars": line.rx_idle_chars, "tx_idle_chars": line.tx_idle_chars}
    return ToolFacts(
        voltages_v=voltages,
        has_serial=True,
        settings={"baud_rate": line.baud_rates, "parity": tuple(line.parities), "stop_bits": line.stop_bits},
        spans={name: (figures.least, figures.most) for name, figures in idle.items()},
    )


def plug(facts: PlugFacts | None) -> Plug | None:
    """Return what a device takes from the tool connector of a robot."""
    if facts is None:
        return None
    return Plug(voltage_v=facts.voltage.si, serial=None if facts.serial is None else facts.serial.model_dump())


def _line(facts: DeviceModel, written: DeviceSpec) -> ToolSerialFacts | None:
    """Return the facts of a serial line that is used."""
    connector, known = written.tool_connector, facts.robot.tool_connector
    return None if connector is None or connector.serial is None or known is None else known.serial


def _serial(written: ToolSerialSpec, facts: ToolSerialFacts | None) -> ToolSerial:
    """Return a serial line as the spec has it, else as the robot usually has it."""
    stated = ToolSerial(
        port=written.port,
        baud_rate=written.baud_rate,
        parity=written.parity,
        stop_bits=written.stop_bits,
        rx_idle_chars=written.rx_idle_chars,
        tx_idle_chars=written.tx_idle_chars,
        tcp_port=written.tcp_port,
    )
    if facts is None:
        return stated
    return replace(
        stated,
        rx_idle_chars=facts.rx_idle_chars.usual if stated.rx_idle_chars is None else stated.rx_idle_chars,
        tx_idle_chars=facts.tx_idle_chars.usual if stated.tx_idle_chars is None else stated.tx_idle_chars,
        tcp_port=facts.tcp_port if stated.tcp_port is None else stated.tcp_port,
    )


def gripper_of(facts: DeviceModel, written: DeviceSpec, prefix: str) -> Gripper | None:
    """Return the gripper that the device is, with the speed and force that the spec states."""
    gripper, stated = facts.gripper, written.grip or GripSpec()
    if gripper is None:
        return None
    speed = gripper.max_speed.si if stated.speed is None else min(stated.speed.si, gripper.max_speed.si)
    return Gripper(
        joint=prefix + gripper.joint,
        open=gripper.open.si,
        closed=gripper.closed.si,
        max_force=gripper.max_force.si,
        max_velocity=_joint_speed(gripper, speed),
        goal_tolerance=float(gripper.goal_tolerance.si),
        stroke_m=gripper.stroke.si,
        swing=si(gripper.swing),
        max_speed_m_s=gripper.max_speed.si,
        min_force=si(gripper.min_force),
        grip_speed_m_s=si(stated.speed),
        grip_force=si(stated.force),
    )


def _joint_speed(gripper: GripperFacts, speed_m_s: float) -> float | None:
    """Return the joint speed that corresponds to a speed of the jaws, in rad/s or m/s; None where it has no value.

    Jaw travel is taken as linear in the joint position. The limit in a vendor's URDF differs, and was not measured.
    """
    way, stroke = abs(float(gripper.closed.si) - float(gripper.open.si)), gripper.stroke.si
    return speed_m_s * way / stroke or None if stroke > 0.0 else None
