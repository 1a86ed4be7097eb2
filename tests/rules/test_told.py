"""What findings tell beside their place, of fragments: figures, advice and other places, written by hand."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cellc.contract.diagnostics import Diagnostic
from tests.rules.examples import Example, diagnose_example

_NETWORK = "interfaces: {{/object_pose: {{simulated: {{{}}}}}}}"
_JOINTS = "devices: {{arm: {{simulated_joints: {{'*': {{{}}}}}}}}}"
_FINGERS = """
devices: {{gripper: {{architecture: direct_sdk, adapter: {{run: cell_drivers/fingers}}}}}}
interfaces:
  /gripper/state: {{topic: sensor_msgs/msg/JointState, from: gripper, to: {{task: {{depth: 1}}}}, wants: newest,
                   rate: 20 Hz, max_age: 100 ms, on_stale: reject_goal}}
  /gripper/grasp: {{{}: gripper, client: task{}}}
control: {{controllers: {{gripper_action: null}}}}
rehearsals: {{pick_and_place: {{steps: [{{move: home}}, {{detect: object}}, {{move: pick}}]}}}}
"""
_GRASP, _TRIGGER = "action: control_msgs/action/ParallelGripperCommand, server", "service: std_srvs/srv/Trigger, server"
_BOUND = ", frame: world, timeout: 5 s, on_timeout: cancel_and_hold, cancel_within: 200 ms"
_STAMP = "devices: {{camera: {{stamp: {{source: hardware, clock: {}, synchronized_by: {}, max_offset: {}}}}}}}\n"
_QUEUE = "interfaces: {{/object_pose: {{wants: {}, max_age: {}, to: {{task: {{reliability: {}, depth: {}}}}}}}}}"
_SPARE = (
    "calibrations: {spare: {revision: 1, measured: 2026-07-02, method: touch probe, samples: 5, residual: 0.3 mm, "
    "owner: perception}}\n"
)
_TWO_CAMERAS = """# a cell of two cameras
frames: {object: {parent: second/color_optical}}
interfaces:
  /second/color/image_raw: {topic: sensor_msgs/msg/Image, from: second, to: {task: {depth: 1}}, wants: newest,
                            frame: second/color_optical, rate: 30 Hz, max_age: 100 ms,
                            on_stale: reject_goal}
