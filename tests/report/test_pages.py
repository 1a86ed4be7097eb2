"""Every code has one page, and the commands, the index and the folder of the pages say the same."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.compiler.pages import all_codes, family_of, render_handbook, render_page
from cellc.compiler.rules.kit import FAMILIES
from cellc.compiler.rules.run import ALL_RULES
from cellc.contract import code_page
from cellc.contract.code_page import RENAMED, MissingPageError, page_of
from cellc.contract.codes import STAGES
from cellc.contract.limits import DEFAULTS, MIB
from tests.cells import COMPLETE, spec_text, written
from tests.cli.run import run

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "rules"
PAGES = {file.stem: file.read_text(encoding="utf-8") for file in FOLDER.glob("[a-z]*.md")}
LINK_CODE = re.compile(r"^\| \[([\w-]+)\]\(([\w-]+)\.md\) \| (\w+) \|", re.M)
OF_A_STAGE = re.compile(
    r"# .+\n\n(?P<title>[^a-z\n](?:.|\n(?!\n))+\.)\n\n(?P<why>(?:(?!\nFix: |```)[\s\S]){10,}?)\n"
    r"(?:\nExample that is reported:\n\n```(?:yaml|xml|console)\n[\s\S]+?\n```\n)?"
    r"\nFix: (?P<fix>(?:.|\n(?!\n)){10,})\.\n"
)
FIGURES = {
    "file-too-large": (f"{DEFAULTS.spec_bytes // MIB} MiB",),
    "too-deep": (f"{DEFAULTS.spec_depth} deep",),
    "too-many-includes": (f"{DEFAULTS.spec_files} files",),
    "too-many-values": (f"{DEFAULTS.spec_values} values",),
    "xml-too-deep": (f"{DEFAULTS.xml_depth} levels",),
    "xml-too-large": (f"{DEFAULTS.xml_bytes // MIB} MiB",),
    "xacro-too-large": (
        f"{DEFAULTS.xacro_includes} nested includes, {DEFAULTS.xacro_macros} nested macros",
        f"{DEFAULTS.xacro_elements} elements, {DEFAULTS.xml_bytes // MIB} MiB and {DEFAULTS.xacro_seconds} s",
    ),
}


def headings(text: str) -> set[str]:
    """Return the anchors that GitHub and mkdocs give to the headings of a page."""
    return {
        re.sub(r"[^\w -]", "", line).strip().lower().replace(" ", "-") for line in re.findall(r"^#+ (.+)$", text, re.M)
    }


def test_every_code_has_a_page_and_every_page_a_code() -> None:
    assert sorted(PAGES) == list(all_codes())


def test_a_code_belongs_to_one_stage_or_rule() -> None:
    codes = [code for codes in STAGES.values() for code in codes] + [rule.code for rule in ALL_RULES]
    assert sorted(codes) == list(all_codes())
    assert all(re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", code) for code in codes)


def test_heading_of_a_page_is_the_code_and_the_severity_of_its_findings() -> None:
    for code, severity in all_codes().items():
        assert PAGES[code].startswith(f"# {code} ({severity.value})\n\n")
        assert page_of(code).title == " ".join(PAGES[code].split("\n\n")[1].split())[:-1]


@pytest.mark.parametrize("code", [code for codes in STAGES.values() for code in codes])
def test_page_of_a_stage_has_title_reason_and_fix(code: str) -> None:
    page = OF_A_STAGE.fullmatch(PAGES[code])
    assert page is not None
    assert page_of(code).fix == " ".join(page["fix"].split())
    assert len({page["title"], page["why"], page["fix"]}) == 3


@pytest.mark.parametrize("code", FIGURES)
def test_page_of_a_limit_tells_the_limit(code: str) -> None:
    assert all(figure in " ".join(PAGES[code].split()) for figure in FIGURES[code])


def test_no_paragraph_of_a_page_is_wider_than_code_or_turns_into_a_list() -> None:
    for code, text in PAGES.items():
        paragraphs = re.sub(r"^Source:[\s\S]*|```[\s\S]*?```", "", text, flags=re.M)
        assert max(map(len, paragraphs.splitlines())) <= 120, code
        assert not re.search(r"[^\n]\n(?:[-+*>#]|\d+[.)]) ", paragraphs), code


def test_index_names_every_code_with_its_page_and_severity() -> None:
    index = render_handbook()["README.md"]
    assert (FOLDER / "README.md").read_text(encoding="utf-8") == index, "run `cellc explain --all -o docs/rules`"
    rows = LINK_CODE.findall(index)
    assert sorted((code, severity) for code, _, severity in rows) == [(c, s.value) for c, s in all_codes().items()]
    assert all(code == file for code, file, _ in rows)


def test_index_groups_rules_by_family() -> None:
    groups = re.split(r"^## ", render_handbook()["README.md"], flags=re.M)[1:]
    assert [group.partition(":")[0] for group in groups[:-1]] == list(FAMILIES.values())
    for group, folder in zip(groups, [*FAMILIES, ""], strict=True):
        codes = [code for code, *_ in LINK_CODE.findall(group)]
        assert codes == sorted(codes)
        assert {family_of(code) for code in codes} == ({folder} if folder else set(STAGES))


def test_links_to_our_own_pages_lead_to_a_heading() -> None:
    for text in PAGES.values():
        for file, anchor in re.findall(r"\]\(\.\./(\w+\.md)#([\w-]+)\)", text):
            assert anchor in headings((FOLDER.parent / file).read_text(encoding="utf-8")), anchor


def test_titles_use_the_article_that_is_spoken() -> None:
    assert [code for code in all_codes() if re.search(r"\b[Aa] [aeio]", page_of(code).title)] == []


def test_page_is_printed_without_marks_and_links() -> None:
    shown = {code: render_page(page_of(code)) for code in all_codes()}
    assert [code for code, text in shown.items() if re.search(r"(?:#|<!--) expect(?: at| -->|$)", text, re.M)] == []
    assert [code for code, text in shown.items() if "](../" in text] == []
    assert "\nSource: docs/principles.md#calibration\n" in shown["unused-calibration"]
    assert "\n  object: {buffer: 600 ms}\n" in shown["budget-beyond-buffer"]


def test_command_writes_the_pages_and_their_index(tmp_path: Path) -> None:
    folder = tmp_path / "docs" / "rules"
    assert run("explain", "--all", "-o", folder.as_posix()).code == 0
    files = {file.name: file.read_text(encoding="utf-8") for file in folder.iterdir()}
    assert files == {file.name: file.read_text(encoding="utf-8") for file in FOLDER.iterdir()}
    assert run("explain", "--all", "-o", folder.as_posix()).code == 0
    assert run("explain", "reversed-limits", "-o", folder.as_posix()).code == 2


def test_check_without_a_finding_reads_no_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(code_page, "_FOLDERS", (tmp_path / "absent",))
    page_of.cache_clear()
    assert run("check", COMPLETE.as_posix()).code == 0


def test_page_that_an_installation_lacks_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(code_page, "_FOLDERS", (tmp_path / "absent",))
    page_of.cache_clear()
    with pytest.raises(MissingPageError, match="the page of `zero-axis` is missing from this installation"):
        page_of("zero-axis")


def test_renamed_codes_are_gone_and_their_new_names_there() -> None:
    assert not RENAMED.keys() & all_codes().keys()
    assert set(RENAMED.values()) <= all_codes().keys()


@pytest.mark.parametrize(("before", "after"), RENAMED.items())
def test_renamed_code_is_answered_with_its_new_name(before: str, after: str, tmp_path: Path) -> None:
    spec = written(tmp_path, spec_text("minimal") + f"# cellc: ignore {before} as agreed\n")
    asked = (run("explain", before), run("check", spec.as_posix(), "--select", before), run("check", spec.as_posix()))
    for ran, code in zip(asked, (2, 2, 1), strict=True):
        assert f"it was renamed to `{after}`" in ran.out + ran.err
        assert ran.code == code
