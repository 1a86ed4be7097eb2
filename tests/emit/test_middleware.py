"""Middleware files against the schemas of their readers, and who may be reached over which card."""

from __future__ import annotations

import json
import re
from functools import cache
from pathlib import Path
from xml.etree import ElementTree

import pytest
import xmlschema

from tests.cells import DISTROS, spec_text
from tests.emit.cells import artifacts_of, emitted, emitted_once
from tests.foreign_yaml import safe_load
from tests.oracles import UPSTREAM, needs_upstream

CONTROL_CARD = "192.168.56.10"
SERVERS = "server, servers: [{host: control_pc}, {host: vision_pc, nic: bulk, port: 12000}]"
SECOND_HOST = "\n  vision_pc:\n    nics: {bulk: {address: 10.10.0.11/24, carries: [camera]}}\nnetwork:"


def _text(rmw: str, discovery: str, distro: str = "jazzy") -> str:
    text = (
        spec_text("ur5e_pick").replace("ros: jazzy", f"ros: {distro}").replace("rmw_fastrtps_cpp 8.4.4", f"{rmw} 1.0.0")
    )
    text = re.sub(r"discovery: \w+", f"discovery: {discovery}", text)
    return text.replace("\nnetwork:", SECOND_HOST, 1)


@cache
def _fast_dds_schema() -> xmlschema.XMLSchema11:
    return xmlschema.XMLSchema11(UPSTREAM / "xsd" / "fastdds_profiles.xsd")


def _of_middleware(artifacts: dict[str, str]) -> dict[str, str]:
    return {path: text for path, text in artifacts.items() if path.startswith("middleware/")}


@needs_upstream
@pytest.mark.parametrize("distro", DISTROS)
@pytest.mark.parametrize("discovery", ["multicast", "unicast", "localhost", "off"])
def test_fast_dds_profile_is_what_fast_dds_declares(distro: str, discovery: str) -> None:
    files = emitted_once(_text("rmw_fastrtps_cpp", discovery, distro))
    _holds_for_both(files, distro)


@needs_upstream
@pytest.mark.parametrize("distro", ["kilted", "lyrical"])  # version 3, which is that of the schema
def test_clients_of_discovery_servers_are_what_fast_dds_declares(distro: str) -> None:
    files = emitted_once(_text("rmw_fastrtps_cpp", SERVERS, distro))
    # The parser has had it since 2.6 (Fast DDS 3.2.5, XMLElementParser.cpp:3940); the schema beside it has not.
    _holds_for_both({path: text.replace("SUPER_CLIENT", "CLIENT") for path, text in files.items()}, distro)


def _holds_for_both(files: dict[str, str], distro: str) -> None:
    schema = _fast_dds_schema()
    for host in ("control_pc", "vision_pc"):
        # Version 2 has another namespace than the schema, which is that of version 3.
        old = "http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles"
        text = files[f"middleware/{host}.fastdds.xml"]
        assert (old in text) is (distro in ("humble", "jazzy"))
        schema.validate(text.replace(old, "http://www.eprosima.com"))


@needs_upstream
@pytest.mark.parametrize("discovery", ["multicast", "unicast", "localhost", "off"])
def test_cyclone_profile_is_what_cyclone_declares(discovery: str) -> None:
    files = emitted_once(_text("rmw_cyclonedds_cpp", discovery))
    schema = xmlschema.XMLSchema(UPSTREAM / "xsd" / "cyclonedds.xsd")
    for host in ("control_pc", "vision_pc"):
        schema.validate(files[f"middleware/{host}.cyclonedds.xml"])


@pytest.mark.parametrize(
    ("discovery", "multicast", "peers"),
    [
        ("multicast", "true", None),
        ("unicast, peers: [10.10.0.11]", "false", ["127.0.0.1"]),  # ROS_STATIC_PEERS adds the other
        ("localhost", "false", ["127.0.0.1"]),
    ],
)
def test_cyclone_finds_others_by_multicast_or_by_their_addresses(
    discovery: str, multicast: str, peers: list[str] | None
) -> None:
    domain = ElementTree.fromstring(
        emitted_once(_text("rmw_cyclonedds_cpp", discovery))["middleware/control_pc.cyclonedds.xml"]
    )
    assert domain.findtext("{*}Domain/{*}General/{*}AllowMulticast") == multicast
    found = domain.find("{*}Domain/{*}Discovery")
    assert (found is None) is (peers is None)
    assert [element.get("Address") for element in domain.iterfind(".//{*}Peer")] == (peers or [])


