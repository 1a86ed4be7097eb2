"""The connector at the tool frame of a robot: the voltage that it gives, and its serial line."""

from typing import Annotated, Literal

from pydantic import Field, StringConstraints

from cellc.compiler.spec.quantity import Voltage
from cellc.contract.stated import StatedModel

Parity = Literal["none", "odd", "even"]
StopBits = Literal[1, 2]
BaudRate = Annotated[int, Field(ge=50, le=20_000_000)]

DeviceNode = Annotated[str, StringConstraints(pattern=r"^(/[A-Za-z0-9_.-]+)+$", max_length=100)]
"""What a tool makes in the file system: of characters that no shell reads otherwise."""


class ToolSerialSpec(StatedModel):
    """The serial line of a tool connector, which the robot forwards to the computer of its driver."""

    port: DeviceNode = Field(
        ..., description="Device node that it becomes on that computer.", examples=["/run/user/1000/arm_tool"]
    )
    baud_rate: BaudRate = Field(..., description="Baud rate.", examples=[115200])
    parity: Parity = Field("none", description="Parity.", examples=["none"])
    stop_bits: StopBits = Field(1, description="Stop bits.", examples=[1])
    rx_idle_chars: float | None = Field(
        None,
        description="Silence that ends a received message, in characters; the robot's usual one if absent.",
        examples=[1.5],
        ge=0.0,
        le=1000.0,
    )
    tx_idle_chars: float | None = Field(
        None,
        description="Silence on the line before the tool transmits, in characters; the robot's usual one if absent.",
        examples=[3.5],
        ge=0.0,
        le=1000.0,
    )
    tcp_port: int | None = Field(
        None,
        description="Port of the robot on which it is forwarded; the robot's usual one if absent.",
        examples=[54321],
        ge=1,
        le=65535,
    )


class ToolConnectorSpec(StatedModel):
    """What the tool connector of a robot gives to the tools that have their power from it."""

    voltage: Voltage = Field(..., description="Voltage that it gives.", examples=["24 V"])
    serial: ToolSerialSpec | None = Field(
        None,
        description="Serial line that the robot forwards; none if absent.",
        examples=[{"port": "/run/user/1000/arm_tool", "baud_rate": 115200}],
    )
