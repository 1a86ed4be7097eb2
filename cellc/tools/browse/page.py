"""A page of the catalog: what is known of a device, where it is from, and how it looks."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.compiler.catalog.device_model import DeviceModel
from cellc.compiler.catalog.effects import EffectFacts
from cellc.compiler.catalog.load import CatalogDevice
from cellc.compiler.formats.escape import code, markdown
from cellc.compiler.formats.markdown_table import TableCell, table
from cellc.compiler.formats.views import Part, two_views
from cellc.contract.transforms import Pose
from cellc.contract.vocabulary import Loop, Moment, Need
from cellc.robot.description.model import Joint
from cellc.robot.description.posture import farthest, posture
from cellc.tools.browse.controllers import FILE, controllers_page
from cellc.tools.browse.search import distributions, entries, listed_in_table


def pages() -> dict[str, str]:
    """Return every file of the catalog's documentation by its name: an index, and a page and a picture for each."""
    known = tuple(entries())
    files = {"README.md": _index(known), FILE: controllers_page()}
    for entry in known:
        files[f"{entry.model.model}.md"] = page(entry, f"{entry.model.model}.svg")
        files[f"{entry.model.model}.svg"] = picture(entry)
    return files


def _index(known: tuple[CatalogDevice, ...]) -> str:
    return "\n".join(
        (
            "# Catalog",
            "",
            "Every device that a spec can name as `model:`. `cellc catalog` lists them too, and finds them by words,",
            "kind, reach, payload and distribution. A robot that is not here: [own robot](../own_robot.md).",
            f"What drives them: [kinds of controllers]({FILE}).",
            "",
            listed_in_table(known),
            "",
        )
    )


def page(entry: CatalogDevice, picture_file: str | None = None) -> str:
    """Return the page of a device as Markdown, with its picture where there is a file of it."""
    model = entry.model
    sections: dict[str, str] = {
        "Joints": table(("joint", "type", "range", "velocity", "effort", "home"), _joints(entry)),
        "Frames": table(("name in a spec", "link", "remark"), _frames(model)),
        "States": table(("state", "outputs that set it", "sensors that report it", "remark"), _states(model)),
        "Packages": table(("part", "ROS 2", "versions", "source"), releases(model)),
        "What the real robot does": table(BEHAVIOR, behavior(model) if model.kind == "arm" else ()),
        "What it does": table(("moment", "what moves", "what happens", "source"), _effects(model)),
        "Stops": table(("state", "component", "a claim lacks", "reported by", "ends by", "shown"), _stops(model)),
        "Its own controllers": table(("kind", "plugin"), _controllers(model)),
        "Network": table(("port", "who opens it", "for"), _ports(model)),
        "Safety": "\n".join(_safety(model)) or "None.",
        "What the mock cannot prove": _list(model.mock_cannot_prove),
        "Sources": _list((*model.sources, f"read on {model.as_of}")),
    }
    blocks = [f"# {code(model.model)}", markdown(f"{model.vendor}: {model.summary}"), *_figures(entry)]
    blocks += [] if picture_file is None else [f"![{model.model} from two sides, with its frames]({picture_file})"]
    blocks += [f"```yaml\ndevices:\n  {model.kind}: {{model: {model.model}}}\n```"]
    blocks += [f"## {title}\n\n{text}" for title, text in sections.items() if text != "None."]
    return "\n\n".join(blocks) + "\n"


def _figures(entry: CatalogDevice) -> Iterator[str]:
    model = entry.model
    sentences = []
    if model.limits.reach is not None:
        sentences.append(f"reach {model.limits.reach.value.text} ({model.limits.reach.source})")
    if model.limits.payload is not None:
        sentences.append(f"payload {model.limits.payload.value.text} ({model.limits.payload.source})")
    if model.limits.repeatability is not None:
        sentences.append(f"repeatability {model.limits.repeatability.value.text} ({model.limits.repeatability.source})")
    if model.tool_frame is not None:
        far = farthest(entry.description, model.tool_frame, _home(model))
        sentences.append(f"{code(model.tool_frame)} gets {far * 1000:.0f} mm from the axis of the first joint")
    mass = sum(link.inertial.mass for link in entry.description.links if link.inertial is not None)
    sentences += [f"its links weigh {mass:.2f} kg"] if mass else []
    released = distributions(model)
    sentences += [f"driver for {', '.join(released)}"] if released else []
    if sentences:
        yield _list(sentences)


