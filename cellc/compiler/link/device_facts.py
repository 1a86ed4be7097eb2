"""What the spec states of a device and the catalog knows of it, in SI, prefixed, with placeholders filled."""

from __future__ import annotations

import datetime
from collections.abc import Iterable, Iterator

from cellc.compiler.catalog.device_bring_up import CommissioningStep as CommissioningFacts
from cellc.compiler.catalog.device_bring_up import SafetyStateFacts
from cellc.compiler.catalog.device_graph import ViewFacts
from cellc.compiler.catalog.device_model import DeviceModel, PackageFacts
from cellc.compiler.catalog.robot_facts import HumanStep
from cellc.compiler.cell.device import (
    Camera,
    CameraStream,
    Connection,
    DeviceJoint,
    DeviceLimits,
    DeviceMock,
    DeviceVersions,
    FieldOfView,
    LimitShares,
    NetworkNeeds,
    Packages,
    Sensing,
    SimulatedJoint,
    Software,
    Stamp,
)
from cellc.compiler.cell.hardware import Adapter, DeviceControl, HardwareComponent
from cellc.compiler.cell.vendor import (
    CommissioningStep,
    Procedures,
    Reading,
    RecordSource,
    RecoveryProcedure,
    SafetyState,
    SpeedControl,
    VendorSafety,
)
from cellc.compiler.link.hardware import device_driver, offered_interfaces, run_nodes, started_nodes
from cellc.compiler.link.names import Placeholders
from cellc.compiler.link.ports import listened
from cellc.compiler.link.quantities import joint_figure, si
from cellc.compiler.link.robot import command_laws, conditions, drives, set_by
from cellc.compiler.link.site import bind_clock
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.devices import EVERY_JOINT, DeviceSpec
from cellc.contract.diagnostics import YamlPath
from cellc.contract.pins import day_of
from cellc.contract.vocabulary import Distro


def device_control(
    facts: DeviceModel,
    written: DeviceSpec,
    known: Placeholders,
    distro: Distro | None,
    hardware: HardwareComponent | None,
) -> DeviceControl:
    """Return what commands a device by a component or by its driver, and what that offers."""
    nodes = run_nodes(facts, known, written.firmware)
    return DeviceControl(
        hardware=hardware,
        driver=device_driver(facts, known),
        adapter=_adapter(written),
        initial_state=written.initial_state,
        offers=tuple(offered_interfaces(facts, nodes, known, distro)),
        starts=started_nodes(nodes, known, distro),
        speed_scaling=None if facts.speed_scaling is None else known.fill(facts.speed_scaling.state_interface),
        laws=command_laws(facts),
        drives=drives(facts),
        update_rates_hz=() if facts.control is None else tuple(rate.si for rate in facts.control.update_rates),
        controller_kinds={kind: tuple(controller.plugins) for kind, controller in facts.controllers.items()},
    )


def device_software(facts: DeviceModel, written: DeviceSpec) -> Software:
    """Return what the version tuple has of a device."""
    rows = tuple(row.of_model(facts.model) for row in facts.versions)
    return Software(versions=_versions(written), packages=_packages(facts.packages), version_rows=rows)


def _packages(facts: PackageFacts) -> Packages:
    library = facts.library
    return Packages(
        driver=facts.driver,
        sdk=facts.sdk,
        description=facts.description,
        sdk_package=facts.sdk if library is None else None,
        sdk_debian=None if library is None else library.debian,
    )


def device_sensing(facts: DeviceModel, written: DeviceSpec, known: Placeholders, prefix: str) -> Sensing:
    """Return what a sensor measures, and when."""
    return Sensing(stamp=_stamp(written), exposure_s=_exposure_s(facts, written), camera=_camera(facts, known, prefix))


def device_limits(facts: DeviceModel, written: DeviceSpec) -> DeviceLimits:
    """Return what a device may do as a whole."""
    payload, reach = facts.limits.payload, facts.limits.reach
    repeatability, tilt = facts.limits.repeatability, facts.limits.tilt
    return DeviceLimits(
        limit_shares=limit_shares(written),
        payload_limit_kg=None if payload is None else payload.value.si,
        reach_m=None if reach is None else reach.value.si,
        repeatability_m=None if repeatability is None else repeatability.value.si,
        tilt_rad=None if tilt is None else tilt.value.si,
    )


