"""The plan of the bring-up and the program that takes it: proof first, one request, the effect, and a last word."""

from __future__ import annotations

import ast
import json
import stat
import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory
from types import SimpleNamespace
from typing import Any
from xml.etree.ElementTree import fromstring

import pytest

from tests.cells import built
from tests.consumers.matrix import Build, build, every_build
from tests.consumers.permissions import policy_of
from tests.consumers.stand_in_graph import StandIn, messages_of, program
from tests.consumers.starting import (
    activated,
    bring_ups,
    every_process,
    moves,
    plan,
    processes,
    proven,
    written,
    written_managers,
)
from tests.emit.cells import contract_data
from tests.foreign_yaml import safe_load

TARGETS = ("mock", "real")
_ENDLESS = "import time; print('up', flush=True); time.sleep(600)"
_DESCRIBING = ("robot_state", "description")
_REPORTING = ("arm_speed", "arm_io", "arm_tcp", "arm_software")
_RUNNING = "/arm_io/robot_program_running"
_SPEED = "/arm_speed/speed_scaling"


def every_proof(cell: str, distro: str) -> Iterator[Any]:
    """Yield all proofs and effects of both targets."""
    for target in TARGETS:
        for step in proven(plan(cell, distro), target):
            yield from (*step["proof"], *step.get("effect", ()))


@every_build
def test_launching_takes_every_phase_of_its_target(cell: str, distro: str) -> None:
    for target in TARGETS:
        taken = [process.arguments for process in processes(cell, distro, target) if process.executable == "bring_up"]
        assert all(words[:4] == ("--plan", "config/bring_up.json", "--target", target) for words in taken)
        phases = {step["phase"] for step in plan(cell, distro)[target]}
        launched = {"start", "claim", "activate"} & phases if target == "mock" else {"start"} & phases
        assert {word for words in taken for word in words[4:]} & {"start", "activate", "claim"} == launched
        for process in moves(build(cell, distro), target):
            assert process.prefix[-2:] == ("move", "--")
            assert target in process.prefix


class _ParsedError(Exception):
    """The program has read its arguments and its plan, and would join the graph."""


@every_build
def test_program_takes_the_arguments_that_it_is_launched_with(cell: str, distro: str) -> None:
    built = build(cell, distro)
    started = [
        process.arguments
        for process in every_process(built)
        if (process.package, process.executable) == (cell, "bring_up")
    ]
    started += [move.prefix[1:] for target in TARGETS for move in moves(built, target)]
    for target in TARGETS:
        phases = {word for words in started if target in words for word in _parsed(built, words)}
        # No launch file is left out: each phase that the plan has is begun by one of them.
        assert phases >= {step["phase"] for step in plan(cell, distro)[target]}


def _parsed(built: Build, words: tuple[str, ...]) -> list[str]:
    """Let the program read the words that it is launched with, as launch_ros extends them; return the phases."""
    module = program(built.cell, built.distro)

    def joined(name: str, enclave: str) -> None:
        raise _ParsedError(name)

    module.Graph = joined
    with TemporaryDirectory() as folder:
        told = [f"{folder}/{Path(word).name}" if word in built.texts else word for word in words]
        (Path(folder) / "bring_up.json").write_text(built.texts["config/bring_up.json"], encoding="utf-8")
        with pytest.raises(_ParsedError):
            module.main([*told, "--ros-args", "--enclave", "/cell"])
    return [word for word in words if word in ("start", "activate", "claim", "move")]