def _home(model: DeviceModel) -> Mapping[str, float]:
    return {name: position.si for name, position in (model.home or {}).items()}


def _joints(entry: CatalogDevice) -> Iterator[tuple[TableCell, ...]]:
    home = entry.model.home or {}
    for joint in entry.description.joints:
        if joint.movable:
            follows = "" if joint.mimic is None else f", follows {joint.mimic.joint}"
            stands = code(home[joint.name].text) if joint.name in home else ""
            yield code(joint.name), f"{joint.type}{follows}", *_limits(joint), stands


def _limits(joint: Joint) -> tuple[str, str, str]:
    limit, unit = joint.limit, "m" if joint.slides else "rad"
    if limit is None:
        return "", "", ""
    ends = (limit.lower, limit.upper)
    bounded = None not in ends and joint.type != "continuous"
    reach = code(f"{_figure(limit.lower)} to {_figure(limit.upper)} {unit}") if bounded else "without end"
    force = "N" if joint.slides else "Nm"
    return reach, f"{_figure(limit.velocity)} {unit}/s", f"{_figure(limit.effort)} {force}"


def _figure(value: float | None) -> str:
    return "?" if value is None else f"{value:.6g}"


def _states(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    """Yield the states of a switched device: what each output is set to for it, and what each sensor reads in it."""
    switched = model.switched
    for name, state in ({} if switched is None else switched.states).items():
        holds = "holds a part or a tool" if switched is not None and switched.holds == name else ""
        yield code(name), _levels(state.outputs), _levels(state.sensors), holds


def _levels(levels: Mapping[str, bool]) -> str:
    return ", ".join(f"{code(name)} {'on' if level else 'off'}" for name, level in levels.items()) or "–"


def _frames(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    for name, link in model.frames.items():
        uses = ["the root"] if name == model.base else []
        uses += ["tools mount here"] if model.tool_frame in (name, link) else []
        uses += ["looks along z"] if name in model.optical_frames else []
        yield code(name), code(link), ", ".join(uses)


def releases(model: DeviceModel) -> Iterator[tuple[str, str, str, str]]:
    """Yield which versions of which part are released for which distribution, with the source."""
    for row in (row.of_model(model.model) for row in model.versions):
        bounds = [f"from {row.minimum}"] if row.minimum else []
        bounds += [f"below {row.below}"] if row.below else []
        product = [] if row.product is None else [row.product]
        said = " ".join((*product, ", ".join((*row.known, *bounds)) or row.note or row.ambiguous or ""))
        yield row.part, "all" if row.distro is None else row.distro.value, said, f"{row.source}, {row.as_of}"


def _effects(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    real = None if model.control is None else model.control.hardware.real
    for moment, effect in {} if real is None else real.effects.items():
        yield moment.value, effect.motion.value, effect.does, effect.source
    for node in model.nodes:
        if node.effect is not None:
            yield f"start of {node.executable}", node.effect.motion.value, node.effect.does, node.effect.source


BEHAVIOR = ("when", "moves", "component", "reported by", "what happens", "source")
_NOT_STATED = "not stated"
_MOMENTS = {
    "pause": Moment.PROGRAM_PAUSE,
    "resume": Moment.PROGRAM_RESUME,
    "lost link": Moment.LINK_LOST,
    "reconnect": Moment.RECONNECT,
    "hold of a claim": Moment.CLAIM,
}


def behavior(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    """Yield what an arm does in a stop, a pause, a lost link, a claim and a jog, and how its joints follow commands."""
    effects = _real_effects(model)
    for state in () if model.safety is None else model.safety.states:
        if state.stops:
            moves, left, by, does, source = _played(model, effects.get(state.moment), state.ends)
            yield state.name, moves, left, by, f"{does}; ends by {state.left_by.value}", source
    for name, moment in _MOMENTS.items():
        if moment in effects:
            yield name, *_played(model, effects[moment], ())
        elif moment in (Moment.PROGRAM_PAUSE, Moment.PROGRAM_RESUME):
            yield name, "", "", "", "set points pass through no program of the robot", ""
        else:
            yield name, _NOT_STATED, "", "", "", ""
    if model.jog is not None:
        runs = "its driver reads on" if model.jog.driver_runs else "its driver is stopped"
        yield "jog", "", "", runs, model.jog.does, model.jog.source
    for law in model.laws:
        held = f"a canceled or aborted goal holds what is {law.held.value}"
        gravity = f"gravity: {law.gravity.value}" if law.loop is Loop.SPRING else ""
        said = "; ".join(filter(None, (f"{law.loop.value} loop", gravity, held, law.because or "")))
        yield f"law of {', '.join(law.commands) or 'other'} commands", "", "", "", said, law.source


def _real_effects(model: DeviceModel) -> Mapping[Moment, EffectFacts]:
    real = None if model.control is None else model.control.hardware.real
    return {} if real is None else real.effects


def _played(model: DeviceModel, effect: EffectFacts | None, more: tuple[Need, ...]) -> tuple[TableCell, ...]:
    """Return what moves, the state of the component, who says so, what happens, and where this was read."""
    if effect is None:
        return _NOT_STATED, "", "", "", ""
    left = effect.leaves or ""
    reporting = _reported(model, (*effect.ends, *more)) if left == "active" else "its component"
    by = reporting if left else ""
    return effect.motion.value, left, by, effect.does, effect.source


def _reported(model: DeviceModel, lost: tuple[Need, ...]) -> TableCell:
    real = None if model.control is None else model.control.hardware.real
    reports = {} if real is None else real.reported_by
    known = (reports[need] for need in lost if need in reports)
    topics = tuple(dict.fromkeys(f"{report.topic} of {report.controller}" for report in known))
    return topics or "no topic"


def _stops(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    """Yield the states that stop the device as the mock plays them: what they leave, who says so, what ends them."""
    real = None if model.control is None else model.control.hardware.real
    for state in () if model.safety is None else model.safety.states:
        if state.stops:
            effect = None if real is None else real.effects.get(state.moment)
            lost = (*(() if effect is None else effect.ends), *state.ends)
            left = "not stated" if effect is None or effect.leaves is None else effect.leaves
            by = "its component, the controller manager" if left != "active" else _reported(model, lost)
            yield (
                state.name,
                left,
                tuple(need.value for need in lost),
                by,
                state.left_by.value,
                state.reported or state.seen or "",
            )


def _controllers(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    for kind, controller in model.controllers.items():
        yield code(kind), tuple(dict.fromkeys(code(use.type) for use in controller.plugins.values()))


def _ports(model: DeviceModel) -> Iterator[tuple[TableCell, ...]]:
    for port in () if model.network is None else model.network.ports:
        opened = "the computer" if port.direction == "host_to_device" else "the device"
        yield f"{port.port} {port.protocol}", opened, port.service


def _safety(model: DeviceModel) -> Iterator[str]:
    if model.safety is None:
        return
    yield markdown(f"Stopped by {model.safety.stop_authority}.")
    stops = [state.name for state in model.safety.states if state.stops]
    if stops:
        yield markdown(f"It stops by itself in {', '.join(stops)}.")
    if model.safety.watchdog:
        yield markdown(f"Watchdog: {model.safety.watchdog}.")


def _list(texts: Iterable[str]) -> str:
    return "\n".join(f"- {markdown(text)}" for text in texts) or "None."


def picture(entry: CatalogDevice) -> str:
    """Return the device as it is at home, from two sides, with the frames that a spec can name."""
    description = entry.description
    poses = posture(description, _home(entry.model))
    shapes = (
        (link.name, collision) for link in description.links for collision in link.collisions if link.name in poses
    )
    named: Mapping[str, Pose] = {name: poses[link] for name, link in entry.model.frames.items() if link in poses}
    joined = (joint for joint in description.joints if joint.child in poses)
    return two_views(
        Part(
            entry.model.model,
            (0.0, 0.0, 0.0),
            tuple((poses[link] @ shape.pose, shape.geometry) for link, shape in shapes),
            tuple((poses[joint.parent].position, poses[joint.child].position) for joint in joined),
            tuple(named.items()),
        )
    )