def vendor_procedures(
    facts: DeviceModel, written: DeviceSpec, known: Placeholders, distro: Distro | None
) -> Procedures:
    """Return what people do and read at the real device, as far as it fits this cell."""
    holding = conditions(facts, written)
    return Procedures(
        safety=_vendor_safety(facts, known, holding),
        record=tuple(_record(facts)),
        readings=tuple(_readings(facts)),
        jog=None if facts.jog is None else facts.jog.does,
        jog_begins=(None if facts.jog is None else facts.jog.before) or "",
        jog_ends=(None if facts.jog is None else facts.jog.then) or "",
        driver_runs=facts.jog is None or facts.jog.driver_runs,
        speed_control=_speed_control(facts),
        payload_entry=known.fill(facts.robot.payload_entry.get(set_by(written), "")),
        rotation_vector=facts.robot.rotation_vector,
        commissioning=tuple(
            _step(step, known)
            for step in facts.commissioning
            if (not step.only or distro in step.only) and (not step.when or holding.intersection(step.when))
        ),
    )


def _speed_control(facts: DeviceModel) -> SpeedControl | None:
    control = facts.speed_control
    if control is None:
        return None
    low = 1.0 if control.low is None else control.low.si
    return SpeedControl(name=control.name or "", does=control.does or control.because or "", low=low)


def device_mock(
    facts: DeviceModel,
    written: DeviceSpec,
    prefix: str,
    path: YamlPath,
    joints: tuple[DeviceJoint, ...],
    document: SourceDocument,
) -> DeviceMock:
    """Return a device on the mock.

    Args:
        path: of the device in the spec.
    """
    return DeviceMock(
        home={prefix + joint: position.si for joint, position in (facts.home or {}).items()},
        simulated_joints=_simulated_joints(written, (*path, "simulated_joints"), joints, document),
        mock_cannot_prove=(*facts.mock_cannot_prove, *_taken_on_trust(facts)),
    )


def _record(facts: DeviceModel) -> Iterator[RecordSource]:
    for field, record in facts.record.items():
        yield RecordSource(
            attempt_field=field,
            controller_kind=record.controller,
            topic=record.topic,
            field=record.field,
            read=record.read,
        )


def _readings(facts: DeviceModel) -> Iterator[Reading]:
    for reading in facts.readings:
        yield Reading(
            name=reading.name,
            controller_kind=reading.controller,
            below=reading.topic or reading.service or "",
            fields=reading.fields,
            values=reading.values,
            expected=reading.expected,
            version=reading.version,
        )


def _versions(written: DeviceSpec) -> DeviceVersions:
    """Return the parts of the version tuple that the device adds."""
    return DeviceVersions(
        revision=written.revision,
        serial=written.serial,
        firmware=written.firmware,
        driver=written.driver,
        sdk=written.sdk,
        description=written.description,
    )


def connection_of(written: DeviceSpec, port: str | None) -> Connection | None:
    """Return how the real device is reached.

    Args:
        port: its serial port, where it has one.
    """
    stated = written.connection
    if stated is None:
        return None
    return Connection(host=stated.host, nic=stated.nic, address=stated.address, port=port, through=stated.through)


def limit_shares(written: DeviceSpec) -> LimitShares:
    """Return the shares of the device's own limits; whole where nothing is written."""
    limits = written.limits
    if limits is None:
        return LimitShares()
    velocity, acceleration = si(limits.velocity), si(limits.acceleration)
    return LimitShares(
        velocity=1.0 if velocity is None else velocity, acceleration=1.0 if acceleration is None else acceleration
    )


def mounted_on(written: DeviceSpec) -> datetime.date | None:
    """Return the day on which a device was mounted for the last time."""
    since = None if written.mount is None else written.mount.since
    return None if since is None else day_of(since)


def _stamp(written: DeviceSpec) -> Stamp | None:
    """Return what a sensor stamps."""
    stamp = written.stamp
    if stamp is None:
        return None
    return Stamp(source=stamp.source, clock=bind_clock(stamp, stamp.clock))


def _adapter(written: DeviceSpec) -> Adapter | None:
    """Return the watchdog of a direct SDK."""
    adapter = written.adapter
    if adapter is None:
        return None
    return Adapter(
        command_timeout_s=si(adapter.command_timeout),
        stop_time_s=si(adapter.stop_time),
        goal_time_s=si(adapter.goal_time),
        path_tolerance=None if adapter.path_tolerance is None else joint_figure(adapter.path_tolerance),
        stiffness=None if adapter.stiffness is None else adapter.stiffness.si,
        damping=None if adapter.damping is None else adapter.damping.si,
    )


def _simulated_joints(
    written: DeviceSpec, path: YamlPath, joints: tuple[DeviceJoint, ...], document: SourceDocument
) -> tuple[SimulatedJoint, ...]:
    """Return what the mock adds to joints, with the commanded joints that each key means."""
    return tuple(
        SimulatedJoint(
            name=key,
            path=(*path, key),
            span=document.locate((*path, key)),
            joints=tuple(
                joint.name for joint in joints if joint.command_interfaces and key in (EVERY_JOINT, joint.local_name)
            ),
            lag_s=si(simulated.lag),
            noise=None if simulated.noise is None else joint_figure(simulated.noise),
            velocity=None if simulated.velocity is None else joint_figure(simulated.velocity),
        )
        for key, simulated in written.simulated_joints.items()
    )