@every_build
def test_real_target_is_claimed_by_a_person_alone(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    claims = [step for step in plan(cell, distro)["real"] if step["phase"] == "claim"]
    assert bool(claims) is ("launch/claim.launch.xml" in texts)
    if claims:
        (argument,) = fromstring(texts["launch/claim.launch.xml"]).findall("arg")
        assert "default" not in argument.attrib
        released = {step["release"] for step in claims}
        words = [choice.attrib["value"] for choice in argument.findall("choice")]
        named = {word.partition("_FOR_")[2] for word in words}
        assert (len(words), named) == (len(released), released if len(released) > 1 else {""})


@every_build
def test_conditions_name_what_the_cell_has(cell: str, distro: str) -> None:
    texts = build(cell, distro).texts
    contract = contract_data(texts["contract.json"])
    frames = set(safe_load(texts["config/frames.yaml"])["frames"])
    controllers = {
        (f"{manager['namespace']}/controller_manager", controller["full_name"].rpartition("/")[2])
        for manager in contract["managers"].values()
        for controller in manager["controllers"].values()
    }
    asked = {f"{manager['namespace']}/controller_manager" for manager in contract["managers"].values()}
    asked |= {
        f"{manager['namespace']}/{name}_publisher" for manager in contract["managers"].values() for name in _DESCRIBING
    }
    managed = {f"/{name}" for name, node in written(cell).get("nodes", {}).items() if node.get("lifecycle")}
    kinds = {name: one["kind"] for name, one in contract["interfaces"].items()}
    descriptions = {path: fromstring(text) for path, text in texts.items() if path.endswith(".urdf")}
    components = {
        ros2_control.attrib["name"] for root in descriptions.values() for ros2_control in root.findall("ros2_control")
    }
    # The stopper of claims, where a robot tells whether it listens.
    watching = {"/claim_watch"} if plan(cell, distro).get("watches") else set()
    for proof in every_proof(cell, distro):
        if proof["kind"] == "controller":
            assert (proof["manager"], proof["controller"]) in controllers
        elif proof["kind"] in ("topic", "action"):
            assert kinds[proof[proof["kind"]]] == proof["kind"]
        elif proof["kind"] == "transform":
            assert {proof["parent"], proof["child"]} <= frames
        elif proof["kind"] == "hardware":
            assert proof["component"] in components
        elif proof["kind"] == "alone":
            assert set(proof["nodes"]) <= {*managed, *asked}
        else:
            assert proof["kind"] == "mock" or proof["node"] in managed | watching, proof


@every_build
def test_mover_of_the_mock_looks_at_the_description_of_every_manager(cell: str, distro: str) -> None:
    # Each host is started with a target of its own, so that one manager may run the mock and another a robot.
    managers = [namespace for namespace, _ in written_managers(cell, distro)]
    alone = f"/{'robot_state' if len(managers) == 1 else 'description'}_publisher"
    asked = "/controller_manager" if distro == "humble" else alone
    steps = proven(plan(cell, distro), "mock")
    moving = [step for step in steps if step["phase"] == "move"]
    looked = [proof["node"] for step in moving for proof in step["proof"] if proof["kind"] == "mock"]
    assert looked == ([f"{manager}{asked}" for manager in managers] if moving else [])
    # Nor does the mock ask anything of a real cell that waits in the same domain.
    for step in steps:
        if step.get("request") is not None:
            looked = [proof for proof in step["proof"] if proof["kind"] == "mock"]
            assert [proof["node"] for proof in looked] == [f"{manager}{asked}" for manager in managers]


@every_build
def test_nothing_is_asked_where_a_second_cell_would_hear_it(cell: str, distro: str) -> None:
    # A mock that nobody ended has the names of the real cell, and answers in its place.
    for target in TARGETS:
        for step in proven(plan(cell, distro), target):
            to = step["request"] if step.get("request") is not None else {}
            if to.get("kind") == "versions":  # it reads what is installed, and asks no node
                assert "proof" not in step or not step["proof"]
                continue
            (alone,) = [proof["nodes"] for proof in step["proof"] if proof["kind"] == "alone"]
            assert {to[key] for key in ("manager", "node") if key in to} <= set(alone)


@every_build
def test_everything_is_activated_once_and_alternates_never(cell: str, distro: str) -> None:
    for target in TARGETS:
        for namespace, manager in written_managers(cell, distro):
            spawned = _spawned(cell, distro, target, namespace)
            wanted = [n for n, one in manager["controllers"].items() if one.get("active", True) and n in spawned]
            assert sorted(activated(cell, distro, target, f"{namespace}/controller_manager")) == sorted(wanted)


def _spawned(cell: str, distro: str, target: str, namespace: str) -> set[str]:
    lines = [
        process.arguments
        for launch in bring_ups(build(cell, distro), target)
        for process in launch.processes
        if process.executable == "spawner" and f"{namespace}/controller_manager" in process.arguments
    ]
    return {name for line in lines for name in line[: line.index("-c")]}


@every_build
def test_policy_lets_the_steps_ask_and_act(cell: str, distro: str) -> None:
    policy = policy_of(build(cell, distro).texts)
    (enclave,) = [
        enclave for enclave in policy.iter("enclave") if enclave.attrib["path"] == plan(cell, distro)["enclave"]
    ]
    may = {entry.text for profile in enclave.iter("profile") for kind in profile for entry in kind}
    for proof in every_proof(cell, distro):
        if proof["kind"] == "topic":
            assert proof["topic"] in may
        elif proof["kind"] == "controller":
            assert {f"{proof['manager']}/{name}" for name in ("list_controllers", "switch_controller")} <= may
        elif proof["kind"] == "hardware":
            assert f"{proof['manager']}/list_hardware_components" in may
        elif proof["kind"] == "lifecycle":
            assert {f"{proof['node']}/{name}" for name in ("get_state", "change_state")} <= may
        elif proof["kind"] == "mock":
            assert f"{proof['node']}/get_parameters" in may
    assert {"/tf", "/tf_static"} <= may
    # To wait is not to move: neither a goal nor a command may come from here.
    assert not [kind for profile in enclave.iter("profile") for kind in profile if kind.tag == "actions"]


def test_program_is_python_of_the_oldest_distribution_and_may_be_executed() -> None:
    text = build("ur5e_pick", "humble").texts["scripts/bring_up"]
    ast.parse(text, feature_version=(3, 10))
    assert text.startswith("#!/usr/bin/env python3\n")
    (folder,) = [parent for parent in Path(__file__).parents if (parent / "generated").is_dir()]
    for file in folder.glob("generated/*/scripts/bring_up"):
        assert file.stat().st_mode & stat.S_IXUSR


def started() -> StandIn:
    """Return the pick cell with its processes up and nothing configured."""
    module = program()
    messages_of(module)
    return StandIn(
        module,
        nodes_={"/perception": "unconfigured", "/robot_state_publisher": "", "/claim_watch": ""},
        controllers=dict.fromkeys(("joint_states", "arm_trajectory", "gripper_action", *_REPORTING), "inactive"),
        hardware={"arm_hardware": "active", "gripper_hardware": "unconfigured"},
        messages={
            "/joint_states": SimpleNamespace(),
            _RUNNING: SimpleNamespace(data=True),
            _SPEED: SimpleNamespace(data=100.0),
            "/arm_io/safety_mode": SimpleNamespace(mode=1),
            "/arm_io/robot_mode": SimpleNamespace(mode=7),
        },
        servers={"/move_action", "/gripper_action/gripper_cmd"},
        frames={"world", "camera_color_optical_frame", "arm_base_link", "tcp"},
    )


@pytest.fixture
def graph() -> StandIn:
    """The pick cell with its processes up and nothing configured."""
    return started()


def run(graph: StandIn, tmp_path: Path, *words: str, wait_s: float = 20.0, steps: str = "") -> int:
    """Run the program of the pick cell on a graph, with its own plan or that of another cell."""
    module = graph.module
    module.Graph = lambda name, enclave: graph
    module.LOOK_S = 0.0
    module.ANSWER_S = 0.0
    module.PATIENCE_S = wait_s
    file = tmp_path / "bring_up.json"
    file.write_text(steps or json.dumps(plan("ur5e_pick", "jazzy")))
    ended = module.main(["--plan", str(file), *words])
    assert isinstance(ended, int)
    return ended


def test_steps_are_taken_in_the_order_of_their_proofs(graph: StandIn, tmp_path: Path) -> None:
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim") == 0
    assert graph.log == [
        "/perception inactive",
        "activate joint_states",
        "activate arm_speed",
        "/perception active",
        "activate gripper_hardware",
        "deactivate joint_states",
        "activate joint_states",
        "activate arm_trajectory",
        "activate gripper_action",
        "leave",
    ]


def test_steps_that_were_taken_before_are_not_asked_for_again(graph: StandIn, tmp_path: Path) -> None:
    run(graph, tmp_path, "--target", "mock", "start", "activate", "claim")
    graph.log.clear()
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim") == 0
    # What reads states is restarted each time: whether it has read the new ones cannot be asked.
    assert graph.log == ["deactivate joint_states", "activate joint_states", "leave"]


def test_starting_the_real_target_claims_nothing(graph: StandIn, tmp_path: Path) -> None:
    assert run(graph, tmp_path, "--target", "real", "start") == 0
    # That of inputs and outputs claims no joint, and says whether the robot's program runs.
    active = {name for name, state in graph.controllers.items() if state == "active"}
    assert active == {"joint_states", *_REPORTING}


def activated_by_people(graph: StandIn, tmp_path: Path) -> None:
    """Take the steps up to the activation while no program plays, and play it: as the gates have people do."""
    graph.messages[_RUNNING] = SimpleNamespace(data=False)
    assert run(graph, tmp_path, "--target", "real", "start", "activate") == 0
    graph.messages[_RUNNING] = SimpleNamespace(data=True)


def claimed(graph: StandIn, tmp_path: Path) -> None:
    """Take the steps of the real target up to the claims."""
    activated_by_people(graph, tmp_path)
    assert run(graph, tmp_path, "--target", "real", "claim") == 0


def test_a_publisher_that_speaks_of_changes_alone_need_not_have_spoken(graph: StandIn, tmp_path: Path) -> None:
    # Universal_Robots_ROS2_Driver 3.8.0 gpio_controller.cpp:267: a program that never ran since its start is not told.
    del graph.messages[_RUNNING]
    assert run(graph, tmp_path, "--target", "real", "start", "activate", wait_s=0.05) == 1
    graph.silent_for[_RUNNING] = graph.module.UNSAID_S + 0.1
    assert run(graph, tmp_path, "--target", "real", "start", "activate") == 0
    assert run(graph, tmp_path, "--target", "real", "claim", wait_s=0.05) == 1  # that it runs must be said


def test_claims_are_not_asked_for_where_the_watch_does_not_agree(
    graph: StandIn, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    activated_by_people(graph, tmp_path)
    graph.refuses.add("arm")
    assert run(graph, tmp_path, "--target", "real", "claim") == 1
    assert "acknowledge_arm refused: a proof is missing" in capsys.readouterr().err
    assert graph.controllers["arm_trajectory"] == "inactive"


def test_hardware_that_moves_as_it_is_activated_waits_for_a_person(graph: StandIn, tmp_path: Path) -> None:
    run(graph, tmp_path, "--target", "real", "start")
    assert graph.hardware["gripper_hardware"] == "unconfigured"
    assert run(graph, tmp_path, "--target", "real", "claim", wait_s=0.05) == 1
    assert run(graph, tmp_path, "--target", "real", "activate", wait_s=0.05) == 1  # a program plays
    activated_by_people(graph, tmp_path)
    assert run(graph, tmp_path, "--target", "real", "claim") == 0


def test_release_of_one_arm_activates_that_arm_alone_in_any_order(tmp_path: Path) -> None:
    """Nothing can be read before the first arm is active; then what reads states is restarted to read the other."""
    steps = built("openarm_bimanual").texts["config/bring_up.json"]
    graph = started()
    graph.nodes_ = {"/robot_state_publisher": "", "/controller_manager": ""}
    controllers = ("joint_states", "left_trajectory", "right_trajectory", "left_gripper", "right_gripper")
    graph.controllers = dict.fromkeys(controllers, "inactive")
    graph.hardware = {f"openarm_{side}_hardware_interface": "unconfigured" for side in ("left", "right")}
    graph.frames = {f"openarm_{side}_{name}" for side in ("left", "right") for name in ("base_link", "grasp")}
    assert run(graph, tmp_path, "--target", "real", "start", steps=steps) == 0
    assert set(graph.controllers.values()) == {"inactive"}
    for side, restarted in (("right", []), ("left", ["deactivate joint_states"])):
        graph.log.clear()
        assert run(graph, tmp_path, "--target", "real", "--release", side, "activate", steps=steps) == 0
        activated = f"activate openarm_{side}_hardware_interface"
        assert graph.log == [activated, *restarted, "activate joint_states", "leave"]
    for side in ("left", "right"):
        graph.log.clear()
        assert run(graph, tmp_path, "--target", "real", "--release", side, "claim", steps=steps) == 0
        assert graph.log == [f"activate {side}_trajectory", f"activate {side}_gripper", "leave"]


def test_ur_is_claimed_while_its_program_runs_and_the_person_acknowledges_for_it(
    graph: StandIn, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    # Universal_Robots_ROS2_Driver issue 1084: claimed, jogged, played, and the arm jumps to where it was claimed.
    (watched,) = plan("ur5e_pick", "jazzy")["watches"]
    assert watched["controllers"] == ["arm_trajectory"]
    activated_by_people(graph, tmp_path)
    graph.messages[_RUNNING] = SimpleNamespace(data=False)
    assert run(graph, tmp_path, "--target", "real", "claim", wait_s=0.05) == 1
    assert "/arm_io/robot_program_running must be True, got False" in capsys.readouterr().err
    graph.messages[_RUNNING] = SimpleNamespace(data=True)
    assert run(graph, tmp_path, "--target", "real", "claim") == 0
    assert graph.log[-4:] == ["acknowledge arm", "activate arm_trajectory", "activate gripper_action", "leave"]
    assert [process for process in processes("ur5e_pick", "jazzy", "real") if process.executable == "claim_watch"]


def test_mock_asks_nothing_of_a_real_cell_in_the_same_domain(graph: StandIn, tmp_path: Path) -> None:
    graph.plugins = "<plugin>ur_robot_driver/URPositionHardwareInterface</plugin>"
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim", wait_s=0.05) == 1
    assert graph.hardware["gripper_hardware"] == "unconfigured"
    assert graph.controllers["arm_trajectory"] == "inactive"


@pytest.mark.parametrize("name", ["/controller_manager", "/perception", "/robot_state_publisher"])
def test_mock_asks_nothing_where_another_cell_has_its_names(graph: StandIn, tmp_path: Path, name: str) -> None:
    # Two servers of one name both hear a request: `ros2 node list` warns of that, and nothing refuses it.
    graph.nodes_["/controller_manager"] = ""
    graph.twice = [name]
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim", wait_s=0.05) == 1
    assert set(graph.controllers.values()) == {"inactive"}
    assert graph.nodes_["/perception"] == "unconfigured"


def test_real_target_asks_nothing_where_a_mock_was_not_ended(
    graph: StandIn, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    graph.nodes_["/controller_manager"] = ""
    graph.twice = ["/controller_manager"]
    assert run(graph, tmp_path, "--target", "real", "start", wait_s=0.05) == 1
    assert "expected one node /controller_manager, got two" in capsys.readouterr().err
    assert graph.log == ["leave"]


@pytest.mark.parametrize("left", ["arm_trajectory", "gripper_action"])
def test_claim_after_a_stop_asks_for_what_was_lost_alone(graph: StandIn, tmp_path: Path, left: str) -> None:
    # A strict request that names an active controller is refused as a whole: ros2_control 4.47.0, controller_manager.
    activated_by_people(graph, tmp_path)
    run(graph, tmp_path, "--target", "real", "claim")
    graph.controllers[left] = "inactive"
    graph.log.clear()
    assert run(graph, tmp_path, "--target", "real", "claim", wait_s=0.05) == 0
    assert graph.log == ["acknowledge arm", f"activate {left}", "leave"]


def test_claims_that_hold_are_not_called_done_while_the_robot_is_deaf(
    graph: StandIn, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    activated_by_people(graph, tmp_path)
    run(graph, tmp_path, "--target", "real", "claim")
    graph.messages[_RUNNING] = SimpleNamespace(data=False)
    assert run(graph, tmp_path, "--target", "real", "claim", wait_s=0.05) == 1
    assert "robot_program_running must be True, got False" in capsys.readouterr().err


def test_processes_that_come_up_late_are_waited_for(graph: StandIn, tmp_path: Path) -> None:
    controllers, graph.controllers = graph.controllers, {}
    graph.on_spin = lambda times: graph.controllers.update(controllers) if times == 5 else None
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim") == 0


@pytest.mark.parametrize(
    ("kind", "said"),
    [
        ("spawner", "controller joint_states must be inactive, got not loaded"),
        ("hardware", "hardware arm_hardware must be active, got inactive"),
        ("transform", "no transform from arm_base_link to tcp"),
        ("states", "no message on /joint_states"),
        ("refusal", "/perception refused to configure"),
        ("switch", "/controller_manager refused to activate arm_trajectory, gripper_action"),
    ],
)
def test_nothing_is_claimed_without_proof_and_what_is_missing_is_said(
    graph: StandIn, tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str, said: str
) -> None:
    if kind == "spawner":
        graph.controllers.clear()
    elif kind == "hardware":
        graph.hardware["arm_hardware"] = "inactive"
    elif kind == "transform":
        graph.frames.discard("tcp")
    elif kind == "states":
        graph.messages.clear()
    else:
        graph.refuses |= {"/perception"} if kind == "refusal" else {"arm_trajectory"}
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim", wait_s=0.05) == 1
    assert "activate arm_trajectory" not in graph.log
    error = capsys.readouterr().err
    assert said in error
    assert kind in ("transform", "states", "switch") or "Skipped: " in error


def test_lost_answer_of_a_request_that_was_done_is_no_failure(graph: StandIn, tmp_path: Path) -> None:
    graph.silent = 2
    assert run(graph, tmp_path, "--target", "mock", "start", "activate", "claim") == 0
    assert graph.log.count("activate arm_trajectory") == 1


@pytest.mark.parametrize("plugins", ["mock_components/GenericSystem", "a_driver/Hardware", ""])
def test_mover_of_the_mock_is_not_started_on_real_hardware(
    graph: StandIn, tmp_path: Path, capfd: pytest.CaptureFixture[str], plugins: str
) -> None:
    run(graph, tmp_path, "--target", "mock", "start", "activate", "claim")
    graph.plugins = f"<plugin>{plugins}</plugin><plugin>mock_components/GenericSystem</plugin>" if plugins else ""
    ended = run(graph, tmp_path, "--target", "mock", "move", "--", "echo", "it moves", wait_s=0.05)
    mocked = plugins == "mock_components/GenericSystem"
    assert ("it moves" in capfd.readouterr().out) is mocked
    assert ended == (0 if mocked else 1)


def test_mover_waits_for_its_claims(graph: StandIn, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    run(graph, tmp_path, "--target", "real", "start")
    assert run(graph, tmp_path, "--target", "real", "move", "--", "echo", "it moves", wait_s=0.05) == 1
    said = capfd.readouterr()
    assert "it moves" not in said.out
    assert "controller arm_trajectory must be active, got inactive" in said.err


def test_mover_does_not_survive_its_claims(graph: StandIn, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    claimed(graph, tmp_path)
    graph.on_spin = lambda times: graph.controllers.update(arm_trajectory="inactive")
    assert run(graph, tmp_path, "--target", "real", "move", "--", sys.executable, "-c", _ENDLESS) == 1
    assert "stopped: controller arm_trajectory must be active, got inactive" in capfd.readouterr().err


def test_mover_does_not_survive_a_managed_node(
    graph: StandIn, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    # An adapter claims as a controller does, and people deactivate it to clear the area.
    claimed(graph, tmp_path)
    graph.on_spin = lambda times: graph.nodes_.update({"/perception": "inactive"})
    assert run(graph, tmp_path, "--target", "real", "move", "--", sys.executable, "-c", _ENDLESS) == 1
    assert "stopped: /perception must be active, got inactive" in capfd.readouterr().err


@pytest.mark.parametrize(
    ("topic", "message", "said"),
    [
        ("/arm_io/safety_mode", SimpleNamespace(mode=5), "/arm_io/safety_mode must be 1 or 2, got 5"),
        (_SPEED, SimpleNamespace(data=0.0), "/arm_speed/speed_scaling must be above 0, got 0.0"),
        ("/arm_io/robot_mode", SimpleNamespace(mode=3), "/arm_io/robot_mode must be 7, got 3"),
        (_RUNNING, SimpleNamespace(data=False), "/arm_io/robot_program_running must be True, got False"),
    ],
)
def test_mover_does_not_survive_a_stop_that_is_over_before_anybody_looks(
    graph: StandIn, tmp_path: Path, capfd: pytest.CaptureFixture[str], topic: str, message: Any, said: str
) -> None:
    claimed(graph, tmp_path)
    # One message, and the newest one of the topic is as before by the time of the next look.
    graph.on_spin = lambda times: graph.on_message(topic, message)
    assert run(graph, tmp_path, "--target", "real", "move", "--", sys.executable, "-c", _ENDLESS) == 1
    assert f"stopped: {said}" in capfd.readouterr().err


def test_exit_status_of_the_mover_is_passed_on(graph: StandIn, tmp_path: Path) -> None:
    claimed(graph, tmp_path)
    command = [sys.executable, "-c", "raise SystemExit(7)", "--ros-args", "-r", "__node:=task"]
    assert run(graph, tmp_path, "--target", "real", "move", "--", *command) == 7


def test_fingers_run_while_no_program_plays_and_a_claim_waits_for_what_takes_it_back() -> None:
    # ros2_control 4.46.0, resource_manager.cpp:2376: a component that is activated holds up all others for seconds.
    steps = {step["name"]: step["proof"] for step in proven(plan("ur5e_pick", "jazzy"), "real")}
    told = {"kind": "topic", "topic": _RUNNING, "type": "std_msgs/msg/Bool", "field": "data"}
    assert {**told, "values": [False], "unsaid": True} in steps["activate_gripper"]
    assert {**told, "values": [True]} in steps["claim_control"]
    assert {"kind": "node", "node": "/claim_watch"} in steps["claim_control"]


@pytest.mark.parametrize(
    ("edges", "parent", "child", "connected"),
    [
        ({"a": "world"}, "world", "a", True),
        ({"a": "world"}, "a", "world", True),  # either way up the tree
        ({"a": "world", "b": "a", "c": "b"}, "world", "c", True),
        ({"a": "world", "b": "a", "c": "b", "d": "a"}, "c", "d", True),  # by way of a
        ({"/a": "/world"}, "world", "a", True),  # tf2 strips a leading slash
        ({"b": "a", "d": "c"}, "a", "d", False),
        ({"b": "a"}, "a", "unheard", False),
        ({}, "world", "world", False),
        ({"a": "b", "b": "a", "d": "c"}, "a", "d", False),  # a circle ends
    ],
)
def test_frames_are_connected_by_what_both_hang_on(
    edges: dict[str, str], parent: str, child: str, connected: bool
) -> None:
    graph = object.__new__(program().Graph)
    graph._parents, graph._listened = {}, {"/tf", "/tf_static"}
    headers = {name: SimpleNamespace(frame_id=above) for name, above in edges.items()}
    heard = [SimpleNamespace(child_frame_id=name, header=header) for name, header in headers.items()]
    for edge in heard:  # one message each, as several publishers send them
        graph._place(SimpleNamespace(transforms=[edge]))
    assert graph.connects(parent, child) is connected


def test_launch_ends_with_the_manager_and_with_the_stopper_of_claims_on_every_distribution() -> None:
    # Universal_Robots_ROS2_Driver issue 1084: with a dead stopper a claim outlives the program, and the arm jumps.
    for distro in ("humble", "jazzy"):
        found = [process for process in processes("ur5e_pick", distro, "real") if process.executable == "claim_watch"]
        found += [
            process for process in processes("ur5e_pick", distro, "real") if process.executable == "ros2_control_node"
        ]
        assert len(found) == 2
        for finding in found:
            by_prefix = bool(finding.prefix) and finding.prefix[0].endswith("/lib/ur5e_pick/required")
            assert finding.on_exit == "shutdown" if distro == "jazzy" else by_prefix
