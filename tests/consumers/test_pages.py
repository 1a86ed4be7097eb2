"""The audit and the manifest against the contract, the spec and the catalog's own files."""

from __future__ import annotations

import json
import re
from typing import Any

from tests.cells import catalog_facts
from tests.consumers.matrix import build, every_build, spec_for
from tests.consumers.starting import node_name, processes, written
from tests.emit.cells import contract_data
from tests.foreign_yaml import safe_load

_OF_CELL = ("os", "kernel", "ros", "rmw", "ros2_control", "moveit")
_OF_DEVICE = ("revision", "serial", "firmware", "driver", "sdk", "description")


def tables(cell: str, distro: str) -> dict[str, list[list[str]]]:
    """Return the rows of every section of the audit, without their heads."""
    parts = re.split(r"^## (.+)$", build(cell, distro).texts["audit.md"], flags=re.MULTILINE)
    sections = dict(zip(parts[1::2], parts[2::2], strict=True))
    return {
        name: [[part.strip() for part in line.split(" | ")] for line in _rows(text)] for name, text in sections.items()
    }


def _rows(text: str) -> list[str]:
    lines = [line.strip("| ") for line in text.splitlines() if line.startswith("|")]
    return lines[2:]


def _tuple(cell: str, distro: str) -> dict[str, str]:
    spec: Any = safe_load(spec_for(cell, distro))
    versions = spec["versions"]
    parts = {name: versions.get(name, "UNKNOWN") for name in _OF_CELL}
    rollback = versions.get("rollback", {})
    parts |= {f"rollback.{name}": rollback.get(name, "UNKNOWN") for name in ("image", "configuration")}
    return parts | {
        f"{device}.{name}": one.get(name, "UNKNOWN") for device, one in spec["devices"].items() for name in _OF_DEVICE
    }


@every_build
def test_manifest_has_the_version_tuple_of_the_spec(cell: str, distro: str) -> None:
    manifest = json.loads(build(cell, distro).texts["manifest.json"])
    assert manifest["version_tuple"] == {name: str(value) for name, value in _tuple(cell, distro).items()}
    assert manifest["cell"] == cell
    contract = contract_data(build(cell, distro).texts["contract.json"])
    assert manifest["configuration_id"] == contract["configuration_id"]


@every_build
def test_audit_asks_for_every_unknown_and_judges_every_pin(cell: str, distro: str) -> None:
    found = tables(cell, distro)
    asked = {row[2].strip("`") for row in found["Open questions"]}
    pinned = {(row[0], row[1]): row[2] for row in found["Version tuple"]}
    for name, value in _tuple(cell, distro).items():
        holder, _, part = name.rpartition(".")
        if value == "UNKNOWN":
            path = f"versions.{name}" if holder in ("", "rollback") else f"devices.{name}"
            assert path in asked
        elif holder != "rollback":
            assert pinned[holder or cell, part] == str(value)


@every_build
def test_audit_expects_the_interfaces_of_the_contract(cell: str, distro: str) -> None:
    found = tables(cell, distro)
    promised = contract_data(build(cell, distro).texts["contract.json"])["interfaces"]
    rows = [row for kind in ("topics", "services", "actions") for row in found[f"Expected {kind}"]]
    assert [row[0].strip("`") for row in rows if "`" in row[0]] == [
        name for kind in ("topic", "service", "action") for name, one in promised.items() if one["kind"] == kind
    ]
    for row in rows:
        one = promised[row[0].strip("`")]
        assert row[1] == one["type"]
        for shown, ends in ((row[2], one["sources"]), (row[3], one["sinks"])):
            wanted = dict.fromkeys(
                "{} ({}, {}, depth {})".format(
                    end["node"], *(end["qos"][k] for k in ("reliability", "durability", "depth"))
                )
                for end in ends
            )
            assert shown == (", ".join(wanted) or "none")


