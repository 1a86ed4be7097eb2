"""``cellc evidence`` by the door that users take: its exit codes, forms, files, help and completion."""

from __future__ import annotations

import json
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import pytest

from tests.cells import ROOT
from tests.cli.run import run
from tests.evidence.attempts import complete, notes, observe, package
from tests.view.page import unheard

PACKAGE = ("--package", package("ur5e_pick").as_posix())


@pytest.fixture(name="whole", scope="module")
def whole_fixture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return complete(tmp_path_factory.mktemp("evidence") / "attempt-001")


def _cellc(*words: str, folder: Path) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "cellc", *words], cwd=folder, capture_output=True, text=True, check=False
    )


def test_a_folder_is_read_from_end_to_end_where_people_call_it(tmp_path: Path) -> None:
    shutil.copytree(package("ur5e_pick"), tmp_path / "generated/ur5e_pick")
    folder = tmp_path / "evidence/attempt-001"
    folder.mkdir(parents=True)
    notes(folder, "ur5e_pick")
    for page in (tmp_path / "generated/ur5e_pick/gates").glob("*.md"):
        ticked = page.read_text(encoding="utf-8").replace("- [ ]", "- [x]")
        (folder / page.name).write_text(ticked, encoding="utf-8")
    observe(folder, "ur5e_pick", "G3", wrong=lambda seen: seen.nodes.append("/task"))
    ran = _cellc("evidence", "evidence/attempt-001", folder=tmp_path)  # the evidence names its cell
    assert (ran.returncode, ran.stderr) == (1, "")
    lines = ran.stdout.splitlines()
    assert "G0 Manifest: UNKNOWN" in lines
    assert "G2 Mock: complete, but not to be signed yet: G0 is UNKNOWN" in lines
    assert "G3 Network: FAILED" in lines
    assert "  signed by: network" in lines
    assert "  FAILED     nodes of later gates: /task runs, and G7 starts it (expected: none runs)" in lines
    assert "  missing    observe-G4-*.json" in lines
    assert lines[-1].startswith(
        "14 gates: 0 complete, 5 waiting for earlier gates, 1 FAILED, 8 UNKNOWN. cellc signs nothing"
    )
    observe(folder, "ur5e_pick", "G0")
    passed = _cellc("evidence", "evidence/attempt-001", "--gate", "G2", "-o", "out", folder=tmp_path)
    assert passed.returncode == 0
    assert passed.stdout.splitlines()[2] == "G2 Mock: complete, to be signed by the owner controls"
    assert sorted(each.name for each in (tmp_path / "out").iterdir()) == [
        "ur5e_pick.evidence.html",
        "ur5e_pick.evidence.json",
    ]


def test_files_are_those_that_are_printed_and_those_of_others_stay(whole: Path, tmp_path: Path) -> None:
    for _ in range(2):
        assert run("evidence", whole.as_posix(), *PACKAGE, "-o", tmp_path.as_posix()).code == 0
    for form in ("json", "html"):
        written = (tmp_path / f"ur5e_pick.evidence.{form}").read_text(encoding="utf-8")
        assert written == run("evidence", whole.as_posix(), *PACKAGE, "--format", form).out
    (tmp_path / "ur5e_pick.evidence.html").write_text("my notes", encoding="utf-8")
    ran = run("evidence", whole.as_posix(), *PACKAGE, "-o", tmp_path.as_posix())
    assert (ran.code, "is no file of this command" in ran.err) == (2, True)
    assert (tmp_path / "ur5e_pick.evidence.html").read_text(encoding="utf-8") == "my notes"


def test_its_own_files_in_the_folder_of_evidence_change_nothing(whole: Path, tmp_path: Path) -> None:
    folder = Path(shutil.copytree(whole, tmp_path / "attempt-001")).as_posix()
    before = run("evidence", folder, *PACKAGE, "--format", "json", "-o", folder).out
    assert run("evidence", folder, *PACKAGE, "--format", "json").out == before


class _Page(HTMLParser):
    """Notes what a page would load or run, and its text."""

    def __init__(self) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.links: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.links += [value or "" for name, value in attrs if name in ("src", "href", "onclick", "onload")]

    def handle_data(self, data: str) -> None:
        self.text += f"{data}\n"


