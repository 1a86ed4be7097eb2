"""What is told of edits of a cell; each expectation was written from the edit, with figures by hand.

The pedestal is 0.8 m high and the arm's limits are halves of its catalog's: 180 deg/s and 5 rad/s^2. At `home` the tool
points straight down, so that a longer tool lowers the tip by as much. Edits of one case have nothing to do with each
other: they share it because a build takes time.
"""

from __future__ import annotations

import json

import pytest

from cellc.tools.review.facts import facts_of
from cellc.tools.review.sides import Package
from tests.review.edits import changes_between
from tests.review.revisions import Edit, Repository, changes_of, edited, package_of

ARM = "arm_elbow_joint, arm_shoulder_lift_joint, arm_shoulder_pan_joint, arm_wrist_1_joint, arm_wrist_2_joint, "
ARM += "arm_wrist_3_joint"
OF_TRAJECTORY = ", ".join(f"arm_trajectory {joint}" for joint in ARM.split(", "))
# The bring-up asks a node of a lifecycle, and what is asked must be there once.
LOOKED_AT = "/perception/get_available_transitions, /perception/get_state"
STALE = "stale_camera: {use: pick_and_place, inject: {freeze: camera, at: 2 s}, expect: stale_state}"
CANCELED = "canceled: {use: pick_and_place, inject: {cancel: move, at: 3 s}, expect: canceled, within: 200 ms}"


