"""Subjects of gate lines: the things of a cell, each with the fields that a text may name."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Device
from cellc.compiler.cell.interface import Interface
from cellc.compiler.cell.real_target import unmoved_on_real
from cellc.compiler.deploy.drills import (
    adapter_drills,
    claimed,
    claimed_adapter_drills,
    claimed_drills,
    early_drills,
    interlocks,
    late_drills,
    open_drills,
    pulled,
)
from cellc.compiler.deploy.ends import is_late
from cellc.compiler.deploy.files import is_servo
from cellc.compiler.deploy.gate_loads import loaded_devices, tool_centers, tool_connectors
from cellc.compiler.deploy.gate_motion import (
    Values,
    authorized_motion,
    cancels,
    driven_back,
    endpoint_command,
    first_motion,
    first_stage,
    gripper_goals,
    guided,
    guided_back,
    guiding,
    jogged,
    jogging,
    later_stages,
    missing_first_motion,
    real_actions,
    released,
    risk_assessment,
    senders,
    short_motions,
    small_goal,
    stated_jogs,
    stop_reasons,
    unguarded,
    unstated_jogs,
)
from cellc.compiler.deploy.gate_states import (
    bounded_clocks,
    identities,
    layers_first,
    layers_powered,
    modes,
    open_speed_controls,
    open_stop_figures,
    read_states,
    ready_states,
    secret_files,
    self_resuming,
    speed_controls,
    stop_evidence,
    stop_figures,
    stop_tests,
    stopping_devices,
    unreported_stops,
    variables,
    without_speed_control,
)
from cellc.compiler.deploy.gate_versions import (
    built,
    elsewhere,
    rollback,
    shown_with_power,
    unknown,
    unknown_with_power,
    visible,
)
from cellc.compiler.deploy.labels import said_around
from cellc.compiler.deploy.processes import description_nodes, launch_hosts, used_hosts
from cellc.compiler.deploy.readiness import shown_late
from cellc.compiler.deploy.recording import record_command
from cellc.compiler.deploy.releases import ACTIVATE, CLAIM, move_mock, restart_of, start_mock, start_real
from cellc.compiler.deploy.versions import fetched_parts
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.numbers import shortest
from cellc.compiler.formats.urdf.hardware import credentials
from cellc.compiler.graph.cell_graph import CellGraph
from cellc.compiler.link.derived import JOINT_STATE_TYPE
from cellc.contract.vocabulary import UNKNOWN, BringUpPhase, Feature, InterfaceKind, features

Row = Mapping[str, str]
_SLOWER = "5 %"
"""Of its stated rate, by which a topic may arrive more slowly: commands print an average."""

CELL = "cell"
"""The subject of a line that is written once."""


def cell_row(cell: Cell, header: Header, code: str) -> Row:
    """Return what every text and command may name; ``record`` is for a bag of one gate."""
    stop = cell.safety.stop
    return {
        "gate": code,
        "cell": cell.name,
        "build": header.command,
        "description": f"generated/{cell.name}/urdf/{cell.name}.real.urdf",
        "start_mock": start_mock(cell),
        "record": " \\\n  ".join(record_command(cell, f"{code}-bag")),
        "domain": str(cell.network.domain_id),
        "stop_authority": stop.authority,
        "stop_path": stop.path,
        "observer": cell.safety.recovery.observer,
        "restart": restart_of(cell),
        "secrets": "".join(f"{name}=none " for device in cell.devices for name in credentials(device)[0]),
        "attempt_fields": ", ".join(cell.recording.attempt_fields),
    }


def _calibrated_frames(graph: CellGraph) -> Iterator[Values]:
    return ((frame.name, frame.calibration) for frame in graph.cell.frames if frame.calibration is not None)


def _success(graph: CellGraph) -> Iterator[Values]:
    """Yield the rehearsals that must succeed often enough, with least share and confidence."""
    for rehearsal in graph.cell.rehearsals:
        if rehearsal.success is not None:
            yield rehearsal.name, f"{100.0 * rehearsal.success:.6g} %", f"{rehearsal.confidence:.6g}"


def _mock_statements(graph: CellGraph) -> Iterator[Values]:
    return ((device.name, name, said.by, said.date) for device, name, said in graph.cell.signed_for_mock())


def _mock_actions(graph: CellGraph) -> Iterator[Values]:
    return (
        (controller.action,)
        for controller in graph.cell.controllers
        if controller.action and "mock" in controller.targets
    )


def _observing(graph: CellGraph) -> Iterator[Values]:
    """Yield where the running graph is observed: on each host, which is responsible for its own ends."""
    hosts = launch_hosts(graph.cell)
    return ((f"On {host}: ", f" --host {host}") for host in hosts) if hosts else iter((("", ""),))


def _joint_states(graph: CellGraph) -> Iterator[Interface]:
    return (interface for interface in _on_real(graph) if interface.type == JOINT_STATE_TYPE and interface.sinks)


def _servo(graph: CellGraph) -> Iterator[Values]:
    """Yield what MoveIt Servo commands, what starts it, and the command that shows the ends of its topic."""
    servo = graph.cell.servo
    if servo is not None:
        (node,) = (node for node in graph.cell.nodes if is_servo(graph.cell, node))
        service = "switch_command_type" if Feature.PLUGIN_LISTS in features(graph.cell.distro) else "start_servo"
        speeds = (graph.cell.text("motion", "servo", name) for name in ("linear", "rotational", "joint"))
        timeout = shortest(servo.command_timeout_s)
        command = endpoint_command(graph.cell, InterfaceKind.TOPIC, servo.topic)
        yield node.full_name, f"{node.full_name}/{service}", servo.controller, *speeds, timeout, command


def _by_vendors(
    graph: CellGraph, *, after_release: bool = False, powers: bool = False, moves: bool = False
) -> Iterator[Values]:
    """Yield the vendors' steps for people in the gates, or those that come there after a release.

    Steps that power the drives are yielded separately: a stop is tested on powered drives. So are those that move a
    device by a program of its vendor, after small goals of the cell.
    """
    for device in graph.cell.devices:
        for step in device.procedures.commissioning:
            if (step.after_release, step.powers, step.moves) == (after_release, powers, moves):
                commands = (
                    *(_addressed(device, command) for command in step.run),
                    *_of_this_launch(device.name, step.log),
                )
                yield device.name, step.does, "\n".join(commands), step.gate, step.sets or ""


def _addressed(device: Device, command: str) -> str:
    address = UNKNOWN if device.site.connection is None else device.site.connection.address or UNKNOWN
    return command.replace("{address}", shell_word(address))


def _of_this_launch(device: str, lines: tuple[str, ...]) -> Iterator[str]:
    """Yield commands that compare the last line with one of these texts in the log of the newest hardware launch.

    Each launch has a folder of its own below that of the logs. An earlier run's line would be taken for this one's, so
    that no line fails too, and the name of the file, with its time, is printed above it.
    """
    if lines:
        wanted = " ".join(f"-e {shell_word(line)}" for line in lines)
        managers = 'grep -lF -e ros2_control_node "$(printenv ROS_LOG_DIR || echo ~/.ros/log)"/*/launch.log'
        newest = f"{managers} | xargs -r -d '\\n' ls -t | head -n 1 | xargs -r -d '\\n'"
        passed, failed = (
            f"echo '{verdict}  log         {device}: last line above'" for verdict in ("PASSED", "FAILED")
        )
        verdict = f"grep -qF {shell_word(lines[0])} && {passed} || {failed}"
        yield from (f"{newest} ls -l", f"{newest} grep -hF {wanted} | tail -n 1 | tee /dev/stderr | {verdict}")


def _nominal_devices(graph: CellGraph) -> Iterator[Values]:
    for device in graph.cell.devices:
        if device.body.kinematics is not None and device.body.kinematics.calibration is None:
            file = f"{graph.cell.name}/{device.name}_calibration.yaml"
            target = f'"$(pwd)"/{shell_word(f"cells/{file}")}'
            command = _addressed(device, device.body.kinematics.command).replace("FILE", target)
            yield device.name, device.body.kinematics.state, f"cells/{file}", command


def _calibrated_devices(graph: CellGraph) -> Iterator[Values]:
    for device in graph.cell.devices:
        calibration = None if device.body.kinematics is None else device.body.kinematics.calibration
        if calibration is not None:
            facts = (calibration.name, calibration.hash, calibration.measured, calibration.owner, calibration.sha256)
            yield device.name, *facts, f"cells/{graph.cell.name}/{calibration.name}"


def _cards(graph: CellGraph) -> Iterator[Values]:
    """Yield the cards of computers on which no program of the cell compares them."""
    compared = used_hosts(graph.cell)
    for nic in graph.network.nics:
        if nic.host not in compared:
            yield nic.full_name, nic.text, ", ".join(nic.carries) or "none declared"


def _reached_devices(graph: CellGraph) -> Iterator[Values]:
    for device in graph.network.devices:
        if device.text is not None:
            yield device.host, device.device, device.nic or "not stated", device.text


def _late_streams(graph: CellGraph) -> Iterator[Values]:
    """Yield the topics with a rate that wait for hardware that a person activates."""
    for interface in _on_real(graph):
        if interface.rate_hz is not None and interface.kind is InterfaceKind.TOPIC and is_late(graph, interface):
            # What is measured is the sum of all sources, and the interface has the rate of the slowest manager.
            several = f" or more ({len(interface.sources)} sources)" if len(interface.sources) > 1 else ""
            age = (
                "no age limit"
                if interface.max_age_s is None
                else f"no sample older than {shortest(interface.max_age_s)} s"
            )
            yield interface.name, f"{shortest(interface.rate_hz)} Hz{several}, at most {_SLOWER} less", age


def _seen(graph: CellGraph) -> Iterator[Values]:
    """Yield the topics with a rate of nodes that look at images: without what they look for they publish nothing."""
    watching = {
        end.full_name
        for each in _on_real(graph)
        if each.type.endswith(("/Image", "/PointCloud2"))
        for end in each.sinks
    }
    for interface in _on_real(graph):
        if interface.kind is InterfaceKind.TOPIC and interface.rate_hz is not None:
            yield from ((end.full_name, interface.name) for end in interface.sources if end.full_name in watching)


def _late_groups(graph: CellGraph) -> Iterator[Values]:
    """Yield the ends of planning groups whose joints do not show from the start on."""
    return ((group.tip_frame, group.base_link) for group in shown_late(graph.cell))


def _on_real(graph: CellGraph) -> Iterator[Interface]:
    return (interface for interface in graph.cell.interfaces if "real" in interface.targets)


def _each(values: tuple[str, ...]) -> Iterator[Values]:
    return ((value,) for value in values)


_VENDOR_STEP = ("device", "does", "command", "gate", "sets")
_DRILL = ("device", "act", "follows")
_PAYLOAD = ("device", "mass", "center_of_mass", "inertia", "and_inertia", "frame", "set_by", "entry", "gate")
_CENTER = ("device", "tcp", "frame", "xyz", "rotation_vector", "rpy", "rotation", "command", "same", "gate")
_STREAM = ("topic", "rate", "age")
_FIRST_MOTION = ("joint", "direction", "max_delta", "velocity", "timeout", "name", "si")
_SUBJECTS: Mapping[str, tuple[Values, Callable[[CellGraph], Iterator[Values]]]] = {
    "built_part": (("command",), built),
    "elsewhere_part": (("part", "version"), elsewhere),
    "fetched_part": (("part", "version", "driver"), lambda graph: fetched_parts(graph.cell)),
    "visible_part": (("part", "version"), visible),
    "rollback_part": (("part", "version"), rollback),
    "powered_part": (("part", "version", "gate"), shown_with_power),
    "unknown_part": (("holder", "parts"), unknown),
    "unknown_powered_part": (("part", "gate"), unknown_with_power),
    "nominal_device": (("device", "state", "file", "command"), _nominal_devices),
    "calibrated_device": (("device", "file", "hash", "measured", "owner", "sha256", "path"), _calibrated_devices),
    "calibrated_frame": (("frame", "calibration"), _calibrated_frames),
    "surrounding": (("part", "what"), lambda graph: said_around(graph.cell)),
    "mock_statement": (("device", "loaded", "by", "date"), _mock_statements),
    "success": (("rehearsal", "share", "confidence"), _success),
    "mock_motion": (("command",), lambda graph: _each(move_mock(graph.cell))),
    "manager": (("manager",), lambda graph: ((manager.node,) for manager in graph.cell.managers)),
    "observing": (("where", "host"), _observing),
    "mock_action": (("action",), _mock_actions),
    "real_start": (("where", "command"), lambda graph: start_real(graph.cell)),
    "joint_states": (("topic",), lambda graph: ((interface.name,) for interface in _joint_states(graph))),
    "stopping_device": (("device", "states", "command", "gate"), stopping_devices),
    "unreported_stop": (("device", "state", "seen", "gate"), unreported_stops),
    "ready_states": (("device", "states"), ready_states),
    "read_states": (("device", "states"), read_states),
    "seen": (("node", "topic"), _seen),
    "variables": (("device", "names", "command"), variables),
    "secret_file": (("device", "file", "command"), secret_files),
    "modes": (("device", "modes", "gate"), modes),
    "self_resuming": (("device", "state"), self_resuming),
    "loaded_device": (_PAYLOAD, loaded_devices),
    "loaded_when_powered": (_PAYLOAD, lambda graph: loaded_devices(graph, powered=True)),
    "tool_center": (_CENTER, tool_centers),
    "center_when_powered": (_CENTER, lambda graph: tool_centers(graph, powered=True)),
    "layers_first": ((), layers_first),
    "layers_powered": (("device", "gate"), layers_powered),
    "tool_connector": (("device", "voltage", "tools"), tool_connectors),
    "servo": (("node", "starts", "controller", "linear", "rotational", "joint", "timeout", "command"), _servo),
    "stop_test": (("gate", "powered", "restarted"), stop_tests),
    "stop_evidence": (("evidence", "gate"), stop_evidence),
    "stop_figures": (("device", "figures", "source", "gate"), stop_figures),
    "open_stop_figures": (("device", "gate"), open_stop_figures),
    "speed_control": (("device", "name", "low", "does"), speed_controls),
    "no_speed_control": (("device", "does"), without_speed_control),
    "open_speed_control": (("device",), open_speed_controls),
    "first_motion": (_FIRST_MOTION, first_motion),
    "small_goal": ((*_FIRST_MOTION, "slow", "bound", "command", "cancel"), small_goal),
    "first_stage": (("percent", "file", "joint", "full", "command"), first_stage),
    "later_stage": (("percent", "file", "joint", "full", "command", "again"), later_stages),
    "risk_assessment": (("document", "figures"), risk_assessment),
    "jogging": ((), jogging),
    "stated_jog": (("device", "does"), stated_jogs),
    "unstated_jog": (("device",), unstated_jogs),
    "jogged": (_FIRST_MOTION, jogged),
    "guiding": (("begins", "ends"), guiding),
    "guided": ((*_FIRST_MOTION, "does"), guided),
    "guided_back": (_FIRST_MOTION, guided_back),
    "driven_back": (_FIRST_MOTION, driven_back),
    "missing_first_motion": ((), missing_first_motion),
    "stop_reason": (("reason",), stop_reasons),
    "vendor_step": (_VENDOR_STEP, _by_vendors),
    "vendor_power": (_VENDOR_STEP, lambda graph: _by_vendors(graph, powers=True)),
    "vendor_motion": (_VENDOR_STEP, lambda graph: _by_vendors(graph, moves=True)),
    "vendor_sign": (_VENDOR_STEP, lambda graph: _by_vendors(graph, after_release=True)),
    "real_activation": (("where", "command"), lambda graph: released(graph, ACTIVATE, BringUpPhase.ACTIVATE)),
    "real_claim": (("where", "command"), lambda graph: released(graph, CLAIM, BringUpPhase.CLAIM)),
    "real_motion": (("where", "command", "slow"), authorized_motion),
    "sender": (("node",), senders),
    "gripper_goal": (("device", "action", "half", "open", "force"), gripper_goals),
    "real_action": (("action",), real_actions),
    "short_motion": (("action", "seconds"), short_motions),
    "cancel": (("action", "seconds", "service"), cancels),
    "pulled": (("device", "does"), pulled),
    "claimed": (("device", "does"), claimed),
    "early_drill": (_DRILL, early_drills),
    "late_drill": (_DRILL, late_drills),
    "drill": (_DRILL, claimed_drills),
    "adapter_drill": (("device", "act"), adapter_drills),
    "claimed_adapter_drill": (("device", "act"), claimed_adapter_drills),
    "open_drill": (("device", "state", "follows"), open_drills),
    "interlock": (("area", "granted_by"), interlocks),
    "unmoved": (
        ("device", "joint"),
        lambda graph: ((device.name, joint.name) for device, joint in unmoved_on_real(graph.cell)),
    ),
    "unguarded": (("device", "name", "type", "does", "command"), unguarded),
    "card": (("card", "address", "carries"), _cards),
    "reached_device": (("host", "device", "card", "address"), _reached_devices),
    "device": (("device", "serial", "firmware", "safety", "gate"), identities),
    "late_stream": (_STREAM, _late_streams),
    "bounded_clock": (("host", "offset", "by"), bounded_clocks),
    "late_group": (("tip", "base"), _late_groups),
    "described_node": (("node",), lambda graph: _each(description_nodes(graph.cell))),
}
_OF_CELL = ("cell", "build", "description", "start_mock", "record", "domain", "stop_authority", "stop_path")

FIELDS: Mapping[str, Values] = {
    CELL: ("gate", *_OF_CELL, "observer", "restart", "secrets", "attempt_fields"),
    **{name: fields for name, (fields, _) in _SUBJECTS.items()},
}
"""Fields that a text of each subject may name. Every text may name those of the cell."""

ROWS: Mapping[str, Callable[[CellGraph], Iterator[Values]]] = {name: rows for name, (_, rows) in _SUBJECTS.items()}
"""The values of the fields, once for each subject that a cell has."""
