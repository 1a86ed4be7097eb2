"""The attempts of a rehearsal along its time, each with the eight steps of its packet and what its record says."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from xml.etree.ElementTree import Element

from cellc.mock.record import AttemptRecord
from cellc.mock.report_page.element import tag
from cellc.mock.report_page.figures import at, seconds
from cellc.mock.report_page.lanes import Bar, axis, lane
from cellc.mock.report_page.packet import packet
from cellc.mock.report_page.panel import TimeAxis


def attempts(records: Sequence[AttemptRecord], time: TimeAxis) -> Element:
    """Return the timeline; the last record sums up and is left out."""
    rows = [row for record in records[:-1] for row in _attempt(record, time)]
    return tag("div", tag("h3", "Packet trace"), *rows, axis(time), class_="lanes")


def _attempt(record: AttemptRecord, time: TimeAxis) -> Iterator[Element]:
    good = record.outcome == "succeeded"
    words = f"{at(record.started_ns)} to {at(record.ended_ns)}: {record.outcome}"
    bar = Bar(record.started_ns / 1e9, record.ended_ns / 1e9, "done" if good else "ended", words)
    outcome = tag("span", record.outcome, class_="plain" if good else "bad")
    yield lane([tag("b", record.step), " ", outcome], [bar], time)
    yield packet(record)
    details = [tag("span", text) for text in _details(record)]
    if details:
        yield tag("p", *details, class_="details")


def _details(record: AttemptRecord) -> Iterator[str]:
    yield record.attempt_id
    if record.goal_frame is not None and record.goal_stamp is not None:
        yield f"goal in {record.goal_frame} at {at(record.goal_stamp)}"
    if record.joint_state_age is not None:
        yield f"joint state {seconds(record.joint_state_age)} old"
    if record.tf_lookup_age is not None:
        yield f"transform {seconds(record.tf_lookup_age)} old"
    if record.calibration_id:
        yield f"calibration {', '.join(record.calibration_id)}"
    if record.plan_result is not None:
        yield f"plan: {record.plan_result}"
    if record.controller_name is not None:
        scaling = "" if record.speed_scaling is None else f", speed scaling {record.speed_scaling:.0%}"
        yield f"controller {record.controller_name}{scaling}"
    if record.result is not None:
        yield " ".join(f"result {record.result.status} {record.result.error_string}".split())
    if record.cancel is not None:
        yield f"cancelled at {at(record.cancel.requested_ns)}, held after {seconds(record.cancel.latency_s)}"
    if record.safety_state != "normal":
        yield f"safety state {record.safety_state}"
    if record.fault_code:
        yield f"reason: {record.fault_code}"
    if record.operator_intervention != "none":
        yield f"operator: {record.operator_intervention}"
