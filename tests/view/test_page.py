"""The page of a cell: it needs nothing from outside, runs nothing of a stranger's, and says what the spec says."""

from __future__ import annotations

import base64
import hashlib
import re
import shutil
import subprocess
from dataclasses import replace
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import tostring

import pytest

from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import Findings
from cellc.mock.report_page.html import breakable
from cellc.tools.view.content import Content, before_of, content_of
from cellc.tools.view.page import three_js, to_html
from cellc.tools.view.subject import read_subject
from tests.cells import ROOT, spec_text
from tests.cells import written as written_spec
from tests.cli.run import PICK, Ran, run
from tests.report.findings import finding
from tests.view.page import Page, unheard

HOSTILE = "</script><script>alert(1)</script><!--<script>\u2028<img src=x onerror=alert(1)>\"'&lt;"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return the page of a spec, as the command writes it."""
    place = tmp_path_factory.mktemp("view") / "cell.html"
    ran = run("view", PICK, "-o", place.as_posix())
    assert (ran.code, ran.err) == (0, "")
    assert ran.out.startswith(f"wrote {place.as_posix()}, ")
    return place


@pytest.fixture(scope="module")
def page(written: Path) -> Page:
    """Return the same, parsed."""
    return Page(written.read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def of_folder() -> Content:
    """Return what is shown of the generated folder of the same cell."""
    return content_of(read_subject(ROOT / "generated/ur5e_pick"), (), 0)


def test_the_page_loads_nothing_and_names_nothing_to_load(written: Path, page: Page) -> None:
    loading = ("src", "href", "srcset", "action", "data", "poster", "background")
    named = {found[key] for _, found in page.elements for key in loading if key in found}
    assert {name for name in named if not name.startswith(("#", "data:image/svg+xml;base64,"))} == set()
    assert not any(re.search(r"url\(|@import", style) for style in page.styles)
    assert written.stat().st_size < 2_000_000


def test_a_screen_reader_has_a_word_for_everything(written: Path) -> None:
    assert unheard(written.read_text(encoding="utf-8")) == []


def test_a_drawing_that_scrolls_is_reached_by_the_keyboard(page: Page) -> None:
    scrolling = [found for tag, found in page.elements if tag == "div" and "tabindex" in found]
    assert {found["aria-label"] for found in scrolling} >= {"From two sides", "Who talks to whom"}


def test_the_browser_is_told_to_run_the_scripts_of_the_page_alone(page: Page) -> None:
    def digest(text: str) -> str:
        return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"

    kinds = [found.get("type") for tag, found in page.elements if tag == "script"]
    assert kinds == ["application/json", None, None]
    assert page.policy["default-src"] == ["'none'"]
    assert page.policy["script-src"] == [digest(text) for text in page.scripts[1:]]
    assert page.policy["style-src"] == [digest(text) for text in page.styles]
    # Under that policy neither an attribute of an element may run something, nor style it.
    assert not [name for _, found in page.elements for name in found if name.startswith("on") or name == "style"]


def test_paper_is_light_where_the_screen_is_dark(page: Page) -> None:
    dark = re.findall(r"@media ([^{]*prefers-color-scheme[^{]*)", "".join(page.styles))
    assert dark
    assert all(rule.startswith("screen and ") for rule in dark)


def test_a_narrow_screen_is_told_from_paper(page: Page) -> None:
    narrow = re.findall(r"@media ([^{]*-width[^{]*)", "".join(page.styles))
    assert len(narrow) >= 3
    assert all(rule.startswith("screen and ") for rule in narrow)


def test_long_names_break_between_their_words() -> None:
    name = "/arm_software/get_robot_software_version"
    html = tostring(breakable(name), encoding="unicode", method="html")
    assert html == "<span>/<wbr>arm_<wbr>software/<wbr>get_<wbr>robot_<wbr>software_<wbr>version</span>"
    assert "".join(breakable(name).itertext()) == name


def test_three_js_stands_in_the_page_with_its_license(page: Page) -> None:
    assert page.scripts[1] == three_js()
    assert "Three.js Authors" in page.scripts[1][:200]
    assert "SPDX-License-Identifier: MIT" in page.scripts[1][:200]


def test_a_spec_and_its_generated_folder_are_drawn_alike(page: Page, of_folder: Content) -> None:
    html = to_html(of_folder, three_js())
    assert Page(html).data == page.data
    assert to_html(of_folder, three_js()) == html


def test_names_of_strangers_are_data(of_folder: Content) -> None:
    scene, (first, *_) = of_folder.scene, of_folder.runs
    assert scene is not None
    assert of_folder.subject.folder is not None
    contract = of_folder.subject.folder.contract
    folder = replace(of_folder.subject.folder, contract=contract.model_copy(update={"summary": HOSTILE}))
    hostile = replace(
        of_folder,
        subject=replace(of_folder.subject, name=HOSTILE, folder=folder, pictures={"graph/responsibility.svg": HOSTILE}),
        scene=replace(scene, frames=tuple(replace(frame, name=HOSTILE) for frame in scene.frames)),
        runs=(replace(first, name=HOSTILE, reason=HOSTILE),),
    )
    restore_topic, found = Page(to_html(of_folder, three_js())), Page(to_html(hostile, three_js()))
    assert len(found.scripts) == len(restore_topic.scripts)
    assert found.scripts[1:] == restore_topic.scripts[1:]
    assert not [tag for tag, attributes in found.elements if tag == "img" and "onerror" in attributes]
    assert found.data["scene"]["frames"][0]["name"] == HOSTILE
    assert found.data["runs"][0]["name"] == HOSTILE
    assert "<img src=x onerror=alert(1)>" in found.text


def test_the_page_says_what_the_spec_says(page: Page) -> None:
    # Literally from cells/ur5e_pick/cell.yaml: summary, an interface with its bounds, the owner of a gate, a blocker.
    assert "picks parts from fixture A under a wrist camera" in page.text
    assert re.search(r"/camera/color/image_raw .* best effort, volatile, last 1 .* at most 0.1 s old", page.text)
    assert "30 Hz" in page.text
    assert re.search(r"G3 Network .* network", page.text)
    assert re.search(r"\d+ \| +firmware: UNKNOWN", page.text)


def test_the_page_of_a_change_draws_where_things_stood_and_lists_what_moved(tmp_path: Path, of_folder: Content) -> None:
    before = tmp_path / "before"
    shutil.copytree(ROOT / "generated/ur5e_pick", before)
    for target in ("mock", "real"):
        urdf = before / f"urdf/ur5e_pick.{target}.urdf"
        text = urdf.read_text(encoding="utf-8")
        assert text.count('<origin xyz="0 0 0.8"/>') == 1
        urdf.write_text(text.replace('<origin xyz="0 0 0.8"/>', '<origin xyz="0 0.25 0.8"/>'), encoding="utf-8")
    compared = replace(of_folder, before=before_of(before.as_posix(), (ROOT / "generated/ur5e_pick").as_posix()))
    found = Page(to_html(compared, three_js()))
    home = {when: _home(found.data[when]) for when in ("before", "scene")}
    shoulder = found.data["scene"]["groups"].index("arm_shoulder_link")
    assert home["before"][7 * shoulder + 1] - home["scene"][7 * shoulder + 1] == pytest.approx(0.25)
    assert re.search(r"What changed .* arm_base_link pose in its parent .* 0 250 800 mm", found.text)
    assert "before" in [attributes.get("data-layer") for _, attributes in found.elements]
    assert "before" not in [
        attributes.get("data-layer") for _, attributes in Page(to_html(of_folder, three_js())).elements
    ]


def test_a_change_of_nothing_is_told_in_a_word(of_folder: Content) -> None:
    same = (ROOT / "generated/ur5e_pick").as_posix()
    found = Page(to_html(replace(of_folder, before=before_of(same, same)), three_js()))
    assert "Gates to repeat: none Nothing. Rehearsals on the mock" in found.text


def _home(scene: dict[str, Any]) -> list[float]:
    (numbers,) = (pose["groups"] for pose in scene["poses"] if pose["name"] == "home")
    assert isinstance(numbers, list)
    return numbers


def test_a_spec_that_is_no_yaml_is_shown_with_its_findings_alone(tmp_path: Path) -> None:
    ran, found = _viewed(tmp_path, "format: 1\ncell: bench\nframes: { <b>tip: {}\n", "--against", PICK)
    assert ran.code == 1
    assert f"not compared with {PICK}: there is no package of {tmp_path.as_posix()}/cell.yaml" in ran.out
    assert found.scripts == []
    assert "3 | frames: { <b>tip" in found.text
    assert "nothing is drawn: an error keeps the cell from being linked" in found.text
    assert re.search(r"Not drawn what why the whole cell .*\(.*cell.yaml:\d+:\d+\)", found.text)
    assert [tag for tag, _ in found.elements].count("b") == 2  # that of the note and that of what is not drawn


def test_the_errors_of_a_spec_are_counted_and_the_first_has_its_place(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    text = spec_text("minimal")
    line = text[: text.index("  update_rate")].count("\n") + 1
    (tmp_path / "cell.yaml").write_text(text.replace("  update_rate", "  upate_rate"), encoding="utf-8")
    ran = run("view", "cell.yaml")
    wrote, *told = ran.out.splitlines()
    assert (ran.code, wrote.partition(",")[0]) == (1, "wrote minimal.html")
    assert told == [
        f"1 error at cell.yaml:{line}:3: `control` has no key `upate_rate`",
        "`cellc check cell.yaml` shows it",
    ]
    (tmp_path / "cell.yaml").write_text("format: 1\ncell: 'bench' # of two\nframes: { a\nhosts: }\n", encoding="utf-8")
    ran = run("view", "cell.yaml")
    assert (ran.code, ran.out.partition(",")[0]) == (1, "wrote bench.html")
    assert re.search(
        r"\n(\d errors, the first|1 error) at cell\.yaml:[34]:\d+: .+\n`cellc check cell\.yaml` shows", ran.out
    )


def test_the_name_of_a_page_leads_nowhere_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "here").mkdir()
    monkeypatch.chdir(tmp_path / "here")
    robot = '<robot name="../../x"><link name="base"/></robot>'
    for name, text in (("cell.yaml", "format: 1\ncell: ../../x\n"), ("arm.urdf", robot)):
        (tmp_path / "here" / name).write_text(text, encoding="utf-8")
        run("view", name)
    assert sorted(path.name for path in (tmp_path / "here").iterdir()) == [
        "arm.html",
        "arm.urdf",
        "cell.yaml",
        "here.html",
    ]


def test_a_spec_with_mistakes_of_every_kind_is_drawn_as_far_as_it_can_be_linked(tmp_path: Path) -> None:
    mistakes = {
        "ros: jazzy": "ros: jazy",
        "model: robotiq_2f_85": "model: robotiq_2f_58",
        "xyz: 0 0 0.8 m}": "xyz: 0 0 0.8 m, calibraton: x}",
        "parent: world, xyz: 450 100 850 mm": "parnt: world, xyz: 450 100 850 mm",
        "goal_time: 1 s": "goaltime: 1 s",
        "update_rate: 500 Hz": "update_rate: fast",
        "domain_id: 42": "domain_id: 4242",
        "box: 900 1200 40 mm": "box: 900 1200 mm",
        "cancel_within: 200 ms": "cancel_within: 200",
        "acknowledge: operator": "acknowledged: operator",
    }
    text = spec_text("ur5e_pick")
    for right, wrong in mistakes.items():
        assert right in text
        text = text.replace(right, wrong, 1)
    ran, found = _viewed(tmp_path, text)
    assert (ran.code, ran.err) == (1, "")
    scene = found.data["scene"]
    assert {shape["owner"] for shape in scene["shapes"]} == {"arm", "camera", ""}
    assert [shape["link"] for shape in scene["shapes"] if not shape["owner"]] == ["floor"]
    # By hand: the arm is mounted 0.8 m above the world, and the camera stands where it is drawn, on the flange.
    base = next(frame for frame in scene["frames"] if frame["name"] == "arm_base_link")
    assert base["pose"][:3] == [0, 0, 0.8]
    told = found.text[found.text.index("Not drawn what why") :]
    assert re.search(r"devices\.gripper the catalog has no model `robotiq_2f_58` \(\S+:\d+:12\)", told)
    assert re.search(
        r"frames\.tcp it needs what is not drawn frames\.fixture_A `frames\.fixture_A` has no key `parnt`", told
    )
    assert re.search(r"scene\.table `scene\.table\.box` must have 3 numbers, got 2", told)
    assert "devices.arm " not in told[: told.index("Findings")]
    assert len(re.findall(r"unknown-key|missing-unit|wrong-count|not-a-quantity", found.text)) > 5


def test_what_hangs_in_a_circle_is_told_and_the_rest_is_drawn(tmp_path: Path) -> None:
    circle = "fixture_A: {parent: jig, xyz: 0 0 1 mm}\n  jig: {parent: fixture_A}\n  "
    text = re.sub(r"fixture_A: \{parent: world.*\n  ", circle, spec_text("ur5e_pick"))
    ran, found = _viewed(tmp_path, text)
    assert ran.code == 1
    assert {shape["owner"] for shape in found.data["scene"]["shapes"]} == {"arm", "camera", "gripper", ""}
    assert re.search(r"frames\.fixture_A [^.]*`fixture_A`.* frames\.jig .* frames\.object", found.text)


def test_a_robot_alone_is_drawn(tmp_path: Path) -> None:
    file = ROOT / "tests/corpus/valid/parts/demo_arm/demo_arm.urdf"
    ran = run("view", file.as_posix(), "-o", (tmp_path / "x.html").as_posix())
    found = Page((tmp_path / "x.html").read_text(encoding="utf-8"))
    assert (ran.code, ran.err) == (0, "")
    assert {shape["owner"] for shape in found.data["scene"]["shapes"]} == {"robot"}
    assert "a robot alone: a cell that mounts it" in found.text


def _viewed(folder: Path, text: str, *more: str) -> tuple[Ran, Page]:
    ran = run("view", written_spec(folder, text).as_posix(), "-o", (folder / "x.html").as_posix(), *more)
    return ran, Page((folder / "x.html").read_text(encoding="utf-8"))


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (("generated/ur5e_pick", "--rehearsal", "nope"), "has no rehearsal `nope`"),
        (("tests/view",), "holds no contract.json"),
        (("generated/ur5e_pick", "-o", "no/such/folder/x.html"), "cannot be written"),
    ],
)
def test_what_cannot_be_shown_is_told_in_one_line(
    arguments: tuple[str, ...], told: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(ROOT)
    ran = run("view", *arguments)
    assert ran.code == 2
    assert ran.err.startswith("error: ")
    assert ran.err.count("\n") == 1
    assert told in ran.err


@pytest.mark.skipif(shutil.which("chromium") is None, reason="no chromium on this machine")
def test_a_browser_draws_the_page_without_a_word_on_its_console(written: Path) -> None:
    graphics = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
    seen = ("--enable-logging=stderr", "--virtual-time-budget=2000", "--dump-dom")
    done = subprocess.run(
        ["chromium", "--headless", "--no-sandbox", *graphics, *seen, written.as_uri()],
        capture_output=True,
        text=True,
        check=True,
        timeout=120,
    )
    assert [line for line in done.stderr.splitlines() if "CONSOLE" in line] == []
    drawn = Page(done.stdout)
    assert drawn.elements[0][1].keys() >= {"data-drawn"}
    assert "pick_and_place" in drawn.text
    assert "fixture_A" in drawn.text
    assert "arm gripper camera all drawn as visual shapes" in drawn.text


def test_the_page_leads_to_each_of_its_sections(page: Page, of_folder: Content) -> None:
    for shown in (page, Page(to_html(of_folder, three_js()))):
        links = [attributes["href"] for tag, attributes in shown.elements if tag == "a"]
        sections = [f"#{attributes['id']}" for tag, attributes in shown.elements if tag == "section"]
        assert set(links) <= set(sections)
        assert {"#rehearsals", "#interfaces", "#graph", "#gates"} <= set(links)
        assert ("#findings" in links) is (shown is page)


@pytest.mark.parametrize(
    ("severities", "told"),
    [
        ((), "no findings"),
        ((Severity.AUDIT, Severity.AUDIT), "2 audit items"),
        ((Severity.ERROR,), "1 error"),
        ((Severity.WARNING, Severity.ERROR, Severity.ERROR), "2 errors, 1 warning"),
        ((Severity.WARNING, Severity.BLOCKER), "1 blocker, 1 warning"),
    ],
)
def test_page_counts_what_the_check_found(of_folder: Content, severities: tuple[Severity, ...], told: str) -> None:
    found = Findings("cell.yaml", {}, tuple(finding(severity=severity) for severity in severities))
    html = to_html(replace(of_folder, subject=replace(of_folder.subject, findings=found)), three_js())
    assert f"<dt>findings</dt><dd>{told}</dd>" in html


def test_page_of_a_folder_says_nothing_of_findings(of_folder: Content) -> None:
    assert "<dt>findings</dt>" not in to_html(of_folder, three_js())


def test_a_tall_picture_is_in_sheets_that_paper_need_not_cut(page: Page) -> None:
    """Each is at most as high as an upright page, and together they are the whole picture, each row in one of them."""
    pictures = [found["src"] for tag, found in page.elements if tag == "img" and found["alt"].startswith("Every arrow")]
    texts = [base64.b64decode(source.partition("base64,")[2]).decode() for source in pictures]
    boxes = [[float(number) for number in text.partition('viewBox="')[2].partition('"')[0].split()] for text in texts]
    assert len(boxes) > 1
    assert all(left == 0 and width == 1000 and height <= 1300 for left, _, width, height in boxes)
    whole = (ROOT / "generated/ur5e_pick/graph/responsibility.svg").read_text(encoding="utf-8")
    ends = [top + height for _, top, _, height in boxes]
    assert [top for _, top, _, _ in boxes] == [0, *ends[:-1]]
    assert f'viewBox="0 0 1000 {ends[-1]:g}"' in whole
    rows = re.findall(r'<rect x="\d+" y="([\d.]+)" width="190" height="([\d.]+)"', whole)
    assert rows
    cut = [row for row in rows for end in ends if float(row[0]) < end < float(row[0]) + float(row[1])]
    assert cut == []
