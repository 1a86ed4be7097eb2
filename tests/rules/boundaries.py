"""Figures that lie on, just inside and just outside the bound of a rule."""

from __future__ import annotations

from tests.rules.examples import Example

_SERVO = """
nodes:
  follower: {{run: cell_tasks/follower, host: control_pc, owner: integration, language: python}}
interfaces:
  /arm_forward/commands: {{topic: std_msgs/msg/Float64MultiArray, from: {{follower: {{depth: 1}}}},
                          to: {{arm_forward: {{depth: 1}}}}, unit: rad, wants: newest, rate: {value}, max_age: 20 ms,
                          on_stale: stop_and_hold}}
control:
  controllers:
    arm_forward: {{type: forward_command, device: arm, client: follower, active: false,
                  parameters: {{interface_name: position}}}}
  switches:
    to_forward: {{activate: [arm_forward], deactivate: [arm_trajectory]}}
"""
_LIMIT = (
    '<joint name="turn" type="revolute"><parent link="base"/> <child link="arm"/> <axis xyz="0 0 1"/>'
    '<limit lower="{value}" upper="1" velocity="1" effort="10"/></joint>'
)
_STAMP = "{{source: hardware, clock: camera, exposure: 8 ms, synchronized_by: global_time, max_offset: {value}}}"
_TOPIC = "{{from: {{perception: {{reliability: reliable, depth: 1, {value}}}}}}}"
_FIRST = (
    "{{joint: arm/joint_6, direction: +, max_delta: {delta}, velocity: {velocity}, timeout: 5 s, stop_if: [overshoot]}}"
)
# 192.168.56.101 is 0xc0a83865, and 0x6538a8c0 with its bytes turned; 101 is 0o145.
_PLACES_OF_A_DEVICE = (
    *("192.168.56.101", "192.168.56.0101", "192.168.56.0145", "192.168.14437", '"3232249957"', "3232249957"),
    *("3232249957.0", "1698212032", '"0xC0A83865"', "0300.0xa8.56.101", '"::ffff:192.168.56.101"', "192.168.56.101."),
    *('"[::ffff:c0a8:3865]:30002"', '"64:ff9b::c0a8:3865"', '"tcp://192.168.56.101:30002/x"', "ip192.168.56.101"),
    *("[192, 168, 56, 101]", '["192", "168", "56", "101"]', "/dev/ttyUSB0", '"port=//dev/../dev/./ttyUSB0"'),
    *('"a@192.168.56.0101,b"', "[1, 3232249957]"),
)
_OTHER_PLACES = (
    *("192.168.56.102", "1192.168.56.101", "3232249958", '"0xc0a83866"', '"::ffff:192.168.56.102"', "true", "1.5"),
    *("[192, 168, 56, 102]", "/dev/ttyUSB1", "192.168.56", "[192, 168, 56, 101, 1]", '"192.168.56.0x1g"'),
)
_TOLD_HARDWARE = ("parameters: {a.robot_description: x}", "parameters: {a: ['<plugin>']}")


def _yaml(template: str, **values: str) -> Example:
    return Example("yaml", template.format(**values))


def _spec(code: str, template: str, accepted: tuple[str, ...], reported: tuple[str, ...]) -> list[Case]:
    cases = [(code, _yaml(template, value=value), False) for value in accepted]
    return cases + [(code, _yaml(template, value=value), True) for value in reported]


def _named(kind: str, length: int) -> Example:
    name = "/" + "a" * (length - 1)
    texts = {
        "topic": "{topic: std_msgs/msg/String, from: perception, to: task}",
        "service": "{service: std_srvs/srv/Trigger, server: perception, client: task}",
        "action": "{action: moveit_msgs/action/MoveGroup, server: move_group, client: task}",
    }
    return Example("yaml", f"interfaces: {{{name}: {texts[kind]}}}")


def _first(delta: str, velocity: str) -> Example:
    return Example("yaml", "bringup: {first_motion: " + _FIRST.format(delta=delta, velocity=velocity) + "}")


Case = tuple[str, Example, bool]

