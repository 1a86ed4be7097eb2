"""The environment of each host and what the package installs: where the started processes look."""

from __future__ import annotations

import ast
import re
import subprocess
import sys
from pathlib import Path
from xml.etree.ElementTree import fromstring

import pytest

from tests.cells import DISTROS
from tests.consumers.matrix import build, every_build, spec_for
from tests.consumers.starting import every_process
from tests.emit.cells import emitted
from tests.foreign_yaml import safe_load

# rviz (14.1.18) and moveit_ros/visualization of moveit2 (2.12.3): RViz passes over a name that it does not have.
_OF_TOPIC = {"Value", "Depth", "History Policy", "Reliability Policy", "Durability Policy", "Filter size"}
_OF_DISPLAYS = {
    "rviz_default_plugins/Grid": {"Cell Size", "Plane Cell Count"},
    "rviz_default_plugins/RobotModel": {"Description Source", "Description Topic", "Visual Enabled"},
    "rviz_default_plugins/TF": {"Show Names", "Frame Timeout"},
    "rviz_default_plugins/Image": {"Topic"},
    "moveit_rviz_plugin/PlanningScene": {"Planning Scene Topic", "Robot Description"},
    "moveit_rviz_plugin/Trajectory": {"Trajectory Topic", "Loop Animation", "Robot Description"},
}


@every_build
def test_environment_is_the_spec_and_leads_to_files_of_the_package(cell: str, distro: str) -> None:
    texts, spec = build(cell, distro).texts, safe_load(spec_for(cell, distro))
    for path in (path for path in texts if path.endswith(".sh")):
        subprocess.run(["bash", "-n"], input=texts[path], text=True, check=True, capture_output=True)
        stated = dict(re.findall(r'^export (\w+)="(.*)"$', texts[path], re.MULTILINE))
        rmw = spec["versions"].get("rmw", "").split(" ")[0]
        assert stated["RMW_IMPLEMENTATION"] == (rmw or stated["RMW_IMPLEMENTATION"])
        if "network" in spec:
            assert stated["ROS_DOMAIN_ID"] == str(spec["network"]["domain_id"])
        discovery = "ROS_LOCALHOST_ONLY" if distro == "humble" else "ROS_AUTOMATIC_DISCOVERY_RANGE"
        # rmw_fastrtps adds a UDP transport on every card under LOCALHOST, and under SYSTEM_DEFAULT nothing.
        fast = stated["RMW_IMPLEMENTATION"] == "rmw_fastrtps_cpp"
        here = {"SUBNET", "SYSTEM_DEFAULT", "OFF"} if fast else {"SUBNET", "LOCALHOST", "OFF"}
        assert stated[discovery] in ({"0", "1"} if distro == "humble" else here)
        leads = {name: value.split("/", 1)[1] for name, value in stated.items() if "_cell_share" in value}
        leads = {name: value.removeprefix("/").removeprefix("${_cell_share}/") for name, value in leads.items()}
        assert set(leads.values()) <= set(texts)
        wanted = {
            "rmw_fastrtps_cpp": {"FASTRTPS_DEFAULT_PROFILES_FILE", "FASTDDS_DEFAULT_PROFILES_FILE"},
            "rmw_cyclonedds_cpp": {"CYCLONEDDS_URI"},
        }
        assert set(leads) == wanted[stated["RMW_IMPLEMENTATION"]]
        assert texts[path].splitlines()[-1] == "unset _cell_share"  # it is sourced
        assert texts[path].count(f'"$(ros2 pkg prefix --share {cell})"') == 1


@every_build
def test_rviz_knows_every_property_of_its_displays(cell: str, distro: str) -> None:
    tree = safe_load(build(cell, distro).texts["config/cell.rviz"])
    assert set(tree) == {"Panels", "Visualization Manager"}
    shown = tree["Visualization Manager"]
    assert set(shown) == {"Class", "Displays", "Global Options", "Tools", "Views"}
    assert set(shown["Global Options"]) == {"Fixed Frame", "Frame Rate"}
    for display in shown["Displays"]:
        assert set(display) - {"Class", "Name", "Enabled"} == _OF_DISPLAYS[display["Class"]]
        for value in display.values():
            assert not isinstance(value, dict) or set(value) <= _OF_TOPIC


