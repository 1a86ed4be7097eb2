"""Rules on parameters of controllers and drivers."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator

from cellc.compiler.catalog.parameter_facts import ParameterFacts, is_named
from cellc.compiler.cell.interface import ParameterValue
from cellc.compiler.cell.robot import Impedance, ImpedanceFacts
from cellc.compiler.graph.claims import written_parameters
from cellc.compiler.graph.stated_parameters import stated_parameters
from cellc.compiler.rules.kit import CellGraph, Findings, Severity, did_you_mean, found, rule
from cellc.contract.vocabulary import TRAJECTORIES


@rule(Severity.WARNING)
def discouraged_parameter(graph: CellGraph) -> Findings:
    """Yield values that a controller or program accepts, of which the catalog says that they make the cell worse."""
    for parameter in stated_parameters(graph.cell):
        facts, worse = parameter.facts, parameter.worse()
        if facts is None or worse is None:
            continue
        useless = worse.is_any or facts.default is None or worse.holds(facts.default, parameter.beside)
        advice = "delete the line" if useless else f"delete the line: the default is `{facts.default}`"
        message = f"`{parameter.name}` of `{parameter.owner}` is `{_shown(parameter.value)}`: {worse.does}"
        yield found(graph, parameter.path, message, advice)


_GAIN = re.compile(r"gains\.(.+)\.[pid]")
_OTHER_GAIN = 5.0
"""Ratio above which a loop has another bandwidth, not another tuning."""


@rule(Severity.WARNING)
def gain_against_vendor(graph: CellGraph) -> Findings:
    """Yield gains of the spec that are many times those of the vendor for the same joint, or a fraction of them."""
    for parameter in written_parameters(graph.cell):
        value, usual = parameter.value, parameter.controller.vendor_parameters.get(parameter.name)
        named = _GAIN.fullmatch(parameter.name)
        if named is None or not isinstance(value, float) or not isinstance(usual, float) or min(value, usual) <= 0.0:
            continue
        if not 1.0 / _OTHER_GAIN <= value / usual <= _OTHER_GAIN:
            message = f"`{parameter.name}` of `{parameter.controller.name}` must be near the vendor's {usual:g}"
            advice = "delete the line: the vendor's gain is used"
            message = f"{message}, at most {_OTHER_GAIN:g} times more or less, got {value:g}"
            yield found(graph, parameter.path, message, advice)


@rule(Severity.WARNING, assumes=("refused-impedance",))
def impedance_without_effect(graph: CellGraph) -> Findings:
    """Yield impedance of an arm whose joints are claimed by other interfaces alone on the real target."""
    for device in graph.cell.devices:
        takes = device.robot.accepts.impedance_facts
        if device.robot.impedance is None or takes is None:
            continue
        joints = {joint.name for joint in device.joints}
        ends = (
            claim.rpartition("/")
            for controller in graph.cell.controllers
            if "real" in controller.targets
            for claim in controller.claims("real")
        )
        claimed = {interface for owner, _, interface in ends if owner in joints}
        if claimed and not claimed & set(takes.acts_on):
            by = " and ".join(sorted(claimed))
            message = f"the impedance of `{device.name}` has no effect: controllers command its joints by {by}"
            yield found(graph, (*device.path, "impedance"), message)


@rule(Severity.ERROR)
def missing_controller_parameter(graph: CellGraph) -> Findings:
    """Yield controllers without a parameter that the distribution requires, or takes no empty value of.

    A parameter that goes to the node is not missing, whether the spec, the device or its kind says its value.
    """
    for controller in graph.cell.controllers:
        kind = controller.declared
        declared = {} if kind is None else kind.parameters_in(graph.cell.distro)
        for name, facts in declared.items():
            # One for each name of a list, as in `gains.<joint>.p`, has a default in every kind; where there is no joint
            # to write, another rule says so.
            if kind is None or name in controller.parameters or name == kind.joints_parameter or "<" in name:
                continue
            if (facts.not_empty and facts.default in ("", ())) or (facts.required and facts.default is None):
                message = f"`{controller.kind}` requires `{name}`, but `{controller.name}` does not state it"
                yield found(graph, controller.path, message, f"write `parameters: {{{name}: ...}}`")


@rule(Severity.ERROR)
def conflicting_parameters(graph: CellGraph) -> Findings:
    """Yield controllers with parameters of several groups of which their kind takes one, or of none."""
    for controller in graph.cell.controllers:
        groups = () if controller.declared is None else controller.declared.either
        given = [[name for name in group if controller.parameters.get(name)] for group in groups]
        if not groups or sum(map(bool, given)) == 1:
            continue
        wanted = " or ".join(f"`{group[0]}`" for group in groups)
        got = " and ".join(f"`{names[0]}`" for names in given if names) or "none"
        path = next(((*controller.path, "parameters", n) for names in reversed(given) for n in names), controller.path)
        yield found(graph, path, f"`{controller.name}` must have either {wanted}, got {got}")


@rule(Severity.ERROR)
def parameter_out_of_range(graph: CellGraph) -> Findings:
    """Yield numbers below or above what the declaration allows, items of lists too, and texts that it does not list."""
    for parameter in stated_parameters(graph.cell):
        facts = parameter.facts
        if facts is None:
            continue
        subject = f"`{parameter.name}` of `{parameter.owner}`"
        if facts.not_empty and parameter.value in ("", ()):
            yield found(graph, parameter.path, f"{subject} must not be empty")
        if (reason := _unfit_list(facts, parameter.value, parameter.beside)) != "":
            yield found(graph, parameter.path, f"{subject} {reason}")
        seen: list[ParameterValue] = []
        for path, item in parameter.items():
            reason = _out_of_range(facts, item) or ("must not repeat an item" if facts.unique and item in seen else "")
            seen.append(item)
            if reason:
                yield found(graph, path, f"{subject} {reason}, got `{item}`")


def _unfit_list(facts: ParameterFacts, value: ParameterValue, beside: Callable[[str], object]) -> str:
    """Say what is wrong with a list as a whole; empty for nothing."""
    if not isinstance(value, tuple):
        return ""
    alone = next(((item, other) for item, other in facts.needs.items() if item in value and other not in value), None)
    if alone is not None:
        return f"must have `{alone[1]}` beside `{alone[0]}`"
    whole = None if facts.within is None else beside(facts.within)
    strange = next((item for item in value if isinstance(whole, tuple) and item not in whole), None)
    return "" if strange is None else f"must have no item that `{facts.within}` lacks, got `{strange}`"


def _out_of_range(facts: ParameterFacts, value: ParameterValue) -> str:
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        if facts.minimum is not None and value < facts.minimum:
            return f"must be at least {facts.minimum:g}"
        if facts.exclusive_minimum is not None and value <= facts.exclusive_minimum:
            return f"must be more than {facts.exclusive_minimum:g}"
        if facts.maximum is not None and value > facts.maximum:
            return f"must be at most {facts.maximum:g}"
    choices = facts.one_of or facts.subset_of
    if isinstance(value, str) and choices and value not in choices:
        return "must be one of " + ", ".join(choices)
    return ""


@rule(Severity.AUDIT)
def parameter_not_played(graph: CellGraph) -> Findings:
    """Yield parameters of the spec that the mock does not play, where they differ from what it does."""
    for parameter in written_parameters(graph.cell):
        kind = parameter.controller.declared
        facts = None if kind is None else kind.parameter(parameter.name, graph.cell.distro)
        if facts is not None and facts.not_played is not None and parameter.value != facts.default:
            message = f"no rehearsal plays `{parameter.name}` of `{parameter.controller.name}`"
            yield found(graph, parameter.path, f"{message}: on the mock, {facts.not_played}")


_Stated = tuple[tuple[str, ...], tuple[float, ...], "tuple[float, float] | None", str]


@rule(Severity.ERROR)
def refused_impedance(graph: CellGraph) -> Findings:
    """Yield impedance for no device, of another number of joints, and figures that the robot does not take."""
    for device in graph.cell.devices:
        stated, takes = device.robot.impedance, device.robot.accepts.impedance_facts
        if stated is None:
            continue
        path = (*device.path, "impedance")
        if takes is None:
            yield found(graph, path, f"the driver of `{device.name}` sets no impedance")
            continue
        joints = takes.joints or len(device.actuated_joints)
        for key, counted in (("joint", stated.joint), ("damping", stated.damping)):
            if counted is not None and len(counted) != joints:
                message = f"`{key}` of the impedance of `{device.name}` must be {joints} figures, got {len(counted)}"
                yield found(graph, (*path, key), message)
        for keys, figures, span, unit in _impedance_figures(stated, takes):
            if span is None:
                yield found(graph, (*path, *keys), f"the driver of `{device.name}` sets no `{keys[-1]}`")
                continue
            least, most = span
            refused = [figure for figure in figures if not least <= figure <= most]
            if refused:
                message = f"`{keys[-1]}` of `{device.name}` must be {least:g} to {most:g} {unit}, got {refused[0]:g}"
                yield found(graph, (*path, *keys), message)


def _impedance_figures(stated: Impedance, takes: ImpedanceFacts) -> Iterator[_Stated]:
    """Yield each figure that is written: its keys, values, least and most, and unit."""
    if stated.joint is not None:
        yield ("joint",), stated.joint, takes.joint, "N m/rad"
    if stated.damping is not None:
        yield ("damping",), stated.damping, takes.damping, "N m s/rad"
    if stated.cartesian is not None:
        yield ("cartesian", "translation"), stated.cartesian.translation, takes.translation, "N/m"
        yield ("cartesian", "rotation"), stated.cartesian.rotation, takes.rotation, "N m/rad"


@rule(Severity.ERROR)
def refused_thresholds(graph: CellGraph) -> Findings:
    """Yield thresholds for no device, of another number of joints, and upper ones below the lower."""
    for device in graph.cell.devices:
        if device.robot.collision is None:
            continue
        path = (*device.path, "collision")
        if not device.robot.accepts.thresholds:
            yield found(graph, path, f"the driver of `{device.name}` sets no collision thresholds")
            continue
        joints = len(device.actuated_joints)
        for name in ("torque", "force", "moment"):
            given = getattr(device.robot.collision, name)
            if name == "torque" and not len(given.lower) == len(given.upper) == joints:
                counts = f"{len(given.lower)} and {len(given.upper)}"
                message = f"torque thresholds of `{device.name}` must be {joints} lower and upper ones, got {counts}"
                yield found(graph, (*path, name), message)
            elif any(low > high for low, high in zip(given.lower, given.upper, strict=True)):
                message = f"each lower {name} threshold of `{device.name}` must be at most the upper one"
                yield found(graph, (*path, name), message)


@rule(Severity.ERROR, assumes=("unprovided-command-interface",))
def trajectory_without_gains(graph: CellGraph) -> Findings:
    """Yield trajectory controllers without position commands that have a joint without a proportional gain."""
    for controller in graph.cell.controllers:
        target = controller.targets[-1]  # the real one where it is there
        kinds = {interface.rpartition("/")[2] for interface in controller.claims(target)}
        if controller.behavior not in TRAJECTORIES or len(kinds) != 1 or not kinds <= {"velocity", "effort"}:
            continue
        without = [joint for joint in controller.joints if not controller.parameters_on(target).get(f"gains.{joint}.p")]
        if without:
            more = f" and {len(without) - 1} more" if len(without) > 1 else ""
            message = f"`{controller.name}` commands only {kinds.pop()} and must have gains, but `gains.{without[0]}.p`"
            zero = f"{more} are zero" if more else " is zero"
            yield found(graph, (*controller.path, "command_interfaces"), f"{message}{zero}")


@rule(Severity.ERROR)
def unknown_controller_parameter(graph: CellGraph) -> Findings:
    """Yield parameters of the spec that the kind of the controller does not declare for the distribution."""
    for parameter in written_parameters(graph.cell):
        kind = parameter.controller.declared
        if kind is None:
            continue
        here = {*kind.parameters_in(graph.cell.distro), *parameter.controller.plugin_parameters}
        if not any(is_named(declared, parameter.name) for declared in here):
            message = f"`{parameter.controller.kind}` has no parameter `{parameter.name}` in {graph.cell.distro}"
            yield found(graph, parameter.path, message, did_you_mean(parameter.name, here, "parameters"))


_TYPES: dict[str, type] = {"bool": bool, "int": int, "double": float, "string": str}
_ARRAY = "_array"


@rule(Severity.ERROR)
def wrong_parameter_type(graph: CellGraph) -> Findings:
    """Yield parameters of the spec whose value has another type than the declared one."""
    for parameter in stated_parameters(graph.cell):
        facts, value = parameter.facts, parameter.value
        expected = "none" if facts is None else facts.type
        item_type = _TYPES.get(expected.removesuffix(_ARRAY))
        is_list = isinstance(value, tuple)
        if item_type is None or (
            is_list == expected.endswith(_ARRAY) and all(type(item) is item_type for _, item in parameter.items())
        ):
            continue
        message = f"`{parameter.name}` of `{parameter.owner}` must be of type {expected}, got `{_shown(value)}`"
        yield found(graph, parameter.path, message, f"write {_corrected(value, expected)}")


def _corrected(value: ParameterValue, expected: str) -> str:
    items = value if isinstance(value, tuple) else (value,)
    if expected.startswith("double") and all(type(item) is int for item in items):
        doubles = tuple(float(item) for item in items)
        return f"`{_shown(doubles if expected.endswith(_ARRAY) else doubles[0])}`"
    return f"a value of type {expected}"


def _shown(value: ParameterValue) -> str:
    return f"[{', '.join(map(str, value))}]" if isinstance(value, tuple) else str(value)
