"""What holds every number of the language: a rule that is not in a table of bounds, or nothing, with the reason.

Keys are places in the schema of ``cell.yaml``: ``*`` is a name or a number of a list.
"""

from __future__ import annotations

BY_RULES: dict[str, tuple[str, ...]] = {
    "areas.*.rpy": ("out-of-range",),
    "bringup.commissioning.stages": ("disordered-stages", "out-of-range"),
    "bringup.first_motion.max_delta": ("first-motion-too-large", "first-motion-cannot-end"),
    "bringup.first_motion.velocity": ("first-motion-too-large", "first-motion-cannot-end"),
    "control.controllers.*.path_tolerance": ("path-tolerance-without-effect", "unmeetable-tolerance"),
    "control.controllers.*.path_tolerance.*": ("path-tolerance-without-effect", "unmeetable-tolerance"),
    "control.controllers.*.parameters.*": ("parameter-out-of-range", "wrong-parameter-type"),
    "control.controllers.*.parameters.*.*": ("parameter-out-of-range", "wrong-parameter-type"),
    "control.update_rate": ("refused-update-rate",),
    "devices.*.connection.first_port": ("shared-port", "out-of-range"),
    "devices.*.mount.rpy": ("mounted-against-vendor", "reversed-angles", "out-of-range"),
    "devices.*.mount.xyz": ("implausible-distance", "detached-mount", "implausible-view"),
    "devices.*.tool_connector.serial.baud_rate": ("refused-tool-connector", "tool-serial-mismatch"),
    "devices.*.tool_connector.serial.rx_idle_chars": ("refused-tool-connector",),
    "devices.*.tool_connector.serial.stop_bits": ("refused-tool-connector", "tool-serial-mismatch"),
    "devices.*.tool_connector.serial.tcp_port": ("shared-port", "out-of-range"),
    "devices.*.tool_connector.serial.tx_idle_chars": ("refused-tool-connector",),
    "devices.*.tool_connector.voltage": ("refused-tool-connector", "tool-voltage-mismatch"),
    "format": ("unsupported-format",),
    "frames.*.grasp.friction": ("grip-too-weak", "out-of-range"),
    "frames.*.rpy": ("out-of-range",),
    "frames.*.simulated_pose.rpy": ("out-of-range",),
    "frames.*.xyz": ("implausible-distance",),
    "kpis.stale_state_rejection": ("tolerated-wrong-owner",),
    "kpis.wrong_owner_events": ("tolerated-wrong-owner",),
    "motion.goals.*.approach": ("implausible-approach", "infeasible-approach"),
    "motion.goals.*.rpy": ("unreachable-goal", "out-of-range"),
    "motion.goals.*.xyz": ("goal-out-of-reach", "unreachable-goal"),
    "motion.poses.*.*": ("pose-outside-limits", "radians-as-degrees"),
    "network.domain_id": ("domain-id-out-of-range", "domain-in-ephemeral-ports"),
    "network.servers.*.port": ("taken-discovery-port", "out-of-range"),
    "nodes.*.callbacks.*.period": ("callbacks-exceed-thread",),
    "nodes.*.callbacks.*.takes": ("callbacks-exceed-thread", "age-budget-exceeded"),
    "nodes.*.threads": ("threads-without-effect", "out-of-range"),
    "rehearsals.*.confidence": ("out-of-range",),
    "rehearsals.*.inject.at.step": ("event-never-comes",),
    "scene.*.rpy": ("out-of-range",),
    "scene.*.touched.points.*": ("touched-points-apart", "implausible-distance"),
    "scene.*.touched.within": ("touched-points-apart", "out-of-range"),
    "scene.*.xyz": ("implausible-distance", "link-inside-scene"),
}
"""Key → codes of other rules and stages that hold it from below and above."""

