"""What a folder of evidence says of each gate: complete, missing, failed, of others, and who signs."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from tests.cells import generated
from tests.cli.run import Ran, run
from tests.evidence.attempts import JOINTS, complete, first_goal, manifest, observe, package, ticked

PACKAGE = ("--package", package("ur5e_pick").as_posix())
_GATES = ["G0", "G1", "G2", *(f"L{number}" for number in range(1, 7)), *(f"G{number}" for number in range(3, 8))]
_OWN = manifest("ur5e_pick")["configuration_id"]
_OTHER = "cfg-0123456789ab"


@pytest.fixture(name="whole", scope="module")
def whole_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return complete(tmp_path_factory.mktemp("evidence") / "attempt-001")


@pytest.fixture(name="folder")
def folder_fixture(whole: Path, tmp_path: Path) -> Path:
    """A copy to change."""
    return Path(shutil.copytree(whole, tmp_path / "attempt-001"))


def states(folder: Path, *words: str) -> tuple[Ran, dict[str, Any], dict[str, Any]]:
    """Return what was printed, the report, and its gates by code."""
    ran = run("evidence", folder.as_posix(), *PACKAGE, "--format", "json", *words)
    report = json.loads(ran.out)
    return ran, report, {gate["gate"]: gate for gate in report["gates"]}


def test_all_that_the_checklists_ask_for_is_complete_and_names_who_signs(whole: Path) -> None:
    ran, report, gates = states(whole)
    assert ran.code == 0
    assert (report["complete"], report["refused"], report["unread"], report["beside"]) == (True, [], [], [])
    assert (report["cell"], report["configuration_id"]) == ("ur5e_pick", _OWN)
    assert list(gates) == _GATES
    signing: dict[str, str] = {}
    for page in ("promotion", "network"):
        text = (package("ur5e_pick") / f"gates/{page}.md").read_text(encoding="utf-8")
        owners = re.findall(r"Signed by: owner `(.+?)`\.", text)
        signing.update(zip(re.findall(r"^## ([GL]\d) ", text, re.MULTILINE), owners, strict=True))
    assert {code: gate["signed_by"] for code, gate in gates.items()} == signing
    assert {gate["status"] for gate in gates.values()} == {"complete"}
    assert [piece["attempts"] for piece in gates["G3"]["files"] if piece["kind"] == "observe"] == [["20261128T101500Z"]]


def test_nothing_is_there(tmp_path: Path) -> None:
    ran, _, gates = states(tmp_path)
    assert ran.code == 1
    assert {gate["status"] for gate in gates.values()} == {"UNKNOWN"}
    assert gates["G3"]["missing"] == ["G3-freshness.md", "observe-G3-*.json"]
    assert gates["G7"]["missing"] == [
        "G7-attempt.md",
        "G7-bag",
        *(f"G7-first-goal-arm_{joint}_joint-end-*.json" for joint in JOINTS),
        "G7-first-goal-arm_wrist_3_joint-cancel-*.json",
        "observe-G7-*.json",
        "G7-bag.attempt.json",
    ]


def test_gates_that_are_not_asked_for_count_for_nothing(folder: Path) -> None:
    for each in folder.glob("G7-*"):
        shutil.rmtree(each) if each.is_dir() else each.unlink()
    assert states(folder)[0].code == 1
    ran, _, gates = states(folder, "--gate", "L4", "--gate", "G3")
    assert (ran.code, list(gates)) == (0, ["L4", "G3"])


def _rewrite(place: Path, **fields: Any) -> None:
    place.write_text(json.dumps({**json.loads(place.read_text(encoding="utf-8")), **fields}), encoding="utf-8")


_OBSERVED = "observe-G3-20261128T101500Z.json"
_ILL: dict[str, tuple[Callable[[Path], object], str, str, str]] = {
    "no notes": (lambda folder: (folder / "G1-model.md").unlink(), "G1", "UNKNOWN", "missing"),
    "empty notes": (lambda folder: (folder / "G1-model.md").write_text(" \n"), "G1", "UNKNOWN", "is empty"),
    "notes that say FAILED": (
        lambda folder: (folder / "G2-mock.md").write_text("passed  a: x\nFAILED  pick: timeout (expected succeeded)\n"),
        "G2",
        "FAILED",
        "G2-mock.md says FAILED of pick",
    ),
    "notes without the configuration": (
        lambda folder: (folder / "G0-inventory.md").write_text("uname\n"),
        "G0",
        "UNKNOWN",
        f"does not have the configuration ID {_OWN}",
    ),
    "notes of two configurations": (
        lambda folder: (folder / "G1-model.md").write_text(f"{_OWN} after {_OTHER}\n"),
        "G1",
        "UNKNOWN",
        f"also names configuration {_OTHER}",
    ),
    "a short time": (lambda folder: _rewrite(folder / _OBSERVED, seconds=12.0), "G3", "UNKNOWN", "600 s must be"),
    "no comparison": (lambda folder: _rewrite(folder / _OBSERVED, lines=[]), "G3", "UNKNOWN", "nothing was compared"),
    "a recording that was not ended": (
        lambda folder: (folder / "G6-bag/metadata.yaml").unlink(),
        "G6",
        "UNKNOWN",
        "the recording was not ended",
    ),
    "a failed first goal": (
        lambda folder: first_goal(folder, "arm_elbow_joint", "end", "FAILED", seen="out: left its way"),
        "G7",
        "FAILED",
        "out: left its way",
    ),
    "an attempt of which nothing is known": (
        lambda folder: _rewrite(folder / "G7-bag.attempt.json", outcome="UNKNOWN"),
        "G7",
        "UNKNOWN",
        "outcome UNKNOWN",
    ),
}


@pytest.mark.parametrize("what", _ILL)
def test_what_is_wrong_is_named_at_its_gate_alone(what: str, folder: Path) -> None:
    spoil, code, status, said = _ILL[what]
    spoil(folder)
    ran, _, gates = states(folder)
    assert ran.code == 1
    assert {gate: each["status"] for gate, each in gates.items() if each["status"] != "complete"} == {code: status}
    assert said in json.dumps(gates[code])


def test_each_comparison_that_did_not_pass_is_named(folder: Path) -> None:
    observe(folder, "ur5e_pick", "G3", at="20261128T110000Z", wrong=lambda seen: seen.nodes.append("/perception"))
    _, _, gates = states(folder)
    assert gates["G3"]["status"] == "FAILED"
    (finding,) = gates["G3"]["findings"]
    assert finding["status"] == "FAILED"
    assert finding["text"] == "node names: /perception runs 2 times (expected: each once)"
    assert gates["G3"]["notes"] == [f"{_OBSERVED} is an earlier run, in which 0 lines failed"]


def test_a_newer_run_that_passes_replaces_a_failed_one_which_is_still_named(folder: Path) -> None:
    observe(folder, "ur5e_pick", "G3", at="20261128T090000Z", wrong=lambda seen: seen.nodes.append("/perception"))
    ran, _, gates = states(folder)
    assert ran.code == 0
    assert gates["G3"]["notes"] == ["observe-G3-20261128T090000Z.json is an earlier run, in which 1 line failed"]


_FOREIGN: dict[str, tuple[Callable[[Path], object], str, str]] = {
    "observation of another configuration": (
        lambda folder: _rewrite(folder / _OBSERVED, configuration_id=_OTHER),
        _OBSERVED,
        f"is of configuration {_OTHER}, this package is {_OWN}",
    ),
    "observation of another cell": (
        lambda folder: _rewrite(folder / _OBSERVED, cell="minimal"),
        _OBSERVED,
        "is of cell `minimal`, this package is of `ur5e_pick`",
    ),
    "observation of the mock": (
        lambda folder: _rewrite(folder / _OBSERVED, target="mock"),
        _OBSERVED,
        "observes the mock; G3 is passed on the real target",
    ),
    "observation of another gate": (
        lambda folder: _rewrite(folder / _OBSERVED, gate="L3"),
        _OBSERVED,
        "says to be observe-L3-20261128T101500Z.json: it was renamed",
    ),
    "notes of another configuration": (
        lambda folder: (folder / "G1-model.md").write_text(f"{_OTHER}\n"),
        "G1-model.md",
        f"is of configuration {_OTHER}, this package is {_OWN}",
    ),
    "manifest of another cell": (
        lambda folder: (folder / "G0-inventory.md").write_text('{\n  "cell": "minimal",\n}\n'),
        "G0-inventory.md",
        "is of cell `minimal`, this package is of `ur5e_pick`",
    ),
    "attempt of another configuration": (
        lambda folder: _rewrite(folder / "G7-bag.attempt.json", configuration_id=_OTHER),
        "G7-bag.attempt.json",
        f"is of configuration {_OTHER}, this package is {_OWN}",
    ),
    "first goal of another configuration": (
        lambda folder: first_goal(folder, "arm_elbow_joint", "end", configuration_id=_OTHER),
        "G7-first-goal-arm_elbow_joint-end-20261128T103000Z.json",
        f"is of configuration {_OTHER}, this package is {_OWN}",
    ),
    "checklist of another cell": (
        lambda folder: shutil.copy(package("minimal") / "gates/promotion.md", folder),
        "promotion.md",
        "is no copy of gates/promotion.md of this package: G0 differs",
    ),
}


@pytest.mark.parametrize("what", _FOREIGN)
def test_evidence_of_others_is_refused_file_by_file(what: str, folder: Path) -> None:
    spoil, path, why = _FOREIGN[what]
    spoil(folder)
    ran, report, _ = states(folder)
    assert ran.code == 1
    assert report["refused"] == [{"path": path, "why": why}]


def test_a_first_goal_without_its_package_names_no_configuration(folder: Path) -> None:
    place = first_goal(folder, "arm_elbow_joint", "end")
    record = json.loads(place.read_text(encoding="utf-8"))
    del record["cell"], record["configuration_id"]
    place.write_text(json.dumps(record), encoding="utf-8")
    _, _, gates = states(folder)
    (piece,) = (each for each in gates["G7"]["files"] if each["status"] == "UNKNOWN")
    assert piece["said"] == "names no configuration: it was started without --package"


def test_rehearsals_that_were_kept_count_for_the_mock_gate(folder: Path) -> None:
    runs = folder / "runs"
    assert run("mock", package("minimal").as_posix(), "--evidence", runs.as_posix()).code == 0
    _, report, _ = states(folder)
    assert [each["path"] for each in report["refused"]] == ["runs/evidence.json"]
    of_minimal = ("--package", package("minimal").as_posix(), "--gate", "G2", "--format", "json")
    (folder / "G2-mock.md").write_text("passed  ready: succeeded\n", encoding="utf-8")
    ticked(folder, "minimal")
    gate = json.loads(run("evidence", folder.as_posix(), *of_minimal).out)["gates"][0]
    assert (gate["status"], gate["notes"]) == ("complete", ["1 of 1 rehearsals ended as expected: runs/evidence.json"])
    (runs / "ready.kpis.json").write_text("{}", encoding="utf-8")
    gate = json.loads(run("evidence", folder.as_posix(), *of_minimal).out)["gates"][0]
    assert gate["findings"] == [
        {"status": "UNKNOWN", "text": "runs/evidence.json: `ready.kpis.json` is not as cellc wrote it"}
    ]


def test_accepted_versions_are_shown_to_who_signs(folder: Path) -> None:
    line = "2026-11-28T09:00:00Z vm accepted by Ann: arm.sdk must be ur_client_library 2.14.1, is 2.15.0"
    (folder / "versions.txt").write_text(f"{line}\n", encoding="utf-8")
    _, _, gates = states(folder)
    assert gates["G0"]["notes"][0] == f"versions.txt: {line}"


def test_versions_that_are_unknown_stop_the_manifest_and_every_gate_after_it(tmp_path: Path) -> None:
    ran = run("evidence", tmp_path.as_posix(), "--package", generated("ur5e_pick").as_posix(), "--format", "json")
    pins = json.loads((generated("ur5e_pick") / "manifest.json").read_text(encoding="utf-8"))["version_tuple"]
    unknown = [part for part, version in pins.items() if version == "UNKNOWN"]
    assert "arm.serial" in unknown
    said = f"{len(unknown)} parts of the version tuple UNKNOWN: {', '.join(unknown)}; enter them in the spec"
    gate = json.loads(ran.out)["gates"][0]
    assert (gate["status"], gate["findings"][0]["status"]) == ("UNKNOWN", "UNKNOWN")
    assert gate["findings"][0]["text"].startswith(said)


def test_a_gate_waits_for_those_before_it_in_the_order_of_the_checklists(folder: Path) -> None:
    """README of a package: from top to bottom, and the network (G3) layer by layer."""
    observe(folder, "ur5e_pick", "L4", at="20261128T120000Z", wrong=lambda seen: seen.streams.clear())
    (folder / "G1-model.md").unlink()
    ran, report, gates = states(folder, "--gate", "G3", "--gate", "L3")
    assert (ran.code, report["complete"]) == (1, False)
    assert {code: gate["status"] for code, gate in gates.items()} == {"G3": "complete", "L3": "complete"}
    assert gates["L3"]["waits_for"] == [{"gate": "G1", "status": "UNKNOWN"}]
    assert gates["G3"]["waits_for"] == [{"gate": "G1", "status": "UNKNOWN"}, {"gate": "L4", "status": "FAILED"}]
    page = run("evidence", folder.as_posix(), *PACKAGE, "--gate", "G3", "--format", "html").out
    assert ("complete, but not to be signed yet: G1 is UNKNOWN, L4 is FAILED" in page, "Signature" in page) == (
        True,
        False,
    )
    text = run("evidence", folder.as_posix(), *PACKAGE, "--gate", "G3").out
    assert "1 gate: 0 complete, 1 waiting for earlier gates, 0 FAILED, 0 UNKNOWN." in text


def test_an_attempt_that_repeats_a_gate_is_read_after_the_earlier_one(folder: Path) -> None:
    observe(folder, "ur5e_pick", "G3", at="20261128T120000Z", wrong=lambda seen: seen.nodes.append("/perception"))
    again = folder.with_name("attempt-002")
    again.mkdir()
    shutil.copy(package("ur5e_pick") / "gates/promotion.md", again)
    both = ("evidence", folder.as_posix(), again.as_posix(), *PACKAGE)
    assert run(*both).code == 1  # nothing of it is in the second: a copied checklist that is blank counts for nothing
    observe(again, "ur5e_pick", "G3", at="20261128T130000Z")
    (again / "G3-freshness.md").write_text("done\n", encoding="utf-8")
    assert run(*both).code == 1  # its lines are not ticked
    ticked(again, "ur5e_pick")
    for page in again.glob("*.md"):  # those of the other gates stay blank
        sections = re.split(r"^(?=## )", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
        blank = [each if each.startswith("## G3") else each.replace("- [x]", "- [ ]") for each in sections]
        page.write_text("".join(blank), encoding="utf-8")
    ran = run(*both, "--format", "json")
    report = json.loads(ran.out)
    assert (ran.code, report["folders"]) == (0, [folder.as_posix(), again.as_posix()])
    (gate,) = (gate for gate in report["gates"] if gate["gate"] == "G3")
    assert gate["files"][1]["paths"] == [f"{again.as_posix()}/observe-G3-20261128T130000Z.json"]
    assert run("evidence", again.as_posix(), folder.as_posix(), *PACKAGE).code == 1  # the last one counts


def test_a_rehearsal_that_the_mock_printed_as_failed_fails_its_gate(folder: Path) -> None:
    printed = "passed  ready: succeeded (expected succeeded)\nfailed  slipped: timeout (expected grip_failure)\n"
    (folder / "G2-mock.md").write_text(f"{printed}failed on the first try, repeated\n", encoding="utf-8")
    (finding,) = states(folder)[2]["G2"]["findings"]
    assert (finding["status"], finding["text"]) == ("FAILED", "G2-mock.md says FAILED of slipped")


def _filled(folder: Path, code: str, *, ticked: bool, result: str = "") -> None:
    """Fill in the checklist of one gate, and tick nothing of the others."""
    page = (package("ur5e_pick") / "gates/network.md").read_text(encoding="utf-8")
    before, section = page.split(f"## {code} ")
    section, *after = section.split("\n## ")
    if ticked:
        section = section.replace("- [ ]", "- [x]")
    blank = "Result (passed or stopped): ________ Name: ________________ Date, time: ________________"
    if result:
        section = section.replace(blank, f"Result (passed or stopped): {result} Name: Ann Date, time: 2026-11-28 09:00")
    (folder / "network.md").write_text(f"{before}## {code} " + "\n## ".join([section, *after]), encoding="utf-8")


def test_a_filled_in_checklist_says_what_is_ticked_and_signed(folder: Path) -> None:
    _filled(folder, "L2", ticked=True, result="passed")
    ran, report, gates = states(folder)
    assert report["refused"] == []
    assert gates["L2"]["status"] == "complete"
    number = (package("ur5e_pick") / "gates/network.md").read_text(encoding="utf-8").split("## L2 ")[1]
    boxes = number.split("## L3 ")[0].count("- [ ]")
    assert gates["L2"]["page"] == f"network.md: {boxes} of {boxes} lines ticked; result: passed, Ann, 2026-11-28 09:00"
    assert gates["L3"]["status"] == "UNKNOWN"
    assert gates["L3"]["page"] == "network.md: 0 of 2 lines ticked; result: blank"
    (finding,) = gates["L3"]["findings"]
    keys = "check that each enclave in use has its keys. `security/policy.xml` lists the enclaves."
    assert finding["text"] == f"network.md: 2 lines not ticked, first: If access control is enforced, {keys}"
    boxes = (package("ur5e_pick") / "gates/promotion.md").read_text(encoding="utf-8").split("## G1 ")[0].count("- [ ]")
    assert gates["G0"]["page"] == f"promotion.md: {boxes} of {boxes} lines ticked; result: blank"
    assert ran.code == 1


def test_a_gate_without_a_ticked_copy_of_its_checklist_is_not_complete(folder: Path) -> None:
    (folder / "promotion.md").unlink()
    _, _, gates = states(folder)
    (finding,) = gates["G1"]["findings"]
    boxes = (package("ur5e_pick") / "gates/promotion.md").read_text(encoding="utf-8")
    number = boxes.split("## G1 ")[1].split("## G2 ")[0].count("- [ ]")
    assert (gates["G1"]["status"], finding["text"]) == (
        "UNKNOWN",
        f"no copy of gates/promotion.md with {number} lines ticked",
    )
    assert gates["L2"]["status"] == "complete"


def test_what_a_program_compared_is_not_found_a_second_time_in_its_printed_lines(folder: Path) -> None:
    observe(folder, "ur5e_pick", "G4", at="20261128T111500Z", wrong=lambda seen: seen.nodes.append("/task"))
    line = "FAILED  graph      nodes of later gates: /task runs, and G7 starts it (expected: none runs)"
    (folder / "G4-transitions.md").write_text(f"{line}\nFAILED  log        a fault of the driver\n", encoding="utf-8")
    _, _, gates = states(folder)
    assert [finding["text"] for finding in gates["G4"]["findings"]] == [
        "nodes of later gates: /task runs, and G7 starts it (expected: none runs)",
        "G4-transitions.md says FAILED of log        a fault of the driver",
    ]


def test_people_may_write_behind_a_line_of_the_checklist(folder: Path) -> None:
    _filled(folder, "L2", ticked=True)
    page = folder / "network.md"
    page.write_text(re.sub(r"(- \[x\] .*)", r"\1 done at 9:12", page.read_text(encoding="utf-8")), encoding="utf-8")
    _, report, gates = states(folder)
    assert (report["refused"], gates["L2"]["page"]) == ([], "network.md: 6 of 6 lines ticked; result: blank")


def test_a_line_that_does_not_apply_is_marked_with_its_reason(folder: Path) -> None:
    page = folder / "network.md"
    keys = "- [x] If access control is enforced, check that each enclave in use has its keys."
    text = page.read_text(encoding="utf-8")
    assert text.count(keys) == 1
    page.write_text(text.replace(keys, keys.replace("[x]", "[-]")), encoding="utf-8")
    _, _, gates = states(folder)
    (finding,) = gates["L3"]["findings"]
    assert finding["text"].startswith(
        "network.md: 1 line marked as not applying without a reason behind, first: If access"
    )
    assert gates["L3"]["page"] == "network.md: 1 of 2 lines ticked, 1 do not apply; result: blank"
    line = next(line for line in text.splitlines() if line.startswith(keys))
    reasoned = f"{line.replace('[x]', '[-]')} Not enforced here."
    page.write_text(text.replace(line, reasoned), encoding="utf-8")
    assert states(folder)[2]["L3"]["status"] == "complete"


def test_what_cannot_be_read_beside_what_can_is_named(folder: Path) -> None:
    (folder / "observe-G3-20261128T120000Z.json").write_text("{", encoding="utf-8")
    _, _, gates = states(folder)
    (finding,) = gates["G3"]["findings"]
    assert (gates["G3"]["status"], finding["status"]) == ("UNKNOWN", "UNKNOWN")
    assert finding["text"].startswith("observe-G3-20261128T120000Z.json: is not JSON")


def test_a_checklist_that_says_stopped_fails_its_gate(folder: Path) -> None:
    _filled(folder, "L2", ticked=True, result="stopped")
    assert states(folder)[2]["L2"]["status"] == "FAILED"


def test_what_no_gate_asks_for_is_listed(folder: Path) -> None:
    (folder / "photo.jpg").write_bytes(b"\xff\xd8")
    ran, report, _ = states(folder)
    assert (ran.code, report["beside"]) == (0, ["photo.jpg"])
