"""What programs have at the ROS graph, by their own names: nodes of a kind, and programs that no device brings."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.catalog.catalog_model import CatalogModel, Date, DistroName, FileName, GraphName, Text, Token


class EndpointFacts(CatalogModel):
    """What a program has at the ROS graph besides what every node has: names as it says them, ``~/`` below its own."""

    publishes: tuple[GraphName, ...] = ()
    subscribes: tuple[GraphName, ...] = ()
    serves: tuple[GraphName, ...] = ()
    requests: tuple[GraphName, ...] = ()
    executes: tuple[GraphName, ...] = ()
    source: Text


class ImpliedFacts(EndpointFacts):
    """What every node of a kind has; ``only`` empty means every distribution."""

    only: tuple[DistroName, ...] = ()


class InnerNodeFacts(ImpliedFacts):
    """A node of a process; a name that differs at every start ends with ``*``; ``parameters`` where it serves them."""

    name: Annotated[str, StringConstraints(pattern=r"^[A-Za-z0-9_{}/]+\*?\Z", max_length=100)]
    parameters: bool = True


class ProgramFacts(CatalogModel):
    """The nodes of one program; several entries of one name are what one node has in different distributions."""

    package: Token
    executable: FileName
    nodes: tuple[InnerNodeFacts, ...] = Field(min_length=1)


NodeKind = Literal["node", "lifecycle", "controller", "component", "transforms"]


class ProgramTable(CatalogModel):
    """``catalog/programs.yaml``."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    implied: dict[NodeKind, tuple[ImpliedFacts, ...]]
    programs: tuple[ProgramFacts, ...]
