"""What the controller of a robot can be told, and who can start the program on it."""

from typing import Literal

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, NodeName, ParameterFact, Text, Token


class ProgramWay(CatalogModel):
    """One way in which the program on the robot comes to run.

    ``parameters`` are given to the hardware plugin, ``node_parameters`` to nodes of the driver, where it is chosen.
    """

    name: Literal["pendant", "dashboard", "headless"]
    by: Literal["person", "driver"]
    mode: Literal["local", "remote"]
    parameters: dict[Text, Text] = Field(default_factory=dict)
    node_parameters: dict[NodeName, dict[Text, ParameterFact]] = Field(default_factory=dict)


class ProgramFacts(CatalogModel):
    """The program on the robot through which set points pass; the first way is that of a spec that says nothing."""

    ways: tuple[ProgramWay, ...] = Field(min_length=1)
    source: Text

    def way(self, by: str, mode: str) -> ProgramWay | None:
        """Return the way of ``person`` or ``driver`` in a mode."""
        return next((one for one in self.ways if (one.by, one.mode) == (by, mode)), None)


class CenterFacts(CatalogModel):
    """Where the robot says where its TCP is: a topic of a kind of controller."""

    controller: Token
    topic: Token
    source: Text


class RobotControllerFacts(CatalogModel):
    """What the robot's own controller can be told.

    ``payload_service`` says which service tells it the payload, and when; ``thresholds`` which takes those of
    collisions.
    """

    program: ProgramFacts | None = None
    tcp: CenterFacts | None = None
    payload_service: Text | None = None
    thresholds: Text | None = None


StepCondition = Literal[
    "pendant",
    "dashboard",
    "headless",
    "payload_by_installation",
    "payload_by_service",
    "thresholds_stated",
    "thresholds_open",
]
"""What a spec may say of a device, so that people do one thing or the other."""
