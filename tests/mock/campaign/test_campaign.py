"""Campaigns end in named outcomes within their bounds, the same on any number of processes."""

from __future__ import annotations

import pickle
from collections.abc import Callable, Sequence
from pathlib import Path

import pytest

from cellc.contract.compute.processes import processes
from cellc.mock import MockCell, MockError, load
from cellc.mock.campaign.campaign import Campaign, conduct, make_plan
from cellc.mock.campaign.plan import CampaignPlan, CampaignRun
from cellc.mock.faults.registry import possible_faults
from cellc.mock.task import context as task_context
from tests.mock.campaign.conftest import plan_of

Chosen = Sequence[CampaignRun]


def campaign_of(cell: MockCell, choose: Callable[[CampaignPlan], Chosen], *, jobs: int = 1, seed: int = 0) -> Campaign:
    plan, baselines = make_plan(cell, possible_faults(cell.contract), seed)
    return conduct(
        cell,
        choose(plan),
        baselines,
        seed=seed,
        factory=processes(jobs) if jobs > 1 else None,
        progress=lambda *_: None,
    )


def every_run(plan: CampaignPlan) -> Chosen:
    return tuple(plan.singles())


def sample(plan: CampaignPlan) -> Chosen:
    """Return every 23rd run, which is prime to the number of steps, and some pairs."""
    return (*tuple(plan.singles())[::23], *plan.pairs(6, seed=1))


def told(campaign: Campaign) -> list[str]:
    return [
        f"{end.run.identifier}: {end.result.outcome}, response {end.result.response_s} of {end.run.within_s}, "
        f"{end.crash}{end.limits.excesses}"
        for end in campaign.failed
    ]


def test_every_fault_at_every_step_of_the_smallest_cell_ends_as_named(cells: dict[str, MockCell]) -> None:
    campaign = campaign_of(cells["minimal"], every_run)
    assert told(campaign) == []
    assert campaign.passed
    faults = {end.run.hits[0].fault for end in campaign.ends}
    assert faults == {case.name.replace(" ", ":") for case in possible_faults(cells["minimal"].contract)}
    assert {end.run.hits[0].step for end in campaign.ends} == {1, 2, 3, 4}


@pytest.mark.parametrize("name", ["ur5e_pick", "fr3_hand"])
def test_sample_of_faults_and_pairs_ends_as_named(cells: dict[str, MockCell], name: str) -> None:
    campaign = campaign_of(cells[name], sample)
    assert told(campaign) == []
    assert campaign.passed
    assert {peak.quantity for peak in campaign.limits.peaks} == {"velocity", "acceleration", "jerk"}
    assert all(0.0 < peak.share <= 1.0 for peak in campaign.limits.peaks)


def test_runs_are_the_same_bits_on_one_process_on_two_and_alone(folders: dict[str, Path]) -> None:
    def some(plan: CampaignPlan) -> Chosen:
        return tuple(plan.singles())[::19]

    alone = campaign_of(load(folders["minimal"]), some)
    shared = campaign_of(load(folders["minimal"]), some, jobs=2)
    assert [(end.run.identifier, end.digest) for end in shared.ends] == [
        (end.run.identifier, end.digest) for end in alone.ends
    ]
    assert shared.ends == alone.ends
    last = alone.ends[-1]

    def replayed(plan: CampaignPlan) -> Chosen:
        found = plan.find(last.run.identifier)
        assert found is not None
        return (found,)

    assert campaign_of(load(folders["minimal"]), replayed).ends[0].digest == last.digest


def test_digest_tells_runs_apart(cells: dict[str, MockCell]) -> None:
    campaign = campaign_of(cells["minimal"], lambda plan: tuple(plan.singles())[::9])
    assert len({end.digest for end in campaign.ends}) == len(campaign.ends)


