"""What programs have at the ROS graph, by their own names: nodes of a kind, and programs that no device brings."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.catalog.catalog_model import (
    CatalogModel,
    Date,
    DistroName,
    FileName,
    GraphName,
    ParameterFact,
    Text,
    Token,
)


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
    """The nodes of one program; several entries of one name are what one node has in different distributions."""

    package: Token
    executable: FileName
    nodes: tuple[InnerNodeFacts, ...] = Field(min_length=1)


class DiscouragedValue(CatalogModel):
    """A value of a parameter, or a range of values, that its program takes and that makes a cell worse.

    Attributes:
        value: The value; absent where a range is meant.
        below: What the values of a range are below.
        above: What the values of a range are above.
        does: What the program does with it, as the end of a sentence.
        source: Line of code or document from which this was read.
    """

    value: ParameterFact | None = None
    below: float | None = None
    above: float | None = None
    does: Text
    source: Text

    def holds(self, value: object) -> bool:
        """Tell whether a value is meant; of a list, whether an item is."""
        if isinstance(value, tuple):
            return any(self.holds(item) for item in value)
        if isinstance(value, (bool, str)) or self.value is not None:
            return value == self.value and isinstance(value, bool) == isinstance(self.value, bool)
        number = value if isinstance(value, (int, float)) else 0.0
        return (self.below is not None and number < self.below) or (self.above is not None and number > self.above)


class ProgramParameterFacts(CatalogModel):
    """A parameter of a program with values that it takes and that make a cell worse.

    Attributes:
        package: Package of the program.
        executables: Names of the program, one or more.
        name: Name of the parameter, dots for nesting, ``<group>`` for any name.
        only: Distributions of which this is so; empty for all.
        discouraged: The values.
    """

    package: Token
    executables: tuple[FileName, ...] = Field(min_length=1)
    name: Text
    only: tuple[DistroName, ...] = ()
    discouraged: tuple[DiscouragedValue, ...] = Field(min_length=1)


NodeKind = Literal["node", "lifecycle", "controller", "component", "transforms"]


class ProgramTable(CatalogModel):
    """``catalog/programs.yaml``."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    implied: dict[NodeKind, tuple[ImpliedFacts, ...]]
    programs: tuple[ProgramFacts, ...]
    parameters: tuple[ProgramParameterFacts, ...] = ()
