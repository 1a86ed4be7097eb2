"""The pages that lead through the gates: each in order, with commands that fit the cell, its evidence and stop."""

from __future__ import annotations

import json
import re
import subprocess
from typing import Any

from tests.consumers.matrix import build, every_build
from tests.emit.cells import contract_data, unbroken
from tests.foreign_yaml import safe_load

_ORDER = ["G0", "G1", "G2", "G3", *(f"L{number}" for number in range(1, 7)), "G4", "G5", "G6", "G7"]
_PAGES = ("gates/promotion.md", "gates/network.md")
_BLOCK = re.compile(r"^  ```sh\n(.*?)^  ```$", re.DOTALL | re.MULTILINE)
_KEPT = re.compile(r' 2>&1 \| tee -a "\$E/(.+?)"$', re.MULTILINE)


def sections(cell: str, distro: str) -> dict[str, str]:
    """Return the text of every gate by its code, the layers after the gate that they belong to."""
    found: dict[str, str] = {}
    for page in _PAGES:
        parts = re.split(r"^## ([GL]\d) .*$", unbroken(build(cell, distro).texts[page]), flags=re.MULTILINE)
        found |= dict(zip(parts[1::2], parts[2::2], strict=True))
    return {code: found[code] for code in _ORDER} | found


def commands(text: str) -> list[str]:
    """Return the commands of the blocks for a shell, each on one line, without what only writes the evidence."""
    lines = "\n".join(_BLOCK.findall(text)).replace("\\\n", " ").splitlines()
    bare = (re.sub(r"^\{ (.*); \}$", r"\1", _KEPT.sub("", line).strip()) for line in lines)
    return [" ".join(line.split()) for line in bare if line not in ("", "{", "}")]


def table_rows(cell: str, distro: str) -> list[list[str]]:
    """Return the rows of the tables at the top of the page."""
    top = build(cell, distro).texts["README.md"].split("\n## Set up each shell\n")[0]
    lines = [line for line in top.splitlines() if line.startswith("| [")]
    return [[part.strip() for part in line.split("|")[1:-1]] for line in lines]


@every_build
def test_pages_and_table_have_every_gate_once_and_in_order(cell: str, distro: str) -> None:
    assert list(sections(cell, distro)) == _ORDER
    in_table = [row[0].split("]")[0].strip("[") for row in table_rows(cell, distro)]
    assert in_table == [code for letter in "GL" for code in _ORDER if code.startswith(letter)]


