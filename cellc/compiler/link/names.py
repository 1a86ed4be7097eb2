"""What names of the spec and placeholders of the catalog mean, and the report of a name that nothing has."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping

from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.source.document import SourceDocument
from cellc.compiler.spec.cell_spec import CellSpec
from cellc.compiler.spec.devices import DeviceSpec
from cellc.contract.diagnostics import Diagnostic, Severity, YamlPath, did_you_mean, only_nearest
from cellc.contract.frozen import dataclass
from cellc.contract.vocabulary import UNKNOWN


def unknown_name(
    code: str, name: str, kind: str, candidates: Iterable[str], document: SourceDocument, path: YamlPath
) -> Diagnostic:
    """Report a reference to something that does not exist, with the nearest names that do.

    Args:
        kind: singular noun, such as ``frame``, or several: ``camera or device with joints``.
        path: where the reference is written; marked at the key where that is the name.
    """
    is_key = path[-1:] == (name,) and document.text_at(path) != name
    span = document.locate_key(path) if is_key else document.locate(path)
    known = tuple(candidates)
    return Diagnostic(
        code=code,
        severity=Severity.ERROR,
        message=f"there is no {kind} `{name}`",
        span=span,
        yaml_path=path,
        help=did_you_mean(name, known, f"{_plural(kind)} of this cell"),
        fix=document.fix(span, name, only_nearest(name, known), sure=False),
    )


def _plural(kind: str) -> str:
    """Return the plural of nouns, each before what is said of it."""
    return " or ".join(re.sub(r"( (?:with|of|in|that|whose) |$)", r"s\1", noun, count=1) for noun in kind.split(" or "))


def home_host(spec: CellSpec) -> str:
    """Return the computer of what states none: that of the first controller manager, else the first; empty for none."""
    managers = (*(() if spec.control is None else (spec.control,)), *spec.managers.values())
    stated = (manager.host for manager in managers if manager.host is not None)
    return next(stated, next(iter(spec.hosts), ""))


_PORT = re.compile(r"\{port_(\d{1,5})\}")
_PLACEHOLDER = re.compile(r"\{(\w+)\}")  # `{share:PACKAGE}` stays: only an installed workspace knows the folder


@dataclass(frozen=True, slots=True)
class Placeholders:
    """The values for one device of the cell.

    ``{port_50001}`` is a port of the host on which its driver listens: the vendor's number, moved by ``port_shift``.
    """

    values: Mapping[str, str]
    port_shift: int = 0

    def fill(self, text: str) -> str:
        """Return the text with every known placeholder replaced; others stay as they are."""
        ports = _PORT.sub(lambda match: str(int(match[1]) + self.port_shift), text)
        return _PLACEHOLDER.sub(lambda match: self.values.get(match[1], match[0]), ports)

    def fill_parameters(self, parameters: Mapping[str, ParameterValue]) -> dict[str, ParameterValue]:
        """Return parameters with the texts of names, values and lists filled: a joint may stand in any of them."""
        return {self.fill(name): self._fill_value(value) for name, value in parameters.items()}

    def _fill_value(self, value: ParameterValue) -> ParameterValue:
        if isinstance(value, str):
            return self.fill(value)
        if isinstance(value, tuple):
            return tuple(self.fill(item) if isinstance(item, str) else item for item in value)
        return value


JOINT_STATES = "/joint_states"
"""The topic from which robot_state_publisher and planners read all joints.

It needs no merging node: several publishers on it are usual, and readers combine joints by name. joint_state_publisher
with a ``source_list`` would stamp old states again, and report zero for joints that it has not received.
"""


def graph_name(namespace: str, full_name: str, name: str) -> str:
    """Return a name of a controller in full: below its own, or in its namespace, whose joint states join the others."""
    if name.startswith("~/"):
        return f"{full_name}{name[1:]}"
    return JOINT_STATES if f"/{name}" == JOINT_STATES else f"{namespace}/{name}"


def placeholders(
    name: str, prefix: str, written: DeviceSpec, spec: CellSpec, controllers: Mapping[str, str], port_shift: int = 0
) -> Placeholders:
    """Collect the values for a device; what the connection does not state is UNKNOWN, never guessed.

    Args:
        controllers: those of the device, as `controllers_by_device` has them.
    """
    connection = written.connection
    host_address = UNKNOWN
    if connection is not None and connection.nic is not None and connection.host in spec.hosts:
        nic = spec.hosts[connection.host].nics.get(connection.nic)
        host_address = UNKNOWN if nic is None else nic.address.partition("/")[0]
    return Placeholders(
        {
            "device": name,
            "prefix": prefix,
            "stem": prefix.removesuffix("_") or name,
            "bare_prefix": prefix.removesuffix("_"),
            "address": (connection.address if connection is not None else None) or UNKNOWN,
            "port": port_of(written, spec) or UNKNOWN,
            "host_address": host_address,
            **_credentials(name, written),
            "carrier_address": _carrier_address(written, spec),
            "prefix_namespace": "/" + prefix.removesuffix("_") if prefix.removesuffix("_") else "",
            **{f"controller_{kind}": named for kind, named in controllers.items()},
        },
        port_shift=port_shift,
    )


def _credentials(name: str, written: DeviceSpec) -> dict[str, str]:
    """Return what xacro replaces by user name and password as the driver starts: no file of the package has either."""
    stated = None if written.connection is None else written.connection.credentials
    if stated is not None and stated.startswith("/"):
        return {key: f"{{yaml:{stated}:{key}}}" for key in ("username", "password")}
    variable = stated or name.upper()
    return {key: f"{{env:{variable}_{key.upper()}}}" for key in ("username", "password")}


def controllers_by_device(spec: CellSpec) -> Mapping[str, Mapping[str, str]]:
    """Return the full name of the first controller of each kind, by the device that it is of."""
    found: dict[str, dict[str, str]] = {}
    managers = (*(() if spec.control is None else (spec.control,)), *spec.managers.values())
    for manager in reversed(managers):
        for name, controller in reversed(manager.controllers.items()):
            if controller.device is not None:
                found.setdefault(controller.device, {})[controller.type] = f"{manager.namespace}/{name}"
    return found


def _carrier_address(written: DeviceSpec, spec: CellSpec) -> str:
    """Return the address of the device in whose frame this one is mounted: a tool may be reached through its arm."""
    carrier = None if written.mount is None else spec.devices.get(written.mount.parent.partition("/")[0])
    connection = None if carrier is None else carrier.connection
    return UNKNOWN if connection is None else connection.address or UNKNOWN


def port_of(written: DeviceSpec, spec: CellSpec) -> str | None:
    """Return the serial port of a device: its own, else the one that the robot forwards through which it is reached."""
    connection = written.connection
    if connection is None or connection.port is not None or connection.through is None:
        return None if connection is None else connection.port
    carrier = spec.devices.get(connection.through)
    connector = None if carrier is None else carrier.tool_connector
    return None if connector is None or connector.serial is None else connector.serial.port
