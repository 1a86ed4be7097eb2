"""The page that leads through the gates: each in order, with commands that fit the cell, its evidence and stop."""

from __future__ import annotations

import re
import subprocess

from tests.consumers.matrix import build, every_build
from tests.emit.cells import contract_data
from tests.foreign_yaml import safe_load

_ORDER = ["G0", "G1", "G2", "G3", *(f"L{number}" for number in range(1, 7)), "G4", "G5", "G6", "G7"]
_BLOCK = re.compile(r"^```sh\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def sections(cell: str, distro: str) -> dict[str, str]:
    """Return the text of every gate of the walk by its code, in order."""
    walk = build(cell, distro).texts["README.md"].split("\n## The walk\n")[1].split("\n## ")[0]
    parts = re.split(r"^#{3,4} ([GL]\d) .*$", walk, flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


def commands(text: str) -> list[str]:
    """Return the commands of the blocks for a shell, each on one line, without what only writes the evidence."""
    lines = "\n".join(_BLOCK.findall(text)).replace("\\\n", " ").splitlines()
    return [" ".join(line.split()) for line in lines if line.strip() and not re.match(r"\s*(#|\{|\})", line)]


def table_rows(cell: str, distro: str) -> list[list[str]]:
    """Return the rows of the tables at the top of the page."""
    top = build(cell, distro).texts["README.md"].split("\n## Every shell, once\n")[0]
    lines = [line for line in top.splitlines() if line.startswith("| [")]
    return [[part.strip() for part in line.split("|")[1:-1]] for line in lines]


@every_build
def test_walk_has_every_gate_once_and_in_order(cell: str, distro: str) -> None:
    assert list(sections(cell, distro)) == _ORDER
    assert [row[0].split("]")[0].strip("[") for row in table_rows(cell, distro)] == [
        *(code for code in _ORDER if code.startswith("G")),
        *(code for code in _ORDER if code.startswith("L")),
    ]


@every_build
def test_table_says_what_the_sections_say_and_leads_to_them(cell: str, distro: str) -> None:
    text = build(cell, distro).texts["README.md"]
    anchors = [
        re.sub(r"[^a-z0-9 -]", "", title.lower()).replace(" ", "-") for title in re.findall(r"^#+ (.*)$", text, re.M)
    ]
    for code, shows, command, evidence, owner, stop in table_rows(cell, distro):
        section = sections(cell, distro)[code.split("]")[0].strip("[")]
        (anchor,) = re.findall(r"\(#([\w-]+)\)", code)
        assert anchors.count(anchor) == 1
        assert f"Passed when {shows}." in section
        assert f"Evidence `{evidence}`, signed by {owner}. **Stop on:** {stop}." in section
        assert command == "by people" or command.strip("`") in section


@every_build
def test_every_gate_leaves_evidence_of_its_own(cell: str, distro: str) -> None:
    files = [
        re.findall(r"^Evidence `(.+?)`, signed by .+\. \*\*Stop on:\*\* \S", text, re.M)
        for text in sections(cell, distro).values()
    ]
    assert all(len(one) == 1 for one in files)
    assert len({one[0] for one in files}) == len(_ORDER)
    for (file,), (code, text) in zip(files, sections(cell, distro).items(), strict=True):
        assert file.startswith(f"{code}-")
        assert set(re.findall(r'tee -a "\$E/(.+?)"', text)) <= {file}
    for code, text in sections(cell, distro).items():
        page = build(cell, distro).texts["gates/promotion.md" if code.startswith("G") else "gates/network.md"]
        assert f"evidence/<attempt_id>/{re.findall(r'^Evidence `(.+?)`', text, re.M)[0]}`" in page


@every_build
def test_checklists_hold_the_commands_of_the_walk(cell: str, distro: str) -> None:
    for page, letter in (("promotion", "G"), ("network", "L")):
        ticked = commands(re.sub(r"^  ", "", build(cell, distro).texts[f"gates/{page}.md"], flags=re.MULTILINE))
        walked = [
            one for code, text in sections(cell, distro).items() if code.startswith(letter) for one in commands(text)
        ]
        assert ticked == walked


@every_build
def test_checklists_tick_what_the_walk_says(cell: str, distro: str) -> None:
    for page, letter in (("promotion", "G"), ("network", "L")):
        ticked = re.findall(r"^- \[ \] (.+)$", build(cell, distro).texts[f"gates/{page}.md"], re.MULTILINE)
        walked = [text for code, text in sections(cell, distro).items() if code.startswith(letter)]
        said = [line[2:] for text in walked for line in text.splitlines() if line.startswith(("- ", "# "))]
        assert ticked == said


@every_build
def test_blocks_are_what_a_shell_takes(cell: str, distro: str) -> None:
    for block in _BLOCK.findall(build(cell, distro).texts["README.md"]):
        subprocess.run(["bash", "-n"], input=block, text=True, check=True, capture_output=True)


@every_build
def test_commands_name_what_the_cell_has(cell: str, distro: str) -> None:
    artifacts = build(cell, distro).texts
    contract = contract_data(artifacts["contract.json"])
    kinds = {name: one["kind"] for name, one in contract["interfaces"].items()}
    managers = {f"{one['namespace']}/controller_manager" for one in contract["managers"].values()}
    frames = set(safe_load(artifacts["config/frames.yaml"])["frames"])
    seen = 0
    for command in (one for text in sections(cell, distro).values() for one in commands(text)):
        words = command.split()
        if (topic := re.search(r"ros2 topic \w+ (?:-v |--once )?(\S+)", command)) is not None:
            assert kinds[topic.group(1)] == "topic", command
        elif (action := re.search(r"ros2 action info (\S+)", command)) is not None:
            assert kinds[action.group(1)] == "action", command
        elif command.startswith("ros2 control "):
            assert words[-1] in managers, command
        elif "tf2_echo" in command:
            assert set(words[-2:]) <= frames, command
        elif command.startswith("ros2 lifecycle "):
            assert f'name="{words[3].rpartition("/")[2]}"' in artifacts["launch/cell.launch.xml"], command
        elif command.startswith("ros2 launch "):
            assert (words[2], f"launch/{words[3]}" in artifacts) == (cell, True), command
            arguments = {word.split(":=")[0] for word in words[4:]}
            assert arguments <= set(re.findall(r'<arg name="(\w+)"', artifacts[f"launch/{words[3]}"])), command
        elif command.startswith("ros2 bag "):
            recorded = set(safe_load(artifacts["config/recording_qos.yaml"]))
            assert {word for word in words if word.startswith("/")} == recorded
        else:
            continue
        seen += 1
    assert seen > 15


@every_build
def test_files_that_commands_read_are_in_the_package(cell: str, distro: str) -> None:
    for command in (one for text in sections(cell, distro).values() for one in commands(text)):
        for path in re.findall(rf"generated/{cell}/(\S+)", command):
            assert path in {*build(cell, distro).texts, "manifest.json"}, command


@every_build
def test_gate_of_enabling_holds_no_command(cell: str, distro: str) -> None:
    # Enabling is a step of the vendor's procedure: no line to paste may stand for it.
    assert commands(sections(cell, distro)["G5"]) == []


@every_build
def test_real_target_is_started_only_after_the_mock_gate_and_motion_last(cell: str, distro: str) -> None:
    real = [code for code, text in sections(cell, distro).items() if "target:=real" in text]
    moving = ["G7"] if "launch/move.launch.xml" in build(cell, distro).texts else []
    assert real == ["G3", "G4", *moving]
    moves = [code for code, text in sections(cell, distro).items() if "move.launch.xml target:=real" in text]
    assert moves == moving


@every_build
def test_file_list_of_the_page_is_the_folder(cell: str, distro: str) -> None:
    page = build(cell, distro).texts["README.md"].split("\n## What is here\n")[1]
    listed = re.findall(r"^- `(.+?)`:", page, re.MULTILINE)
    assert len(listed) > 10
    for path in listed:
        assert any(one.startswith(path) for one in build(cell, distro).texts), path