"""
_PLANT = "hosts: {control_pc: {clock: {domain: plant}}}\n"


def _told(code: str, fragment: str, folder: Path) -> list[Diagnostic]:
    return [diagnostic for diagnostic in diagnose_example(Example("yaml", fragment), folder) if diagnostic.code == code]


@pytest.mark.parametrize(
    ("fragment", "message"),
    [
        (_NETWORK.format("latency: -1 ms"), "`latency` must be at least 0, got `-1 ms`"),
        (_NETWORK.format("jitter: -1 ms"), "`jitter` must be at least 0, got `-1 ms`"),
        (_NETWORK.format("loss: 101 %"), "`loss` must be between 0 % and 100 %, got `101 %`"),
        (_NETWORK.format("reordering: -1 %"), "`reordering` must be between 0 % and 100 %, got `-1 %`"),
        (
            "hosts: {control_pc: {clock: {simulated_drift: 10001 ppm}}}",
            "`simulated_drift` must be between -10000 ppm and 10000 ppm, got `10001 ppm`",
        ),
        (
            "devices: {camera: {stamp: {simulated_drift: -10001 ppm}}}",
            "`simulated_drift` must be between -10000 ppm and 10000 ppm, got `-10001 ppm`",
        ),
        (_JOINTS.format("lag: -1 ms"), "`lag` must be at least 0, got `-1 ms`"),
        (_JOINTS.format("noise: -1 deg"), "`noise` must be at least 0, got `-1 deg`"),
        (_JOINTS.format("velocity: 0 deg/s"), "`velocity` must be above 0, got `0 deg/s`"),
    ],
)
def test_range_of_a_simulated_figure(fragment: str, message: str, folder: Path) -> None:
    assert [finding.message for finding in _told("impossible-simulation", fragment, folder)] == [message]


@pytest.mark.parametrize(
    "fragment",
    [
        _NETWORK.format("latency: 0 ms, jitter: 0 ms, loss: 0 %, reordering: 100 %"),
        _JOINTS.format("lag: 0 ms, noise: 0 deg, velocity: 0.001 deg/s"),
        "hosts: {control_pc: {clock: {simulated_drift: -10000 ppm}}}",
    ],
)
def test_ends_of_the_range_of_a_simulated_figure_belong_to_it(fragment: str, folder: Path) -> None:
    assert _told("impossible-simulation", fragment, folder) == []


@pytest.mark.parametrize(
    ("max_age", "depth", "most"),
    [
        # 3 samples at 10 Hz are 300 ms old; 2 fit into 250 ms, and 1 into 199 ms.
        ("250 ms", 3, "`depth: 2` or less"),
        ("200 ms", 3, "`depth: 2` or less"),
        ("199 ms", 3, "`depth: 1`"),
        ("150 ms", 2, "`depth: 1`"),
        ("300 ms", 3, None),
        ("150 ms", 1, None),
    ],
)
def test_queue_that_fits_into_the_age_is_advised(max_age: str, depth: int, most: str | None, folder: Path) -> None:
    fragment = _QUEUE.format("newest", max_age, "best_effort", depth)
    advice = [] if most is None else [f"use {most}, or allow a greater age"]
    assert [finding.help for finding in _told("queue-older-than-max-age", fragment, folder)] == advice


@pytest.mark.parametrize(
    ("fragment", "field"),
    [
        (_STAMP.format("camera", "null", "2 ms"), "synchronized_by"),
        (_STAMP.format("camera", "ptp", "null"), "max_offset"),
        (_STAMP.format("camera", "null", "null"), "synchronized_by"),  # the first of both
        (_STAMP.format("camera", "ptp", "2 ms"), None),
        (_STAMP.format("ros", "null", "null"), None),  # the clock of the hosts
        (_PLANT + _STAMP.format("plant", "null", "null"), None),
        (_PLANT + _STAMP.format("ros", "null", "null"), "synchronized_by"),  # which no host has here
    ],
)
def test_clock_of_a_sensor_is_that_of_a_host_or_bound_to_it(fragment: str, field: str | None, folder: Path) -> None:
    told = _told("unsynchronized-sensor-clock", fragment, folder)
    assert [finding.yaml_path for finding in told] == ([] if field is None else [("devices", "camera", "stamp", field)])
    assert all(f"of `camera` does not state `{field}`" in finding.message for finding in told)


@pytest.mark.parametrize(
    ("head", "bound", "reported"),
    [
        (_GRASP, _BOUND, False),
        (_GRASP, ", frame: world", True),  # nothing ends it
        (_TRIGGER, ", timeout: 5 s, on_timeout: error", True),  # a service cannot be canceled
    ],
)
def test_commands_of_a_direct_sdk_are_bounded_by_an_action_with_a_timeout(
    head: str, bound: str, reported: bool, folder: Path
) -> None:
    told = _told("direct-sdk-without-bounded-command", _FINGERS.format(head, bound), folder)
    advice = "declare an action with `server: gripper` and a timeout"
    assert [finding.help for finding in told] == ([advice] if reported else [])


def test_trajectory_controller_of_the_device_that_scales_is_advised(folder: Path) -> None:
    """It comes first of what the device has for trajectories; a broadcaster of the factor is none."""
    (told,) = _told("unscaled-trajectory", "control: {controllers: {arm_trajectory: {type: joint_trajectory}}}", folder)
    assert told.help == "use `type: scaled_joint_trajectory`"


@pytest.mark.parametrize(
    ("code", "fragment", "places"),
    [
        (
            "unused-calibration",
            _SPARE + "frames: {jig: {parent: world, xyz: 1 0 0 m, designed: true}, bin: {parent: world}}",
            [("designed, without a measurement", "jig")],
        ),
        ("unused-calibration", _SPARE, []),
        (
            "object-under-another-camera",
            "# a cell of two cameras\nframes: {object: {parent: second/color_optical}}",
            [("its images", "/camera/camera/color/image_raw")],
        ),
        (
            "object-under-another-camera",
            _TWO_CAMERAS,
            [("its images", "/camera/camera/color/image_raw"), ("the images of `second`", "/second/color/image_raw")],
        ),
    ],
)
def test_other_places_of_a_finding(code: str, fragment: str, places: list[tuple[str, str]], folder: Path) -> None:
    (told,) = _told(code, fragment, folder)
    lines = (folder / "cell.yaml").read_text(encoding="utf-8").splitlines()
    named = [[line for line in lines[: one.span.line] if re.match(r"  [^ ]", line)][-1] for one in told.related]
    related = [(one.message, name.strip(" :")) for one, name in zip(told.related, named, strict=True)]
    assert related == places


_SHAPE = '<collision><geometry><mesh filename="package://nowhere/{}.stl"/></geometry></collision>'


@pytest.mark.parametrize(
    ("links", "told_of_them"),
    [
        # The base stands on the ground; the carriage slides, and the tool hangs on the arm, which turns.
        (("base",), "contact of `stage_base`, which do not move, is not checked"),
        (("tool",), "contact of `stage_tool`, 1 of which move, is not checked"),
        (
            ("base", "carriage", "tool"),
            "contact of `stage_base`, `stage_carriage`, `stage_tool`, 2 of which move, is not checked",
        ),
    ],
)
def test_links_whose_contact_is_not_checked(links: tuple[str, ...], told_of_them: str, folder: Path) -> None:
    fragment = "\n".join(f'<link name="{link}">{_SHAPE.format(link)}</link>' for link in links)
    (told,) = (
        diagnostic
        for diagnostic in diagnose_example(Example("xml", fragment), folder)
        if diagnostic.code == "mesh-not-found"
    )
    assert told.message.endswith(f"; {told_of_them}")
    assert [f"/{link}.stl`" in told.message for link in ("base", "carriage", "tool")] == [
        link in links for link in ("base", "carriage", "tool")
    ]
