"""Numbered interfaces written out, within bounds."""

from __future__ import annotations

from cellc.compiler.catalog.device_interfaces import counted


def test_numbers_are_written_out() -> None:
    assert list(counted(["gpio/in_[0..2]", "gpio/mode"])) == ["gpio/in_0", "gpio/in_1", "gpio/in_2", "gpio/mode"]


def test_number_of_a_stranger_is_not_counted_up_to() -> None:
    # Written out it was more than the memory of the machine.
    assert list(counted(["a_[0..99999999999]"])) == ["a_[0..99999999999]"]
