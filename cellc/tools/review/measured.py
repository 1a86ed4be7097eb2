"""Which calibrations measured a device: they end with another model, serial number, mount or day of mounting of it."""

from __future__ import annotations

from collections.abc import Iterator

from cellc.contract.contract import Contract
from cellc.contract.vocabulary import UNKNOWN
from cellc.tools.review.leaves import Delta

_MODEL, _PINS, _SINCE = ("contract", "devices"), ("contract", "version_tuple"), ("mounted_on",)


def unmeasured(delta: Delta, before: Contract, after: Contract) -> tuple[str, ...]:
    """Return the calibrations that measured what a change replaces or moves, and have no new revision since."""
    device, moved = _changed(delta, after)
    return tuple(
        name
        for name, old in before.calibrations.items()
        if name in after.calibrations
        and after.calibrations[name].revision <= old.revision
        and (device, moved) in {*_rests_on(name, before)} & {*_rests_on(name, after)}
    )


def _changed(delta: Delta, contract: Contract) -> tuple[str | None, bool]:
    """Return the device that a change replaces or moves, and whether it moves; reading a serial is neither."""
    path, device = delta.path, None
    if delta.after is None or delta.before == UNKNOWN:
        return None, False
    if path[:2] == _MODEL and path[3:] == ("model",):
        return path[2], False
    if path[:2] == _PINS and path[2].endswith(".serial"):
        return path[2].removesuffix(".serial"), False
    if path[0] == "device" and path[2:] == _SINCE:
        return path[1], True
    if path[0] == "placement":
        device = next((name for name, each in contract.devices.items() if each.root_link == path[1]), None)
    return device, True


def _rests_on(calibration: str, contract: Contract) -> Iterator[tuple[str, bool]]:
    """Yield each device between a measured frame and the next joint that moves; with True where its mount is, too.

    The pose of a mount that the calibration itself measured is its result; the day of mounting is not.
    """
    roots = {device.root_link: name for name, device in contract.devices.items()}
    for measured, frame in contract.frames.items():
        if frame.calibration != calibration:
            continue
        seen: set[str] = set()
        name, moves = measured, False
        while name in contract.frames and name not in seen:
            seen.add(name)
            moves = moves or contract.frames[name].moving
            if name in roots:
                yield roots[name], False
                if moves:
                    break
                yield roots[name], True
            name = contract.frames[name].parent
