"""What an upgrade changes, for people: at a terminal, and as a comment of a pull request."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from cellc.contract.diagnostics.wording import count
from cellc.contract.printing import Line, Style, Styled
from cellc.contract.upgrade import Upgrade, UpgradeInterface, UpgradeParameter, UpgradePin
from cellc.contract.vocabulary import UNKNOWN
from cellc.tools.review.markdown import LONGEST, as_code, as_prose, folded, render_markdown
from cellc.tools.review.text import finding_lines, gate_line, render_review

_FEW = 6
_STYLE = {"OK": Style.GREEN, UNKNOWN: Style.YELLOW, "INCOMPATIBLE": Style.RED}


def render_upgrade(upgrade: Upgrade) -> Iterator[Line]:
    """Yield the lines of an upgrade for a terminal, what is asked first."""
    yield summed_up(upgrade)
    yield from (f"{upgrade.after}  {fact}" for fact in upgrade.facts)
    yield from _section("to decide", upgrade.questions, Style.YELLOW)
    yield from finding_lines("errors of the check, so no package is compared", upgrade.errors)
    yield ""
    yield "version tuple"
    for pin in upgrade.pins:
        yield f"  {_moved(pin)}"
        yield ("      ", Styled(pin.answer, _STYLE[pin.answer]), Styled(f": {pin.evidence}", Style.DIM))
    yield from _section("declared parameters", map(parameter_line, _alike(upgrade.parameters)))
    yield from _section("names at the ROS graph", map(interface_line, upgrade.interfaces))
    if upgrade.review is not None:
        yield ""
        yield from render_review(upgrade.review)
    else:
        yield from _section("gates to repeat (their evidence is no longer valid)", map(gate_line, upgrade.gates))


def upgrade_markdown(upgrade: Upgrade, longest: int = LONGEST) -> str:
    """Return an upgrade as a comment of a pull request.

    Args:
        longest: characters; what does not fit is counted.
    """
    head = [f"### {as_prose(summed_up(upgrade))}", "", *(f"- {as_prose(fact)}" for fact in upgrade.facts), ""]
    head += folded("To decide", map(as_prose, upgrade.questions), is_open=True)
    errors = (f"{as_code(finding.code)}: {as_prose(finding.message)}" for finding in upgrade.errors)
    head += folded("Errors of the check", errors, is_open=True)
    pins = (f"{as_prose(_moved(pin))}; **{pin.answer}**: {as_prose(pin.evidence)}" for pin in upgrade.pins)
    head += folded("Version tuple", pins, is_open=True)
    head += folded("Declared parameters", (as_prose(parameter_line(row)) for row in _alike(upgrade.parameters)))
    head += folded("Names at the ROS graph", (as_prose(interface_line(interface)) for interface in upgrade.interfaces))
    if upgrade.review is None:
        return "\n".join((*head, *folded("Gates to repeat", (as_prose(gate_line(gate)) for gate in upgrade.gates))))
    text = "\n".join(head) + "\n"
    return text + render_markdown(upgrade.review, longest - len(text))


def summed_up(upgrade: Upgrade) -> str:
    """Return one line: how many pins change, and how much is asked."""
    pins = sum(pin.before != pin.after for pin in upgrade.pins)
    text = f"{count(pins, 'pin')} change{'s' if pins == 1 else ''}, {count(len(upgrade.questions), 'question')}"
    return f"{upgrade.cell}: {upgrade.before} to {upgrade.after}: {text}"


def _moved(pin: UpgradePin) -> str:
    text = f"stays {pin.before}" if pin.before == pin.after else f"{pin.before} -> {pin.after}"
    return f"{pin.holder} {pin.part}: {text}"


def parameter_line(alike: Sequence[UpgradeParameter]) -> str:
    """Return what becomes of parameters that the same nodes declare and of which the same becomes."""
    first = alike[0]
    what = f" {first.what}" if first.what else ""
    named = ", ".join(parameter.parameter + _values(parameter) for parameter in alike)
    return f"{_nodes(first.nodes)}: {first.change}{what}: {named}"


def _values(one: UpgradeParameter) -> str:
    stated = ", stated by the cell" if one.stated else ""
    if one.change == "changes":
        return f" ({one.before} -> {one.after}{stated})"
    default = one.before if one.after is None else one.after
    return f" ({default}{stated})" if default is not None else stated


def _alike(parameters: Iterable[UpgradeParameter]) -> Iterator[Sequence[UpgradeParameter]]:
    groups: dict[tuple[tuple[str, ...], str, str], list[UpgradeParameter]] = {}
    for parameter in parameters:
        groups.setdefault((parameter.nodes, parameter.change, parameter.what), []).append(parameter)
    yield from groups.values()


def interface_line(one: UpgradeInterface) -> str:
    """Return a name that nodes gain or lose."""
    return f"{one.change}: {one.right} {one.name} of {_nodes(one.nodes)}"


def _nodes(names: Sequence[str]) -> str:
    more = f" and {len(names) - _FEW} more" if len(names) > _FEW else ""
    return ", ".join(names[:_FEW]) + more


def _section(title: str, lines: Iterable[str], style: Style | None = None) -> Iterator[Line]:
    items = list(lines)
    if items:
        yield ""
        yield title if style is None else (Styled(title, style),)
        yield from (f"  {line}" for line in items)
