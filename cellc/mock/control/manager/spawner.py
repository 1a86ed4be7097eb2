"""One call of the spawner: load, configure, activate, stopping at the first failure."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cellc.mock.control.log import Log
from cellc.mock.control.manager.registry import ControllerRegistry
from cellc.mock.control.manager.switching import Strictness, Switch, Switcher
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


def spawn(
    names: Sequence[str],
    inactive: bool,
    file: ParameterFile | None,
    registry: ControllerRegistry,
    switcher: Switcher,
    apply: Callable[[Switch], None],
    log: Log,
) -> SpawnResponse:
    """Bring controllers up.

    Args:
        names: controllers in order.
        inactive: whether they are only configured (--inactive).
        file: parameters of --param-file.
        registry: the controllers.
        switcher: checks the activations.
        apply: carries a switch out.
        log: the log.

    Returns:
        How it ended.
    """
    logger = f"spawner_{names[0]}" if names else "spawner"
    for index, name in enumerate(names):
        rest = tuple(names[index + 1 :])
        if name not in registry.controllers:
            loaded = registry.load(name, file)
            if not loaded.ok:
                log.fatal(logger, f"Failed loading controller {name}")
                return SpawnResponse(False, name, loaded.message, rest)
        if registry.controllers[name].state == "unconfigured":
            configured = registry.configure(name)
            if not configured.ok:
                log.error(logger, f"Failed to configure controller : {name}")
                return SpawnResponse(False, name, configured.message, rest)
        if inactive:
            continue
        answer = _activate(name, switcher, apply)
        if not answer.ok:
            log.error(logger, f"Failed to activate controller : {name}")
            return SpawnResponse(False, name, answer.message, rest)
    return SpawnResponse(True)


def _activate(name: str, switcher: Switcher, apply: Callable[[Switch], None]) -> ServiceResponse:
    answer, switch = switcher.check([name], [], Strictness.STRICT)
    if switch is not None:
        apply(switch)
    return answer