GROUPS: dict[str, tuple[tuple[Edit, ...], list[str]]] = {
    "what was measured": (
        (
            ("xyz: 0 0 162 mm", "xyz: 0 0 163 mm"),
            ("path: hardwired", "path: safety_bus"),
            ("observer: operator}", "observer: guard}"),
            ("    program: {played", "    tool_connector: {voltage: 24 V}\n    program: {played"),
            ("payload: {mass: 1.0 kg", "payload: {mass: 1.5 kg"),
            ("summary: UR5e with", "summary: An UR5e with"),
            ("residual: 0.8 mm", "residual: 1.2 mm"),
            ("recovery_time: 120 s", "recovery_time: 180 s"),
            (f"  {STALE}\n", ""),
            (CANCELED, CANCELED.replace("within: 200 ms", "within: 400 ms")),
            ("limits: controls, watchdogs", "limits: robot, watchdogs"),
            ("timeout: 90 s\n", "timeout: 45 s\n"),
        ),
        [
            "dangerous safety | cell | path of the stop | hardwired -> safety_bus",
            "dangerous safety | arm | voltage of the tool connector added | None -> present",
            "dangerous calibration | tcp | pose in its parent | xyz 0 0 162 mm, rpy 0 0 0 deg -> "
            "xyz 0 0 163 mm, rpy 0 0 0 deg | moves 1 mm",
            "dangerous calibration | hand_eye | residual | 0.8 mm -> 1.2 mm | +50 %",
            "dangerous payload | arm | robot TCP xyz | 0.00 0.00 173.00 mm -> 0.00 0.00 174.00 mm | moves 1 mm",
            "dangerous payload | arm | robot payload mass | 1.0 kg -> 1.5 kg | +50 %",
            "dangerous rehearsals | canceled | bound of the outcome | 200 ms -> 400 ms | +100 %",
            "review safety | cell | recovery observer | operator -> guard",
            "review motion | manipulator in home | tip | xyz 491.9 133.3 1114.9 mm, rpy 180 0 180 deg -> "
            "xyz 491.9 133.3 1113.9 mm, rpy 180 0 180 deg | moves 1 mm",
            "safe interfaces | /move_action | timeout | 90 s -> 45 s | -50 %",
            "review rehearsals | stale_camera | rehearsal removed | stale_state -> None",
            "review owners | limits | owner | controls -> robot",
            "review figures | recovery_time_s | target figure | 120 s -> 180 s | +50 %",
            "safe documents | cell | summary | UR5e with a Robotiq 2F-85 picks parts from fixture A under a wrist "
            "camera -> An UR5e with a Robotiq 2F-85 picks parts from fixture A under a wrist camera",
        ],
    ),
    "what is around": (
        (
            ("walls: {none: the nearest is 3 m away}", "walls: {none: the nearest is 2 m away}"),
            ("floor: {shapes: [floor]}", "floor: {open: {person: safety, date: 2027-01-01}}"),
            (
                "  table: {parent: world, xyz: 350 0 780 mm, box: 900 1200 40 mm}",
                "  table: {parent: world, xyz: 350 0 780 mm, cylinder: {radius: 700 mm, length: 40 mm}}",
            ),
        ),
        [
            "dangerous safety | walls | reason why there is nothing | the nearest is 3 m away -> "
            "the nearest is 2 m away",
            "dangerous safety | floor | what is stated around the arms shapes | floor -> ",
            "review safety | floor | open question on the surroundings date | None -> 2027-01-01",
            "review safety | floor | open question on the surroundings person | None -> safety",
            "dangerous model | table | collision shapes | box 900 1200 40 mm -> cylinder of radius 700 mm, "
            "length 40 mm",
        ],
    ),
    "what was measured again": (
        (
            ("xyz: 450 100 850 mm", "xyz: 450 100 860 mm"),
            ("fixture_a: {revision: 2", "fixture_a: {revision: 3"),
            ("hand_eye: {revision: 4", "hand_eye: {revision: 3"),
            ("xyz: 0 0 11 mm, rpy: 0 0 90 deg", "xyz: 0 0 11 mm, rpy: 0 0 91 deg"),
            ("max_delta: 5 deg, velocity: 5 deg/s", "max_delta: 10 deg, velocity: 5 deg/s"),
            ("to: {task: {reliability: reliable, depth: 1}}", "to: {task: {reliability: best_effort, depth: 1}}"),
            ("max_age: 200 ms", "max_age: 300 ms"),
            ("frame: world\n    timeout", "frame: arm/base_link\n    timeout"),
            ("rate: 30 Hz", "rate: 15 Hz"),
        ),
        [
            "dangerous calibration | gripper_base_link | pose in its parent | xyz 0 0 11 mm, rpy 0 0 90 deg -> "
            "xyz 0 0 11 mm, rpy 0 0 91 deg | turns 1 deg",
            "dangerous calibration | hand_eye | revision | 4 -> 3",
            "dangerous payload | arm | robot TCP rpy | 0.00 0.00 90.00 deg -> 0.00 0.00 91.00 deg",
            "dangerous interfaces | /move_action | frame of the payload | world -> arm_base_link | breaks",
            "dangerous time | /object_pose | oldest sample that may be used | 200 ms -> 300 ms | +50 %",
            "dangerous safety | arm | first motion largest move | 5 deg -> 10 deg | +100 %",
            "review calibration | fixture_a | revision | 2 -> 3",
            "review frames | fixture_A | pose in its parent | xyz 450 100 850 mm, rpy 0 0 0 deg -> "
            "xyz 450 100 860 mm, rpy 0 0 0 deg | moves 10 mm",
            "review motion | pick | place in the root frame | xyz 450 -150 860 mm, rpy 180 0 0 deg -> "
            "xyz 450 -150 870 mm, rpy 180 0 0 deg | moves 10 mm",
            "review motion | place | place in the root frame | xyz 450 100 860 mm, rpy 180 0 0 deg -> "
            "xyz 450 100 870 mm, rpy 180 0 0 deg | moves 10 mm",
            "review motion | manipulator in home | tip | xyz 491.9 133.3 1114.9 mm, rpy 180 0 180 deg -> "
            "xyz 491.9 133.3 1114.9 mm, rpy 180 0 179 deg | turns 1 deg",
            "review interfaces | /camera/color/image_raw | rate | 30 Hz -> 15 Hz | -50 %",
            "review QoS | /object_pose subscribers task | quality of service reliability | reliable -> best_effort",
            "review devices | camera | rate of images | 30 Hz -> 15 Hz | -15 Hz",
        ],
    ),
    "limits and where it goes": (
        (
            ("limits: {velocity: 50 %, acceleration: 50 %}", "limits: {velocity: 60 %, acceleration: 40 %}"),
            ("goal_time: 1 s", "goal_time: 2 s"),
            ("path_tolerance: 0.2 rad", "path_tolerance: 0.3 rad"),
            ("goal_tolerance: 0.01 rad", "goal_tolerance: 0.005 rad"),
            ("domain_id: 42", "domain_id: 43"),
            ("home: {manipulator: 0 -90 90 -90 -90 0 deg}", "home: {manipulator: 90 -90 90 -90 -90 0 deg}"),
            ("approach: 0 0 -100 mm}\n    place", "approach: 0 0 -80 mm}\n    place"),
            ("box: 900 1200 40 mm", "box: 900 1200 60 mm"),
        ),
        [
            f"dangerous limits | {ARM} | velocity | 90 deg/s -> 108 deg/s | +20 %",
            f"dangerous control | {OF_TRAJECTORY} | path tolerance | 0.2 rad -> 0.3 rad | +50 %",
            "dangerous control | arm_trajectory | time past the end | 1 s -> 2 s | +100 %",
            "review model | table | collision shapes | box 900 1200 40 mm -> box 900 1200 60 mm"
            " | gains 10 mm on each side in z",
            f"safe control | {OF_TRAJECTORY} | goal tolerance | 0.01 rad -> 0.005 rad | -50 %",
            "review motion | pick | approach | 0 0 -100 mm -> 0 0 -80 mm",
            "review motion | home manipulator | joint positions | 0 -90 90 -90 -90 0 deg -> 90 -90 90 -90 -90 0 deg",
            "review motion | manipulator in home | tip | xyz 491.9 133.3 1114.9 mm, rpy 180 0 180 deg -> "
            "xyz -133.3 491.9 1114.9 mm, rpy 180 0 -90 deg | moves 721 mm, turns 90 deg",
            "review network | control_pc | ROS_DOMAIN_ID | 42 -> 43 | breaks",
            f"safe limits | {ARM} | acceleration | 2.5 rad/s^2 -> 2 rad/s^2 | -20 %",
        ],
    ),
    "what it is made of": (
        (
            ("type: scaled_joint_trajectory", "type: joint_trajectory"),
            ("driver: ur_robot_driver 3.8.0", "driver: ur_robot_driver 3.7.0"),
            ("firmware: polyscope 5.21.0", "firmware: polyscope 5.22.0"),
            ("address: 192.168.56.101", "address: 192.168.56.102"),
            ("discovery: localhost", "discovery: multicast"),
            ("exposure: 8 ms", "exposure: 10 ms"),
            ("max_offset: 1 ms", "max_offset: 2 ms"),
        ),
        [
            "dangerous control | arm_trajectory | behavior | scaled_joint_trajectory -> joint_trajectory",
            "dangerous control | arm_trajectory | plugin | ur_controllers/ScaledJointTrajectoryController -> "
            "joint_trajectory_controller/JointTrajectoryController",
            "dangerous time | control_pc | bound of its offset | 1 ms -> 2 ms | +100 %",
            "dangerous network | arm_hardware | address | 192.168.56.101 -> 192.168.56.102",
            "review control | arm_trajectory | parameter constraints.stopped_velocity_tolerance | 0.2 -> 0.01 | -95 %",
            "review devices | camera | parameter depth_module.exposure | 8000 -> 10000",
            "review devices | camera | parameter rgb_camera.exposure | 80 -> 100",
            "review network | arm_dashboard_client, arm_state_helper | address | 192.168.56.101 -> 192.168.56.102",
            "review control | arm_trajectory | parameter speed_scaling_interface_name | "
            "arm_speed_scaling/speed_scaling_factor -> None",
            "review time | camera | exposure | 8 ms -> 10 ms | +25 %",
            "review versions | arm.driver | pinned version | ur_robot_driver 3.8.0 -> ur_robot_driver 3.7.0",
            "review versions | arm.firmware | pinned version | polyscope 5.21.0 -> polyscope 5.22.0",
            "review network | control_pc | variable ROS_AUTOMATIC_DISCOVERY_RANGE | SYSTEM_DEFAULT -> SUBNET",
        ],
    ),
    "who takes part": (
        (
            (
                "  task: {run: cell_tasks/",
                "  watcher: {run: cell_tasks/watcher, host: control_pc, owner: data}\n  task: {run: cell_tasks/",
            ),
            (
                "to: {task: {reliability: reliable, depth: 1}}",
                "to: {task: {reliability: reliable}, watcher: {depth: 1}}",
            ),
            ("lifecycle: true, ", ""),
            ("  /object_pose:", "  /part_pose:"),
            ("      client: move_group\n    gripper_action:", "      client: task\n    gripper_action:"),
            ("pick: {frame: object,", "pick: {frame: fixture_A,"),
        ),
        [
            "dangerous control | /arm_trajectory/follow_joint_trajectory task | client added | None -> present",
            "dangerous control | arm_trajectory | permitted client | move_group -> task",
            "dangerous motion | pick | frame | object -> fixture_A",
            "dangerous start order | activate_perception, configure_perception | hardware startup step removed | "
            "start -> None",
            "review control | /arm_trajectory/follow_joint_trajectory move_group | client removed | present -> None",
            "review control | /watcher | node added | None -> cell_tasks",
            "review motion | pick | place in the root frame | xyz 450 -150 860 mm, rpy 180 0 0 deg -> "
            "xyz 450 100 860 mm, rpy 180 0 0 deg | moves 250 mm",
            "review interfaces | /part_pose | name of the interface | /object_pose -> /part_pose | breaks",
            "review interfaces | /joint_states move_group, /tf move_group, /tf_static move_group | subscriber "
            "removed | present -> None",
            "review QoS | /part_pose subscribers task | quality of service depth | 1 -> 10",
            f"review network | /observe | right to request | 24 entries -> 23 entries | lost {LOOKED_AT}; "
            "new /watcher/get_parameters",
            # The goal is no longer at the part: what the fingers should close on is not known.
            "review rehearsals | canceled, lost_part, no_part, pick_and_place, program_stopped, slipped, stale_camera, "
            "wrong_part | rehearsal steps | 7 entries -> 7 entries | "
            "lost grip gripper close object; new grip gripper close",
            "safe interfaces | /part_pose watcher | subscriber added | None -> present",
        ],
    ),
}