@every_build
def test_programs_use_no_name_that_nothing_defines(cell: str, distro: str) -> None:
    tool = [str(Path(sys.executable).parent / "ruff"), "check", "--isolated", "--no-cache", "--select", "F", "-"]
    programs = [text for text in build(cell, distro).texts.values() if text.startswith("#!/usr/bin/env python3")]
    assert programs
    for text in programs:
        done = subprocess.run(tool, input=text, text=True, check=False, capture_output=True)
        assert done.returncode == 0, done.stdout


@every_build
def test_fast_dds_uses_the_transports_that_it_describes(cell: str, distro: str) -> None:
    for path in (path for path in build(cell, distro).texts if path.endswith(".fastdds.xml")):
        text = re.sub(' xmlns="[^"]*"', "", build(cell, distro).texts[path])
        dds = fromstring(text)
        described = [tag.text for tag in dds.findall(".//transport_descriptor/transport_id")]
        used = [tag.text for tag in dds.findall(".//userTransports/transport_id")]
        assert sorted(map(str, described)) == sorted(map(str, used))
        kinds = [tag.findtext("type") for tag in dds.findall(".//transport_descriptor")]
        assert sorted(map(str, kinds)) == ["SHM", "UDPv4"]
        assert dds.findtext(".//useBuiltinTransports") == "false"  # they would use every card
        assert dds.findall(".//interfaceWhiteList/*")


@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("discovery", ["unicast", "localhost"])
def test_fast_dds_without_multicast_asks_its_peers_on_the_cards_for_ros_alone(
    discovery: str, distro: str, tmp_path: Path
) -> None:
    spec = safe_load(spec_for("fr3_hand", distro))
    text = spec_for("fr3_hand", distro)
    text = text.replace(spec["versions"]["rmw"].split(" ")[0], "rmw_fastrtps_cpp", 1)
    text = re.sub(r"(\bdiscovery: )\w+", rf"\g<1>{discovery}", text)
    texts = emitted(tmp_path, text)
    for host in spec["hosts"]:
        dds = fromstring(re.sub(' xmlns="[^"]*"', "", texts[f"middleware/{host}.fastdds.xml"]))
        # Fast DDS 2.6 to 3: four processes of a peer are asked where nothing is said.
        assert int(dds.findtext(".//transport_descriptor/maxInitialPeersRange") or 4) >= 32
        # A locator of no address, and no multicast group is joined.
        assert len(dds.findall(".//metatrafficUnicastLocatorList/locator")) == 1
        assert not dds.findall(".//metatrafficUnicastLocatorList//address")
        peers = [tag.text for tag in dds.findall(".//initialPeersList//address")]
        assert peers[0] == "127.0.0.1"
        assert (len(peers) > 1) is (discovery == "unicast")
        shell = texts[f"middleware/{host}.sh"]
        assert 'LOCALHOST"' not in shell
        if distro != "humble":
            assert 'export ROS_AUTOMATIC_DISCOVERY_RANGE="SYSTEM_DEFAULT"' in shell