BOUNDARIES: list[Case] = [
    # 3 rad/s, of which the mock counts with 1e-9 at least.
    *_spec(
        "limit-share-of-nothing",
        "devices: {{arm: {{limits: {{velocity: {value}}}}}}}",
        ("4e-8 %",),
        ("3e-8 %", "1e-30 %"),
    ),
    *_spec(
        "path-tolerance-without-effect",
        "control: {{controllers: {{arm_trajectory: {{path_tolerance: {value}}}}}}}",
        ("1 rad",),
        ("1.001 rad", "200 deg"),
    ),
    *_spec(
        "unmeetable-tolerance",
        "control: {{controllers: {{arm_trajectory: {{goal_tolerance: {value}}}}}}}",
        ("0.0001 rad",),
        ("0.00009 rad",),
    ),
    *_spec("coarse-calibration", "calibrations: {{tcp: {{residual: {value}}}}}", ("5 mm",), ("5.1 mm", "1.2 cm")),
    *_spec("too-few-samples", "calibrations: {{hand_eye: {{samples: {value}}}}}", ("10",), ("9", "3")),
    *_spec("too-few-samples", "calibrations: {{tcp: {{samples: {value}}}}}", ("3",), ("2",)),
    *_spec(
        "calibration-of-another-time",
        "calibrations: {{fixture_a: {{measured: {value}}}}}",
        ("2025-07-01", "2027-07-02"),
        ("2025-06-29", "2027-07-03", "2019-01-01"),
    ),
    *_spec(
        "calibration-before-mounting",
        "devices: {{camera: {{mount: {{since: {value}}}}}}}",
        ("2026-07-01", "2020-02-29"),
        ("2026-07-02", "2027-01-01"),
    ),
    # easy_handeye writes the result of a camera beside the robot in the base frame of the robot.
    *_spec(
        "detached-mount",
        "devices: {{camera: {{mount: {{parent: {value}, xyz: 1.2 0.4 0.9 m, rpy: 0 40 180 deg}}}}}}",
        ("arm/base_link", "arm/base", "world"),
        ("arm/tool0", "gripper/base"),
    ),
    *_spec(
        "mounted-against-vendor",
        "devices: {{gripper: {{mount: {{xyz: 0 0 {value} mm}}}}}}",
        ("0.9", "-0.9"),
        ("1.1", "-1.1"),
    ),
    *_spec(
        "implausible-center-of-mass",
        "devices: {{arm: {{payload: {{center_of_mass: {value}}}}}}}",
        ("0 0 58 mm", "0 -5 62 mm", "0 0 5 mm"),
        ("0 0 4.9 mm", "0 0 -6 mm", "0 0 58 cm", "0 0 0 mm"),
    ),
    *_spec(
        "host-offset-beyond-age",
        "hosts: {{control_pc: {{nics: {{cell: {{address: 10.20.0.10/24, carries: [ros]}}}}}},"
        " vision_pc: {{scheduling: generic, clock: {{domain: ros, synchronized_by: chrony, max_offset: {value}}},"
        " nics: {{cell: {{address: 10.20.0.11/24, carries: [ros]}}}}}}}}\n"
        "network: {{discovery: multicast}}\nnodes: {{perception: {{host: vision_pc}}}}\n"
        "safety: {{stop: {{independent_of: [control_pc, vision_pc]}}}}",
        ("98 ms",),
        ("199 ms", "500 ms"),
    ),
    *_spec(
        "implausible-distance", "frames: {{fixture_A: {{xyz: {value}}}}}", ("20 0 0 m",), ("20.001 0 0 m", "0 0 21 m")
    ),
    *_spec("short-transform-buffer", "frames: {{object: {{buffer: {value}}}}}", ("200 ms",), ("199 ms",)),
    *_spec(
        "too-few-reference-points",
        "frames: {{jig: {{parent: world, xyz: 1 0 0 m, calibration: fixture_a, reference_points: {value}}}}}",
        ("3",),
        ("1", "2"),
    ),
    *_spec(
        "clock-offset-beyond-age", "devices: {{camera: {{stamp: " + _STAMP + "}}}}", ("99 ms",), ("100 ms", "101 ms")
    ),
    *_spec(
        "max-age-beyond-timeout",
        "interfaces: {{/object_pose: {{max_age: {value}}}}}",
        ("20 s", "1 s"),
        ("20.001 s", "21 s"),
    ),
    *_spec(
        "mixed-clocks",
        "targets: {{sim: {{clock: {value}}}}}\nnodes: {{perception: {{clock: wall}}}}",
        ("wall",),
        ("sim",),
    ),
    ("mixed-clocks", Example("yaml", "targets: {sim: {}}\nnodes: {perception: {clock: wall}}"), True),
    ("mixed-clocks", Example("yaml", "targets: {real: {}}\nnodes: {perception: {clock: wall}}"), False),
    *_spec(
        "backlog-of-newest",
        "interfaces: {{/object_pose: {{to: {{task: {{reliability: reliable, depth: {value}}}}}}}}}",
        ("1",),
        ("2",),
    ),
    *_spec(
        "deadline-below-period",
        "interfaces: {{/object_pose: " + _TOPIC + "}}",
        ("deadline: 100 ms", "deadline: 101 ms"),
        ("deadline: 99 ms",),
    ),
    *_spec(
        "address-in-parameters",
        "nodes: {{task: {{parameters: {{at: {value}}}}}}}",
        _OTHER_PLACES,
        _PLACES_OF_A_DEVICE,
    ),
    *_spec(
        "driver-on-mock",
        "nodes: {{task: {{{value}}}}}",
        ("run: cell_tasks/pick_place", "parameters: {robot: robot_description}", "run: ur_description/viewer"),
        ("run: ur_robot_driver/any", "run: demo_arm_driver/any", "run: own/my_ros2_control_node", *_TOLD_HARDWARE),
    ),
    *_spec("scripted-servo-loop", _SERVO, ("99 Hz", "99.9 Hz"), ("100 Hz", "101 Hz")),
    *_spec(
        "unusable-address",
        "hosts: {{control_pc: {{nics: {{bulk: {{address: {value}}}}}}}}}",
        ("10.10.0.0/31", "10.10.0.1/31", "10.10.0.0/32", "10.10.0.1/30"),
        ("10.10.0.0/30", "10.10.0.3/30"),
    ),
    *_spec(
        "firmware-outside-matrix",
        "devices: {{arm: {{firmware: controller {value}}}}}",
        ("5.9.4", "9.99.99"),
        ("5.9.3", "10.0.0", "10.0.1", "10"),
    ),
    # Declared with an empty default that may not stay: force_torque_sensor_broadcaster_parameters.yaml, not_empty.
    *_spec(
        "missing-controller-parameter",
        "control: {{controllers: {{force: "
        "{{type: force_torque_sensor_broadcaster, device: arm, parameters: {value}}}}}}}",
        ("{sensor_name: x, frame_id: tool0}",),
        ("{sensor_name: x}",),
    ),
    # 85 % of 1.46 m from base to tip are 1.24 m; the floor is 780 mm below the mount.
    *_spec(
        "surroundings-within-reach",
        "surroundings: {{walls: {{none: the nearest is {value} away}}}}",
        ("1.5 m", "1500 mm", "200 cm", "far"),
        ("1 m", "900 mm", "40 cm"),
    ),
    *_spec(
        "parameter-out-of-range",
        "control: {{controllers: {{arm_trajectory: {{parameters: {{action_monitor_rate: {value}}}}}}}}}",
        ("0.1",),
        ("0.09",),
    ),
    *_spec(
        "uneven-update-rate",
        "control: {{controllers: {{arm_trajectory: {{update_rate: {value}}}}}}}",
        ("500 Hz", "250 Hz", "100 Hz"),
        ("499 Hz", "200 Hz", "333 Hz"),
    ),
    *_spec(
        "pose-outside-limits",
        "motion: {{poses: {{home: {{manipulator: 0 -1.5 1.5 -1.5 -1.5 {value} rad}}}}}}",
        ("6.2831853", "-6.2831853"),
        ("6.2831854", "-6.2831854"),
    ),
    *[
        ("illegal-ros-name", _named(kind, longest), False)
        for kind, longest in (("topic", 247), ("service", 240), ("action", 221))
    ],
    *[
        ("illegal-ros-name", _named(kind, longest + 1), True)
        for kind, longest in (("topic", 247), ("service", 240), ("action", 221))
    ],
    ("first-motion-too-large", _first("15 deg", "15 deg/s"), False),
    ("first-motion-too-large", _first("15.01 deg", "5 deg/s"), True),
    ("first-motion-too-large", _first("5 deg", "15.01 deg/s"), True),
    ("first-motion-too-large", _first("16 deg", "5 deg/s"), True),
    ("first-motion-cannot-end", _first("5 deg", "1 rad/s"), False),
    ("first-motion-cannot-end", _first("5 deg", "0.9 deg/s"), True),  # 5.6 s in a timeout of 5 s
    ("first-motion-cannot-end", _first("5 deg", "1 deg/s"), False),  # just 5 s
    ("degrees-as-radians", Example("xml", _LIMIT.format(value="-25.13")), False),  # 8 pi is 25.1327
    ("degrees-as-radians", Example("xml", _LIMIT.format(value="-25.14")), True),
    ("degrees-as-radians", Example("xml", _LIMIT.format(value="-30")), True),
]
"""Code, fragment, and whether the rule reports it."""
