"""Rules on what is recorded of an attempt."""

from __future__ import annotations

from cellc.compiler.cell.site import ATTEMPT_FIELDS
from cellc.compiler.graph.data_flow import known_topics
from cellc.compiler.rules.advice import add_controllers
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule


@rule(Severity.WARNING)
def recording_without_card(graph: CellGraph) -> Findings:
    """Yield recordings of several hosts with cards, none of which carries the bag."""
    cell = graph.cell
    with_cards = [host for host in cell.hosts.values() if host.nics]
    if not cell.recording.topics or len(with_cards) < 2 or any("bag" in nic.carries for nic in graph.network.nics):
        return
    free = (nic for nic in graph.network.nics if "control" not in nic.carries)
    related = tuple(Related(f"`{nic.full_name}` may be the one", cell.locate(*nic.path)) for nic in free)
    message = f"a card of one of the {len(with_cards)} hosts must carry `bag`, as topics are recorded"
    yield found(graph, ("recording", "topics"), message, related=related)


@rule(Severity.ERROR)
def removed_attempt_field(graph: CellGraph) -> Findings:
    """Yield the missing fields in one finding."""
    fields = graph.cell.recording.attempt_fields
    missing = [field for field in ATTEMPT_FIELDS if field not in fields]
    if missing:
        names = ", ".join(f"`{field}`" for field in missing)
        path = ("recording", "attempt_fields")
        yield found(graph, path, f"an attempt does not record {names}")


@rule(Severity.WARNING)
def unfed_attempt_field(graph: CellGraph) -> Findings:
    """Yield devices with a connection whose part of the record has no publisher, once for each controller kind."""
    cell = graph.cell
    for device in cell.devices:
        wanted = [
            source for source in device.procedures.record if source.attempt_field in cell.recording.attempt_fields
        ]
        missing: dict[str, list[str]] = {}
        for source in wanted if device.site.connection is not None else ():
            if source.controller_kind is not None and cell.reporting(device, source) is None:
                missing.setdefault(source.controller_kind, []).append(f"`{source.attempt_field}`")
        for kind, fields in missing.items():
            message = (
                f"{' and '.join(fields)} of the attempt record must come from `{device.name}`, which has no publisher"
            )
            yield found(graph, (*device.path, "model"), message, add_controllers(device, (kind,), cell.distro))


_ALWAYS = ("/diagnostics", "/rosout", "/parameter_events", "/tf", "/tf_static", "/clock", "/joint_states")


@rule(Severity.WARNING, assumes=("illegal-ros-name",))
def unknown_recorded_topic(graph: CellGraph) -> Findings:
    """Yield recorded topics that no interface declares, and no device or controller publishes."""
    known = {*_ALWAYS, *(interface.name for interface in graph.cell.interfaces)}
    known = known.union(*known_topics(graph.cell).published.values())
    for index, topic in enumerate(graph.cell.recording.topics):
        if topic not in known:
            path = ("recording", "topics", index)
            yield found(graph, path, f"`{topic}` has no publisher", did_you_mean(topic, known, "topics"))


_BULK = ("/Image", "/PointCloud2", "/CompressedImage")
"""What is not recorded unless it is asked for."""


@rule(Severity.WARNING)
def unrecorded_observation(graph: CellGraph) -> Findings:
    """Yield images and clouds that feed motion and are not among the recorded topics, where the spec lists some."""
    if not graph.cell.recording.topics:
        return
    feeding = graph.data.feeding_motion()
    for interface in graph.cell.interfaces:
        if not interface.type.endswith(_BULK) or interface.derived or interface.name not in feeding:
            continue
        stem = interface.name.rpartition("/")[0]
        if not any(topic == interface.name or topic.startswith(f"{stem}/") for topic in graph.cell.recording.topics):
            message = f"`{interface.name}` feeds motion and must be recorded"
            related = (Related("decisions rest on it", interface.span),)
            yield found(graph, ("recording", "topics"), message, related=related)