@every_build
def test_everything_that_is_read_at_run_time_is_installed(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    installs = re.findall(
        r"^install\((FILES|DIRECTORY)\n((?:  [\w./]+\n)+)  DESTINATION share/\$\{PROJECT_NAME\}\n\)",
        texts["CMakeLists.txt"],
        re.M,
    )
    kinds = {kind: set(names.split()) for kind, names in installs}
    folders = {path.split("/")[0] for path in texts if "/" in path and not path.startswith(("gates", "graph"))}
    # What runs is no file that is read: it is installed where ros2 run looks, with the right to be executed.
    ((programs, home),) = re.findall(
        r"^install\(PROGRAMS\n((?:  [\w./]+\n)+)  DESTINATION (\S+)\n\)", texts["CMakeLists.txt"], re.M
    )
    assert home == "lib/${PROJECT_NAME}"
    assert set(programs.split()) == {path for path in texts if path.startswith("scripts/")}
    processes = every_process(build(cell, distro))
    started = {process.executable for process in processes if process.package == cell}
    # The program before another one, and what the bring-up starts itself.
    started |= {process.prefix[0].rpartition("/")[2] for process in processes if process.prefix} | {
        "installed_versions.py"
    }
    # What a person runs to compare the graph with the package, and what that imports.
    started |= {"observe", *(f"observe_{part}.py" for part in ("checks", "host", "listener", "reports"))}
    assert started == {path.rpartition("/")[2] for path in programs.split()}
    assert kinds["DIRECTORY"] | {"scripts"} >= folders - {"evidence"}
    assert kinds["FILES"] >= {"contract.json", "manifest.json", "rehearsals.json"}
    assert texts["CMakeLists.txt"].rstrip().endswith("ament_package()")
    assert f"project({cell} NONE)" in texts["CMakeLists.txt"]
    assert "find_package(ament_cmake REQUIRED)" in texts["CMakeLists.txt"]


@every_build
def test_usage_of_a_program_has_the_options_that_it_reads_and_files_of_the_package(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    for path, text in texts.items():
        if path.startswith("scripts/") and not path.endswith(".py"):
            told = ast.get_docstring(ast.parse(text)) or ""
            usage = "\n".join(line for line in told.splitlines() if line.startswith("    "))
            assert usage.split()[0] == path.rpartition("/")[2]
            assert set(re.findall(r"--[a-z]+", usage)) <= set(re.findall(r'add_argument\(\s*"(--[a-z]+)"', text)), path
            assert set(re.findall(r"--[a-z]+ ([\w/]+\.\w+)", usage)) <= set(texts), path


# vcstool/clients/__init__.py of https://github.com/dirk-thomas/vcstool: what can be fetched.
_CLIENTS = {"bzr", "git", "hg", "svn", "tar", "zip"}


@every_build
def test_sources_are_fetched_as_vcs_import_reads_them(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    if "sources.repos" not in texts:
        return
    read = safe_load(texts["sources.repos"])
    assert set(read) == {"repositories"}
    for folder, one in read["repositories"].items():
        # vcstool/commands/import_.py: a repository without a type or an address is left out.
        assert set(one) == {"type", "url", "version"}, folder
        assert one["type"] in _CLIENTS
        # The folder has the name that `git clone` gives it.
        assert one["url"].rpartition("/")[2] == f"{folder}.git"
        assert re.fullmatch(r"https://[\w.-]+(/[\w.-]+)+\.git", one["url"])
        # A number would be taken for one by YAML, and `git checkout` gets words alone.
        assert isinstance(one["version"], str)
        assert re.fullmatch(r"[0-9a-f]{40}|v?\d+(\.\d+)+", one["version"]), "a branch moves"


@every_build
def test_profiles_reach_the_cards_for_ros_and_no_other(cell: str, distro: str) -> None:
    texts, spec = build(cell, distro).texts, safe_load(spec_for(cell, distro))
    remote = spec.get("network", {}).get("discovery") in ("unicast", "multicast")
    for host, one in spec.get("hosts", {}).items():
        cards = [card["address"].split("/")[0] for card in one["nics"].values() if "control" not in card["carries"]]
        wanted = ["127.0.0.1", *(cards if remote else ())]
        fast, cyclone = (texts.get(f"middleware/{host}.{kind}.xml", "") for kind in ("fastdds", "cyclonedds"))
        assert re.findall(r"<NetworkInterface address=\"(.+?)\"/>", cyclone) == (wanted if cyclone else [])
        allowed = re.findall("<interfaceWhiteList>(.*?)</interfaceWhiteList>", fast, re.DOTALL)
        assert re.findall("<address>(.+?)</address>", "".join(allowed)) == (wanted if fast else [])
        assert fast or cyclone
