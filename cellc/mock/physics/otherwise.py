"""What one run has of masses and friction otherwise than its scene: parts, tools, and what controllers hold of arms."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping

from cellc.contract.contract import Contract
from cellc.mock.physics.dynamics import Dynamics
from cellc.mock.reality import Reality
from cellc.robot.physics.scene import Scene, Weight

_LIGHTEST = 0.05
"""Share of its mass that a body has at least, whatever is drawn."""


def make_real(dynamics: Dynamics, contract: Contract, reality: Reality) -> None:
    """Let bodies weigh, and parts slide, as one run draws it; to be done before anything moves."""
    weights = dict(_weights(dynamics.scene, contract, reality))
    if weights:
        dynamics.weigh(weights)
    for name, part in reality.parts.items():
        if part.more_friction and dynamics.moves(name):
            dynamics.reshape(name, friction=max(0.0, dynamics.friction(name) + part.more_friction))


def tools(scene: Scene, contract: Contract, device: str) -> tuple[str, ...]:
    """Return the bodies of other devices that a device carries."""
    carried = _carried(scene, contract, device)
    return tuple(dict.fromkeys(body for other in carried for body in scene.below(contract.devices[other].root_link)))


def _carried(scene: Scene, contract: Contract, device: str) -> tuple[str, ...]:
    """Return the other devices that a device carries."""
    below = set(scene.below(contract.devices[device].root_link))
    return tuple(name for name, other in contract.devices.items() if name != device and other.root_link in below)


def _weights(scene: Scene, contract: Contract, reality: Reality) -> Iterator[tuple[str, Weight]]:
    """Yield each body that differs from the scene, those of parts last."""
    held: dict[str, float] = {}
    mass: dict[str, float] = {}
    for device, share in reality.compensation.items():
        held |= dict.fromkeys(scene.below(contract.devices[device].root_link), 1.0 + share)
    for device, more_kg in reality.tool_more_kg.items():
        bodies = tools(scene, contract, device)
        mass |= dict.fromkeys(bodies, _heavier(scene, bodies, more_kg))
    for part, more_kg in _parts_kg(scene, contract, reality).items():
        mass[part] = _heavier(scene, (part,), more_kg)
    for body in dict.fromkeys((*held, *mass)):
        yield body, Weight(mass.get(body, 1.0), held.get(body, 1.0))


def _parts_kg(scene: Scene, contract: Contract, reality: Reality) -> Mapping[str, float]:
    """Return by how much parts are heavier: of each what is drawn of itself, and of the arm whose tool grips it."""
    found = {name: part.more_kg for name, part in reality.parts.items() if part.more_kg and name in scene.parts}
    for device, more_kg in reality.part_more_kg.items():
        hands = {device, *_carried(scene, contract, device)}
        for name in scene.parts:
            frame = contract.frames.get(name)
            if frame is not None and frame.grasp is not None and hands & frame.grasp.bands.keys():
                found[name] = found.get(name, 0.0) + more_kg
    return found


def _heavier(scene: Scene, bodies: Iterable[str], more_kg: float) -> float:
    """Return the factor by which bodies are so much heavier together."""
    stated_kg = scene.mass_kg(bodies)
    return max(_LIGHTEST, 1.0 + more_kg / stated_kg) if stated_kg > 0.0 else 1.0
