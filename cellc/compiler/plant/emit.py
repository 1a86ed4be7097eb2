"""The package of a plant: the bridges between its cells, and what its cells are and how each is built.

``config/line_1_to_line_2.yaml`` is read by domain_bridge 0.5.0, which takes one file: one process for each two cells,
because one file cannot have two topics of one name. ``launch/plant.launch.xml`` starts them all, on a computer that
reaches both graphs. Left out: nodes of the cells, which are in packages of their own, and are not started from here.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from pathlib import PurePosixPath
from xml.etree.ElementTree import Element

from cellc.compiler.artifact import Artifact
from cellc.compiler.formats.escape import launch_text, markdown, shell_word
from cellc.compiler.formats.header import Header
from cellc.compiler.formats.markdown_table import table
from cellc.compiler.formats.numbers import rounded
from cellc.compiler.formats.xml_text import comment, element
from cellc.compiler.formats.xml_text import render as xml
from cellc.compiler.formats.yaml_text import Tree
from cellc.compiler.formats.yaml_text import render as yaml
from cellc.compiler.output.manifest import with_manifest
from cellc.compiler.plant.plant import Crossing, Part, Plant, bridge_name
from cellc.contract.manifest import ConfigurationInputs

_BRIDGE = "domain_bridge"
_LAUNCH = "launch/plant.launch.xml"
_CELLS = "config/cells.yaml"


def emit_plant(plant: Plant) -> tuple[Artifact, ...]:
    """Return the files of the package, and the manifest over them."""
    header = Header(plant.name, f"cellc build {shell_word(PurePosixPath(plant.file).name)}")
    artifacts = tuple(_artifacts(plant, header))
    digest = hashlib.sha256("\0".join(artifact.text for artifact in artifacts).encode()).hexdigest()
    inputs = ConfigurationInputs(calibrations={}, tf_publishers={}, urdf_sha256="", cell_sha256=digest)
    distro = plant.first.cell.distro.value
    return with_manifest(
        artifacts,
        cell=plant.name,
        configuration_id=f"cfg-{digest[:12]}",
        configuration_inputs=inputs,
        version_tuple={"ros": distro},
    )


def _artifacts(plant: Plant, header: Header) -> Iterator[Artifact]:
    yield Artifact("README.md", _readme(plant, header))
    yield Artifact("package.xml", xml(_package(plant), header.text))
    yield Artifact("CMakeLists.txt", header.commented("#") + _build_file(plant))
    yield Artifact(_CELLS, header.commented("#") + yaml({"cells": {key: _cell(each) for key, each in _parts(plant)}}))
    yield Artifact(_LAUNCH, xml(element("launch", {"version": "0.1.1"}, _bridges(plant)), header.text))
    for (source, receiver), crossings in plant.bridges().items():
        yield Artifact(_config(source, receiver), header.commented("#") + yaml(_bridge(crossings)))


def _parts(plant: Plant) -> Iterator[tuple[str, Part]]:
    yield from plant.parts.items()


def _config(source: str, receiver: str) -> str:
    return f"config/{bridge_name(source, receiver)}.yaml"


def _bridge(crossings: tuple[Crossing, ...]) -> Tree:
    """Return what one bridge carries: each topic once, however many nodes of the receiver hear it."""
    source, receiver = crossings[0].source, crossings[0].receiver
    return {
        "name": bridge_name(source.key, receiver.key),
        "from_domain": source.domain,
        "to_domain": receiver.domain,
        "topics": {
            source.own_name(crossing.name).removeprefix("/"): {
                "type": crossing.type,
                "remap": receiver.own_name(crossing.name).removeprefix("/"),
                "qos": _profile(crossing),
            }
            for crossing in crossings
        },
    }


def _profile(crossing: Crossing) -> Tree:
    """Return the profile of the publisher; what a bridge reads at run time is `auto`."""
    interface = crossing.source.interface(crossing.source.own_name(crossing.name))
    assert interface is not None  # a plant with a crossing that its cells do not declare is not written
    qos = next(end.qos for end in interface.sources if end.node == crossing.source_node)
    return {
        "reliability": qos.reliability,
        "durability": qos.durability,
        "history": qos.history,
        "depth": qos.depth,
        "deadline": "auto",
        "lifespan": "auto",
    }


def _cell(part: Part) -> Tree:
    """Return a cell and the pose of its world: m, and roll, pitch, yaw in rad."""
    return {
        "spec": part.spec,
        "package": part.cell.name,
        "owner": part.owner,
        "domain_id": part.domain,
        "xyz": tuple(rounded(way) for way in part.pose.position),
        "rpy": tuple(rounded(turn) for turn in part.pose.rpy()),
    }


def _bridges(plant: Plant) -> Iterator[Element]:
    program = f"$(find-pkg-prefix {_BRIDGE})/lib/{_BRIDGE}/{_BRIDGE}"
    for source, receiver in plant.bridges():
        yield comment(f"from {source} to {receiver}")
        config = f"$(find-pkg-share {plant.name})/{_config(source, receiver)}"
        name = launch_text(bridge_name(source, receiver))
        yield element("executable", {"name": name, "cmd": f"{program} {config}", "output": "both"})


def _package(plant: Plant) -> Element:
    types = {crossing.type.partition("/")[0] for crossing in plant.crossings}
    needed = sorted({_BRIDGE, "ros2launch", *types} if plant.crossings else {"ros2launch"})
    return element(
        "package",
        {"format": "3"},
        [
            element("name", text=plant.name),
            element("version", text="1.0.0"),
            element("description", text=plant.summary if plant.summary.strip() else f"Plant {plant.name}."),
            comment("the spec has no mail address, so this one is a placeholder"),
            element("maintainer", {"email": "maintainer@unset.invalid"}, text=plant.name),
            element("license", text="Apache-2.0"),
            element("buildtool_depend", text="ament_cmake"),
            *(element("exec_depend", text=name) for name in needed),
            element("export", children=[element("build_type", text="ament_cmake")]),
        ],
    )


def _build_file(plant: Plant) -> str:
    folders = "install(DIRECTORY\n  config\n  launch\n  DESTINATION share/${PROJECT_NAME}\n)"
    return (
        f"cmake_minimum_required(VERSION 3.8)\nproject({plant.name} NONE)\n\nfind_package(ament_cmake REQUIRED)\n\n"
        f"{folders}\ninstall(FILES\n  manifest.json\n  DESTINATION share/${{PROJECT_NAME}}\n)\n\nament_package()\n"
    )


def _readme(plant: Plant, header: Header) -> str:
    cells = table(
        ("cell", "package", "domain", "owner", "world at, m", "built and reviewed with"),
        (
            (
                key,
                part.cell.name,
                str(part.domain),
                part.owner,
                " ".join(f"{rounded(way):g}" for way in part.pose.position),
                f"`cellc build {shell_word(part.spec)}`",
            )
            for key, part in _parts(plant)
        ),
    )
    topics = table(
        ("topic", "type", "from", "to", "owner"),
        (
            (
                crossing.name,
                crossing.type,
                f"{crossing.source.key}/{crossing.source_node}",
                f"{crossing.receiver.key}/{crossing.receiver_node}",
                crossing.owner,
            )
            for crossing in plant.crossings
        ),
    )
    areas = table(
        ("area", "let in by", "released"), ((area.name, area.granted_by, area.released) for area in plant.areas)
    )
    return _README.format(
        header="\n".join(header.lines),
        name=plant.name,
        summary=markdown(plant.summary),
        cells=cells,
        topics=topics,
        areas=areas,
    )


_README = """\
<!--
{header}
-->
# {name}

{summary}

## Cells

Each cell is built, started, rehearsed and reviewed by itself, from its own spec; this package changes none of them.

{cells}

## What crosses

Each cell is a graph in a domain of its own. When the cells are up, start the bridges on a computer that reaches both
graphs: `ros2 launch {name} plant.launch.xml`. They carry messages, and start nothing.

{topics}

## Shared areas

{areas}
"""
