"""A sweep on the command line: what it prints, writes and refuses."""

from __future__ import annotations

import json
import re
from pathlib import Path
from urllib.parse import unquote

import pytest

from tests.cells import generated
from tests.cli.refused import assert_refused
from tests.cli.run import run


def test_a_sweep_says_rate_margins_draws_and_verdict_and_a_run_is_made_again(nest_folder: Path, tmp_path: Path) -> None:
    journal = str(tmp_path / "runs.jsonl")
    ran = run("sweep", str(nest_folder), "--runs", "6", "--jobs", "1", "--journal", journal)
    lines = ran.out.splitlines()
    assert ran.code == 1, ran.out
    assert lines[0] == "put: 6 runs with seed 0, 5 succeeded"
    assert lines[1].endswith("with confidence 0.975 (Clopper-Pearson)")
    drawn = "nest x, y, z normal, deviation in space 1 mm calibrations.nest.residual"
    assert drawn in [" ".join(line.split()) for line in lines]
    assert lines[-1] == "UNKNOWN: 85 % of the runs must succeed, with confidence 0.95; 6 runs do not decide it"
    failed = next(line.split()[1].rstrip(":") for line in lines if line.startswith("FAILED"))
    told = json.loads(run("sweep", str(nest_folder), "--runs", "6", "--jobs", "1", "--journal", journal, "--json").out)
    number = int(failed.removeprefix("sweep:"))
    again = run("replay", str(nest_folder), failed, "--journal", journal)
    assert again.code == 1
    assert f"FAILED  {failed}: missed put" in again.out
    assert f"digest: {told['sweeps'][0]['runs'][number]['digest']}" in again.out
    assert_refused(
        run("replay", str(nest_folder), failed, "--journal", journal, "--seed", "1"), "belongs to another sweep"
    )
    assert told["sweeps"][0]["verdict"] is None
    kept = tmp_path / "kept"
    run("sweep", str(nest_folder), "--runs", "6", "--jobs", "1", "--journal", journal, "--evidence", str(kept))
    assert [unquote(file.stem) for file in kept.glob("*.mcap")] == [f"put/{failed}"]  # of failures alone
    page = (kept / "report.html").read_text(encoding="utf-8")
    assert "Sweep of put" in page
    assert page.count('class="runs beyond"') == 1  # one run of six is beyond the tolerance
    (row,) = re.findall(rf"<tr>(?:(?!</tr>).)*put/{failed}(?:(?!</tr>).)*</tr>", page)[:1]
    assert "missed put" in row
    assert "✓" not in row
    alone = tmp_path / "alone"
    run("replay", str(nest_folder), failed, "--evidence", str(alone))
    page = (alone / "report.html").read_text(encoding="utf-8")
    assert "0 of 1 rehearsal ended as expected" in page
    assert "missed put, FAILED" in page


def test_several_folders_are_swept_into_one_table(nest_folder: Path) -> None:
    folder, without = str(nest_folder), str(generated("minimal"))
    ran = run("sweep", folder, without, "--runs", "6", "--jobs", "1")
    assert ran.code == 1
    table = [line.split() for line in ran.out.splitlines()[1:3]]
    assert [row[0] for row in table] == ["FAILED", "passed"]  # six runs decide nothing; a cell that draws nothing
    assert table[0][-5:] == ["put", "5", "of", "6", "UNKNOWN"]
    assert run("mock", folder, without, "--jobs", "1").code == 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["sweep", "--runs", "0"], "the number of runs is 0; it must be 1 or greater"),
        (["gates", "--sweep", "-1"], "the number of runs is -1; it must be 1 or greater"),
        (["gates", "--journal", "runs.jsonl"], "--journal needs --sweep"),
        (["replay", "ready/delay:arm@1", "--journal", "x"], "--journal needs a run of a sweep, `sweep:NUMBER`"),
        (["replay", "ready/delay:arm@1", "--rehearsal", "x"], "--rehearsal needs a run of a sweep"),
        (["replay", "ready/delay:arm@1", "sweep:1"], "runs of a sweep cannot be combined with runs of the campaign"),
        (["replay", "sweep:1", "--records", "x"], "--records cannot be combined with a run of a sweep"),
        (["sweep"], "the folder has no `config/uncertainty.json`; write `uncertainty: {}` in the spec"),
        (["replay", "sweep:x"], "the folder has no `config/uncertainty.json`"),
        (["sweep", "--runs", "10000001"], "at most 10000000"),
        (["sweep", "--seed", str(1 << 64)], "that of a sweep must be below 2^64"),
        (["replay", "sweep:1", "--seed", str(1 << 64)], "that of a sweep must be below 2^64"),
        (["sweep", "--jobs", "2", "--cluster", "tcp://127.0.0.1:1"], "--jobs cannot be combined with --cluster"),
    ],
)
def test_what_cannot_be_swept_is_refused(arguments: list[str], words: str) -> None:
    assert_refused(run(arguments[0], str(generated("minimal")), *arguments[1:]), words)
