"""What programs have at the ROS graph, by their own names: nodes of a kind, and programs that no device brings."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.catalog.catalog_model import (
    CatalogModel,
    Date,
    DistroName,
    FileName,
    GraphName,
    Text,
    Token,
)
from cellc.compiler.catalog.parameter_facts import ParameterFacts


class EndpointFacts(CatalogModel):
    """What a program has in the ROS graph besides what every node has; a name below its own begins with ``~/``.

    Attributes:
        publishes: Topics that it publishes.
        subscribes: Topics that it subscribes to.
        serves: Services that it answers.
        requests: Services that it calls.
        executes: Actions that it executes.
        source: Line of code or document from which this was read.
    """

    publishes: tuple[GraphName, ...] = ()
    subscribes: tuple[GraphName, ...] = ()
    serves: tuple[GraphName, ...] = ()
    requests: tuple[GraphName, ...] = ()
    executes: tuple[GraphName, ...] = ()
    source: Text


class ImpliedFacts(EndpointFacts):
    """What every node of a kind has.

    Attributes:
        only: Distributions of which this is so; empty for all.
    """

    only: tuple[DistroName, ...] = ()


class InnerNodeFacts(ImpliedFacts):
    """A node of a process.

    Attributes:
        name: Name of the node; one that differs at every start ends with ``*``.
        parameters: Whether the node serves parameters.
    """

    name: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_{}/]+\*?\Z", max_length=100)]
    parameters: bool = True


class ProgramFacts(CatalogModel):
    """The nodes of one program; several entries of one name are what one node has in different distributions.

    ``types`` are those of what its first node has, by the names there.
    """

    package: Token
    executable: FileName
    types: dict[GraphName, Text] = Field(default_factory=dict)
    nodes: tuple[InnerNodeFacts, ...] = Field(min_length=1)


NodeKind = Literal["node", "lifecycle", "controller", "component", "transforms"]


class ProgramTable(CatalogModel):
    """``catalog/programs.yaml``."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    implied: dict[NodeKind, tuple[ImpliedFacts, ...]]
    programs: tuple[ProgramFacts, ...]


class ProgramParameters(CatalogModel):
    """What programs declare, or read of what they are started with, in some distributions.

    Attributes:
        package: Package of the programs.
        executables: Names of the programs, one or more.
        only: Distributions of which this is so; empty for all.
        prefix: What each name begins with.
        closed: Whether they read nothing else; absent where plugins of others have parameters of their own.
        parameters: The parameters by name, dots for nesting, ``<group>`` for any name.
        source: Where they are declared.
    """

    package: Token
    executables: tuple[FileName, ...] = Field(min_length=1)
    only: tuple[DistroName, ...] = ()
    prefix: Annotated[str, StringConstraints(pattern=r"^([A-Za-z0-9_]+\.)*\Z", max_length=100)] = ""
    closed: bool = False
    parameters: dict[Text, ParameterFacts]
    source: Text


class ProgramParameterTable(CatalogModel):
    """``catalog/program_parameters.yaml``."""

    format: Literal[1]
    as_of: Date
    programs: tuple[ProgramParameters, ...]
