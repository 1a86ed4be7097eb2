"""How often a rehearsal succeeds where a fixture stands somewhere else than it is said to, against closed forms."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cellc.contract.compute.processes import processes
from cellc.contract.uncertainty import UncertainQuantity
from cellc.mock import MockCell, MockError, load
from cellc.mock.plant import Plant
from cellc.mock.report_page.sweep_section import histogram, sweep_section
from cellc.mock.sweep.draws import draw, draw_all
from cellc.mock.sweep.figures import confidence_of_look, explain, interval
from cellc.mock.sweep.journal import Journal
from cellc.mock.sweep.margins import Margin, margins
from cellc.mock.sweep.runs import RunStore, SweepRun, SweepRuns
from cellc.mock.sweep.summary import explanations, unexplained
from cellc.mock.sweep.sweep import Sweep, execute, sweep, uncertainty_of
from tests.cells import generated
from tests.mock.sweep.conftest import RESIDUAL_M, TOLERANCE_M
from tests.planning.arm import dh_singular_values

NEST = ("nest x", "nest y", "nest z")


def missed_by_hand() -> float:
    """Return how likely a point is farther off than the tolerance: Maxwell's distribution of its distance."""
    sigma = RESIDUAL_M / math.sqrt(3.0)
    far = TOLERANCE_M / sigma
    return math.erfc(far / math.sqrt(2.0)) + math.sqrt(2.0 / math.pi) * far * math.exp(-(far**2) / 2.0)


def swept(cell: MockCell, most: int, *, jobs: int = 1, ends: RunStore | None = None) -> Sweep:
    factory = processes(jobs) if jobs > 1 else None
    kept = dict[int, SweepRun]()
    entry = cell.entry("put")
    return sweep(
        cell,
        entry,
        seed=0,
        most=most,
        factory=factory,
        ends=RunStore() if ends is None else ends,
        keep=lambda run: kept.update({run.number: run}),
    )


@pytest.fixture(scope="session")
def twelve(nest: MockCell) -> Sweep:
    return swept(nest, 12)


def test_a_tip_is_as_far_from_the_goal_as_the_fixture_was_displaced(nest: MockCell, twelve: Sweep) -> None:
    quantities = uncertainty_of(nest).quantities
    for run in twelve.runs:
        drawn = draw(quantities, 0, run.number)
        distance = math.sqrt(sum(drawn[name] ** 2 for name in NEST))
        assert run.goals["put"].distance_m == pytest.approx(distance, abs=1e-7)
        assert run.outcome == ("succeeded" if distance <= TOLERANCE_M else "missed put")
    assert {run.outcome for run in twelve.runs} == {"succeeded", "missed put"}


def test_what_joints_and_reach_had_left_is_told_of_each_goal(nest: MockCell, twelve: Sweep) -> None:
    watched: list[Plant] = []
    assert nest.rehearse(nest.entry("put"), watch=watched.append).passed
    (arrival,) = watched[0].arrivals
    stood = watched[0].world.joint_positions(arrival.stamp_ns)
    # Joints of a UR5e turn 360 degrees to either side, and its elbow 180 (UR5e technical specification).
    ends = {name: math.radians(180 if "elbow" in name else 360) for name in nest.contract.groups["manipulator"].joints}
    used = max(abs(stood[name]) / end for name, end in ends.items())
    assert arrival.joint_room is not None
    assert 1.0 - 2.0 * arrival.joint_room == pytest.approx(used)
    assert {tuple(run.goals) for run in twelve.runs} == {("put",)}
    assert all(run.goals["put"].joint_room == pytest.approx(arrival.joint_room, abs=0.01) for run in twelve.runs)
    assert all(run.joint_state_age_s is not None for run in twelve.runs)
    # The end of the reach is where the least singular value is 0; here it is taken from the vendor's DH parameters.
    at = np.array([stood[name] for name in nest.contract.groups["manipulator"].joints])
    assert arrival.singular_value == pytest.approx(dh_singular_values(at)[-1], abs=1e-4)


