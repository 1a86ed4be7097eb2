"""Which link of a chain had no fresh data: from the sensor to the task, the first one that explains an old stamp.

Ages here are of simulated time, which no node knows: where everything arrives in time, clocks are apart.
"""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.devices import ContractCamera
from cellc.mock.nodes.perception import DEFAULT_RATE_HZ, Camera, Perception
from cellc.mock.nodes.robot_state_publisher import JointStateFeed
from cellc.mock.plant import Plant


def starved_observation(plant: Plant, frame: str, max_age_s: float) -> str:
    """Say which link between the camera and the task brings no observation of a frame that is young enough."""
    return next(_broken_links(plant, frame, round(max_age_s * 1e9)))


def _broken_links(plant: Plant, frame: str, max_age_ns: int) -> Iterator[str]:
    """Yield what is wrong from the camera on; what comes last is so where nothing else is."""
    authority, now_ns = plant.contract.frames[frame].authority, plant.now_ns
    perception, stream = plant.perceptions.get(frame), _camera(plant, authority)
    if perception is None or stream is None:
        yield f"no images reach `{authority}`"
        return
    camera, facts = stream
    if camera.last is None:
        yield f"`{camera.device}` has published no image"
    elif now_ns - camera.last.taken_ns > max_age_ns:
        yield f"the newest image of `{camera.device}` is {_s(now_ns - camera.last.taken_ns)} old"
    yield from _of_detector(perception, authority, camera, facts, now_ns, max_age_ns)
    arrived_ns = plant.task.observations[frame].arrived_ns
    if arrived_ns is None:
        yield f"no pose from `{authority}` has reached `{plant.task.name}`"
    elif now_ns - arrived_ns > round(1e9 / (plant.contract.frames[frame].rate_hz or DEFAULT_RATE_HZ)):
        yield f"no pose from `{authority}` has reached `{plant.task.name}` for {_s(now_ns - arrived_ns)}"
    yield _apart(plant, camera.device) or f"poses from `{authority}` reach `{plant.task.name}` late"


def _camera(plant: Plant, detector: str) -> tuple[Camera, ContractCamera] | None:
    """Return the camera whose images a node looks at."""
    for device, camera in plant.cameras.items():
        facts = plant.contract.devices[device].camera
        interface = None if facts is None else plant.contract.interfaces.get(facts.topic)
        if facts is not None and interface is not None and any(sink.node == detector for sink in interface.sinks):
            return camera, facts
    return None


def _of_detector(
    perception: Perception, name: str, camera: Camera, facts: ContractCamera, now_ns: int, max_age_ns: int
) -> Iterator[str]:
    look = perception.last
    queue = f"queue of {perception.depth or 'any length'} at {facts.rate_hz:g} Hz"
    if look is None:
        yield f"no image from `{camera.device}` has reached `{name}`"
    elif look.rejected:
        message = f"`{name}` rejected {perception.rejected} of {perception.taken} images"
        yield f"{message}, oldest {_s(perception.oldest_ns)}, {queue}"
    elif look.taken_ns - look.image.taken_ns > max_age_ns:
        yield f"images are {_s(look.taken_ns - look.image.taken_ns)} old when `{name}` takes them, {queue}"
    elif now_ns - look.image.taken_ns > max_age_ns:
        yield f"no image from `{camera.device}` has reached `{name}` for {_s(now_ns - look.taken_ns)}"


def starved_states(plant: Plant, feed: JointStateFeed, max_age_s: float) -> str:
    """Say which link between a broadcaster and the task brings no joint states that are young enough."""
    history, now_ns, max_age_ns = feed.history, plant.now_ns, round(max_age_s * 1e9)
    newest, task = feed.newest(now_ns), plant.task.name
    published = history.stamps[history.stamps <= now_ns]
    if not published.size:
        return f"`{history.broadcaster}` has published none"
    silent_ns = now_ns - int(published[-1])
    if silent_ns > max_age_ns:
        return f"`{history.broadcaster}` has published none for {_s(silent_ns)}"
    if newest is None:
        return f"none from `{history.broadcaster}` has reached `{task}`"
    behind_ns = now_ns - int(history.stamps[newest])
    if behind_ns > max_age_ns:
        return f"`{history.broadcaster}` publishes, but nothing from the last {_s(behind_ns)} has reached `{task}`"
    return _apart(plant, history.broadcaster) or f"those from `{history.broadcaster}` reach `{task}` late"


def starved_transform(plant: Plant, target: str, source: str) -> str:
    """Say who publishes the oldest transform between two frames; empty where each is static."""
    ends = plant.task.buffer.ends(target, source)
    if not ends:
        return ""
    child, stamp_ns = min(ends.items(), key=lambda one: (one[1], one[0]))
    authority = " and ".join(f"`{name}`" for name in plant.task.buffer.authorities(child))
    age_ns = plant.clocks.age_ns(plant.task.name, stamp_ns)
    return f"the newest transform of `{child}` by {authority} is {_s(age_ns)} old"


def _apart(plant: Plant, name: str) -> str:
    """Say how far the clock of somebody is from that of the task; empty where they agree."""
    task = plant.task.name
    apart_ns = plant.clocks.of(name).read(plant.now_ns) - plant.clocks.of(task).read(plant.now_ns)
    return f"the clocks of `{name}` and `{task}` are {_s(abs(apart_ns))} apart" if apart_ns else ""


def _s(time_ns: int) -> str:
    return f"{time_ns / 1e9:.3f} s"