@pytest.mark.parametrize("distro", ["humble", "kilted"])
def test_every_host_asks_every_discovery_server(distro: str) -> None:
    files = emitted_once(_text("rmw_fastrtps_cpp", SERVERS, distro))
    for host in ("control_pc", "vision_pc"):
        tree = ElementTree.fromstring(files[f"middleware/{host}.fastdds.xml"])
        (discovery,) = tree.iterfind(".//{*}builtin/{*}discovery_config")
        assert discovery.findtext("{*}discoveryProtocol") == "SUPER_CLIENT"
        asked = [
            (element.findtext("{*}address"), element.findtext("{*}port"))
            for element in discovery.iterfind(".//{*}locator/{*}udpv4")
        ]
        assert asked == [("10.10.0.10", "11811"), ("10.10.0.11", "12000")]
        # rmw_fastrtps of Humble has Fast DDS 2.6, which knows a server by its number (Fast DDS 2.6, ServerAttributes.h:
        # DEFAULT_ROS2_SERVER_GUIDPREFIX, the third octet of which is the number).
        prefixes = [element.get("prefix") for element in discovery.iterfind(".//{*}RemoteServer")]
        known = ["44.53.00.5f.45.50.52.4f.53.49.4d.41", "44.53.01.5f.45.50.52.4f.53.49.4d.41"]
        assert prefixes == (known if distro == "humble" else [])


def test_discovery_server_is_started_on_its_host_where_the_others_ask_it() -> None:
    files = emitted_once(_text("rmw_fastrtps_cpp", SERVERS))
    starts = {path: text.splitlines()[-1] for path, text in files.items() if "discovery_server" in path}
    assert starts == {
        "middleware/control_pc.discovery_server_0": "exec fastdds discovery -i 0 -l 10.10.0.10 -p 11811",
        "middleware/vision_pc.discovery_server_1": "exec fastdds discovery -i 1 -l 10.10.0.11 -p 12000",
    }
    for path in starts:
        assert f"generated/ur5e_pick/{path}" in files["README.md"]


def test_cell_without_discovery_server_starts_none() -> None:
    files = emitted_once(_text("rmw_fastrtps_cpp", "multicast, servers: [{host: control_pc}]"))
    assert not any("discovery_server" in path or "discovery_config" in text for path, text in files.items())


@pytest.mark.parametrize("rmw", ["rmw_fastrtps_cpp", "rmw_cyclonedds_cpp", "rmw_zenoh_cpp"])
@pytest.mark.parametrize("discovery", ["multicast", "unicast", "localhost"])
def test_no_ros_traffic_is_bound_to_the_control_card(rmw: str, discovery: str) -> None:
    files = _of_middleware(emitted_once(_text(rmw, discovery)))
    assert not any(CONTROL_CARD in text for text in files.values())
    profile = "".join(text for path, text in files.items() if "control_pc." in path and not path.endswith(".sh"))
    assert ("10.10.0.10" in profile) is (discovery != "localhost")
    assert "127.0.0.1" in profile


