"""What holds for every cell: ROS 2 distributions, interface types, QoS profiles, endpoints that every cell has."""

from collections.abc import Iterable, Mapping
from typing import Literal

from pydantic import Field

from cellc.compiler.catalog.catalog_model import CatalogModel, Date, DistroName, ParameterFact, Text, Token
from cellc.compiler.catalog.parameter_facts import ParameterFacts
from cellc.compiler.spec.quantity import Duration
from cellc.contract.entities import Durability, Reliability
from cellc.contract.frozen import dataclass


class CatalogTable(CatalogModel):
    """A file of facts: the version of its notation, the day on which they were read, and where."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)


class DistroFacts(CatalogModel):
    """One distribution."""

    title: Text
    released: Text
    end_of_life: Date
    end_of_life_note: Text | None = None
    lts: bool
    os: tuple[Text, ...] = Field(min_length=1)
    os_tier3: tuple[Text, ...] = ()
    python: Text
    default_rmw: Token
    rmw: tuple[Token, ...] = Field(min_length=1)
    rmw_unverified: tuple[Token, ...] = ()
    packages: dict[Token, Text]
    action_remap_by_one_rule: bool
    description_by: Literal["parameter", "topic"]
    mock_plugin: Text
    mock_parameters: dict[Token, ParameterFact]


class DistroTable(CatalogTable):
    """``catalog/distros.yaml``: every figure holds as of ``as_of`` and grows old."""

    distros: dict[DistroName, DistroFacts]
    dead_mock_parameters: dict[Text, Text]
    harmless_plugins: dict[Text, Text] = Field(min_length=1)
    simulators: dict[Token, Text] = Field(min_length=1)
    harmless_programs: dict[Text, Text] = Field(min_length=1)
    hardware_packages: dict[Token, Text] = Field(min_length=1)


@dataclass(frozen=True, slots=True)
class ReleaseSet:
    """Packages that belong together: those of a sync of a distribution, or of a vendor's release, then ``built``."""

    name: str
    packages: Mapping[str, str]
    built: bool = False


class VendorBuild(CatalogModel):
    """What a vendor's release on one distribution is built with, each package with its version."""

    name: Text
    distro: DistroName
    packages: dict[Token, Text] = Field(min_length=1)


class ReleaseTable(CatalogTable):
    """``catalog/releases.yaml``: a package has a version from the day of one sync of a distribution until the next."""

    syncs: dict[Token, dict[DistroName, dict[Date, Text]]]
    builds: tuple[VendorBuild, ...] = ()

    def sets(self, distro: str) -> tuple[ReleaseSet, ...]:
        """Return what belonged together on a distribution, the newest first; a vendor's own releases stand last."""
        versions = {package: of[here] for package, of in self.syncs.items() for here in of if here == distro}
        days = sorted({day for of in versions.values() for day in of}, reverse=True)
        synced = [
            ReleaseSet(
                f"{distro} of {day}", {name: of[_latest(of, day)] for name, of in versions.items() if min(of) <= day}
            )
            for day in days
        ]
        built = [ReleaseSet(build.name, build.packages, built=True) for build in self.builds if build.distro == distro]
        return (*synced, *reversed(built))


def _latest(days: Iterable[str], until: str) -> str:
    return max(day for day in days if day <= until)


class PackageTable(CatalogTable):
    """``catalog/packages.yaml``: packages that others install, by name and by what the names of a family begin with."""

    prefixes: tuple[Token, ...] = Field(min_length=1)
    packages: tuple[Token, ...] = Field(min_length=1)

    def has(self, name: str) -> bool:
        """Whether a name is that of a package in the table."""
        return name in self.packages or name.startswith(self.prefixes)


class ControllerManagerFacts(CatalogTable):
    """``catalog/controller_manager.yaml``: parameters of the manager's node and of every controller's node."""

    package: Token
    executable: Token
    parameters: dict[Text, ParameterFacts]
    controller_parameters: dict[Text, ParameterFacts]


class InterfaceTypeFacts(CatalogModel):
    """One type; ``unit`` where the definition fixes it, ``stamped`` where it carries a std_msgs/Header."""

    unit: Text | None = None
    stamped: bool = False
    feeds_motion: bool = False
    only: tuple[DistroName, ...] = ()


class InterfaceTypeTable(CatalogTable):
    """``catalog/message_types.yaml``: keys are full names such as ``sensor_msgs/msg/Image``."""

    types: dict[Text, InterfaceTypeFacts]

    def kind_of(self, name: str) -> Literal["topic", "service", "action"] | None:
        """Tell what a known type is for, or None where it is not known."""
        if name not in self.types:
            return None
        kinds: dict[str, Literal["topic", "service", "action"]] = {
            "msg": "topic",
            "srv": "service",
            "action": "action",
        }
        return kinds[name.split("/")[1]]


Rmw = Literal["rmw_fastrtps_cpp", "rmw_cyclonedds_cpp", "rmw_zenoh_cpp"]
RMWS: tuple[Rmw, ...] = ("rmw_fastrtps_cpp", "rmw_cyclonedds_cpp", "rmw_zenoh_cpp")


class QosProfile(CatalogModel):
    """One profile; ``system_default`` and ``best_available`` settings are decided by the middleware."""

    history: Literal["keep_last", "keep_all", "system_default"]
    depth: int = Field(ge=0)
    reliability: Literal["reliable", "best_effort", "system_default", "best_available"]
    durability: Literal["volatile", "transient_local", "system_default", "best_available"]
    lifespan: Duration | None = None


class SystemDefault(CatalogModel):
    """What an RMW makes of ``system_default`` at one kind of endpoint."""

    reliability: Reliability
    durability: Durability
    depth: int = Field(ge=1)


class SystemDefaults(CatalogModel):
    """Both ends; they differ with Fast DDS."""

    writer: SystemDefault
    reader: SystemDefault


class KnownEndpoint(CatalogModel):
    """An endpoint whose profile its author fixed; ``overridable`` where a parameter may change it."""

    topic: Text
    type: Text
    node: Text
    direction: Literal["publish", "subscribe"]
    qos: Token
    overridable: bool = False
    source: Text

    @property
    def is_of_a_program(self) -> bool:
        """Whether `node` names a package, or a program in it; words for what has the end have spaces."""
        return " " not in self.node


class QosTable(CatalogTable):
    """``catalog/qos_profiles.yaml``."""

    profiles: dict[Token, QosProfile]
    system_default: dict[Rmw, SystemDefaults]
    endpoints: tuple[KnownEndpoint, ...]
    action: dict[Literal["send_goal", "cancel_goal", "get_result", "feedback", "status"], Token]


class PlannerPlugin(CatalogModel):
    """A plugin of MoveIt, with what it gets, and the distributions that release its package."""

    plugin: Text
    package: Token
    distros: tuple[DistroName, ...]
    parameters: dict[Text, ParameterFact] = Field(default_factory=dict)
    source: Text


class PipelineFacts(PlannerPlugin):
    """A planning pipeline.

    ``timed`` where it states its own times, ``joint_goals`` where it takes no others, ``avoids_nothing`` where it
    refuses what is in its way.
    """

    timed: bool = False
    joint_goals: bool = False
    avoids_nothing: bool = False
    capabilities: tuple[Text, ...] = ()


class PlannerTable(CatalogTable):
    """``catalog/moveit.yaml``: what solves inverse kinematics, what plans, and the planners of OMPL."""

    solvers: dict[Token, PlannerPlugin]
    pipelines: dict[Token, PipelineFacts]
    planners: tuple[Token, ...]
    planners_source: Text
