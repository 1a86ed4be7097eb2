"""Interface types that a cell may name, with the payload's unit and frame conventions."""


from typing import Literal

from pydantic import Field

from cellc.catalog.catalog_model import CatalogModel, Date, Distro, Text


class InterfaceTypeFacts(CatalogModel):
    """One type; ``unit`` where the definition fixes it, ``stamped`` where it carries a std_msgs/Header."""

    unit: Text | None = None
    stamped: bool = False
    feeds_motion: bool = False
    only: tuple[Distro, ...] = ()


class InterfaceTypeTable(CatalogModel):
    """``catalog/message_types.yaml``: keys are full names such as ``sensor_msgs/msg/Image``."""

    format: Literal[1]
    as_of: Date
    sources: tuple[Text, ...] = Field(min_length=1)
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
