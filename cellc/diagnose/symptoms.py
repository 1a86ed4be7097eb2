"""What is known of symptoms: data with a source each, in which no step can change anything."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from string import Formatter
from typing import Literal

from pydantic import Field, field_validator, model_validator

from cellc.catalog.catalog_model import CatalogModel, Text
from cellc.catalog.read_model import read_model
from cellc.diagnose.subjects import FIELDS, Scope

LAYERS = ("network", "qos", "time", "lifecycle", "ownership", "vendor", "tool", "safety")
"""The layers in the order in which they are ruled out."""
Area = Literal["graph", "time_tf", "controller", "vendor", "network", "safety", "data"]

# Commands that read. Anything else, such as a switch, a parameter set or a published message, is refused as data.
_READING = re.compile(
    r"ros2 (topic (info|list|echo --once|hz|delay|type)|node (list|info)|param (get|list|dump)|action (info|list)"
    r"|service (list|type)|lifecycle (get|nodes)|control list_\w+|pkg prefix|doctor --report"
    r"|run tf2_ros tf2_(echo|monitor))\b[^;&|<>`$]*"
    r"|printenv [A-Z_]+|ip -brief address|ip -statistics link show|chronyc tracking"
)


class Observation(CatalogModel):
    """One thing to look at, by a command that reads or by eye, and what would rule the hypothesis out."""

    of: Scope
    run: Text | None = None
    look: Text | None = None
    refuted: Text

    @field_validator("run")
    @classmethod
    def _only_reads(cls, run: str | None) -> str | None:
        if run is not None and not _READING.fullmatch(run):
            raise ValueError(f"`{run}` is no command that only reads")
        return run

    @model_validator(mode="after")
    def _names_its_subject(self) -> Observation:
        if (self.run is None) == (self.look is None):
            raise ValueError("an observation either runs a command or looks at something")
        for text in (self.run or "", self.look or "", self.refuted):
            unknown = {name for _, name, _, _ in Formatter().parse(text) if name is not None} - set(FIELDS[self.of])
            if unknown:
                raise ValueError(f"`{self.of}` has no {', '.join(sorted(unknown))}")
        return self


class Hypothesis(CatalogModel):
    """One cause and how to rule it out."""

    cause: Text
    observations: tuple[Observation, ...] = Field(min_length=1)


class Symptom(CatalogModel):
    """What somebody sees, or a program logs.

    Args:
        said: lists of word beginnings; a text matches where it has all words of one list.
        logged: patterns of log lines; groups name what the line speaks of.
        never: the shortcut that hides the cause or takes a protection away.
    """

    name: Text
    never: Text
    source: Text
    said: tuple[tuple[Text, ...], ...] = ()
    logged: tuple[Text, ...] = ()
    hypotheses: tuple[Hypothesis, ...] = Field(min_length=1)

    @field_validator("logged")
    @classmethod
    def _compiles(cls, logged: tuple[str, ...]) -> tuple[str, ...]:
        for pattern in logged:
            re.compile(pattern)
        return logged


class LayerKnowledge(CatalogModel):
    """One layer: its symptoms and the approval area whose owner decides."""

    layer: Literal["network", "qos", "time", "lifecycle", "ownership", "vendor", "tool", "safety"]
    title: Text
    owner: Area
    symptoms: tuple[Symptom, ...] = Field(min_length=1)


FOLDER = Path(__file__).parent / "knowledge"


@cache
def knowledge() -> tuple[LayerKnowledge, ...]:
    """Return every layer, in the order in which they are ruled out.

    Raises:
        ValueError: a file of the package is not what its model says; tests hold that none is.
    """
    return tuple(_layer(name) for name in LAYERS)


def _layer(name: str) -> LayerKnowledge:
    read = read_model(FOLDER / f"{name}.yaml", f"{name}.yaml", LayerKnowledge)
    if read.value is None:
        raise ValueError("; ".join(f"{found.span}: {found.message}" for found in read.diagnostics))
    return read.value[0]
