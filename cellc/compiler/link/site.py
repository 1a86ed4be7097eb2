"""Binds what surrounds the devices: hosts, network, versions, calibrations, owners, safety, bring-up, figures, targets.

Defaults, ``standard`` lists and units are decided here.
"""

from __future__ import annotations

from collections.abc import Mapping

from cellc.compiler.cell.device import Device
from cellc.compiler.cell.entity import Places
from cellc.compiler.cell.site import (
    ATTEMPT_FIELDS,
    STOPPED,
    TARGET_DEFAULTS,
    Bringup,
    Calibration,
    CalibrationFile,
    Clock,
    Commissioning,
    FirstMotion,
    Host,
    NetworkCard,
    Recording,
    Recovery,
    RiskAssessment,
    Safety,
    Target,
)
from cellc.compiler.link.quantities import joint_figure, si
from cellc.compiler.source.document import Node, SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.devices import StampSpec
from cellc.compiler.spec.hosts import ClockSpec
from cellc.compiler.spec.safety import CommissioningSpec, FirstMotionSpec, RiskAssessmentSpec
from cellc.contract.diagnostics import Span, YamlPath
from cellc.contract.entities import Kpis
from cellc.contract.pins import day_of
from cellc.contract.vocabulary import NETWORK_GATES, PROMOTION_GATES


def bind_places(document: SourceDocument) -> Places:
    """Return the place of every value of a document, and its scalars as written."""
    spans: dict[YamlPath, Span] = {}
    texts: dict[YamlPath, str] = {}

    def gather(node: Node, path: YamlPath) -> None:
        for key, child in node.children.items():
            at = (*path, key)
            spans[at] = child.place
            if child.node.children:
                gather(child.node, at)
            elif child.node.text:
                texts[at] = child.node.text

    gather(document.root, ())
    return Places(document.file, spans, texts)


def bind_hosts(spec: CellSpec, places: Places) -> Mapping[str, Host]:
    """Return every computer with its clock and cards."""
    return {
        name: Host(
            name=name,
            path=("hosts", name),
            span=places.locate(("hosts", name)),
            scheduling=host.scheduling,
            clock=bind_clock(host.clock, host.clock.domain),
            nics={
                nic: NetworkCard(
                    address=card.address, interface=card.interface, speed_bps=si(card.speed), carries=card.carries
                )
                for nic, card in host.nics.items()
            },
        )
        for name, host in spec.hosts.items()
    }


def bind_clock(written: ClockSpec | StampSpec, domain: str) -> Clock:
    """Return the clock of a host or a sensor."""
    return Clock(
        domain=domain,
        synchronized_by=written.synchronized_by,
        max_offset_s=si(written.max_offset),
        simulated_offset_s=si(written.simulated_offset) or 0.0,
        simulated_drift=si(written.simulated_drift) or 0.0,
    )


def bind_calibrations(
    spec: CellSpec, places: Places, files: Mapping[str, CalibrationFile]
) -> Mapping[str, Calibration]:
    """Return every calibration by its id, with the file that it is from."""
    return {
        name: Calibration(
            name=name,
            path=("calibrations", name),
            span=places.locate(("calibrations", name)),
            revision=calibration.revision,
            measured=calibration.measured,
            measured_on=day_of(calibration.measured),
            method=calibration.method,
            samples=calibration.samples,
            residual_m=si(calibration.residual),
            owner=calibration.owner,
            serials=calibration.serials,
            file=files.get(name),
        )
        for name, calibration in spec.calibrations.items()
    }


def bind_safety(spec: CellSpec, devices: tuple[Device, ...]) -> Safety:
    """Return the safety boundary; where no recovery states are stated, those that its devices have a way out of."""
    stop, recovery = spec.safety.stop, spec.safety.recovery
    stops = (state for device in devices for state in device.procedures.safety.recoverable_stops)
    return Safety(
        stop=stop,
        recovery=Recovery(
            states=tuple(dict.fromkeys((*STOPPED, *stops))) if recovery.states is None else recovery.states,
            acknowledge=recovery.acknowledge,
            on_reconnect=recovery.on_reconnect,
            owner=recovery.owner,
            observer=recovery.observer,
        ),
        risk_assessment=_risk_assessment(spec.safety.risk_assessment),
    )


def _risk_assessment(written: RiskAssessmentSpec | None) -> RiskAssessment | None:
    if written is None:
        return None
    velocity, reach, force = map(si, (written.velocity, written.reach, written.force))
    return RiskAssessment(document=written.document, velocity=velocity, reach=reach, force=force)


def bind_bringup(spec: CellSpec, places: Places) -> Bringup:
    """Return the gates, ``standard`` written out, and the first motions."""
    gates, first = spec.bringup.gates, spec.bringup.first_motion
    path: YamlPath = ("bringup", "first_motion")
    if isinstance(first, tuple):
        stated = [(one, (*path, place)) for place, one in enumerate(first)]
    else:
        stated = [] if first is None else [(first, path)]
    return Bringup(
        gates=(*PROMOTION_GATES, *NETWORK_GATES) if gates == "standard" else tuple(gates),
        first_motions=tuple(_first_motion(motion, at, places) for motion, at in stated),
        caps=_caps(spec.bringup.commissioning),
    )


_STAGES = (0.1, 0.25, 0.5, 1.0)


def _caps(written: CommissioningSpec | None) -> Commissioning | None:
    if written is None:
        return None
    return Commissioning(
        velocity=1.0 if written.velocity.linear else written.velocity.si,
        acceleration=written.acceleration.si,
        tip_speed=written.velocity.si if written.velocity.linear else None,
        reach=si(written.reach),
        force=si(written.force),
        stages=_STAGES if written.stages is None else written.stages.si,
    )


def _first_motion(written: FirstMotionSpec, path: YamlPath, places: Places) -> FirstMotion:
    return FirstMotion(
        name=written.joint,
        path=path,
        span=places.locate(path),
        direction=written.direction,
        max_delta=joint_figure(written.max_delta),
        velocity=joint_figure(written.velocity),
        timeout_s=written.timeout.si,
        stop_if=written.stop_if,
    )


def bind_kpis(spec: CellSpec) -> Kpis:
    """Return the target figures."""
    kpis = spec.kpis
    return Kpis(
        plan_to_execute_s=si(kpis.plan_to_execute),
        cancel_s=si(kpis.cancel),
        missed_cycles=kpis.missed_cycles,
        stale_state_rejection=si(kpis.stale_state_rejection),
        protective_stops=kpis.protective_stops,
        recovery_time_s=si(kpis.recovery_time),
        wrong_owner_events=kpis.wrong_owner_events,
    )


def bind_recording(spec: CellSpec) -> Recording:
    """Return what is recorded, ``standard`` written out."""
    fields = spec.recording.attempt_fields
    return Recording(
        attempt_fields=ATTEMPT_FIELDS if fields == "standard" else tuple(fields), topics=spec.recording.topics
    )


def bind_targets(spec: CellSpec) -> Mapping[str, Target]:
    """Return the targets that every cell has and those that the spec adds, each with its hardware and clock."""
    targets = dict(TARGET_DEFAULTS)
    for name, target in spec.targets.items():
        clock = target.clock or ("sim" if name == "sim" else "wall")
        targets[name] = Target(hardware=target.hardware or name, clock=clock)
    return targets
