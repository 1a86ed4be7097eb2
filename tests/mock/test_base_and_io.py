"""An arm on a base, and a lamp on a block of digital signals: devices of the catalog that the mock runs."""

from __future__ import annotations

from pathlib import Path

from cellc.mock import load
from tests.cells import build_into, graph_of, written

_CELL = """format: 1
cell: io_bench
versions: {ros: jazzy}
devices:
  stand: {model: pedestal, mount: {parent: world}}
  arm: {model: ur5e, mount: {parent: stand/mount}}
  block: {model: digital_io, mount: {parent: world, xyz: 1 1 0 m}}
  lamp:
    model: signal_lamp
    mount: {parent: world, xyz: 1 0 0 m}
    switching: {outputs: {light: block/io/out_0}}
control:
  update_rate: 500 Hz
  controllers:
    joint_states: {type: joint_state_broadcaster}
    arm_trajectory:
      {type: scaled_joint_trajectory, device: arm, goal_time: 1 s, path_tolerance: 0.2 rad, goal_tolerance: 0.01 rad}
    arm_io: {type: io_and_status, device: arm}
    block_outputs:
      type: gpio_command
      device: block
      parameters: {gpios: ["{prefix}io"], "command_interfaces.{prefix}io.interfaces": [out_0]}
motion:
  groups: {manipulator: {base: arm/base_link, tip: arm/tool0}}
  poses:
    ready: {manipulator: 0 -90 90 -90 -90 0 deg}
    aside: {manipulator: 30 -90 90 -90 -90 0 deg}
rehearsals:
  ready: {steps: [{move: aside}, {set: lamp, state: lit}, {move: ready}]}
"""


def test_arm_on_a_base_moves_and_a_block_of_signals_lights_a_lamp(tmp_path: Path) -> None:
    spec = written(tmp_path, _CELL)
    pose = graph_of(spec).frames.in_world("arm_base_link")
    assert pose is not None
    assert pose.position == (0.0, 0.0, 0.7)
    result = load(build_into(tmp_path / "folder", spec)).run("ready")
    assert (result.outcome, [attempt.outcome for attempt in result.attempts]) == ("succeeded", ["succeeded"] * 4)