def _counted(name: str) -> list[str]:
    """Return the names that one with a range, such as ``output_[0..17]``, stands for."""
    stem, _, numbers = name.rstrip("]").partition("[")
    first, _, last = numbers.partition("..")
    return [f"{stem}{number}" for number in range(int(first), int(last) + 1)] if numbers else [name]


@every_build
def test_audit_names_one_owner_for_each_command_interface(cell: str, distro: str) -> None:
    promised = contract_data(build(cell, distro).texts["contract.json"])["managers"].values()
    claims = []
    for manager in promised:
        for controller, one in manager["controllers"].items():
            by_target = {"": one["command_interfaces"]}
            if one["real_command_interfaces"] is not None:
                by_target = {
                    " on the mock": one["command_interfaces"],
                    " on real hardware": one["real_command_interfaces"],
                }
            suffix = "" if one["active"] else " (inactive)"
            claims += [(name, controller + suffix + where) for where, names in by_target.items() for name in names]
    rows = tables(cell, distro)["Command owners"]
    told = [(name, row[1]) for row in rows for name in _counted(row[0].strip("`"))]
    assert told == claims


@every_build
def test_audit_has_the_way_back_that_the_catalogue_knows(cell: str, distro: str) -> None:
    text = build(cell, distro).texts["audit.md"].split("\n## Recovery\n")[1].split("\n## ")[0]
    wanted: list[str] = []
    limits: list[str] = []
    if dropping := [name for name, one in written(cell)["devices"].items() if _drops_as_its_driver_ends(one["model"])]:
        wanted.append(f"1. Make sure that nothing that {' and '.join(dropping)} may hold can fall on a person")
    for device, one in written(cell)["devices"].items():
        facts, by = catalog_facts(one["model"]), _driven_by(one)
        assert one.get("program", {"mode": "local"})["mode"] == "local"  # of these cells each is started at the pendant
        for way in facts.get("safety", {}).get("recovery", ()):
            if way.get("by", by) != by:
                continue
            steps = [step if isinstance(step, str) else step["does"] for step in way["steps"] if _at_pendant(step)]
            wanted += [f"{device}, {way['state']}:", *(f"{n}. {step}" for n, step in enumerate(steps, 1))]
        limits += [f": {limit}" for limit in facts.get("mock_cannot_prove", ())]
        limits += [pair["because"] for pair in facts.get("allowed_collisions", ())]
        limits += [": its adapter - no launch file starts it on the mock"] if by == "adapter" else []
    limits += [] if written(cell).get("scene") else ["planned paths may pass through a table or fence"]
    assert [line for line in text.splitlines() if re.match(r"\d+\. |\w+, \w+:$", line)] == wanted
    proof = build(cell, distro).texts["audit.md"].split("\n## What the mock cannot prove\n")[1]
    assert len([line for line in proof.splitlines() if line.startswith("- ")]) == len(limits)
    assert all(limit in proof for limit in limits)


def _drops_as_its_driver_ends(model: str) -> bool:
    real = catalog_facts(model).get("control", {}).get("hardware", {}).get("real") or {}
    return bool(real.get("effects", {}).get("deactivate", {}).get("drops_part"))


@every_build
def test_audit_says_whose_shapes_each_device_has(cell: str, distro: str) -> None:
    shown = {row[0]: row[1] for row in tables(cell, distro)["Shapes"]}
    vendors = {
        device: "vendor" in catalog_facts(one["model"])["description"]
        for device, one in written(cell)["devices"].items()
    }
    # No package of a vendor lies beside the cells of the repository.
    assert shown == {
        device: "boxes and cylinders" if known else "from its description" for device, known in vendors.items()
    }


