"""Entries of the catalog by name, each read once for the life of the process."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import field, replace
from functools import lru_cache
from pathlib import Path

from cellc.compiler.catalog.against_description import description_faults
from cellc.compiler.catalog.compiled import (
    CATALOG,
    DEVICE_FILE,
    FAMILY_FILE,
    SHOWN,
    compiled_device,
    compiled_table,
    device_file,
)
from cellc.compiler.catalog.control_faults import control_faults
from cellc.compiler.catalog.controller_kind import ControllerKind
from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.family import read_entry
from cellc.compiler.catalog.figure_bounds import implausible_figures
from cellc.compiler.catalog.jaws import gripper_faults
from cellc.compiler.catalog.joint_figures import wrong_joint_figures
from cellc.compiler.catalog.names import CatalogNames, unknown_names
from cellc.compiler.catalog.programs import ProgramParameterTable, ProgramTable
from cellc.compiler.catalog.read_model import ModelT, read_model, validated
from cellc.compiler.catalog.tables import (
    ControllerManagerFacts,
    DistroTable,
    InterfaceTypeTable,
    PackageTable,
    PlannerTable,
    QosTable,
    ReleaseTable,
)
from cellc.compiler.source.document import SourceDocument
from cellc.contract.diagnostics import Diagnostic, Outcome
from cellc.contract.frozen import dataclass
from cellc.contract.limits import Budget
from cellc.contract.vocabulary import OF_ONE_DEVICE
from cellc.robot.description.model import Description
from cellc.robot.description.urdf_reader import read_urdf


@dataclass(frozen=True, slots=True)
class CatalogDevice:
    """A device of the catalog: its facts, and its description without prefix.

    Args:
        document: its file where the user wrote it; None of an entry that was compiled.
    """

    model: DeviceModel
    description: Description
    document: SourceDocument | None = field(default=None, compare=False, repr=False)


@lru_cache(maxsize=1)
def device_names() -> tuple[str, ...]:
    """Name the devices of the catalog, in alphabetical order."""
    files = (file for file in (CATALOG / "devices").glob("*/*.yaml") if not file.name.endswith(FAMILY_FILE))
    return tuple(sorted(file.parent.name if file.name == DEVICE_FILE else file.stem for file in files))


@lru_cache(maxsize=1)
def controller_kinds() -> tuple[str, ...]:
    """Name the neutral controller kinds, in alphabetical order."""
    return tuple(sorted(file.stem for file in (CATALOG / "controllers").glob("*.yaml")))


@lru_cache(maxsize=64)
def load_device(name: str) -> Outcome[CatalogDevice]:
    """Load a device of the catalog.

    Args:
        name: one of ``device_names()``.

    Raises:
        KeyError: the catalog lists no such device; who asks for a name of the user's tells the user first.
    """
    if name not in device_names():
        raise KeyError(name)
    compiled = compiled_device(name)
    if compiled is None:
        return read_device(name)
    facts, urdf, places = compiled
    description = read_urdf(urdf, f"{SHOWN}/devices/{name}", places)
    assert description.value is not None  # it was valid when it was compiled
    model = DeviceModel.model_validate_json(facts)
    return Outcome(CatalogDevice(model, model.limits.on(description.value)))


def read_device(name: str) -> Outcome[CatalogDevice]:
    """Read the files of a device of the catalog."""
    from cellc.robot.description.read_description import read_catalog_description

    devices = CATALOG / "devices"
    shown = f"{SHOWN}/devices"

    def read(file: Path, arguments: dict[str, str]) -> Outcome[Description]:
        return read_catalog_description(file, arguments, devices, shown)

    file = device_file(name)
    return _load(file, f"{shown}/{file.relative_to(devices).as_posix()}", devices, read)


def load_device_folder(
    folder: Path, root: Path, budget: Budget | None = None, packages: Sequence[str] = ()
) -> Outcome[CatalogDevice]:
    """Load a device that the user wrote: a folder with ``device.yaml`` and its description.

    Args:
        folder: the folder, as the user named it.
        root: the folder that the description and all it includes must lie under.
        budget: what expansions of the spec may still take; as much as one may where it is absent.
        packages: further folders of packages that the spec names.
    """
    return load_device_file(folder / DEVICE_FILE, root, budget, packages)


def load_device_file(
    file: Path, root: Path, budget: Budget | None = None, packages: Sequence[str] = ()
) -> Outcome[CatalogDevice]:
    """Load a device by its file; arguments as of `load_device_folder`."""
    from cellc.robot.description.read_description import read_description

    def read(file: Path, arguments: dict[str, str]) -> Outcome[Description]:
        return read_description(file, arguments, root, budget, packages)

    return _load(file, file.as_posix(), root, read)


def _load(
    file: Path, shown: str, root: Path, read: Callable[[Path, dict[str, str]], Outcome[Description]]
) -> Outcome[CatalogDevice]:
    entry = read_entry(file, shown, root)
    if entry.value is None:
        return Outcome(None, entry.diagnostics)
    facts = validated(entry.value, DeviceModel)
    if facts.value is None:
        return Outcome(None, facts.diagnostics)
    model, document = facts.value
    described = file.parent / model.description.file
    description = read(described, model.description.arguments)
    if description.value is None:
        return Outcome(
            None, tuple(_at_its_name(diagnostic, described, document) for diagnostic in description.diagnostics)
        )
    profiles = load_qos_profiles().value
    assert profiles is not None  # package data, held valid by the catalog's tests
    known = CatalogNames({*controller_kinds(), *OF_ONE_DEVICE}, set(profiles.profiles))
    limited = model.limits.on(description.value)
    wrong = (*unknown_names(model, limited, document, known), *wrong_joint_figures(model, limited, document))
    robot = limited.without_leaderless() if "mimic-of-nothing" in model.excused else limited
    device = None if wrong else CatalogDevice(model, robot, document)
    doubtful = () if wrong else tuple(_doubtful(model, description.value, robot, document))
    return Outcome(device, description.diagnostics + wrong + doubtful)


def _doubtful(
    model: DeviceModel, written: Description, robot: Description, document: SourceDocument
) -> Iterator[Diagnostic]:
    """Yield what does not keep a device from being bound.

    Args:
        written: the description as it is in its file; ``robot`` has the limits of the model.
    """
    distros = load_distros().value
    assert distros is not None  # package data, held valid by the catalog's tests
    yield from implausible_figures(model, robot, document)
    yield from gripper_faults(model, robot, document)
    yield from control_faults(model, robot, document, distros)
    yield from description_faults(model, written, document, set(distros.harmless_plugins))


def _at_its_name(found: Diagnostic, file: Path, document: SourceDocument) -> Diagnostic:
    """Return what is said of a description that is not there as said of its name: there is no file to point into."""
    path = ("description", "file")
    named = found.code == "xacro-file-not-found" and found.span.file == file.as_posix()
    missing = named and not file.is_file()  # or a file that it includes is not there, and its line says so
    return replace(found, span=document.locate(path), yaml_path=path) if missing else found


@lru_cache(maxsize=32)
def load_controller_kind(kind: str) -> Outcome[ControllerKind]:
    """Load a neutral controller kind.

    Args:
        kind: one of ``controller_kinds()``.

    Raises:
        KeyError: the catalog lists no such kind; who asks for a name of the user's tells the user first.
    """
    if kind not in controller_kinds():
        raise KeyError(kind)
    return _table(f"controllers/{kind}.yaml", ControllerKind)


@lru_cache(maxsize=1)
def load_distros() -> Outcome[DistroTable]:
    """Load the table of ROS 2 distributions."""
    return _table("distros.yaml", DistroTable)


@lru_cache(maxsize=1)
def load_controller_manager() -> Outcome[ControllerManagerFacts]:
    """Load the parameters of the controller manager."""
    return _table("controller_manager.yaml", ControllerManagerFacts)


@lru_cache(maxsize=1)
def load_message_types() -> Outcome[InterfaceTypeTable]:
    """Load the interface types that are known."""
    return _table("message_types.yaml", InterfaceTypeTable)


@lru_cache(maxsize=1)
def load_packages() -> Outcome[PackageTable]:
    """Load the packages that no cell is named after."""
    return _table("packages.yaml", PackageTable)


@lru_cache(maxsize=1)
def load_planners() -> Outcome[PlannerTable]:
    """Load what MoveIt may solve and plan with."""
    return _table("moveit.yaml", PlannerTable)


@lru_cache(maxsize=1)
def load_programs() -> Outcome[ProgramTable]:
    """Load what nodes and programs have at the ROS graph."""
    return _table("programs.yaml", ProgramTable)


@lru_cache(maxsize=1)
def load_program_parameters() -> Outcome[ProgramParameterTable]:
    """Load what programs declare, or read of what they are started with."""
    return _table("program_parameters.yaml", ProgramParameterTable)


@lru_cache(maxsize=1)
def load_releases() -> Outcome[ReleaseTable]:
    """Load which versions were released together."""
    return _table("releases.yaml", ReleaseTable)


@lru_cache(maxsize=1)
def load_qos_profiles() -> Outcome[QosTable]:
    """Load the named QoS profiles."""
    return _table("qos_profiles.yaml", QosTable)


def _table(file: str, model: type[ModelT]) -> Outcome[ModelT]:
    compiled = compiled_table(file)
    if compiled is not None:
        return Outcome(model.model_validate_json(compiled))
    read = read_model(CATALOG / file, f"{SHOWN}/{file}", model)
    return Outcome(None if read.value is None else read.value[0], read.diagnostics)


def kind_behind(type_: str, device: DeviceModel | None) -> ControllerKind | None:
    """Return what the catalog says of a type of controller, or None where it has no such type.

    Args:
        type_: the type as the spec writes it.
        device: the device that the controller is of, if it is of any.

    Returns:
        The neutral kind, that which a device's variant acts as, or a kind of the device itself.
    """
    device_kind = None if device is None else device.controllers.get(type_)
    if device_kind is None:
        return load_controller_kind(type_).value if type_ in controller_kinds() else None
    assert device is not None  # it has the controller
    kind = device_kind.own_kind(device.as_of)
    return kind if kind is not None else load_controller_kind(device_kind.behavior).value
