"""Parts of a spec that linking reports, by the code: what is on the page of each."""

from __future__ import annotations

from collections.abc import Mapping

# Each is merged into a complete cell by a test, which finds it reported at its mark and nowhere else.
EXAMPLES: Mapping[str, str] = {
    "ambiguous-node": """
devices:
  stage: {model: ./stage, mount: {parent: world, xyz: 0 2 0 m}, revision: A, firmware: stage 1.0.0}
managers:
  stages:
    namespace: /stages
    update_rate: 100 Hz
    host: control_pc
    controllers:
      joint_states: {type: joint_state_broadcaster}
      stage_trajectory: {type: joint_trajectory, device: stage, client: task, goal_time: 2 s,
                         path_tolerance: 0.2 rad 20 mm, goal_tolerance: {stage/turn: 0.1 rad, stage/slide: 5 mm}}
interfaces:
  /positions: {topic: sensor_msgs/msg/JointState, from: joint_states, to: {task: {depth: 1}},  # expect at from
               wants: newest, rate: 100 Hz, max_age: 100 ms, on_stale: reject_goal}
""",
    "unknown-calibration": """
frames:
  tcp: {calibration: tcp_new}  # expect at calibration
""",
    "unknown-clock": """
rehearsals:
  jump: {use: pick_and_place, inject: {jump_clock: contrl_pc, by: 1 s, at: 1 s},  # expect at jump_clock
         expect: stale_state}
""",
    "unknown-controller": """
control:
  switches:
    hold: {deactivate: [arm_trajectry]}  # expect at 0
""",
    "unknown-device": """
control:
  controllers:
    arm_trajectory: {device: arn}  # expect at device
""",
    "unknown-frame": """
motion:
  goals:
    pick: {frame: objct}  # expect at frame
""",
    "unknown-goal": """
rehearsals:
  short:
    steps: [{move: hom}]  # expect at move
""",
    "unknown-group": """
motion:
  goals:
    pick: {group: manipulater}  # expect at group
""",
    "unknown-host": """
nodes:
  task: {host: control_cp}  # expect at host
""",
    "unknown-interface": """
rehearsals:
  late: {use: pick_and_place, inject: {mismatch_qos: /object_pos, at: 1 s},  # expect at mismatch_qos
         expect: stale_state}
""",
    "hand-eye-differs": """
calibrations:
  hand_eye: {from: measured/hand_eye.json}
devices:
  camera:
    mount: {xyz: 0 -70 30 mm}  # expect at xyz
""",
    "hand-eye-of-other-frames": """
calibrations:
  hand_eye: {from: measured/nameless.json}  # expect at hand_eye
""",
    "invalid-hand-eye": """
calibrations:
  hand_eye: {parent: arm/tool0}  # expect at parent
""",
    "invalid-kinematics": """
devices:
  gripper:
    calibration: {file: measured_arm/side_arm.yaml}  # expect at calibration
""",
    "unknown-joint": """
devices:
  arm:
    simulated_joints:
      joint_9: {lag: 10 ms}  # expect at joint_9
""",
    "unknown-model": """
devices:
  arm: {model: demo_amr}  # expect at model
""",
    "unknown-nic": """
devices:
  arm:
    connection: {nic: robt}  # expect at nic
""",
    "unknown-node": """
interfaces:
  /object_pose: {from: perceptoin}  # expect at from
""",
    "unknown-planner": """
motion:
  groups:
    manipulator: {ik: kdll}  # expect at ik
""",
    "unknown-rehearsal": """
rehearsals:
  repeated: {use: pick_and_plce}  # expect at use
""",
    "unknown-signal": """
devices:
  io: {model: ./demo_io}
  clamp:
    model: ./demo_clamp
    switching: {outputs: {valve: io/io/out_9}}  # expect at valve
""",
    "unknown-state": """
devices:
  lamp:
    model: ./demo_lamp
    switching: {starts: blinking}  # expect at starts
""",
    "controller-without-device": """
control:
  controllers:
    arm_hold: {type: joint_trajectory}  # expect at arm_hold
""",
    "event-never-comes": """
rehearsals:
  late: {use: pick_and_place, inject: {freeze: camera, at: {step: 8}},  # expect at step
         expect: stale_state}
""",
    "not-a-chain": """
motion:
  groups:
    manipulator: {base: gripper/base, tip: arm/base_link}  # expect at tip
""",
    "not-an-executable": """
nodes:
  task: {run: pick_place}  # expect at run
""",
    "planner-not-in-distro": """
motion:
  groups:
    manipulator: {ik: bio_ik}  # expect at ik
""",
    "confidence-of-nothing": """
rehearsals:
  pick_and_place: {confidence: 99 %}  # expect at confidence
""",
    "repeatability-of-nothing": """
uncertainty: {repeatability: {gripper: 0.05 mm}}  # expect at gripper
""",
    "rehearsal-cycle": """
rehearsals:
  first: {use: second}  # expect at use
  second: {use: first}  # expect at use
""",
    "unknown-controller-kind": """
control:
  controllers:
    arm_trajectory: {type: joint_trajectry}  # expect at type
""",
    "unknown-distro": """
versions:
  ros: rolling  # expect at ros
""",
}