@pytest.mark.parametrize(
    ("rmw", "distro", "discovery", "lines"),
    [
        ("rmw_fastrtps_cpp", "jazzy", "multicast", ['export ROS_AUTOMATIC_DISCOVERY_RANGE="SUBNET"']),
        (
            "rmw_cyclonedds_cpp",
            "jazzy",
            "unicast",
            ['export ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST"', 'export ROS_STATIC_PEERS="10.10.0.11"'],
        ),
        ("rmw_cyclonedds_cpp", "kilted", "localhost", ['export ROS_AUTOMATIC_DISCOVERY_RANGE="LOCALHOST"']),
        # Under LOCALHOST rmw_fastrtps adds a transport on every card; the profile says who is asked.
        ("rmw_fastrtps_cpp", "jazzy", "unicast", ['export ROS_AUTOMATIC_DISCOVERY_RANGE="SYSTEM_DEFAULT"']),
        ("rmw_fastrtps_cpp", "kilted", "localhost", ['export ROS_AUTOMATIC_DISCOVERY_RANGE="SYSTEM_DEFAULT"']),
        ("rmw_fastrtps_cpp", "humble", "localhost", ['export ROS_LOCALHOST_ONLY="1"']),
        ("rmw_fastrtps_cpp", "humble", "unicast", ['export ROS_LOCALHOST_ONLY="0"']),
        ("rmw_fastrtps_cpp", "jazzy", SERVERS, ['export ROS_AUTOMATIC_DISCOVERY_RANGE="SYSTEM_DEFAULT"']),
        ("rmw_fastrtps_cpp", "humble", SERVERS, ['export ROS_LOCALHOST_ONLY="0"']),
    ],
)
def test_environment_speaks_the_words_of_the_distribution(
    rmw: str, distro: str, discovery: str, lines: list[str]
) -> None:
    shell = emitted_once(_text(rmw, discovery, distro))["middleware/control_pc.sh"].splitlines()
    about_discovery = [line for line in shell if "DISCOVERY" in line or "LOCALHOST_ONLY" in line or "PEERS" in line]
    assert about_discovery == lines
    assert 'export ROS_DOMAIN_ID="42"' in shell


def test_profiles_that_the_environment_names_are_in_the_package() -> None:
    for rmw in ("rmw_fastrtps_cpp", "rmw_cyclonedds_cpp", "rmw_zenoh_cpp"):
        files = emitted_once(_text(rmw, "unicast"))
        named = re.findall(r"\$\{_cell_share\}/([^\"]+)", files["middleware/control_pc.sh"])
        assert named
        assert set(named) <= set(files)


def test_zenoh_router_listens_and_sessions_connect_to_it_alone() -> None:
    files = emitted_once(_text("rmw_zenoh_cpp", "unicast"))
    # JSON5 with bare keys and trailing commas, brought back to JSON by hand.
    documents = {}
    for kind in ("router", "session"):
        text = re.sub(r"^//.*$", "", files[f"middleware/control_pc.zenoh_{kind}.json5"], flags=re.MULTILINE)
        text = re.sub(r"(\w+):(?=\s)", r'"\1":', text)
        documents[kind] = json.loads(re.sub(r",(\s*})", r"\1", text))
    assert documents["router"]["mode"] == "router"
    assert documents["router"]["listen"]["endpoints"] == ["tcp/127.0.0.1:7447", "tcp/10.10.0.10:7447"]
    assert documents["router"]["connect"]["endpoints"] == ["tcp/10.10.0.11:7447"]
    assert documents["session"]["connect"]["endpoints"] == ["tcp/localhost:7447"]
    assert documents["session"]["scouting"]["multicast"]["enabled"] is False


def test_qos_overrides_are_those_that_rclcpp_reads() -> None:
    sections = safe_load(artifacts_of("ur5e_pick")["config/nodes.yaml"])
    overrides = sections["perception"]["ros__parameters"]["qos_overrides"]
    assert overrides["/camera/color/image_raw"]["subscription"] == {
        "reliability": "best_effort",
        "durability": "volatile",
        "history": "keep_last",
        "depth": 1,
        "liveliness": "automatic",
    }
    assert list(overrides["/object_pose"]) == ["publisher"]


def test_durations_of_qos_are_whole_nanoseconds(tmp_path: Path) -> None:
    before = "from: {perception: {reliability: reliable, depth: 1}}"
    text = spec_text("ur5e_pick")
    assert before in text
    text = text.replace(before, "from: {perception: {deadline: 150 ms, lifespan: 0.5 s, lease_duration: 1 s}}")
    overrides = safe_load(emitted(tmp_path, text)["config/nodes.yaml"])
    policies = overrides["perception"]["ros__parameters"]["qos_overrides"]["/object_pose"]["publisher"]
    assert policies["deadline"] == 150_000_000
    assert policies["lifespan"] == 500_000_000
    assert policies["liveliness_lease_duration"] == 1_000_000_000


def test_cell_without_hosts_needs_no_middleware_files() -> None:
    assert not _of_middleware(artifacts_of("minimal"))