def test_margins_go_from_the_best_run_to_the_worst_up_to_their_bounds(nest: MockCell, twelve: Sweep) -> None:
    found = {margin.name: margin for margin in margins(twelve, nest.contract)}
    distances = sorted(run.goals["put"].distance_m for run in twelve.runs)
    off, near = found["distance at put"], found["least singular value at put"]
    assert (off.values.tolist(), off.bound) == (distances, TOLERANCE_M)
    # Of 12 runs, 1 is the best 5 %, 6 are half of them, and 95 % are all of them.
    assert [off.quantile(share) for share in (0.05, 0.5, 0.95, 1.0)] == [distances[place] for place in (0, 5, 11, 11)]
    assert near.values[-1] == min(run.goals["put"].singular_value for run in twelve.runs)
    # Nothing stands around this arm, so that it has no clearance.
    assert {name: one.bound for name, one in found.items() if one.bound is not None} == {
        "distance at put": TOLERANCE_M,
        "joint range used at put": 1.0,
        "least singular value at put": 0.005,  # docs/mock.md, Sweeps
        "age of joint states": 0.1,
    }


def _margin(name: str, values: tuple[float, ...], bound: float, *, falling: bool = False) -> Margin:
    return Margin(name, "m", np.array(values), bound, falling)


def test_a_drawing_holds_the_bound_and_every_run(nest: MockCell, twelve: Sweep) -> None:
    def places(margin: Margin) -> tuple[list[float], float, list[str]]:
        drawn = list(histogram(margin).iter())
        bars = [one for one in drawn if one.tag == "rect"]
        (bound,) = [float(one.attrib["x1"]) for one in drawn if one.attrib.get("class") == "limit"]
        return [float(bar.attrib["x"]) for bar in bars], bound, [bar.attrib["class"] for bar in bars]

    # 200 wide: 6 of 10 is at 120 of them, 10 at the end, in the last of 50 bars.
    assert places(_margin("far", (6.0, 10.0), 10.0)) == ([120.0, 196.0], 199.0, ["runs", "runs"])
    assert places(_margin("far", (4.0, 10.0), 5.0)) == ([80.0, 196.0], 100.0, ["runs", "runs beyond"])
    assert places(_margin("near", (10.0, 6.0), 0.0, falling=True)) == ([0.0, 80.0], 199.0, ["runs", "runs"])
    assert places(_margin("near", (-5.0, -10.0), 0.0, falling=True)) == ([100.0, 196.0], 0.0, 2 * ["runs beyond"])
    nowhere = replace(
        twelve, runs=SweepRuns.listed(replace(run, goals={}, joint_state_age_s=None) for run in twelve.runs)
    )
    assert "best to worst" not in {element.text for element in sweep_section(nowhere, nest.contract).iter()}


def test_a_margin_of_what_is_observed_ends_where_an_observation_is_too_old() -> None:
    pick = load(generated("ur5e_pick"))
    stated = pick.contract.interfaces["/object_pose"].max_age_s
    swept_twice = sweep(
        pick, pick.entry("pick_and_place"), seed=0, most=2, factory=None, ends=RunStore(), keep=lambda _: None
    )
    found = {margin.name: margin.bound for margin in margins(swept_twice, pick.contract)}
    assert stated is not None
    assert (found["age of transforms at pick"], found["age of transforms at place"]) == (stated, None)
    assert (found["clearance at pick"], found["clearance at place"]) == (0.0, 0.0)


def test_a_run_is_the_same_alone_and_by_any_number_of_processes(nest: MockCell, twelve: Sweep) -> None:
    uncertainty = uncertainty_of(nest)
    assert execute(nest, nest.entry("put"), uncertainty, 0, 7) == twelve.runs[7]
    assert swept(nest, 12, jobs=2) == twelve
    assert execute(nest, nest.entry("put"), uncertainty, 1, 7).digest != twelve.runs[7].digest


def test_what_is_said_of_a_cell_is_drawn_and_nothing_else(nest: MockCell) -> None:
    found = {
        quantity.name: (quantity.distribution, quantity.unit, quantity.spread, quantity.source)
        for quantity in uncertainty_of(nest).quantities
    }
    axis = ("isotropic", "m", RESIDUAL_M, "calibrations.nest.residual")
    assert found == {
        **dict.fromkeys(NEST, axis),
        "clock pc": ("uniform", "s", 0.001, "hosts.pc.clock.max_offset"),
    }


