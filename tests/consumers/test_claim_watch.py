"""The program that takes claims away: in the callback, once and for all, until a person acknowledges what is proven.

What a UR says is ur_controllers 3.8.0, gpio_controller.cpp:247-276 and speed_scaling_state_broadcaster.cpp:133-141.
"""

from __future__ import annotations

import ast
import json
from collections.abc import Callable
from dataclasses import dataclass, field
from types import ModuleType, SimpleNamespace
from typing import Any

import pytest

from tests.consumers.matrix import build, every_build
from tests.consumers.starting import plan

MANAGER = "/controller_manager"
RUNNING, SPEED = "/arm_io/robot_program_running", "/arm_speed/speed_scaling"
SAFETY, ROBOT = "/arm_io/safety_mode", "/arm_io/robot_mode"
WELL = {
    RUNNING: SimpleNamespace(data=True),
    SPEED: SimpleNamespace(data=100.0),
    SAFETY: SimpleNamespace(mode=1),
    ROBOT: SimpleNamespace(mode=7),
}


def program() -> Any:
    """Return the generated program as a module; nothing of ROS is imported before it makes its node."""
    module: Any = ModuleType("claim_watch_of_a_test")
    exec(compile(build("ur5e_pick", "jazzy").texts["scripts/claim_watch"], "claim_watch", "exec"), module.__dict__)
    module.loaded = lambda kind: SimpleNamespace
    return module


@dataclass
class FakeRos:
    """The node of the program, with a controller manager that does what it is asked, at once."""

    topics: dict[str, Callable[[Any], None]] = field(default_factory=dict)
    services: dict[str, Callable[[Any, Any], Any]] = field(default_factory=dict)
    published_: set[str] = field(default_factory=lambda: set(WELL))
    active: set[str] = field(default_factory=set)
    refuses: bool = False
    log: list[str] = field(default_factory=list)

    def published(self, topic: str) -> bool:
        return topic in self.published_

    def listen(self, topic: str, kind: str, take: Callable[[Any], None]) -> bool:
        if topic in self.published_:
            self.topics[topic] = take
        return topic in self.published_

    def serve(self, name: str, kind: str, answer: Callable[[Any, Any], Any]) -> None:
        self.services[name] = answer

    def prepare(self, name: str, kind: str) -> None:
        return

    def ask(self, name: str, done: Callable[[Any], None] = lambda _: None, /, **fields: Any) -> None:
        service = name.rpartition("/")[2]
        if service == "list_controllers":
            done(SimpleNamespace(controller=[SimpleNamespace(name=one, state="active") for one in self.active]))
            return
        self.log.append(name)
        if service == "switch_controller":
            if not self.refuses:
                self.active -= set(fields["deactivate_controllers"])
            done(SimpleNamespace(ok=not self.refuses))

    def say(self, topic: str, message: Any) -> None:
        self.topics[topic](message)

    def acknowledge(self) -> Any:
        return self.services["/claim_watch/acknowledge_arm"](None, SimpleNamespace())


@pytest.fixture
def ros() -> FakeRos:
    """The node."""
    return FakeRos()


def watching(ros: FakeRos) -> Any:
    """Return the watch of the pick cell, after its first look."""
    entries = json.loads(
        json.dumps(plan("ur5e_pick", "jazzy")["watches"]), object_hook=lambda it: SimpleNamespace(**it)
    )
    (watch,) = [program().Watch(ros, entry) for entry in entries]
    watch.look()
    return watch


def claimed(ros: FakeRos) -> Any:
    """Return the watch after a person acknowledged and claimed."""
    watch = watching(ros)
    for topic, message in WELL.items():
        ros.say(topic, message)
    assert ros.acknowledge().success
    ros.active.add("arm_trajectory")
    ros.log.clear()
    return watch


STOPS = [
    pytest.param(SAFETY, SimpleNamespace(mode=3), id="protective stop"),
    pytest.param(SAFETY, SimpleNamespace(mode=5), id="safeguard stop"),
    pytest.param(SAFETY, SimpleNamespace(mode=13), id="a mode that is newer than the plan"),
    pytest.param(ROBOT, SimpleNamespace(mode=3), id="power off"),
    pytest.param(SPEED, SimpleNamespace(data=0.0), id="pause"),
    pytest.param(RUNNING, SimpleNamespace(data=False), id="program stop"),
]