FREE: dict[str, str] = {
    "calibrations.*.revision": "a counter: any revision may be the current one",
    "devices.*.stamp.simulated_offset": "a clock without a battery starts in 1970, and that is rehearsed",
    "hosts.*.clock.simulated_offset": "a clock without a battery starts in 1970, and that is rehearsed",
    "nodes.*.parameters.*": "what a parameter of the user's own program means is not known",
    "nodes.*.parameters.*.*": "what a parameter of the user's own program means is not known",
    "scene.*.touched.free": "only the side on which it lies counts, not how far away",
}
"""Key → why no bound can be given."""

WRONG: tuple[tuple[str, str], ...] = (
    (
        "kpis: {plan_to_execute: 500 s, cancel: 200 s, recovery_time: 120 h, protective_stops: 3000, "
        "missed_cycles: 20000}",
        "kpis.plan_to_execute kpis.cancel kpis.recovery_time kpis.protective_stops kpis.missed_cycles",
    ),
    (
        "calibrations: {hand_eye: {samples: 1000000, residual: 0.0008 um}}\n"
        "hosts: {control_pc: {clock: {max_offset: 0 ms, simulated_drift: 1 %}, nics: {robot: {speed: 1000 bit/s}}}}\n"
        "frames: {object: {rate: 10 kHz, buffer: 10 h, simulated_pose: {xyz: 0 -250 0 m}}, "
        "fixture_A: {reference_points: 3000}}".replace("1 %", "10000 ppm"),
        "calibrations.*.samples calibrations.*.residual hosts.*.clock.max_offset hosts.*.clock.simulated_drift "
        "hosts.*.nics.*.speed frames.*.rate frames.*.buffer frames.*.simulated_pose.xyz frames.*.reference_points",
    ),
    (
        "devices: {camera: {stamp: {exposure: 8 s, max_offset: 0 ms, simulated_drift: 20000 ppm}}}",
        "devices.*.stamp.exposure devices.*.stamp.max_offset devices.*.stamp.simulated_drift",
    ),
    (
        "interfaces: {/object_pose: {rate: 10 kHz, max_age: 200 s, transport: 5 s, "
        "from: {perception: {reliability: reliable, depth: 100000, deadline: 2000 s, lifespan: 5 h, "
        "lease_duration: 1000 s}}, "
        "simulated: {latency: 2 s, jitter: 1 s, loss: 95 %, reordering: 95 %}}, "
        "/move_action: {timeout: 20 h, cancel_within: 200 s}}",
        "interfaces.*.rate interfaces.*.max_age interfaces.*.transport interfaces.*.from.*.depth "
        "interfaces.*.from.*.deadline interfaces.*.from.*.lifespan interfaces.*.from.*.lease_duration "
        "interfaces.*.simulated.latency interfaces.*.simulated.jitter interfaces.*.simulated.loss "
        "interfaces.*.simulated.reordering interfaces.*.timeout interfaces.*.cancel_within",
    ),
    (
        "control: {controllers: {arm_trajectory: {goal_time: 1 ms, path_tolerance: 1 rad, goal_tolerance: 0.5 rad, "
        "update_rate: 20 kHz}}}\n"
        "motion: {groups: {manipulator: {ik_timeout: 5 us}}}",
        "control.controllers.*.goal_time control.controllers.*.goal_tolerance control.controllers.*.path_tolerance "
        "control.controllers.*.update_rate "
        "motion.groups.*.ik_timeout",
    ),
    (
        "control: {controllers: {arm_trajectory: {path_tolerance: 1 rad, goal_tolerance: {arm/joint_1: 0.01 rad, "
        "arm/joint_2: 0.5 rad, arm/joint_3: 0.01 rad, arm/joint_4: 0.01 rad, arm/joint_5: 0.01 rad, "
        "arm/joint_6: 0.01 rad}}}}",
        "control.controllers.*.goal_tolerance control.controllers.*.path_tolerance",
    ),
    (
        "devices: {arm: {limits: {velocity: 0.5 %, acceleration: 0.5 %}, payload: {mass: 0.1 g, part: 2 g, "
        "center_of_mass: 0 0 58 m, inertia: 2.7 3.1 3.6 0 0 0 kg m^2, load: {mass: 0.1 g, "
        "center_of_mass: 0 0 90 m, inertia: 1 1 1 0 0 0 kg m^2}}}}",
        "devices.*.limits.velocity devices.*.limits.acceleration devices.*.payload.mass devices.*.payload.part "
        "devices.*.payload.center_of_mass devices.*.payload.inertia devices.*.payload.load.mass "
        "devices.*.payload.load.center_of_mass devices.*.payload.load.inertia",
    ),
    (
        "devices: {arm: {collision: {torque: {lower: 0 0 0 0 0 0 N m, upper: 900 900 900 900 900 900 N m}, "
        "force: {lower: 0 0 0 N, upper: 4000 4000 4000 N}, moment: {lower: 0 0 0 N m, upper: 900 900 900 N m}}, "
        "impedance: {joint: 0.5 0.5 0.5 0.5 0.5 0.5 N m/rad, damping: 9 9 9 9 9 9 N m s/rad, "
        "cartesian: {translation: 1 1 1 N/m, rotation: 0.1 0.1 0.1 N m/rad}}, "
        "simulated_joints: {joint_1: {lag: 2 s, noise: 30 deg, velocity: 9000 deg/s}}}, "
        "gripper: {grip: {speed: 0.05 mm/s, force: 0.02 N}}}",
        "devices.*.collision.torque.lower devices.*.collision.torque.upper devices.*.collision.force.lower "
        "devices.*.collision.force.upper devices.*.collision.moment.lower devices.*.collision.moment.upper "
        "devices.*.impedance.joint devices.*.impedance.damping devices.*.impedance.cartesian.translation "
        "devices.*.impedance.cartesian.rotation devices.*.simulated_joints.*.lag devices.*.simulated_joints.*.noise "
        "devices.*.simulated_joints.*.velocity devices.*.grip.speed devices.*.grip.force",
    ),
    (
        "# a cell of adapted arms\ndevices: {side_arm: {adapter: {command_timeout: 2 s, stop_time: 20 s, "
        "goal_time: 1 h, path_tolerance: 3 rad, stiffness: 0.5 0.5 N m/rad, damping: 5 5 N m s/rad}}}",
        "devices.*.adapter.command_timeout devices.*.adapter.stop_time devices.*.adapter.goal_time "
        "devices.*.adapter.path_tolerance devices.*.adapter.stiffness devices.*.adapter.damping",
    ),
    (
        "# a cell of wired outputs\ndevices: {clamp: {model: ./demo_clamp, mount: {parent: world, xyz: 1 0 0 m}, "
        "switching: {outputs: {valve: io/io/out_0}, time: 2 min, within: 20 min}}}",
        "devices.*.switching.time devices.*.switching.within",
    ),
    (
        "frames: {object: {grasp: {width: 50 m, tolerance: 30 m, mass: 50 kg, size: 50 50 50 m}}}",
        "frames.*.grasp.width frames.*.grasp.size frames.*.grasp.tolerance frames.*.grasp.mass",
    ),
    (
        "scene: {table: {parent: world, xyz: 0 2 0 m, box: 0.9 1.2 0.04 mm}, "
        "post: {parent: world, xyz: 0 3 0 m, cylinder: {radius: 60 m, length: 700 m}}, "
        "ball: {parent: world, xyz: 0 4 0 m, sphere: 150 m}, wall: {parent: world, xyz: 0 5 0 m, plane: 5 km}, "
        "floor: {parent: world, touched: {shape: plane, edge: 4 mm, within: 2 mm, free: 500 500 300 mm, "
        "points: [0 0 1 mm, 1000 0 0 mm, 0 1000 1 mm, 1000 1000 2 mm]}}, "
        "jig: {parent: world, xyz: 0 6 0 m, mesh: {file: 'package://bench/jig.stl', unit: 5 m}}}\n"
        "areas: {shared: {parent: world, xyz: 9 0 0 m, box: 1 1 1 mm, granted_by: plc}}\n"
        "regions: {object: {box: 80 80 0 m, yaw: 0.001 deg}}".replace("5 km", "5000 m"),
        "scene.*.box scene.*.cylinder.radius scene.*.cylinder.length scene.*.sphere scene.*.plane "
        "scene.*.touched.edge scene.*.mesh.unit areas.*.xyz areas.*.box regions.*.box regions.*.yaw",
    ),
    (
        "uncertainty: {calibrations: {hand_eye: {rotation: 9 deg}}, repeatability: {arm: 50 mm}, "
        "tolerances: {pick: 4 m}}",
        "uncertainty.calibrations.*.rotation uncertainty.repeatability.* uncertainty.tolerances.*",
    ),
    (
        "# a cell of soft bars\nuncertainty: {loads: {bar: {part: 20 kg, compensation: 90 %}}}\n"
        "devices: {bar: {payload: {mass: 1 kg, center_of_mass: 0 0 10 mm, part: 0.5 kg}}}",
        "uncertainty.loads.*.part uncertainty.loads.*.compensation",
    ),
    (
        "uncertainty: {loads: {arm: {payload: 20 kg}}, parts: {object: {mass: 3 kg, friction: 0.4}}}\n"
        "frames: {object: {grasp: {width: 77 mm, tolerance: 2 mm, mass: 0.2 kg}}}",
        "uncertainty.loads.*.payload uncertainty.parts.*.mass uncertainty.parts.*.friction",
    ),
    (
        "nodes: {servo: {run: moveit_servo/servo_node, host: control_pc, owner: integration}}\n"
        "motion: {octomap: {source: /cloud, resolution: 25 m, range: 2 mm, rate: 60 Hz, padding: 30 mm}, "
        "servo: {node: servo, controller: arm_trajectory, linear: 50 m/s, rotational: 20 rad/s, joint: 200 rad/s, "
        "period: 1 s, command_timeout: 1 s}}",
        "motion.octomap.resolution motion.octomap.range motion.octomap.rate "
        "motion.servo.linear motion.servo.rotational motion.servo.joint motion.servo.period "
        "motion.servo.command_timeout",
    ),
    ("motion: {octomap: {source: /cloud, resolution: 25 mm, range: 2 m, padding: 1 m}}", "motion.octomap.padding"),
    (
        "control: {controllers: {gripper_action: {parameters: {stall_velocity_threshold: 0.5}}}}",
        "control.controllers.*.parameters.*",
    ),
    (
        "bringup: {commissioning: {velocity: 0.5 %, acceleration: 0.5 %, reach: 9 mm, force: 0.06 N, "
        "stages: 10 100 %}}\n"
        "safety: {risk_assessment: {document: RA-1, velocity: 250 m/s, reach: 1200 m, force: 100 kN}}",
        "bringup.commissioning.velocity bringup.commissioning.acceleration bringup.commissioning.reach "
        "bringup.commissioning.force safety.risk_assessment.velocity safety.risk_assessment.reach "
        "safety.risk_assessment.force",
    ),
    (
        "rehearsals: {stale_camera: {timeout: 100 s, within: 20 min, success: 9 %, "
        "inject: [{freeze: camera, at: 200 s, lasting: 200 s}, {skip_cycles: 90000, at: 1 s}, "
        "{slow: arm/joint_1, to: 900 rad/s, at: 1 s}, "
        "{displace: arm/joint_1, by: 90 rad, at: {step: 1, after: 200 s}}]}, "
        "long: {steps: [move: home, wait: 1000 s], timeout: 100 s}, slow: {steps: [move: home], timeout: 20 h}}",
        "rehearsals.*.timeout rehearsals.*.within rehearsals.*.success rehearsals.*.inject.at "
        "rehearsals.*.inject.lasting rehearsals.*.inject.skip_cycles rehearsals.*.inject.to rehearsals.*.inject.by "
        "rehearsals.*.inject.at.after rehearsals.*.steps.*.wait",
    ),
    (
        "bringup: {first_motion: {joint: arm/joint_6, direction: +, max_delta: 5 deg, velocity: 5 deg/s, "
        "timeout: 5 h, stop_if: [overshoot]}}",
        "bringup.first_motion.timeout",
    ),
)
"""Fragments with wrong figures, merged into the complete cell, and the keys at which each is reported."""
