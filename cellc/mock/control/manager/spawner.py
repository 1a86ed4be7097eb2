"""One call of the spawner: load, configure, activate, stopping at the first failure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cellc.mock.control.log import Log
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.manager.switch_checks import Strictness, Switch, SwitchChecker
from cellc.mock.control.messages import ServiceResponse
from cellc.mock.control.parameters import ParameterFile


@dataclass(frozen=True, slots=True)
class SpawnResponse:
    """How a spawner ended.

    Attributes:
        ok: exit status 0.
        failed: the controller at which it stopped, empty where it did not.
        reason: the manager's or controller's reason.
        not_tried: names that it did not come to.
    """

    ok: bool
    failed: str = ""
    reason: str = ""
    not_tried: tuple[str, ...] = ()


class Spawner:
    """Brings controllers up.

    Args:
        registry: the controllers.
        checker: checks the activations.
        apply: carries a switch out.
        log: the log.
    """

    def __init__(
        self, registry: ControllerRegistry, checker: SwitchChecker, apply: Callable[[Switch], None], log: Log
    ) -> None:
        self._registry = registry
        self._checker = checker
        self._apply = apply
        self._log = log

    def spawn(self, names: Sequence[str], inactive: bool, file: ParameterFile | None) -> SpawnResponse:
        """Do one call.

        Args:
            names: controllers in order.
            inactive: whether they are only configured (--inactive).
            file: parameters of --param-file.

        Returns:
            How it ended.
        """
        for index, name in enumerate(names):
            answer = self._bring_up(name, inactive, file, f"spawner_{names[0]}")
            if not answer.ok:
                return SpawnResponse(False, name, answer.message, tuple(names[index + 1 :]))
        return SpawnResponse(True)

    def _bring_up(self, name: str, inactive: bool, file: ParameterFile | None, logger: str) -> ServiceResponse:
        if name not in self._registry.controllers:
            loaded = self._registry.load(name, file)
            if not loaded.ok:
                self._log.fatal(logger, f"Failed loading controller {name}")
                return loaded
        if self._registry.controllers[name].state == "unconfigured":
            configured = self._registry.configure(name)
            if not configured.ok:
                self._log.error(logger, f"Failed to configure controller : {name}")
                return configured
        if inactive:
            return ServiceResponse(True)
        answer, switch = self._checker.check([name], [], Strictness.STRICT)
        if switch is not None:
            self._apply(switch)
        if not answer.ok:
            self._log.error(logger, f"Failed to activate controller : {name}")
        return answer