def test_the_known_rate_lies_in_the_interval_in_95_of_100_seeds(nest: MockCell) -> None:
    quantities = [quantity for quantity in uncertainty_of(nest).quantities if quantity.name in NEST]
    truth = 1.0 - missed_by_hand()
    assert truth == pytest.approx(0.9197, abs=1e-4)
    found = 0
    for seed in range(100):
        drawn = np.array([list(draw(quantities, seed, run).values()) for run in range(100)])
        rate = interval(int((np.linalg.norm(drawn, axis=1) <= TOLERANCE_M).sum()), len(drawn), 0.95)
        found += rate.low <= truth <= rate.high
    assert found >= 95


def test_the_only_cause_is_named_and_what_has_no_effect_is_not(nest: MockCell) -> None:
    quantities = uncertainty_of(nest).quantities
    rows = [draw(quantities, 0, run) for run in range(600)]
    values = {quantity.name: np.array([row[quantity.name] for row in rows]) for quantity in quantities}
    distance = np.sqrt(sum(values[name] ** 2 for name in NEST))
    first, *others = explain(
        quantities, lambda group: np.array([values[one.name] for one in group]), distance > TOLERANCE_M
    )
    assert (first.name, first.names, first.explains) == ("nest", NEST, True)
    assert first.statistic == 1.0
    assert [(other.name, other.explains) for other in others] == [("clock pc", False)]
    assert first.halved is not None
    assert first.halved < 1e-3  # Maxwell: 5e-6 at twice the tolerance


@pytest.mark.parametrize(
    ("successes", "runs", "low", "high"),
    [
        (0, 10, 0.0, 0.308497),  # 1 - 0.025 ** (1 / 10)
        (10, 10, 0.691503, 1.0),
        (5, 10, 0.187086, 0.812914),  # R 4.4, binom.test(5, 10)
        (196, 200, 0.949588, 0.994524),  # R 4.4, binom.test(196, 200)
    ],
)
def test_interval_is_that_of_clopper_and_pearson(successes: int, runs: int, low: float, high: float) -> None:
    found = interval(successes, runs, 0.95)
    assert found.low == pytest.approx(low, abs=2e-6)
    assert found.high == pytest.approx(high, abs=2e-6)


def test_all_looks_together_cost_what_may_be_wrong() -> None:
    assert sum(1.0 - confidence_of_look(number, 0.95) for number in range(1, 10_000)) == pytest.approx(0.05, abs=1e-5)


def test_a_quantity_that_is_added_changes_no_other(nest: MockCell) -> None:
    quantities = uncertainty_of(nest).quantities
    added = quantities[0].model_copy(update={"name": "another"})
    assert draw((added, *quantities), 3, 7).items() >= draw(quantities, 3, 7).items()


def test_draws_have_their_distribution() -> None:
    def one(name: str, distribution: str) -> UncertainQuantity:
        common = {"kind": "clock", "target": "pc", "axis": "offset", "unit": "s", "spread": 2.0, "source": "by hand"}
        return UncertainQuantity.model_validate({"name": name, "distribution": distribution, **common})

    rows = [draw((one("n", "normal"), one("u", "uniform")), 0, run) for run in range(2000)]
    normal, uniform = (np.array([row[name] for row in rows]) for name in ("n", "u"))
    assert (normal.mean(), normal.std()) == (pytest.approx(0.0, abs=0.1), pytest.approx(2.0, abs=0.1))
    assert float(np.abs(uniform).max()) < 2.0
    assert (uniform.mean(), uniform.std()) == (
        pytest.approx(0.0, abs=0.1),
        pytest.approx(2.0 / math.sqrt(3.0), abs=0.05),
    )


@pytest.mark.parametrize("seed", [0, 1, 12345678901234567, 2**64 - 1])
def test_many_runs_draw_together_what_each_draws_alone(seed: int, nest: MockCell) -> None:
    # numpy's own generator is the judge of the arithmetic on arrays.
    quantities, numbers = (
        uncertainty_of(nest).quantities,
        np.array([0, 1, 77, 10**6, *range(20000, 40000, 1999), 2**62]),
    )
    alone = [list(draw(quantities, seed, number).values()) for number in numbers.tolist()]
    assert draw_all(quantities, seed, numbers).T.tolist() == alone
    many = np.arange(40000)
    assert draw_all(quantities, seed, many)[:, -3:].T.tolist() == draw_all(quantities, seed, many[-3:]).T.tolist()