def _without_checks_of_the_cell(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(task_context.TaskContext, "check_cell", lambda self: None)


@pytest.mark.parametrize(
    ("removed", "fault", "outcome"),
    [
        (_without_checks_of_the_cell, "protective_stop:arm", "protective_stop"),
        (_without_checks_of_the_cell, "skip_cycles", "missed_cycle"),
    ],
)
def test_removed_watchdog_makes_runs_fail(
    cells: dict[str, MockCell],
    monkeypatch: pytest.MonkeyPatch,
    removed: Callable[[pytest.MonkeyPatch], None],
    fault: str,
    outcome: str,
) -> None:
    def of_fault(plan: CampaignPlan) -> Chosen:
        return tuple(run for run in plan.singles() if run.hits[0].fault == fault and run.hits[0].step in (1, 3))

    cell = cells["ur5e_pick"]
    assert told(campaign_of(cell, of_fault)) == []
    removed(monkeypatch)
    failed = campaign_of(cell, of_fault).failed
    assert failed
    assert all((outcome in end.run.outcomes and end.result.outcome != outcome) or not end.in_time for end in failed)


def test_run_that_raises_is_told_as_crashed_and_hides_no_other(
    cells: dict[str, MockCell], monkeypatch: pytest.MonkeyPatch
) -> None:
    def raising(self: task_context.TaskContext) -> None:
        raise ZeroDivisionError("by hand")

    cell = cells["minimal"]
    plan, baselines = make_plan(cell, possible_faults(cell.contract), 0)
    monkeypatch.setattr(task_context.TaskContext, "check_cell", raising)
    runs = tuple(plan.singles())[:2]
    campaign = conduct(cell, runs, baselines, seed=0, factory=None, progress=lambda *_: None)
    assert [end.crash for end in campaign.ends] == ["ZeroDivisionError: by hand"] * 2
    assert len(campaign.failed) == 2


def test_pairs_are_told_by_their_seed(cells: dict[str, MockCell]) -> None:
    plan = plan_of(cells["ur5e_pick"])
    first = [run.identifier for run in plan.pairs(20, seed=3)]
    assert len(set(first)) == 20
    assert [run.identifier for run in plan.pairs(20, seed=3)] == first
    assert [run.identifier for run in plan.pairs(20, seed=4)] != first
    assert all(run.hits[0].fault != run.hits[1].fault for run in plan.pairs(20, seed=3))


def test_every_run_is_found_by_its_identifier(cells: dict[str, MockCell]) -> None:
    plan = plan_of(cells["ur5e_pick"])
    for run in (*plan.singles(), *plan.pairs(5, seed=0)):
        assert plan.find(run.identifier) == run
        assert plan.find(run.identifier.partition("/")[2]) == run  # there is one rehearsal without faults
    assert plan.find("pick_and_place/stick:nothing@1") is None
    assert plan.find("other/skip_cycles@1") is None


def test_refusal_of_a_worker_arrives_as_it_was_said() -> None:
    refusal = MockError("contract.json", "names nothing")
    arrived = pickle.loads(pickle.dumps(refusal))
    assert (str(arrived), arrived.file, arrived.reason) == (str(refusal), "contract.json", "names nothing")


def test_progress_is_told_after_each_run_with_those_that_failed(
    cells: dict[str, MockCell], monkeypatch: pytest.MonkeyPatch
) -> None:
    def raising(self: task_context.TaskContext) -> None:
        raise ZeroDivisionError("by hand")

    cell, told = cells["minimal"], list[tuple[int, int, int]]()
    plan, baselines = make_plan(cell, possible_faults(cell.contract), 0)
    runs = tuple(plan.singles())[:3]
    for step, count in ((raising, 3), (task_context.TaskContext.check_cell, 0)):
        told.clear()
        with monkeypatch.context() as patch:
            patch.setattr(task_context.TaskContext, "check_cell", step)
            conduct(cell, runs, baselines, seed=0, factory=None, progress=lambda *one: told.append(one))
        assert told == [(done, 3, min(done, count)) for done in (1, 2, 3)]
