"""What the target ``sim`` cannot show: what is not in the simulator, is another one there, or has another form."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.stops import stops_of
from cellc.compiler.formats.escape import code
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.graph.control_laws import control_laws
from cellc.compiler.graph.simulated import COMMANDED, absent, cameras, force_sensors, simulated, simulated_devices
from cellc.contract.vocabulary import UNKNOWN, Loop


def simulator_section(cell: Cell) -> str:
    """Write what a run in the simulator leaves unknown, each line with what is there in its place."""
    rows = (*_controllers(cell), *_devices(cell), *_sensors(cell), *_of_every_cell())
    return table(("what", "answer", "in the simulator"), ((what, UNKNOWN, there) for what, there in rows))


def _controllers(cell: Cell) -> Iterator[tuple[str, str]]:
    lacking = absent(cell)
    for name, missing in lacking.items():
        more = f" and {len(missing) - 1} more" if len(missing) > 1 else ""
        yield f"controller {code(name)}", f"not loaded, because it takes {code(missing[0])}{more}"
    for before, there in zip(cell.controllers, simulated(cell).controllers, strict=True):
        if before.plugin != there.plugin and before.full_name not in lacking:
            yield f"controller {code(before.full_name)}", f"{code(there.plugin)} in the place of {code(before.plugin)}"
        if before.on_real is not None and before.full_name not in lacking:
            claimed = dict.fromkeys(name.rpartition("/")[2] for name in before.on_real.command_interfaces)
            yield (
                f"loop of {code(before.full_name)} by {' and '.join(claimed)}",
                f"it commands {COMMANDED}, as on the mock",
            )
        if before.stand_in is not None:
            yield f"action {code(before.stand_in.action)} of the driver", f"{code(before.full_name)} takes its goals"


def _devices(cell: Cell) -> Iterator[tuple[str, str]]:
    laws = control_laws(cell)
    for device in cell.devices:
        if states := ", ".join(state.name for state in stops_of(device)):
            yield f"stops and modes of {device.name}: {states}", "nothing stops, faults or changes its mode"
        if device.control.speed_scaling is not None:
            yield f"speed scaling of {device.name}", "trajectories run at their full speed"
        if device.switched is not None:
            yield f"inputs and outputs of {device.name}", "none is exported"
        if others := _other_commands(device):
            yield f"commands of {device.name} by {' and '.join(others)}", f"joints take {COMMANDED} alone"
    for device in simulated_devices(cell):
        law = laws.get(device.name)
        if law is not None and law.loop is Loop.UNKNOWN:
            yield f"servo loops of {device.name}", f"a position loop, because {law.because}"


def _other_commands(device: Device) -> tuple[str, ...]:
    named = (
        name for joint in device.joints for name in joint.command_interfaces if device.control.hardware is not None
    )
    return tuple(name for name in dict.fromkeys(named) if name != COMMANDED)


def _sensors(cell: Cell) -> Iterator[tuple[str, str]]:
    for device in cell.devices:
        for group in force_sensors(device):
            there = "what the robot gives to its tool, without noise; the sign of most drivers is the other one"
            yield f"forces of {code(group.name)}", there
    watched = tuple(cameras(cell))
    for camera in watched:
        yield f"images of {code(camera.frame)}", "drawn without noise, blur, exposure or delay"
        if camera.depth is not None:
            yield f"encoding of {code(camera.depth.topic)}", f"32FC1 in m, {camera.depth.encoding} from the driver"
    if len({camera.rate_hz for camera in watched}) > 1:
        yield "rates of cameras", f"{max(camera.rate_hz for camera in watched):g} Hz for all of them"


def _of_every_cell() -> Iterator[tuple[str, str]]:
    yield "delays and losses of networks and drivers", "none: no driver runs, and all of it runs on one computer"
    yield "deadlines of the update loop", "the loop runs on the time of the simulation, which waits for nothing"
    yield "rights of the security policy", "none for the simulator; run it without enforced security"