@every_build
def test_confirmations_say_what_a_person_states_by_them(cell: str, distro: str) -> None:
    texts = "".join(build(cell, distro).texts.values())
    # Chapter 4, section 11: evidence of the gates before, drives without power at first, an observer at the stop.
    stated = {
        "authorizes the hardware launch. Gates G0 to G2 have their evidence. The drives are in the state that "
        "gate G3 names.",
        "authorizes hardware that moves on activation. Gates G0 to G4 have their evidence. No person is within "
        "reach. Nothing is held. No robot program is running.",
        "authorizes claims on real hardware. Gates G0 to G6 have their evidence. The robot accepts commands, as its "
        "vendor describes. Jogging has ended.",
        "authorizes motion on real hardware. Gates G0 to G6 have their evidence. The observer is at the stop.",
        "sends the first goal to real hardware. Gates G0 to G6 have their evidence. Claims are authorized. The speed "
        "is low. The observer is at the stop.",
    }
    for text in re.findall(r'name="confirm_\w+" (?:default="[^"]*" )?description="([^"]*)"', texts):
        said = text.removeprefix("Confirmation of the person who ")
        assert re.sub(r" Not needed on the mock( or in sim)?\.$", "", said) in stated


@every_build
def test_every_way_after_a_loss_leads_back_to_a_gate(cell: str, distro: str) -> None:
    text = build(cell, distro).texts["audit.md"].split("\n## After a crash or lost connection\n")[1].split("\n## ")[0]
    for way in re.split(r"\n\n(?!1\. )", text.strip()):
        assert re.search(r"[Rr]epeat from gate G\d|Repeat layers L1 to L5", way), way
        numbers = [int(number) for number in re.findall(r"^(\d+)\. ", way, re.MULTILINE)]
        assert numbers == [*range(1, len(numbers) + 1)]


@every_build
def test_gates_have_what_people_do_at_each_device(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    page = (texts["gates/promotion.md"] + texts["gates/network.md"]).replace("\\", "")
    for device, one in written(cell)["devices"].items():
        by = _driven_by(one)
        for step in catalog_facts(one["model"]).get("commissioning", ()):
            here = distro in step.get("only", [distro]) and "{" not in step["does"]
            # Of these cells each is started there.
            if here and step.get("when", ["pendant"]) == ["pendant"] and step.get("by", by) == by:
                assert f"{device}: {step['does']}" in page


def _driven_by(device: dict[str, object]) -> str:
    return "adapter" if device.get("architecture") == "direct_sdk" else "driver"


def _at_pendant(step: str | dict[str, object]) -> bool:
    return isinstance(step, str) or "pendant" in str(step["when"])


@every_build
def test_people_of_the_spec_answer_for_what_it_says(cell: str, distro: str) -> None:
    found, owners = tables(cell, distro), written(cell).get("owners", {})
    for title, section in (("Approvals", "approvals"), ("Responsibilities", "responsibilities")):
        shown = {row[0]: row[-1] for row in found[title]}
        assert {name: shown[name] for name in owners.get(section, {})} == owners.get(section, {})


@every_build
def test_audit_expects_no_name_of_a_driver_that_the_launch_file_gives_to_another(cell: str, distro: str) -> None:
    given_away = {source for process in processes(cell, distro, "real") for source in process.remaps}
    assert not {row[0].strip("`") for row in tables(cell, distro)["Other driver interfaces"]} & given_away


@every_build
def test_audit_expects_the_nodes_that_are_launched_with_what_they_are_told(cell: str, distro: str) -> None:
    rows = {row[0].strip("`"): row for row in tables(cell, distro)["Expected nodes"]}
    started = {
        node_name(process): process
        for process in processes(cell, distro, "real")
        if process.executable not in ("spawner", "bring_up", "claim_watch")
    }
    contract = contract_data(build(cell, distro).texts["contract.json"])
    plugins = {
        controller["full_name"]: controller["plugin"]
        for manager in contract["managers"].values()
        for controller in manager["controllers"].values()
    }
    assert {name: rows[name][1] for name in plugins} == plugins
    assert set(rows) == set(plugins) | set(started)
    for name in started:
        process = started[name]
        assert rows[name][1].removesuffix(" (real target)") == f"{process.package}/{process.executable}"
        told = {part.strip("`") for part in rows[name][4].split(", ")}
        assert set(process.files) <= told
        if process.executable != "ros2_control_node":  # Humble's is given the description as well
            assert set(process.values) - {"use_sim_time"} <= told
