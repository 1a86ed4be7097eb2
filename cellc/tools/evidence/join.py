"""Reports of several hosts joined: each host is responsible for its own ends, and contradictions are named."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.contract.frozen import dataclass
from cellc.contract.observation import ObservedTarget
from cellc.tools.evidence.records import SEEN, UNKNOWN, ObservedLine, ObserveRecord

_SOURCES, _SINKS = ("publishers", "server"), ("subscribers", "clients")
PASSED, FAILED = "PASSED", "FAILED"


@dataclass(frozen=True, slots=True)
class JoinedLine:
    """One comparison over all hosts.

    Attributes:
        seen: what did not pass, by host; empty where all passed, or where nothing but the report of a host is missing.
        contradicted: one host passes what another fails.
    """

    part: str
    subject: str
    verdict: str
    expected: str
    seen: str
    contradicted: bool = False


def joined(reports: Mapping[str, ObserveRecord], plan: ObservedTarget) -> Iterator[JoinedLine]:
    """Yield each line of any report once.

    It is PASSED only if it passes on every host that is responsible for it, and on no other host fails. What is seen
    and compared with nothing fails nowhere.

    Args:
        reports: the newest of each host.
    """
    lines = {host: {(line.part, line.subject): line for line in report.lines} for host, report in reports.items()}
    hosts = tuple(plan.hosts) or tuple(reports)
    for key in dict.fromkeys(key for of_host in lines.values() for key in of_host):
        found = {host: of_host[key] for host, of_host in lines.items() if key in of_host}
        yield _joined(key, found, responsible(*key, plan, hosts), tuple(reports))


def _joined(
    key: tuple[str, str], found: Mapping[str, ObservedLine], own_hosts: tuple[str, ...], reporting: tuple[str, ...]
) -> JoinedLine:
    own = [found[host].verdict if host in found else UNKNOWN for host in own_hosts]
    passed = (PASSED, SEEN)
    contradicted = {PASSED, FAILED} <= {line.verdict for line in found.values()}
    verdict = FAILED if FAILED in own else UNKNOWN if UNKNOWN in own or contradicted else PASSED
    shown = {host: line for host, line in found.items() if line.verdict not in passed or contradicted}
    several = len(reporting) > 1
    seen = [f"{host} says {line.verdict}, {line.seen}" if several else line.seen for host, line in shown.items()]
    silent = (host for host in reporting if host in own_hosts and host not in found)
    seen += [f"not observed on {host}, which is responsible for it" for host in silent]
    first = next(iter(shown.values()), next(iter(found.values())))
    return JoinedLine(*key, verdict, first.expected, "; ".join(seen), contradicted)


def responsible(part: str, subject: str, plan: ObservedTarget, hosts: tuple[str, ...]) -> tuple[str, ...]:
    """Return the hosts that are responsible for a line: those of its ends; all where it is of the whole graph.

    What arrives is judged where it is taken.
    """
    name, _, side = subject.partition(", ")
    home = {node: host for host, nodes in plan.hosts.items() for node in nodes}
    ends = plan.ends.get(name)
    if ends is None:
        nodes = [name]
    elif part == "flow":
        nodes = [*ends.sinks] or [*ends.sources]
    else:
        nodes = [*(ends.sources if side not in _SINKS else ()), *(ends.sinks if side not in _SOURCES else ())]
    asked = {home[node] for node in nodes if node in home}
    return tuple(host for host in hosts if host in asked) or hosts