@pytest.mark.parametrize("name", GROUPS)
def test_an_edit_is_told_by_what_it_means(name: str, repository: Repository, main: Package) -> None:
    edits, expected = GROUPS[name]
    after = package_of(repository, repository.commit(edited(*edits)))
    found = changes_of(main, after)
    # In a case each grade lists what belongs together.
    assert sorted(found) == sorted(expected)
    ranks = [("dangerous", "review", "safe").index(told.split()[0]) for told in found]
    assert ranks == sorted(ranks)


def test_there_are_more_than_thirty_edits() -> None:
    assert sum(len(edits) for edits, _ in GROUPS.values()) >= 30


def test_another_claim_another_type_and_one_gate_more_are_told(repository: Repository, main: Package) -> None:
    standard = "L1, L2, L3, L4, L5, L6, G0, G1, G2, G3, G4, G5, G6, G7"
    edits = (
        ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped"),
        ("    gripper_action: {type", "    fingers: {type"),
        ("    arm_software: {type: configuration, device: arm}\n", ""),
        ("to: {perception: {reliability: best_effort,", "to: {perception: {reliability: reliable,"),
        ("gates: standard ", f"gates: [{standard.replace('G3,', 'G3, cable check,')}] "),
    )
    found = changes_of(main, package_of(repository, repository.commit(edited(*edits))))
    software = "ur_controllers/URConfiguration"
    assert sorted(
        finding for finding in found if finding.split()[1] in ("control", "interfaces", "QoS", "gates", "safety")
    ) == sorted(
        [
            f"review control | arm_software | controller removed | {software}Controller -> None",
            "dangerous interfaces | /object_pose | type | geometry_msgs/msg/PoseStamped -> "
            "geometry_msgs/msg/PoseWithCovarianceStamped | breaks",
            "review control | fingers | name of the controller | gripper_action -> fingers | 1 name follows | breaks",
            "review interfaces | /arm_software/get_robot_software_version | interface removed | "
            "ur_msgs/srv/GetRobotSoftwareVersion -> None | breaks",
            "review QoS | /camera/color/image_raw subscribers perception | quality of service reliability | "
            "best_effort -> reliable",
            "review gates | cell | gates | 14 entries -> 15 entries | new cable check",
        ]
    )


def test_ends_that_connect_no_longer_are_dangerous_and_the_reverse_is_safe(main: Package) -> None:
    # A reader that asks for reliable hears no writer that offers best effort (DDS 1.4, 2.2.3.14).
    contract = json.loads(main.files["contract.json"])
    (writer,) = contract["interfaces"]["/object_pose"]["sources"]
    writer["qos"]["reliability"] = "best_effort"
    deaf = facts_of({**main.files, "contract.json": json.dumps(contract)})
    lost, back = (
        [change for change in changes_between(*sides) if change.quantity == "edge"]
        for sides in ((main.facts, deaf), (deaf, main.facts))
    )
    assert [(*one.subjects, one.before, str(one.grade), one.breaking, one.why) for one in lost] == [
        (
            "/object_pose: perception to task",
            "connected",
            "dangerous",
            True,
            "samples no longer arrive (reliability: offered best_effort, requested reliable)",
        )
    ]
    assert [(*one.subjects, one.after, str(one.grade), one.breaking) for one in back] == [
        ("/object_pose: perception to task", "connected", "safe", False)
    ]
