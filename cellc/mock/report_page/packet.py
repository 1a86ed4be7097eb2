"""One packet through its eight steps, from the observation to the result (chapter 4, section 10)."""

from __future__ import annotations

from collections.abc import Iterator
from xml.etree.ElementTree import Element

from cellc.mock.record import AttemptRecord, PacketStep
from cellc.mock.report_page.element import tag
from cellc.mock.report_page.figures import seconds

_WORDS = {
    PacketStep.OBSERVED: "observed",
    PacketStep.TRANSFORMED: "transformed",
    PacketStep.PLANNED: "planned",
    PacketStep.GOAL_SENT: "goal sent",
    PacketStep.ACCEPTED: "accepted",
    PacketStep.WRITTEN: "written",
    PacketStep.DRIVEN: "driven",
    PacketStep.RETURNED: "returned",
}


def packet(record: AttemptRecord) -> Element:
    """Return the eight steps with the time that each came after the one before; steps that were not made are hollow."""
    return tag("ol", *_steps(record), class_="packet")


def _steps(record: AttemptRecord) -> Iterator[Element]:
    stamps = {point.step: point.stamp_ns for point in record.trace}
    before_ns = record.started_ns
    for number, (step, words) in enumerate(_WORDS.items(), start=1):
        stamp_ns = stamps.get(step)
        if stamp_ns is None:
            yield _step(number, words, "–", "missing", f"step {step.value}: not made")
            continue
        # An image is older than the attempt that uses it.
        delta_s = (stamp_ns - before_ns) / 1e9
        told = f"{'+' if delta_s >= 0.0 else '−'}{seconds(abs(delta_s))}"
        yield _step(number, words, told, "made", f"step {step.value}: at {stamp_ns / 1e9:.6f} s")
        before_ns = max(before_ns, stamp_ns)


def _step(number: int, words: str, told: str, state: str, hint: str) -> Element:
    return tag("li", tag("i", str(number)), tag("span", words), tag("b", told), class_=state, title=hint)
