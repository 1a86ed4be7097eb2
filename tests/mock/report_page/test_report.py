"""The report: one file, the same bytes, no text of the spec as markup, and drawings that hide no extreme value."""

from __future__ import annotations

import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from cellc.mock import MockCell
from cellc.mock.cell import cell_of
from tests.mock.conftest import Written, received, write_evidence
from tests.view.page import unheard


class Page(HTMLParser):
    """Elements, attributes and words of a page."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[tuple[str, str]] = []
        self.words = ""
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [(name, value or "") for name, value in attrs]

    def handle_data(self, data: str) -> None:
        self.words += data


@pytest.fixture(scope="module")
def text(written: Written) -> str:
    return (written.folder / "report.html").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def page(text: str) -> Page:
    return Page(text)


def test_a_screen_reader_has_a_word_for_everything(text: str) -> None:
    assert unheard(text) == []


def test_report_needs_nothing_from_outside(text: str, page: Page) -> None:
    assert "script" not in page.tags
    assert "link" not in page.tags
    assert "img" not in page.tags
    links = [value for name, value in page.attributes if name in ("href", "src")]
    assert links
    assert all(link.startswith(("#", "./")) for link in links)
    assert "@import" not in text
    assert not re.search(r"url\(|https?://|//[a-z]", text)


def test_what_is_between_backticks_is_set_as_code(page: Page) -> None:
    assert "code" in page.tags
    assert "`" not in page.words


def test_every_link_leads_to_a_file_or_a_place_of_the_page(page: Page, written: Written) -> None:
    places = {f"#{value}" for name, value in page.attributes if name == "id"}
    for name, value in page.attributes:
        if name == "href":
            assert value in places or (written.folder / value).is_file()


def test_every_rehearsal_stands_in_the_report_with_its_outcome(page: Page, written: Written) -> None:
    for name, result in written.results.items():
        assert f"Rehearsal {name} {result.outcome}, passed" in page.words


def test_each_joint_has_its_limits_and_its_largest_error_with_units(page: Page) -> None:
    # The limits of the arm are two turns either way, half of them for the elbow.
    assert "limits −6.283 … 6.283 rad" in page.words
    assert "limits −3.142 … 3.142 rad" in page.words
    assert page.words.count(", 200 mrad allowed") == 6 * 11


def test_largest_error_is_that_of_all_states_in_the_bag(page: Page, written: Written) -> None:
    states = [each.message for each in received(written.bag("canceled"), "/arm_trajectory/controller_state")]
    worst_mrad = max(abs(float(state.error.positions[3])) for state in states) * 1e3
    assert worst_mrad > 0.1
    section = page.words.rpartition("Rehearsal canceled canceled, passed")[2]
    value, prefix = re.findall(r"arm_wrist_1_joint.*?largest error ([\d.]+) ([mµ])rad", section)[0]
    assert float(value) * {"m": 1.0, "µ": 1e-3}[prefix] == pytest.approx(worst_mrad, rel=5e-3)


def test_steps_of_a_packet_are_told_with_the_time_after_the_one_before(page: Page) -> None:
    """The mock plans for 50 ms, and the first update after the acceptance is one cycle of 2 ms later."""
    assert "3planned+50 ms4goal sent+0 ms5accepted+0 ms6written+2 ms" in page.words


def test_configuration_versions_and_seed_stand_in_the_report(page: Page, cell: MockCell) -> None:
    assert cell.contract.configuration_id in page.words
    for version in cell.contract.version_tuple.values():
        assert version in page.words


def test_gates_are_judged_with_their_evidence(page: Page) -> None:
    assert "G2 Mock" in page.words
    assert "Each command interface is claimed by its one owner" in page.words


def test_names_of_the_spec_are_text_and_never_markup(built_folder: Path, tmp_path: Path) -> None:
    import json
    import shutil

    from cellc.mock import load

    folder = Path(shutil.copytree(built_folder, tmp_path / "cell"))
    hostile = "</style><script>alert('1')</script>\"><b onclick=x>"
    file = folder / "rehearsals.json"
    rehearsals = json.loads(file.read_text(encoding="utf-8"))
    rehearsals["rehearsals"] = [rehearsals["rehearsals"][2] | {"name": f"../{hostile}"}]
    file.write_text(json.dumps(rehearsals), encoding="utf-8")
    contract = json.loads((folder / "contract.json").read_text(encoding="utf-8"))
    contract["summary"] = f"a {hostile}"
    contract["version_tuple"][hostile] = hostile
    (folder / "contract.json").write_text(json.dumps(contract), encoding="utf-8")
    out = tmp_path / "evidence"
    write_evidence(load(folder, edited=True), out)
    page = Page((out / "report.html").read_text(encoding="utf-8"))
    assert "script" not in page.tags
    assert not [name for name, _ in page.attributes if name.startswith("on")]
    assert hostile in page.words
    names = sorted(path.name for path in tmp_path.iterdir())
    assert names == ["cell", "evidence"]
    assert len(list(out.glob("*.mcap"))) == 1


def test_page_of_no_rehearsal_is_no_success(cell: MockCell, tmp_path: Path) -> None:
    empty = cell_of(replace(cell.folder, rehearsals=()))
    write_evidence(empty, tmp_path / "out")
    words = " ".join(Page((tmp_path / "out" / "report.html").read_text(encoding="utf-8")).words.split())
    assert "✗ FAILED 0 of 0 rehearsals ended as expected" in words


def test_parts_of_the_tuple_that_are_unknown_come_first_and_are_marked(cell: MockCell, text: str) -> None:
    """The spec of the cell pins all but the serials and two of the gripper's parts."""
    rows = re.findall(r"<dt>([^<]+)</dt><dd class=\"(unknown|plain)\">([^<]*)</dd>", text)
    assert {name: version for name, _, version in rows} == dict(cell.contract.version_tuple)
    assert all((style == "unknown") is (version == "UNKNOWN") for _, style, version in rows)
    styles = [style for _, style, _ in rows]
    assert styles == sorted(styles, reverse=True)
    assert {"unknown", "plain"} == set(styles)
