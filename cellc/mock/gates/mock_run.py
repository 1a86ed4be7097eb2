"""G2 of the staged promotion gates: launch, claims and action cancel on the mock."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.mock.campaign.limits_report import merge
from cellc.mock.gates.gate import GateCheck, failed, judged, passed, unknown
from cellc.mock.gates.trace import cancel_trace, commanded, owners
from cellc.mock.gates.witness import Testimony


def mock_run_checks(testimony: Testimony) -> Iterator[GateCheck]:
    """Yield the lines of G2."""
    yield _rehearsals(testimony)
    yield _bringup(testimony)
    yield unknown("The launch file starts the nodes", "`ros2 launch` on a host with ROS 2")
    yield owners(testimony)
    yield _servers(testimony)
    for name, _ in commanded(testimony):
        yield cancel_trace(testimony, name)
    yield _faults(testimony)
    yield _limits(testimony)


def _rehearsals(testimony: Testimony) -> GateCheck:
    text = "Every rehearsal ends as declared"
    seen = {witness.name: witness for witness in testimony.witnesses if witness.declared}
    bad = [f"{name}: {witness.result.outcome}" for name, witness in seen.items() if not witness.passed]
    missing = [entry.name for entry in testimony.folder.rehearsals if entry.name not in seen]
    if bad:
        return failed(text, bad)
    if missing or not seen:
        return unknown(text, f"a run of {', '.join(missing) or 'a rehearsal'}")
    return passed(text, [f"{name}: {witness.result.outcome}" for name, witness in seen.items()])


def _bringup(testimony: Testimony) -> GateCheck:
    good: list[str] = []
    bad: list[str] = []
    for witness in testimony.undisturbed():
        stages = witness.result.bringup
        bad += [f"{witness.name}: {stage.stage}: {problem}" for stage in stages for problem in stage.problems]
        if stages and all(stage.passed for stage in stages):
            good.append(f"{witness.name}: {', '.join(stage.stage for stage in stages)} passed")
    return judged("The cell comes up in stages", good, bad, "a run without faults")


def _servers(testimony: Testimony) -> GateCheck:
    """Judge by the graph of the contract, which the mock executes as it is declared."""
    good: list[str] = []
    bad: list[str] = []
    for name, interface in testimony.contract.interfaces.items():
        if interface.kind == "action":
            servers = ", ".join(source.node for source in interface.sources) or "nobody"
            clients = ", ".join(sink.node for sink in interface.sinks) or "nobody"
            (good if len(interface.sources) == 1 else bad).append(f"{name}: {servers} for {clients}")
    return judged("Each action has one server and the declared clients", good, bad, "an action")


def _faults(testimony: Testimony) -> GateCheck:
    runs = [witness for witness in testimony.witnesses if not witness.declared]
    bad = [f"{witness.name}: {witness.result.outcome}" for witness in runs if not witness.passed]
    good = [f"{len(runs)} runs of the campaign"] if runs else []
    text = "Every fault at every step ends in a named outcome within its bound"
    return judged(text, good, bad, "a campaign: `--campaign`")


def _limits(testimony: Testimony) -> GateCheck:
    reports = [witness.limits for witness in testimony.witnesses if witness.limits is not None]
    total = merge(reports)
    shares = ", ".join(f"{peak.quantity} {peak.share:.1%}" for peak in total.peaks)
    moved = any(peak.share > 0.0 for peak in total.peaks)
    good = [f"{len(reports)} runs, largest share of a limit: {shares}"] if moved else []
    bad = [str(excess) for excess in total.excesses]
    return judged(
        "No commanded trajectory exceeds a limit", good, bad, "a campaign in which a trajectory moves a joint"
    )
