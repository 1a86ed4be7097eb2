"""Parameters of the controller manager node itself."""

from __future__ import annotations

from functools import lru_cache

from cellc.contract.frozen import dataclass
from cellc.contract.limits import limits
from cellc.contract.vocabulary import Distro, Feature, features
from cellc.mock.control.errors import ManagerAbortedError
from cellc.mock.control.parameters import Parameter, ParameterError, ParameterFile, ParameterFileError, ParameterSet
from cellc.mock.errors import LimitReachedError

NODE_NAME = "controller_manager"
_KEPT = 8


@dataclass(frozen=True, slots=True)
class ManagerSettings:
    """What the manager gets by its parameters."""

    update_rate: int
    enforce_command_limits: bool
    initially_unconfigured: tuple[str, ...]
    initially_inactive: tuple[str, ...]


@lru_cache(maxsize=_KEPT)
def read_file(text: str) -> ParameterFile:
    """Read the parameter file of the manager's process; kept, since every run of a cell starts from the same text.

    Raises:
        ManagerAbortedError: where rcl refuses it.
    """
    try:
        return ParameterFile(text)
    except ParameterFileError as error:
        raise ManagerAbortedError(
            "failed to initialize rcl: Couldn't parse params file: '--params-file controllers.yaml'. "
            f"Error: {error.reason}"
        ) from None


def read_settings(parameters: ParameterSet, distro: Distro) -> ManagerSettings:
    """Declare and read the parameters of the manager.

    Raises:
        ManagerAbortedError: where its process would end.
    """
    enforced = Feature.LIMITED_BY_DEFAULT in features(distro)
    initial = "hardware_components_initial_state."
    given = parameters.given("update_rate")
    if isinstance(given, float):
        raise ManagerAbortedError(
            "Exception thrown while initializing controller manager parameters: expected [integer] got [double]"
        )
    try:
        parameters.declare(
            (
                Parameter("update_rate", "integer", 100, (), True),
                Parameter("enforce_command_limits", "bool", enforced, (), True),
                Parameter(f"{initial}unconfigured", "string_array", [], (), True),
                Parameter(f"{initial}inactive", "string_array", [], (), True),
            )
        )
    except ParameterError as error:
        raise ManagerAbortedError(
            f"Exception thrown while initializing controller manager parameters: {error.reason}"
        ) from None
    rate = int(parameters.number("update_rate"))
    if rate <= 0:
        raise ManagerAbortedError("cannot store a negative time point in rclcpp::Time")
    if rate > limits().mock_rate:
        text = (
            f"the controller manager has an `update_rate` of {rate} Hz, at most {limits().mock_rate} Hz are simulated"
        )
        raise LimitReachedError(text)
    return ManagerSettings(
        rate,
        parameters.flag("enforce_command_limits") and Feature.LIMITED_COMMANDS in features(distro),
        parameters.texts(f"{initial}unconfigured"),
        parameters.texts(f"{initial}inactive"),
    )
