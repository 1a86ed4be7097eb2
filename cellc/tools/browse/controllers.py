"""The page of the kinds of controllers: what each claims, serves and publishes, and each of its parameters."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.catalog.controller_kind import ControllerKind, ControllerTopic
from cellc.compiler.catalog.load import controller_kinds, load_controller_kind
from cellc.compiler.catalog.parameter_facts import ParameterFacts
from cellc.compiler.formats.escape import code, markdown
from cellc.compiler.formats.markdown_table import TableCell, table
from cellc.contract.vocabulary import Distro

FILE = "controllers.md"
_DIRECTIONS = {"publish": "publishes", "subscribe": "subscribes"}


def controllers_page() -> str:
    """Return the page as Markdown."""
    kinds = [kind for name in controller_kinds() if (kind := load_controller_kind(name).value) is not None]
    blocks = [
        "# Kinds of controllers",
        "`type:` of a controller in a spec names one of these, or one of a device's own (see its page). "
        "`parameters:` takes what its table lists. A parameter of `<joint>` has a value for each joint.",
    ]
    return "\n\n".join((*blocks, *(block for kind in kinds for block in _kind(kind)))) + "\n"


def _kind(kind: ControllerKind) -> Iterator[str]:
    yield f"## {code(kind.kind)}"
    yield markdown(f"{kind.summary[0].upper()}{kind.summary[1:]}.")
    facts = "\n".join(f"- {name}: {text}" for name, text in _facts(kind).items() if text)
    if facts:
        yield facts
    topics = ((code(topic.name), topic.type, _DIRECTIONS[topic.direction], _where(topic)) for topic in kind.topics)
    topic_table = table(("topic", "type", "it", "on"), topics)
    if kind.topics:
        yield topic_table
    parameters = (_parameter(name, facts) for name, facts in kind.parameters.items())
    yield table(("parameter", "type", "default", "allowed", "on"), parameters)
    yield "Sources: " + markdown("; ".join((*kind.sources, f"read on {kind.as_of}"))) + "."


def _facts(kind: ControllerKind) -> Mapping[str, str]:
    plugins = {use.type: None for use in kind.plugins.values()}
    combined = (" + ".join(map(code, combination)) for combination in kind.command_combinations)
    action = kind.action
    return {
        "plugin": ", ".join(map(code, plugins)),
        "distributions": ", ".join(distro.value for distro in kind.plugins),
        "commands of each joint": ", ".join(map(code, kind.command_interfaces)),
        "or": ", ".join(combined),
        "reads of each joint": ", ".join(map(code, kind.state_interfaces)),
        "action": ""
        if action is None
        else f"{code(action.suffix)}, {', '.join(map(code, dict.fromkeys(action.types.values())))}",
        "services": ", ".join(f"{code(service.name)} ({service.type})" for service in kind.services),
    }


def _parameter(name: str, facts: ParameterFacts) -> tuple[TableCell, ...]:
    default = "must be given" if facts.required else "" if facts.default is None else code(_value(facts.default))
    return code(name), facts.type.replace("_", " "), default, ", ".join(_allowed(facts)), _only(facts.only, facts)


def _allowed(facts: ParameterFacts) -> Iterator[str]:
    if facts.minimum is not None:
        yield f"at least {facts.minimum:g}"
    if facts.exclusive_minimum is not None:
        yield f"above {facts.exclusive_minimum:g}"
    if facts.maximum is not None:
        yield f"at most {facts.maximum:g}"
    if facts.one_of:
        yield f"one of {', '.join(map(code, facts.one_of))}"
    if facts.subset_of:
        yield f"any of {', '.join(map(code, facts.subset_of))}"
    if facts.not_empty:
        yield "not empty"
    if facts.unique:
        yield "no name twice"
    if facts.read_only:
        yield "fixed once it is configured"


def _where(topic: ControllerTopic) -> str:
    given = " and ".join(code(f"{name}: {_value(value)}") for name, value in topic.given.items())
    return f"{_only(topic.only)}, with {given}" if given else _only(topic.only)


def _only(only: tuple[Distro, ...], facts: ParameterFacts | None = None) -> str:
    where = ", ".join(distro.value for distro in only) or "all"
    differs = ", ".join(distro.value for distro in facts.differs) if facts is not None else ""
    return f"{where}; otherwise on {differs}" if differs else where


def _value(value: object) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple):
        return f"[{', '.join(map(_value, value))}]"
    return str(value) or '""'
