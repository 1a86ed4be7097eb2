"""Who does the units of a call: processes of this machine, or the workers of a cluster."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cellc.contract.frozen import dataclass

if TYPE_CHECKING:
    from cellc.contract.compute.work import ExecutorFactory


@dataclass(frozen=True, slots=True)
class Fan:
    """Who does it.

    Attributes:
        jobs: processes; None for as many as pay.
        cluster: address of a scheduler of Dask whose workers do it instead.
    """

    jobs: int | None = None
    cluster: str | None = None

    def factory(self, usual: int, tell: Callable[[str], None]) -> ExecutorFactory | None:
        """Return who executes units; None for this process alone.

        Args:
            usual: processes where no number was asked for.
            tell: called with what a person should know while nothing is done.
        """
        # Both load for longer than a small unit takes.
        if self.cluster is not None:
            from cellc.contract.compute.cluster import cluster

            return cluster(self.cluster, tell)
        number = usual if self.jobs is None else self.jobs
        if number <= 1:
            return None
        from cellc.contract.compute.processes import processes

        return processes(number)


USUAL = Fan()