@pytest.mark.parametrize(("topic", "message"), STOPS)
def test_goals_and_claims_end_in_the_callback_of_the_first_message(ros: FakeRos, topic: str, message: Any) -> None:
    claimed(ros)
    ros.say(topic, message)
    assert ros.log == [
        "/move_action/_action/cancel_goal",
        "/arm_trajectory/follow_joint_trajectory/_action/cancel_goal",
        f"{MANAGER}/switch_controller",
    ]
    assert ros.active == set()


@pytest.mark.parametrize(("topic", "message"), STOPS)
def test_a_stop_that_is_over_with_the_next_message_is_remembered(ros: FakeRos, topic: str, message: Any) -> None:
    watch = claimed(ros)
    ros.say(topic, message)
    ros.say(topic, WELL[topic])
    for _ in range(3):
        ros.active.add("arm_trajectory")  # somebody claims without an acknowledgment, the vendor's own stopper for one
        watch.look()
        assert ros.active == set()
    assert ros.acknowledge().success
    ros.active.add("arm_trajectory")
    watch.look()
    assert ros.active == {"arm_trajectory"}


def test_reduced_mode_is_no_stop(ros: FakeRos) -> None:
    claimed(ros)
    ros.say(SAFETY, SimpleNamespace(mode=2))
    ros.say(SPEED, SimpleNamespace(data=0.5))
    assert ros.log == []


@pytest.mark.parametrize(("topic", "message"), STOPS)
def test_nobody_acknowledges_while_a_proof_is_missing(ros: FakeRos, topic: str, message: Any) -> None:
    claimed(ros)
    ros.say(topic, message)
    answer = ros.acknowledge()
    assert (answer.success, topic in answer.message) == (False, True)


def test_a_claim_that_holds_as_the_watch_starts_goes_before_anything_was_heard(ros: FakeRos) -> None:
    ros.active.add("arm_trajectory")
    watch = watching(ros)
    assert ros.active == set()
    assert watch.latched == "not acknowledged since this program started"
    assert ros.acknowledge().message == f"no message on {RUNNING}"


def test_a_topic_that_nobody_publishes_any_more_proves_nothing(ros: FakeRos) -> None:
    watch = claimed(ros)
    ros.published_.discard(SAFETY)
    watch.look()
    assert ros.active == set()
    assert watch.latched == f"{SAFETY} has no publisher"


def test_a_manager_that_refuses_is_asked_again_and_a_late_one_is_said(
    ros: FakeRos, capsys: pytest.CaptureFixture[str]
) -> None:
    watch = claimed(ros)
    ros.refuses = True
    ros.say(SAFETY, SimpleNamespace(mode=3))
    assert "arm_trajectory: not deactivated, will retry (refused) after " in capsys.readouterr().out
    ros.refuses = False
    watch._entry.within_s = 0.0
    watch.look()
    said = capsys.readouterr().out
    assert "arm_trajectory: deactivated after " in said
    assert f" s, LATE: planned 0 s: {SAFETY} is 3. A person must acknowledge.\n" in said


@every_build
def test_program_is_installed_where_the_plan_has_watches_and_python_of_the_oldest_distribution_reads_it(
    cell: str, distro: str
) -> None:
    texts = build(cell, distro).texts
    watched = bool(plan(cell, distro).get("watches"))
    assert ("scripts/claim_watch" in texts, "  scripts/claim_watch\n" in texts["CMakeLists.txt"]) == (watched, watched)
    if watched:
        ast.parse(texts["scripts/claim_watch"], feature_version=(3, 10))


def test_the_time_until_a_claim_is_dropped_counts_from_the_stop_and_not_from_the_last_try(
    ros: FakeRos, capsys: pytest.CaptureFixture[str]
) -> None:
    watch, now = claimed(ros), [0.0]
    type(watch).end.__globals__["time"] = SimpleNamespace(monotonic=lambda: now[0])
    ros.refuses = True
    ros.say(SAFETY, SimpleNamespace(mode=3))
    now[0], ros.refuses = 5.0, False
    watch.look()
    assert ros.active == set()
    assert "deactivated after 5.000 s, LATE" in capsys.readouterr().out


def test_a_manager_that_does_not_answer_is_asked_once_a_second(ros: FakeRos) -> None:
    watch, now, asked = claimed(ros), [0.0], list[str]()
    type(watch).end.__globals__["time"] = SimpleNamespace(monotonic=lambda: now[0])
    ros.say(SAFETY, SimpleNamespace(mode=3))
    vars(ros)["ask"] = lambda name, *_, **__: asked.append(name)
    for _ in range(30):
        now[0] += 0.1
        watch.look()
    assert 2 <= len(asked) <= 4
