"""The interface selection checklist: a late sample, a missing responder, a canceled goal.

An interface passes where each case that concerns its kind was injected and led to a visible, bounded state: the run
ended in another outcome than success, by name, within its bound.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.entities import ContractInterface
from cellc.contract.fault_declaration import Interaction
from cellc.contract.faults import FaultKind
from cellc.contract.rehearsals import FaultEntry
from cellc.contract.vocabulary import AttemptOutcome
from cellc.mock.gates.command_path import cancel_trace
from cellc.mock.gates.gate import GateCheck, judged, unknown
from cellc.mock.gates.runs import GateEvidence, JudgedRun

_IMAGE = "sensor_msgs/msg/Image"
_JOINT_STATE = "sensor_msgs/msg/JointState"
_TF = "tf2_msgs/msg/TFMessage"


def interaction_checks(evidence: GateEvidence) -> Iterator[GateCheck]:
    """Yield the lines of each interface of the contract, in its order."""
    for name, interface in evidence.contract.interfaces.items():
        if interface.kind == "topic":
            yield _late_sample(evidence, name, interface)
            continue
        yield _missing_responder(evidence, name, interface)
        if interface.kind == "action":
            yield _canceled_goal(evidence, name)
    yield unknown("A hard servo loop meets its worst-case timing", "a measurement on the real controller")


def _late_sample(evidence: GateEvidence, name: str, interface: ContractInterface) -> GateCheck:
    text = f"{name} (topic, {interface.wants or 'need not stated'}): a late sample ends in a visible, bounded state"
    late = evidence.with_fault(Interaction.LATE_SAMPLE)
    runs = [run for run, fault in late if _delays(evidence, fault, name, interface)]
    return _bounded(text, runs, "a run in which its samples stay away")


def _missing_responder(evidence: GateEvidence, name: str, interface: ContractInterface) -> GateCheck:
    text = f"{name} ({interface.kind}): a missing responder ends in a visible, bounded state"
    servers = {source.node for source in interface.sources}
    servers |= {
        controller
        for manager in evidence.contract.managers.values()
        for controller, facts in manager.controllers.items()
        if facts.action == name
    }
    silent = evidence.with_fault(Interaction.MISSING_RESPONDER)
    runs = [run for run, fault in silent if fault.target in servers | {name}]
    return _bounded(text, runs, "a run in which its server does not answer")


def _canceled_goal(evidence: GateEvidence, name: str) -> GateCheck:
    for manager in evidence.contract.managers.values():
        for controller, facts in manager.controllers.items():
            if facts.action == name:
                return cancel_trace(evidence, controller)
    return unknown(f"A canceled goal of {name} is held", "its server, which the mock's task replaces")


def _bounded(text: str, runs: list[JudgedRun], needed: str) -> GateCheck:
    bad = [f"{run.name}: {run.result.outcome}" for run in runs if not run.passed]
    good = [f"{run.name}: {run.result.outcome}" for run in runs if run.result.outcome != AttemptOutcome.SUCCEEDED]
    return judged(text, good, bad, needed)


def _delays(evidence: GateEvidence, fault: FaultEntry, name: str, interface: ContractInterface) -> bool:
    """Tell whether a fault keeps samples of a topic from arriving in time."""
    contract = evidence.contract
    if fault.target == name:
        return True
    if fault.kind is FaultKind.DROP_FRAME:
        frame = contract.frames.get(fault.target)
        return frame is not None and name == ("/tf" if frame.moving else "/tf_static") and interface.type == _TF
    device = contract.devices.get(fault.target)
    if device is None:
        return False
    if device.camera is not None:
        return device.camera.topic == name or _follows(interface, contract.interfaces.get(device.camera.topic))
    return interface.type == _JOINT_STATE and fault.kind in (FaultKind.FREEZE, FaultKind.DELAY)


def _follows(interface: ContractInterface, images: ContractInterface | None) -> bool:
    """Tell whether a topic is made of images: its publisher listens to them."""
    if images is None or images.type != _IMAGE:
        return False
    listeners = {sink.node for sink in images.sinks}
    return interface.type != _TF and any(source.node in listeners for source in interface.sources)
