"""ROS 2 distributions: platforms, end of life, released package versions, middleware."""


from typing import Literal

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, Date, Distro, ParameterFact, Text, Token
from cellc.catalog.controller_kind import ParameterFacts


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


class DistroTable(CatalogModel):
    """``catalog/distros.yaml``: every figure holds as of ``as_of`` and grows old."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    distros: dict[Distro, DistroFacts]
    dead_mock_parameters: dict[Text, Text]


class ControllerManagerFacts(CatalogModel):
    """``catalog/controller_manager.yaml``: parameters of the manager's node and of every controller's node."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
    package: Token
    executable: Token
    parameters: dict[Text, ParameterFacts]
    controller_parameters: dict[Text, ParameterFacts]
