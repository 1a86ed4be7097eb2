"""What each word of a closed list means, by the key that takes it: for editors, which show it beside the word."""

from __future__ import annotations

from collections.abc import Mapping

from cellc.contract.vocabulary import UNKNOWN

_UNKNOWN = {UNKNOWN: "not known yet; it must be stated before the real target"}
_TARGETS = {
    "mock": "the devices of cellc's mock, without hardware",
    "sim": "a simulator, which has the clock",
    "real": "the hardware of the vendors",
}
_CLOCKS = {"wall": "the clock of the computer", "sim": "the topic `/clock`"}

MEANINGS: Mapping[str, Mapping[str, str]] = {
    "time_source": {"ros": "the ROS clock of the node", "hardware": "the clock of the device", **_CLOCKS},
    "clock": _CLOCKS,
    "hardware": _TARGETS,
    "kind": {"fixture": "belongs to the process", "obstacle": "is in the way"},
    "cancel": {"move": "the goal of a motion", "grip": "the goal of a gripper"},
    "architecture": {
        "ros2": "the servo loop is closed through ros2_control",
        "direct_sdk": "a program of its own closes the loop with the library of the vendor",
        "hybrid": "the servo loop stays in the controller of the vendor, which ROS commands",
    },
    "initial_state": {
        "unconfigured": "loaded, without a connection",
        "inactive": "connected, and takes no commands",
        "active": "takes commands",
    },
    "when": {
        "started": "before the first action of the step",
        "accepted": "when a controller took its goal",
        "moving": "at the first motion",
    },
    "direction": {"+": "toward larger positions", "-": "toward smaller positions"},
    "transform_at": {"observation": "the stamp of the observation", "latest": "whatever transform is the newest"},
    "grip": {"open": "the fingers open", "close": "the fingers close"},
    "scheduling": {
        "preempt_rt": "fully preemptible kernel: PREEMPT_RT",
        "lowlatency": "preemptible kernel, without the bounds of PREEMPT_RT",
        "generic": "the kernel of a desktop or server",
        **_UNKNOWN,
    },
    "discovery": {
        "multicast": "participants find each other within the subnet",
        "unicast": "participants ask the stated peers",
        "server": "participants ask a discovery server",
        "localhost": "participants of one computer alone find each other",
        "off": "no participant finds another one",
    },
    "carries": {
        "control": "commands and states of robots",
        "camera": "images and point clouds",
        "bag": "what is recorded",
        "ros": "other topics, services and actions",
        "internet": "what leaves the cell",
    },
    "language": {"cpp": "C++ with rclcpp", "python": "Python with rclpy", **_UNKNOWN},
    "set_by": {"installation": "what is saved on the robot", "service": "a service of its driver"},
    "reliability": {"reliable": "lost samples are sent again", "best_effort": "lost samples stay lost"},
    "durability": {
        "volatile": "who joins late gets what is sent from then on",
        "transient_local": "who joins late gets the last samples too",
    },
    "history": {
        "keep_last": "as many samples as `depth` says",
        "keep_all": "all samples, up to limits of the middleware",
    },
    "liveliness": {
        "automatic": "the middleware asserts it",
        "manual_by_topic": "the program asserts it for each topic",
    },
    "acknowledge": {"operator": "a person, before motion goes on", "automatic": "no person: motion goes on by itself"},
    "on_reconnect": {"discard_goal": "the old goal is dropped", "resume_goal": "the old goal goes on"},
    "bring_up": {
        "mock": "the steps that the mock needs",
        "real": "the steps of the real target; devices do what the drivers of their vendors do",
    },
    "mode": {"local": "started at the device", "remote": "started from elsewhere"},
    "commands": {"speed_units": "m/s and rad/s", "unitless": "shares of the largest speeds, from -1 to 1"},
    "source": {
        "hardware": "the exposure, stamped by the device",
        "driver": "the moment when the driver reads",
        "arrival": "the moment when the sample arrives",
        **_UNKNOWN,
    },
    "path": {
        "hardwired": "wires from the stop to the drives",
        "safety_bus": "a bus that is rated for safety",
        "software": "a program",
        **_UNKNOWN,
    },
    "power_lost": {"holds": "the part stays held", "drops": "the part falls", **_UNKNOWN},
    "parity": {"none": "no parity bit", "odd": "odd parity", "even": "even parity"},
    "stop_bits": {"1": "one stop bit", "2": "two stop bits"},
    "phase": {
        "start": "before processes start",
        "activate": "before hardware components become active",
        "claim": "before controllers claim their joints",
    },
    "on_stale": {
        "reject_goal": "the goal is refused",
        "stop_and_hold": "motion stops, and the joints hold",
        "ignore_sample": "the sample is dropped",
        "continue": "the sample is used all the same",
    },
    "on_timeout": {
        "cancel_and_hold": "the goal is canceled, and the joints hold",
        "error": "the client reports an error",
        "continue": "the client goes on",
    },
    "on_violation": {
        "abort_and_hold": "the goal is aborted, and the joints hold",
        "abort_and_decelerate": "the goal is aborted, and the joints slow down to rest",
    },
    "wants": {"newest": "the newest sample alone", "every_sample": "each sample, in order"},
    "shape": {"plane": "a plane through the points", "box": "a box around the points"},
}


def meaning_of_word(key: str, word: str) -> str:
    """Return what a word means as the value of a key; empty where the key says all of it."""
    return MEANINGS.get(key, {}).get(word, "")
