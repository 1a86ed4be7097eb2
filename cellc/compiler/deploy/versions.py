"""The parts of the version tuple that a computer can show: where each is read, and on which computer it is compared.

`observe` compares them at gate G0; the bring-up of the real target compares them again before it observes anything.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import Packages
from cellc.compiler.deploy.configuration import version_tuple
from cellc.compiler.deploy.processes import launch_hosts
from cellc.compiler.formats.escape import shell_word
from cellc.compiler.graph.versions import compatibility
from cellc.contract.frozen import dataclass
from cellc.contract.pins import is_commit, last_word, pinned_package
from cellc.contract.vocabulary import UNKNOWN

_OF_SYSTEM = ("os", "kernel", "ros")
_PACKAGES = {"ros2_control": "controller_manager", "moveit": "moveit_ros_move_group"}
# Pinned as a package and its version; the rest is read on the device or its panel.
_INSTALLED = ("rmw", "driver", "sdk", "description")
_GENERIC = "generic"


@dataclass(frozen=True, slots=True)
class Installed:
    """A part of the tuple that a computer shows.

    Args:
        name: such as ``arm.driver``.
        text: the pin as written.
        package: the ROS package whose version it is; empty for what the system itself, or a Debian package, shows.
        source: the folder of the source that a commit is of; empty where it is pinned by a number.
        debian: the Debian package whose version it is.
    """

    name: str
    text: str
    package: str = ""
    source: str = ""
    debian: str = ""

    @property
    def source_command(self) -> str:
        """What shows its commit to a person; empty for a version, and for a source that no page names."""
        commit = is_commit(last_word(self.text)) and self.source
        return f"git -C {shell_word(self.source)} rev-parse HEAD" if commit else ""

    @property
    def shown(self) -> str:
        """The part and what shows it, as the program compares it: ``arm.driver=package:my_driver``."""
        if self.debian:
            return f"{self.name}=debian:{self.debian}"
        return f"{self.name}=package:{self.package}" if self.package else f"{self.name}=system"


def installed_parts(cell: Cell) -> Iterator[Installed]:
    """Yield what a computer shows of the tuple, in the order of the tuple."""
    sources = {
        (judged.pin.holder, judged.pin.part): f"src/{judged.built_from[0].name}"
        for judged in compatibility(cell)
        if judged.built_from
    }
    for name, text in version_tuple(cell).items():
        holder, _, part = name.rpartition(".")
        if text == UNKNOWN:
            continue
        if part in _OF_SYSTEM and not holder:
            yield Installed(name, text)
        elif part in _PACKAGES and not holder:
            yield Installed(name, text, _PACKAGES[part])
        elif part in _INSTALLED:
            package, debian = _shown_by(cell, holder, part, text)
            if package or debian:
                yield Installed(name, text, package, sources.get((holder or cell.name, part), ""), debian)


def _shown_by(cell: Cell, holder: str, part: str, text: str) -> tuple[str, str]:
    """Return the ROS package and the Debian package that show a part; a device says which, else the pin names one."""
    packages = cell.device(holder).software.packages if holder else Packages()
    if part == "sdk" and packages.sdk is not None:
        return packages.sdk_package or "", packages.sdk_debian or ""
    named = {"driver": packages.driver, "description": packages.description}.get(part)
    return (named if named and pinned_package(text) else pinned_package(text)), ""


def fetched_parts(cell: Cell) -> Iterator[tuple[str, str, str]]:
    """Yield the parts that the build of a driver fetches, with the version and the part that fixes it."""
    for device in cell.devices:
        packages, text = device.software.packages, device.software.versions.sdk
        if packages.sdk is not None and text != UNKNOWN and not (packages.sdk_package or packages.sdk_debian):
            yield f"{device.name}.sdk", text, f"{device.name}.driver"


def compared_on(cell: Cell) -> Iterator[tuple[str, tuple[Installed, ...]]]:
    """Yield each computer that starts something, with the parts that it must show; an empty name for the only one."""
    parts = tuple(installed_parts(cell))
    at_host: dict[str, list[int]] = {}
    for place, part in enumerate(parts):
        holder = part.name.rpartition(".")[0]
        at_host.setdefault(cell.device(holder).site.host if holder else "", []).append(place)
    for host in launch_hosts(cell) or ("",):
        places = sorted((*at_host.get(host, ()), *at_host.get("", ()))) if host else range(len(parts))
        yield host, tuple(parts[place] for place in places if not host or _is_on(cell, parts[place].name, host))


def _is_on(cell: Cell, part: str, host: str) -> bool:
    """Tell whether a computer must show a part: drivers run where devices hang, real time has the kernel."""
    holder, _, name = part.rpartition(".")
    if holder:
        return cell.device(holder).site.host in (host, "")
    if name == "kernel":
        return cell.hosts[host].scheduling != _GENERIC
    if name == "ros2_control":
        return host in cell.managing_hosts
    return name != "moveit" or any(node.host == host for node in cell.planners)
