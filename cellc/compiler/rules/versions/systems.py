"""Rules on distributions, operating systems, middleware, and the way back."""

from __future__ import annotations

import re

from cellc.compiler.graph.versions import distribution
from cellc.compiler.rules.kit import CellGraph, Findings, Related, Severity, did_you_mean, found, rule
from cellc.contract.vocabulary import UNKNOWN

_ORDINARY = re.compile(r"-(generic|lowlatency|azure|aws|oem|virtual|amd64|cloud|raspi)\b")


@rule(Severity.WARNING)
def kernel_without_preemption(graph: CellGraph) -> Findings:
    """Yield a kernel of an ordinary flavour where a host is said to be preemptible."""
    ordinary = _ORDINARY.search(graph.cell.versions.kernel)
    hosts = [host for host in graph.cell.hosts.values() if host.scheduling == "preempt_rt"]
    if ordinary is None or not hosts:
        return
    names = ", ".join(f"`{host.name}`" for host in hosts)
    message = f"the kernel of {names} must be a real-time one, got `{graph.cell.versions.kernel}`"
    related = tuple(Related("said to be preempt_rt", graph.cell.locate(*host.path, "scheduling")) for host in hosts)
    yield found(graph, ("versions", "kernel"), message, related=related)


_ANSWERS = {
    "image": "the digest of the last image that ran",
    "configuration": "the id of the last configuration that ran, such as `cfg-0123456789ab`",
}


@rule(Severity.BLOCKER)
def missing_rollback(graph: CellGraph) -> Findings:
    """Yield the unknown parts of the rollback in one finding."""
    rollback = graph.cell.versions.rollback
    parts = (("image", rollback.image), ("configuration", rollback.configuration))
    missing = [part for part, text in parts if text == UNKNOWN]
    if missing:
        names = " and ".join(f"`{part}`" for part in missing)
        path = ("versions", "rollback", missing[0])
        message = f"the rollback {names} {'are' if len(missing) > 1 else 'is'} UNKNOWN"
        yield found(graph, path, message, f"write {' and '.join(_ANSWERS[part] for part in missing)}")


@rule(Severity.BLOCKER)
def os_of_third_tier(graph: CellGraph) -> Findings:
    """Yield an operating system of the third tier of the distribution."""
    facts = distribution(graph.cell)
    system = graph.cell.versions.os
    lowered = system.lower()
    if facts is not None and any(lowered == tier or lowered.startswith(f"{tier}.") for tier in facts.os_tier3):
        tested = ", ".join(f"`{name}`" for name in facts.os)
        message = f"`{graph.cell.distro}` has no tested packages for `{system}`, only for {tested}"
        yield found(graph, ("versions", "os"), message, f"install {tested}, or keep the evidence of your own build")


@rule(Severity.ERROR)
def os_ros_mismatch(graph: CellGraph) -> Findings:
    """Yield an operating system that the distribution is not built for."""
    facts = distribution(graph.cell)
    system = graph.cell.versions.os
    if facts is None or system == UNKNOWN:
        return
    lowered = system.lower()
    if not any(lowered == built or lowered.startswith(f"{built}.") for built in (*facts.os, *facts.os_tier3)):
        built_for = ", ".join(f"`{name}`" for name in facts.os)
        message = f"`{graph.cell.distro}` is built for {built_for}, not for `{system}`"
        yield found(graph, ("versions", "os"), message, f"install {built_for}, or choose another distribution")


@rule(Severity.ERROR, assumes=("floating-version",))
def rollback_without_digest(graph: CellGraph) -> Findings:
    """Yield an image that is no digest."""
    image = graph.cell.versions.rollback.image
    if image != UNKNOWN and "sha256:" not in image:
        message = f"the rollback image must be given by its digest, got `{image}`"
        yield found(graph, ("versions", "rollback", "image"), message)


@rule(Severity.WARNING, assumes=("calibration-of-another-time",))
def ros_past_end_of_life(graph: CellGraph) -> Findings:
    """Yield a distribution whose end of life lies before the latest calibration."""
    facts = distribution(graph.cell)
    measured = [c.measured_on for c in graph.cell.calibrations.values() if c.measured_on is not None]
    if facts is None or not measured:
        return
    date, end = max(measured).isoformat(), str(facts.end_of_life)
    if date > end:
        message = f"`{graph.cell.distro}` reached its end of life on {end}, before the calibration of {date}"
        yield found(graph, ("versions", "ros"), message)


@rule(Severity.ERROR)
def unknown_rmw(graph: CellGraph) -> Findings:
    """Yield a middleware that the distribution does not have."""
    facts = distribution(graph.cell)
    name = graph.cell.versions.rmw
    if facts is None or name == UNKNOWN:
        return
    known = (*facts.rmw, *facts.rmw_unverified)
    if name.split()[0] not in known:
        message = f"`{name.split()[0]}` is not a middleware of {graph.cell.distro}"
        yield found(graph, ("versions", "rmw"), message, did_you_mean(name.split()[0], known, "middlewares"))