def _taken_on_trust(facts: DeviceModel) -> Iterator[str]:
    """Yield what its folder says need not be looked at, with the reason."""
    for code, because in facts.excused.items():
        yield f"`{code}` of its description is excused: {because}"
    for pair in facts.allowed_collisions:
        yield f"contact of `{pair.links[0]}` and `{pair.links[1]}` is not looked for: {pair.because}"


def _exposure_s(facts: DeviceModel, written: DeviceSpec) -> float:
    """Return the exposure time of the spec, else of the catalog; zero where neither states one."""
    stated = (None if source is None else source.exposure for source in (written.stamp, facts.camera))
    return next((exposure.si for exposure in stated if exposure is not None), 0.0)


def _camera(facts: DeviceModel, known: Placeholders, prefix: str) -> Camera | None:
    """Return the camera that the device is."""
    if (camera := facts.camera) is None:
        return None
    return Camera(
        streams=tuple(
            CameraStream(
                topic=known.fill(stream.topic),
                type=stream.type,
                info_topic=known.fill(stream.info_topic),
                frame=prefix + stream.frame,
                rate_hz=stream.rate.si,
                view=field_of_view(stream.view),
                image_bytes=stream.image.bytes if stream.image else None,
                pixels=(stream.image.width, stream.image.height) if stream.image else None,
                encoding=stream.image.encoding if stream.image else None,
            )
            for stream in camera.streams.values()
        ),
    )


def field_of_view(facts: ViewFacts | None) -> FieldOfView | None:
    """Return what a stream sees, in SI; None where the catalog does not say."""
    if facts is None:
        return None
    return FieldOfView(
        horizontal=facts.horizontal.si,
        vertical=facts.vertical.si,
        nearest_m=facts.nearest.si,
        farthest_m=facts.farthest.si,
    )


def network_needs(facts: DeviceModel, known: Placeholders) -> NetworkNeeds | None:
    """Return what the device asks of its network."""
    network = facts.network
    if network is None:
        return None
    listens = listened(facts, known.port_shift)
    return NetworkNeeds(
        dedicated_link=network.dedicated_link,
        by_carrier=network.by_carrier,
        usual_port=network.usual_port,
        powered=network.powered,
        realtime=network.realtime,
        listens=listens,
    )


def _step(facts: CommissioningFacts, known: Placeholders) -> CommissioningStep:
    """Return what a person does; what is in its commands is quoted where they are written."""
    return CommissioningStep(
        gate=facts.gate,
        does=known.fill(facts.does),
        after_release=facts.after_release,
        powers=facts.powers,
        moves=facts.moves,
        sets=facts.sets,
        log=facts.log,
        run=facts.run,
        by=facts.by,
    )


def _safety_state(facts: SafetyStateFacts) -> SafetyState:
    return SafetyState(
        name=facts.name,
        stops=facts.stops,
        reported=facts.reported,
        seen=facts.seen,
        trip=facts.trip,
        gate=facts.gate,
        moment=facts.moment,
        ends=facts.ends,
        left_by=facts.left_by,
    )


def _vendor_safety(facts: DeviceModel, known: Placeholders, holding: frozenset[str]) -> VendorSafety:
    """Return the vendor's safety boundary; empty where the catalog has none.

    Args:
        holding: what is so of the device, of all that a step may be bound to.
    """
    safety = facts.safety
    if safety is None:
        return VendorSafety()

    def applicable(steps: Iterable[HumanStep]) -> tuple[str, ...]:
        free = (
            step if isinstance(step, str) else step.does if holding.intersection(step.when) else "" for step in steps
        )
        return tuple(known.fill(step) for step in free if step)

    return VendorSafety(
        stop_authority=safety.stop_authority,
        states=tuple(map(_safety_state, safety.states)),
        topics=tuple(
            (f"{known.values[kind]}/{facts.topic}", facts.field or "")
            for facts in safety.reported_by
            if (kind := f"controller_{facts.controller}") in known.values
        ),
        ending=applicable(safety.ending),
        ended=applicable(safety.ended),
        power_off=applicable(safety.power_off),
        modes=safety.modes,
        recovery=tuple(
            RecoveryProcedure(state=facts.state, steps=applicable(facts.steps), by=facts.by)
            for facts in safety.recovery
        ),
        watchdog=safety.watchdog,
        stopping=None if safety.stopping is None else (safety.stopping.figures, safety.stopping.source),
    )