def test_a_sweep_goes_on_where_its_journal_ends_and_ends_as_it_would_have(
    nest: MockCell, twelve: Sweep, tmp_path: Path
) -> None:
    file = tmp_path / "runs.jsonl"
    with Journal(file, nest.contract, "put", 0) as journal:
        for run in twelve.runs[2:10]:
            journal.keep(run)
    with file.open("ab") as cut:
        cut.write(b'{"number":10,"outcome":"' + 1000 * b"x")
    again = Journal(file, nest.contract, "put", 0)
    assert sorted(again.runs.values(), key=lambda run: run.number) == list(twelve.runs[2:10])
    with again:
        assert swept(nest, 12, ends=again.runs) == twelve
        again.keep(twelve.runs[11])
    assert set(Journal(file, nest.contract, "put", 0).runs) == {*range(2, 10), 11}
    with pytest.raises(MockError, match="belongs to another sweep"):
        Journal(file, nest.contract, "put", 1)


def test_a_verdict_comes_as_soon_as_it_is_certain_and_later_runs_change_nothing(nest: MockCell, twelve: Sweep) -> None:
    def ended(passed: Iterable[bool]) -> RunStore:
        store = RunStore()
        for number, well in enumerate(passed):
            store.add(replace(twelve.runs[0], number=number, passed=well))
        return store

    good = swept(nest, 1000, ends=ended(1000 * [True]))
    assert (len(good.runs), good.verdict) == (100, True)  # 0.0125 ** (1 / 100) is 0.957
    bad = swept(nest, 1000, ends=ended(500 * [True, False]))
    assert (len(bad.runs), bad.verdict) == (100, False)
    even = swept(nest, 300, ends=ended(3 * (15 * [False] + 85 * [True])))
    assert (len(even.runs), even.verdict) == (300, None)


def test_more_runs_are_advised_only_where_they_would_be_made_and_would_tell(nest: MockCell, twelve: Sweep) -> None:
    def told(*, asked: int = 12, passed: tuple[int, ...] = (), drawn: bool = True) -> str:
        runs = SweepRuns.listed(replace(run, passed=run.number in passed) for run in twelve.runs)
        quantities = twelve.uncertainty.quantities if drawn else ()
        uncertainty = twelve.uncertainty.model_copy(update={"quantities": quantities})
        swept_so = replace(twelve, runs=runs, asked=asked, uncertainty=uncertainty)
        (last,) = unexplained(swept_so, explanations(swept_so))
        return last.removesuffix(" (Monte Carlo filtering, Kolmogorov-Smirnov)")

    nothing = "no drawn quantity explains the failures; "
    assert told(passed=(1, 2, 3)) == nothing + "more runs may show more"
    assert told(passed=(1, 2, 3), asked=99) == nothing + (
        "the verdict ended the sweep early; without `success` it makes all 99 runs"
    )
    assert told() == "every run failed, so no successful run is left for a comparison"
    assert told(passed=(1,), drawn=False) == "no quantity is drawn that could explain the failures"


def test_a_folder_that_names_what_it_does_not_have_is_refused(nest: MockCell) -> None:
    known = uncertainty_of(nest)
    edited = known.model_copy(update={"tolerances": {"elsewhere": 0.001}})
    with pytest.raises(MockError, match="names goal `elsewhere`, which the folder does not have"):
        uncertainty_of(nest.with_realities(replace(nest.folder, uncertainty=edited), {}))
    with pytest.raises(MockError, match=r"has no `config/uncertainty\.json`; write `uncertainty: \{\}`"):
        uncertainty_of(nest.with_realities(replace(nest.folder, uncertainty=None), {}))


def test_bits_are_those_of_philox_with_seed_and_run_as_key() -> None:
    """numpy's own constructor is asked; a name's counter is the first 24 bytes of its SHA-256."""
    one = UncertainQuantity.model_validate(
        {
            "name": "x",
            "kind": "clock",
            "target": "pc",
            "axis": "offset",
            "unit": "s",
            "distribution": "uniform",
            "spread": 1.0,
            "source": "by hand",
        }
    )
    counter = int.from_bytes(hashlib.sha256(b"x").digest()[:24], "little")
    raw = int(np.random.Philox(key=(77 << 64) | 5, counter=counter).random_raw())
    assert draw((one,), 5, 77)["x"] == pytest.approx(2.0 * (raw / 2.0**64) - 1.0, abs=1e-15)