def test_the_page_is_alone_and_has_a_line_to_sign_for_every_gate(whole: Path) -> None:
    text = run("evidence", whole.as_posix(), *PACKAGE, "--format", "html").out
    assert unheard(text) == []
    page = _Page()
    page.feed(text)
    assert not page.tags & {"script", "link", "img", "iframe", "object"}
    assert {link[:1] for link in page.links} == {"#"}
    assert "@media print" in text
    assert "url(" not in text
    assert "default-src 'none'" in text
    owners = re.findall(r"Name, for (\w+)", page.text)
    stated = [
        gate["signed_by"]
        for gate in json.loads(run("evidence", whole.as_posix(), *PACKAGE, "--format", "json").out)["gates"]
    ]
    assert owners == stated
    assert page.text.count("Signature") == 14


def test_each_sheet_says_of_which_configuration_it_is_and_how_many_there_are(whole: Path) -> None:
    text = run("evidence", whole.as_posix(), *PACKAGE, "--format", "html").out
    manifest = json.loads((package("ur5e_pick") / "manifest.json").read_text(encoding="utf-8"))
    foot = text[text.index("@bottom-left") :]
    assert foot.startswith(f'@bottom-left {{ content: "ur5e_pick, {manifest["configuration_id"]}" }}')
    assert 'counter(page) " of " counter(pages)' in foot


def test_the_same_folder_gives_the_same_bytes(whole: Path) -> None:
    for form in ("text", "json", "html"):
        words = ("evidence", whole.as_posix(), *PACKAGE, "--format", form)
        assert run(*words).out == run(*words).out


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (("nothing", *PACKAGE), "nothing: no such folder"),
        (("{empty}",), "does not name its cell; name the generated folder with --package"),
        (("{empty}", "--package", "nothing"), "nothing: no such folder; name one that `cellc build` wrote"),
        (("{empty}", *PACKAGE, "--gate", "G9"), "'G9' is not one of"),
        (("{empty}", *PACKAGE, "--format", "pdf"), "'pdf' is not one of"),
        ((), "Missing argument 'DIR...'"),
    ],
)
def test_a_wrong_call_is_2(words: tuple[str, ...], said: str, tmp_path: Path) -> None:
    ran = run("evidence", *(word.replace("{empty}", tmp_path.as_posix()) for word in words))
    assert (ran.code, said in ran.err) == (2, True), ran.err


def test_a_package_that_was_edited_judges_nothing(whole: Path, tmp_path: Path) -> None:
    edited = Path(shutil.copytree(package("ur5e_pick"), tmp_path / "ur5e_pick"))
    (edited / "gates/promotion.md").write_text("", encoding="utf-8")
    ran = run("evidence", whole.as_posix(), "--package", edited.as_posix())
    assert (ran.code, "gates/promotion.md" in ran.err) == (2, True)


def test_a_package_of_an_older_cellc_states_no_evidence(
    whole: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    edited = Path(shutil.copytree(package("ur5e_pick"), tmp_path / "ur5e_pick"))
    contract = json.loads((edited / "contract.json").read_text(encoding="utf-8"))
    del contract["gates"]["evidence"]
    (edited / "contract.json").write_text(json.dumps(contract), encoding="utf-8")
    monkeypatch.setattr("cellc.mock.folder.differences", lambda *_: ((), (), contract["configuration_id"]))
    ran = run("evidence", whole.as_posix(), "--package", edited.as_posix())
    assert (ran.code, "an older cellc built it, which states no evidence; build it again" in ran.err) == (2, True)


def test_folders_of_two_cells_are_to_be_told_apart(tmp_path: Path) -> None:
    observe(tmp_path, "ur5e_pick", "G3")
    (tmp_path / "x.json").write_text('{"cell": "minimal"}', encoding="utf-8")
    ran = run("evidence", tmp_path.as_posix())
    assert (ran.code, "names several cells, minimal, ur5e_pick; name the generated folder" in ran.err) == (2, True)


def test_help_has_examples_and_the_page_of_the_command_its_options() -> None:
    ran = run("evidence", "--help")
    assert "cellc evidence evidence/attempt-001 --format html > handover.html" in ran.out
    page = (ROOT / "docs/evidence.md").read_text(encoding="utf-8")
    for option in ("--package", "--gate", "--format", "-o "):
        assert option in page


def test_gates_are_completed() -> None:
    asked = {"COMP_WORDS": "cellc evidence --gate G", "COMP_CWORD": "3", "_CELLC_COMPLETE": "bash_complete"}
    ran = subprocess.run([sys.executable, "-m", "cellc"], env=asked, capture_output=True, text=True, check=False)
    assert [line.partition(",")[2] for line in ran.stdout.splitlines()] == [f"G{number}" for number in range(8)]
