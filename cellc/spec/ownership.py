"""Who answers for what."""

from __future__ import annotations

from pydantic import Field

from cellc.spec.base import SpecModel, Text

_UNKNOWN = "UNKNOWN"


class ResponsibilitiesSpec(SpecModel):
    """The eight responsibilities of the chapter, whatever the architecture; UNKNOWN blocks the real target."""

    frames: Text = Field(_UNKNOWN, description="Owner of frames and calibrations.", examples=["perception"])
    time: Text = Field(_UNKNOWN, description="Owner of clocks and stamps.", examples=["perception"])
    limits: Text = Field(_UNKNOWN, description="Owner of limits.", examples=["controls"])
    watchdogs: Text = Field(_UNKNOWN, description="Owner of watchdogs and timeouts.", examples=["controls"])
    command: Text = Field(_UNKNOWN, description="Owner of the command path.", examples=["integration"])
    logging: Text = Field(_UNKNOWN, description="Owner of logs and attempt records.", examples=["data"])
    vendor_safety: Text = Field(_UNKNOWN, description="Owner of the vendor's safety configuration.", examples=["robot"])
    physical_stop: Text = Field(_UNKNOWN, description="Owner of the physical stop.", examples=["safety"])


class ApprovalsSpec(SpecModel):
    """The seven approval areas of the checkpoint; UNKNOWN blocks the real target."""

    graph: Text = Field(
        _UNKNOWN, description="Is there one command publisher or action server?", examples=["integration"]
    )
    time_tf: Text = Field(
        _UNKNOWN, description="Which stamp and calibration produced the goal?", examples=["perception"]
    )
    controller: Text = Field(
        _UNKNOWN, description="Are joints, interfaces, tolerance and hold defined?", examples=["controls"]
    )
    vendor: Text = Field(_UNKNOWN, description="Are firmware, driver, mode and scaling pinned?", examples=["robot"])
    network: Text = Field(_UNKNOWN, description="Do discovery and data use controlled paths?", examples=["network"])
    safety: Text = Field(_UNKNOWN, description="Are stop, recovery and observer independent?", examples=["safety"])
    data: Text = Field(_UNKNOWN, description="Can failures be replayed by layer?", examples=["data"])


class OwnersSpec(SpecModel):
    """Owners by responsibility and by approval area."""

    responsibilities: ResponsibilitiesSpec = Field(
        default_factory=ResponsibilitiesSpec,
        description="Owner of each responsibility.",
        examples=[{"frames": "perception"}],
    )
    approvals: ApprovalsSpec = Field(
        default_factory=ApprovalsSpec, description="Owner of each approval area.", examples=[{"graph": "integration"}]
    )