@every_build
def test_table_says_what_the_sections_say_and_leads_to_them(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    for gate, shows, command, owner in table_rows(cell, distro):
        section = sections(cell, distro)[gate.split("]")[0].strip("[")]
        ((page, anchor),) = re.findall(r"\(([\w/.]+)#([\w-]+)\)", gate)
        titles = re.findall(r"^#+ (.*)$", texts[page], re.MULTILINE)
        assert [re.sub(r"[^a-z0-9 -]", "", title.lower()).replace(" ", "-") for title in titles].count(anchor) == 1
        assert f"Passed when {shows}." in section
        assert f"Signed by: owner `{owner}`. **Stop on:** " in section
        assert command == "manual" or command.strip("`") in section


@every_build
def test_every_gate_leaves_evidence_of_its_own(cell: str, distro: str) -> None:
    files = []
    for code, text in sections(cell, distro).items():
        (file,) = re.findall(r"^Evidence: `(.+?)`\. Signed by: owner `.+`\. \*\*Stop on:\*\* \S", text, re.MULTILINE)
        assert file.startswith(f"{code}-")
        assert set(_KEPT.findall(text)) <= {file}
        files.append(file)
    assert len(set(files)) == len(_ORDER)


@every_build
def test_contract_has_as_data_what_each_gate_leaves_and_who_signs(cell: str, distro: str) -> None:
    contract = contract_data(build(cell, distro).texts["contract.json"])
    stated = {one["gate"]: one for one in contract["gates"]["evidence"]}
    assert set(stated) == set(_ORDER)
    for code, text in sections(cell, distro).items():
        assert f"Passed when {stated[code]['shows']}." in text
        left = stated[code]["files"]
        closed = "Do not pass this gate." in text
        assert [file["name"] for file in left if file["kind"] == "notes"] == (
            [] if closed else re.findall(r"^Evidence: `(.+?)`\. ", text, re.MULTILINE)
        )
        assert f"Signed by: owner `{stated[code]['signed_by']}`." in text
        typed = commands(text)
        looks = [
            re.search(r"(?: --for (\d+))? --evidence \"\$E\"(?: --host (\w+))?$", line)
            for line in typed
            if " observe " in line
        ]
        asked = {(look[1] and float(look[1]), look[2]) for look in looks if look is not None}
        assert {(file["least_s"], file["host"]) for file in left if file["kind"] == "observe"} == asked
        moves = [line for line in typed if " goal.launch.xml " in line]
        assert sum(file["kind"] == "first_goal" for file in left) == len(set(moves))
        bags = [re.findall(r'--output "\$E/(\S+)"', line) for line in typed if " bag record " in line]
        assert [file["name"] for file in left if file["kind"] == "bag"] == [name for found in bags for name in found]
        assert sum(file["kind"] == "attempt" for file in left) == sum("cellc attempt " in line for line in typed)


@every_build
def test_every_interface_of_the_real_target_has_the_ends_of_the_contract(cell: str, distro: str) -> None:
    assert f"observe --package generated/{cell} --gate L3 " in sections(cell, distro)["L3"]
    observed = json.loads(build(cell, distro).texts["config/observe.json"])["real"]["ends"]
    promised = contract_data(build(cell, distro).texts["contract.json"])["interfaces"]
    ends = {name: (_on_real(one["sources"]), _on_real(one["sinks"])) for name, one in promised.items()}
    there = {name: sides for name, sides in ends.items() if sides[0] or not promised[name]["sources"]}
    assert list(observed) == list(there)
    for name, sides in observed.items():
        assert set(sides["sources"]) == there[name][0], name
        assert there[name][1] <= set(sides["sinks"]), name  # drivers and planners come beside


def _on_real(ends: list[dict[str, Any]]) -> set[str]:
    return {end["full_name"] for end in ends if "real" in end.get("targets", ["mock", "real"])}


@every_build
def test_what_is_read_is_kept_and_what_is_started_is_not(cell: str, distro: str) -> None:
    for text in sections(cell, distro).values():
        for block in _BLOCK.findall(text):
            assert ("| tee -a" in block) != bool(re.search(r"^  ros2 (launch|bag record)", block)), block
            # What a command says of its failure is evidence too: nothing reaches the file without it.
            if "| tee -a" in block:
                # What the gate itself has recorded, and the report that the observer writes beside it.
                written = re.sub(r'"\$E/G\d-bag"| --evidence "\$E"| -o "\$E"', "", block)
                assert len(_KEPT.findall(block)) == block.count("| tee -a") == written.count("$E"), block
                assert not re.search("[<>]", _KEPT.sub("", block)), block


@every_build
def test_a_gate_stands_once(cell: str, distro: str) -> None:
    page = build(cell, distro).texts["README.md"]
    assert len(page.splitlines()) < 200
    for text in sections(cell, distro).values():
        assert not [line for line in re.findall(r"^- \[ \] (.+)$", text, re.MULTILINE) if line in page]


@every_build
def test_blocks_are_what_a_shell_takes(cell: str, distro: str) -> None:
    pages = [build(cell, distro).texts[page] for page in ("README.md", *_PAGES)]
    blocks = [block for page in pages for block in re.findall(r"^ *```sh\n(.*?)^ *```$", page, re.DOTALL | re.M)]
    for block in blocks:
        subprocess.run(["bash", "-n"], input=block, text=True, check=True, capture_output=True)
    assert len(blocks) > 10
    for page in pages:
        fences = [line.strip() for line in page.splitlines() if line.lstrip().startswith("```")]
        assert fences == ["```sh", "```"] * (len(fences) // 2)


@every_build
def test_commands_name_what_the_cell_has(cell: str, distro: str) -> None:
    artifacts = build(cell, distro).texts
    contract = contract_data(artifacts["contract.json"])
    kinds = {name: one["kind"] for name, one in contract["interfaces"].items()}
    managers = {f"{manager['namespace']}/controller_manager" for manager in contract["managers"].values()}
    frames = set(safe_load(artifacts["config/frames.yaml"])["frames"])
    seen = 0
    typed = (command for text in sections(cell, distro).values() for command in commands(text))
    for command in (re.sub(r"^timeout \d+ ", "", word) for word in typed):
        words = command.split()
        if (topic := re.search(r"ros2 topic \w+ (?:-v |--once |--field \S+ )*(\S+)", command)) is not None:
            assert kinds[topic.group(1)] == "topic", command
        elif (action := re.search(r"ros2 action info (\S+)", command)) is not None:
            beside = f"no client in the cell → `{action.group(1)}` →" in artifacts["audit.md"]  # a driver's own
            assert beside or kinds[action.group(1)] == "action", command
        elif command.startswith("ros2 control "):
            assert words[-1] in managers, command
        elif "tf2_echo" in command:
            assert set(words[-2:]) <= frames, command
        elif command.startswith("ros2 lifecycle "):
            assert f'name="{words[-1].rpartition("/")[2]}"' in artifacts["launch/cell.launch.xml"], command
        elif command.startswith("ros2 launch ") and words[2] != cell:  # a tool of a vendor
            assert f"<exec_depend>{words[2]}</exec_depend>" in artifacts["package.xml"], command
        elif command.startswith("ros2 launch "):
            assert (words[2], f"launch/{words[3]}" in artifacts) == (cell, True), command
            arguments = {word.split(":=")[0] for word in words[4:]}
            assert arguments <= set(re.findall(r'<arg name="(\w+)"', artifacts[f"launch/{words[3]}"])), command
        elif command.startswith("ros2 bag record "):
            recorded = set(safe_load(artifacts["config/recording_qos.yaml"]))
            assert {word for word in words if word.startswith("/")} == recorded
        else:
            continue
        seen += 1
    assert seen > 15


@every_build
def test_files_that_commands_read_are_in_the_package(cell: str, distro: str) -> None:
    for command in (command for text in sections(cell, distro).values() for command in commands(text)):
        for path in re.findall(rf"generated/{cell}/(\S+)", command):
            assert path in {*build(cell, distro).texts, "manifest.json"}, command


@every_build
def test_gate_of_enabling_holds_no_command(cell: str, distro: str) -> None:
    # Enabling is a step of the vendor's procedure: no line to paste may stand for it. A gripper that moves as its
    # hardware is activated is released here, because here the area is empty; what the robot says may be read.
    kinds = (
        f"ros2 launch {cell} activate",
        "timeout 10 ros2 topic echo --once ",
        "timeout 10 ros2 run tf2_ros tf2_echo ",
    )
    assert all(command.startswith(kinds) for command in commands(sections(cell, distro)["G5"]))


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
        assert any(text.startswith(path) for text in build(cell, distro).texts), path
