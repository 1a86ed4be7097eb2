"""``middleware/<host>.*``: environment and profile of the pinned middleware, for each host of the spec.

``<host>.sh`` is sourced before anything of the cell is started. Fast DDS, Cyclone DDS and Zenoh each get the file that
they read; only that of the pinned implementation is written. Left out: QoS of topics, which belongs to the endpoints,
and tuning of buffers, which nobody can state without measuring.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.artifact import Artifact
from cellc.emit.middleware.binding import Binding, bindings, origins
from cellc.emit.middleware.cyclone import cyclone_profile
from cellc.emit.middleware.environment import environment
from cellc.emit.middleware.fast import fast_profile
from cellc.emit.middleware.zenoh import zenoh_router, zenoh_session
from cellc.formats.header import Header
from cellc.formats.xml_text import render
from cellc.graph.cell_graph import CellGraph


def emit(graph: CellGraph, header: Header) -> Iterator[Artifact]:
    """Yield environment and profiles."""
    for binding in bindings(graph):
        profiles = tuple(_profiles(graph, header, binding))
        names = tuple(artifact.path for artifact in profiles)
        yield Artifact(f"middleware/{binding.host}.sh", environment(graph.cell, header, binding, names))
        yield from profiles


def _profiles(graph: CellGraph, header: Header, binding: Binding) -> Iterator[Artifact]:
    rmw = graph.cell.spec.versions.rmw.split()[0]
    stem, head = f"middleware/{binding.host}", f"{header.text}\nFrom {', '.join(origins(binding))}."
    if rmw == "rmw_cyclonedds_cpp":
        yield Artifact(f"{stem}.cyclonedds.xml", render(cyclone_profile(graph.cell, binding), head))
    elif rmw == "rmw_zenoh_cpp":
        yield Artifact(
            f"{stem}.zenoh_router.json5",
            header.commented("//") + f"// {', '.join(origins(binding))}\n" + zenoh_router(binding),
        )
        yield Artifact(f"{stem}.zenoh_session.json5", header.commented("//") + zenoh_session())
    elif rmw in ("rmw_fastrtps_cpp", "rmw_fastrtps_dynamic_cpp"):
        yield Artifact(f"{stem}.fastdds.xml", render(fast_profile(graph.cell, binding), head))
