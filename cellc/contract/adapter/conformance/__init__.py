"""Checks that every implementation of `DeviceAdapter` passes: run them against yours before the cell relies on it.

With pytest, for a device at its bench::

    @pytest.mark.parametrize("case", CASES, ids=str)
    def test_my_arm_keeps_the_contract(case: ConformanceCase) -> None:
        case.run(MyRig())

A rig makes fresh adapters and lets time pass. The checks move the first joint by a few command periods at a tenth of
its greatest speed: on real hardware with the area clear, the observer at the stop, and reduced limits.
"""

from cellc.contract.adapter.conformance.commands import COMMAND_CASES, WATCHDOG_CASES
from cellc.contract.adapter.conformance.lifecycle import LIFECYCLE_CASES, ConformanceCase, Rig

CASES: tuple[ConformanceCase, ...] = (*LIFECYCLE_CASES, *COMMAND_CASES, *WATCHDOG_CASES)

__all__ = ["CASES", "ConformanceCase", "Rig"]
