"""Specs of one size each, of one kind of thing each: what is large in one cell is small in another."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import TypeAlias

Json: TypeAlias = "dict[str, Json] | list[Json] | str | int | bool"
Section: TypeAlias = "dict[str, Json]"


def _spec(sections: Section) -> str:
    stand: Section = {"stand": {"model": "pedestal", "mount": {"parent": "world", "xyz": "0 -5 0 m"}}}
    return json.dumps({"format": 1, "cell": "hall", "versions": {"ros": "jazzy"}, "devices": stand, **sections})


def _place(number: int, z: str = "0.1") -> str:
    """Return a place in a row, 9 m from the next: each has as many neighbors however many there are."""
    return f"{9 * number} 0 {z} m"


def _arms(size: int, host: int | None = None) -> Section:
    """Return arms, each at a computer of its own, or all at one."""
    return {
        f"d{n}": {
            "model": "ur5e",
            "mount": {"parent": "world", "xyz": _place(n)},
            "connection": {
                "host": f"h{n if host is None else host}",
                "nic": "a",
                "address": f"192.168.{n}.101" if host is None else f"192.168.{host}.{101 + n}",
            },
        }
        for n in range(size)
    }


def _hosts(size: int) -> Section:
    return {
        f"h{n}": {
            "scheduling": "preempt_rt",
            "clock": {"domain": "ros", "synchronized_by": "chrony", "max_offset": "1 ms"},
            "nics": {
                "a": {"address": f"192.168.{n}.10/24", "carries": ["control"]},
                "b": {"address": f"10.20.0.{10 + n}/24", "carries": ["ros"]},
            },
        }
        for n in range(size)
    }


def _trajectory(number: int) -> Section:
    return {
        "type": "scaled_joint_trajectory", "device": f"d{number}", "goal_time": "1 s", "client": f"n{number}",
        "path_tolerance": "0.2 rad", "goal_tolerance": "0.01 rad",
    }  # fmt: skip


def _nodes(size: int) -> Section:
    return {f"n{n}": {"run": "tasks/node", "owner": "team", "lifecycle": True} for n in range(size)}


def stations(places: list[str]) -> str:
    """Write stands at places of the world."""
    return _spec(
        {
            "devices": {
                f"s{n}": {"model": "pedestal", "mount": {"parent": "world", "xyz": xyz}} for n, xyz in enumerate(places)
            }
        }
    )


def of_chained_frames(size: int) -> str:
    """Write frames each of which hangs on the one before."""
    parents = ["world", *(f"f{n}" for n in range(size))]
    return _spec(
        {"frames": {f"f{n}": {"parent": parents[n], "xyz": "0.1 0 0 m", "designed": True} for n in range(size)}}
    )


def of_calibrations(size: int) -> str:
    """Write measured frames."""
    measured: Section = {
        "revision": 1, "measured": "2026-07-06", "method": "touch probe", "samples": 6, "residual": "0.3 mm",
        "owner": "metrology",
    }  # fmt: skip
    names = range(size)
    return _spec(
        {
            "calibrations": {f"c{n}": measured for n in names},
            "frames": {f"f{n}": {"parent": "world", "xyz": _place(n), "calibration": f"c{n}"} for n in names},
        }
    )


def of_boxes(size: int) -> str:
    """Write boxes and areas, with an arm beside them."""
    box: Section = {"parent": "world", "box": "100 100 100 mm"}
    area: Section = {"parent": "world", "box": "500 400 500 mm"}
    names = range(size)
    return _spec(
        {
            "devices": {"arm": {"model": "ur5e", "mount": {"parent": "world", "xyz": "0 -3 0 m"}}},
            "scene": {f"b{n}": {**box, "xyz": _place(n)} for n in names},
            "areas": {f"a{n}": {**area, "xyz": _place(n, "0.5"), "granted_by": "plc"} for n in names},
        }
    )


def of_cameras(size: int) -> str:
    """Write cameras, half of which look at their frames and half at nothing."""
    names = range(size)
    views = ("0 90 0 deg", "0 -90 0 deg")
    return _spec(
        {
            "devices": {
                f"c{n}": {
                    "model": "realsense_d435i",
                    "mount": {"parent": "world", "xyz": _place(n, "2"), "rpy": views[n % 2]},
                }
                for n in names
            },
            "frames": {f"f{n}": {"parent": "world", "xyz": _place(n), "designed": True} for n in names},
        }
    )


def of_groups(size: int) -> str:
    """Write arms with a group, a pose, a goal, a rehearsal and a first motion each."""
    names = range(size)
    goal: Section = {"xyz": "0.4 0.2 0.3 m", "rpy": "180 0 0 deg", "approach": "0 0 -100 mm"}
    first: Section = {
        "direction": "+", "max_delta": "5 deg", "velocity": "5 deg/s", "timeout": "5 s", "stop_if": ["overshoot"],
    }  # fmt: skip
    return _spec(
        {
            "hosts": _hosts(1),
            "devices": _arms(size, host=0),
            "nodes": _nodes(size),
            "control": {
                "update_rate": "500 Hz",
                "controllers": {"s": {"type": "joint_state_broadcaster"}, **{f"c{n}": _trajectory(n) for n in names}},
            },
            "motion": {
                "groups": {f"g{n}": {"base": f"d{n}/base_link", "tip": f"d{n}/tool0"} for n in names},
                "poses": {f"p{n}": {f"g{n}": "-90 -90 90 -90 -90 0 deg"} for n in names},
                "goals": {f"q{n}": {"group": f"g{n}", "frame": f"d{n}/base_link", **goal} for n in names},
            },
            "rehearsals": {f"r{n}": {"steps": [{"move": f"p{n}"}]} for n in names},
            "bringup": {"first_motion": [{"joint": f"d{n}/wrist_3_joint", **first} for n in names]},
        }
    )


def of_managers(size: int) -> str:
    """Write stations with a computer, an arm and a manager each."""
    names = range(size)
    return _spec(
        {
            "hosts": _hosts(size),
            "devices": _arms(size),
            "nodes": _nodes(size),
            "managers": {f"m{n}": _manager(n) for n in names},
        }
    )


def _manager(number: int) -> Section:
    states: Section = {"type": "joint_state_broadcaster"}
    controllers: Section = {f"s{number}": states, f"c{number}": _trajectory(number)}
    return {
        "update_rate": "500 Hz", "namespace": f"/m{number}", "host": f"h{number}", "controllers": controllers,
    }  # fmt: skip


def of_services(size: int) -> str:
    """Write nodes in a chain, each of which calls a service and an action of the one before."""
    service: Section = {
        "service": "std_srvs/srv/Trigger", "timeout": "1 s", "on_timeout": "error", "on_error": "success",
    }  # fmt: skip
    action: Section = {
        "action": "moveit_msgs/action/MoveGroup", "frame": "world", "timeout": "90 s",
        "on_timeout": "cancel_and_hold", "cancel_within": "200 ms",
    }  # fmt: skip
    ends: list[Section] = [{"server": f"n{n}", "client": f"n{n + 1}"} for n in range(size)]
    named: Section = {f"/s{n}": {**service, **end} for n, end in enumerate(ends)}
    named |= {f"/a{n}": {**action, **end} for n, end in enumerate(ends)}
    return _spec({"nodes": _nodes(size + 1), "interfaces": named})


def of_steps(size: int) -> str:
    """Write one rehearsal of many steps."""
    spec = json.loads(of_groups(2))
    steps = [{"move": f"p{n % 2}"} for n in range(size)]
    return json.dumps(spec | {"rehearsals": {"all": {"steps": steps}}})


def of_readers(size: int) -> str:
    """Write one topic with many readers."""
    topic: Section = {
        "topic": "geometry_msgs/msg/PoseStamped", "wants": "newest", "frame": "world", "rate": "10 Hz",
        "max_age": "200 ms", "on_stale": "reject_goal",
    }  # fmt: skip
    readers: Section = {f"n{n}": {"depth": 1} for n in range(1, size)}
    first: Section = {"n0": {"depth": 1}}
    return _spec({"nodes": _nodes(size), "interfaces": {"/pose": {**topic, "from": first, "to": readers}}})


HALLS: tuple[Callable[[int], str], ...] = (
    of_chained_frames,
    of_calibrations,
    of_boxes,
    of_cameras,
    of_groups,
    of_managers,
    of_services,
    of_steps,
    of_readers,
)
