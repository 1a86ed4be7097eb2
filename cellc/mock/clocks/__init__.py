"""Clocks of hosts and devices: stamps are made on one, ages are measured on another."""

from cellc.mock.clocks.build import build_clocks
from cellc.mock.clocks.clock import Clock, Segment
from cellc.mock.clocks.clocks import DEFAULT, Clocks, TimeJump

__all__ = ["DEFAULT", "Clock", "Clocks", "Segment", "TimeJump", "build_clocks"]
