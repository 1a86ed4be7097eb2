"""Where the devices of a first spec stand, by their kinds: tools on arms, arms on rails, the rest beside them."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from cellc.compiler.catalog.device_model import DeviceModel

_TOOLS = ("gripper", "hand")
_BESIDE_M, _APART_M, _ROW = 3, 2, 8
"""How far from the arms the rest is, how far apart, and how many stand in a row."""


def mounts_of(models: Mapping[str, DeviceModel]) -> dict[str, str]:
    """Return the mount of each device, as the spec writes it."""
    arms = _of_kind(models, "arm")
    mounts = _standing(models, arms)
    tools = {arm: f"{arm}/{models[arm].tool_frame or models[arm].base}" for arm in arms}
    free = [arm for arm in arms if models[arm].gripper is None]
    for sensor, arm in zip(_of_kind(models, "sensor"), free, strict=False):
        carrying = _carrying(models[sensor])
        if carrying is not None:
            mounts[sensor], tools[arm] = f"{{parent: {tools[arm]}}}", f"{sensor}/{carrying}"
    for tool, arm in zip(_of_kind(models, *_TOOLS), free, strict=False):
        mounts[tool] = f"{{parent: {tools[arm]}}}"
    for camera, arm in zip(_of_kind(models, "camera"), arms, strict=False):
        flange = f"{arm}/{models[arm].tool_frame or models[arm].base}"
        mounts[camera] = f"{{parent: {flange}, xyz: 0 -110 30 mm}}"
    beside = _beside()
    return {name: mounts.get(name) or next(beside) for name in models}


def _standing(models: Mapping[str, DeviceModel], arms: list[str]) -> dict[str, str]:
    """Return the mounts of arms and of what carries them: a meter apart, so that arms do not start in each other."""
    under = [name for name in _of_kind(models, "axis", "base") if _carrying(models[name]) is not None]
    mounts: dict[str, str] = {}
    for number, arm in enumerate(arms):
        place = f"{{parent: world, xyz: 0 {number} 0 m}}"
        if number < len(under):
            mounts[under[number]] = place
            place = f"{{parent: {under[number]}/{_carrying(models[under[number]])}}}"
        mounts[arm] = place
    return mounts


def _carrying(model: DeviceModel) -> str | None:
    """Return the frame of a device that another one can stand on; None where it is not clear."""
    others = [name for name, link in model.frames.items() if link != model.base]
    return model.tool_frame or (others[0] if len(others) == 1 else None)


def _of_kind(models: Mapping[str, DeviceModel], *kinds: str) -> list[str]:
    return [name for name, model in models.items() if model.kind in kinds]


def _beside() -> Iterator[str]:
    """Yield places in the world out of the reach of the arms."""
    number = 0
    while True:
        x, y = _BESIDE_M + _APART_M * (number // _ROW), _APART_M * (number % _ROW)
        yield f"{{parent: world, xyz: {x} {y} 0 m}}"
        number += 1
