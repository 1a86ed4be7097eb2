"""A cell without a spec: entities built by hand in a few lines, which rules and graphs ask like linked ones."""

from __future__ import annotations

from dataclasses import fields, replace

import pytest

from cellc.compiler.cell.body import Body
from cellc.compiler.cell.cell import Cell
from cellc.compiler.cell.device import EVERY_JOINT, Camera, CameraStream, Device, DeviceMock, Sensing, SimulatedJoint
from cellc.compiler.cell.entity import Part, Places
from cellc.compiler.cell.hardware import DeviceControl, OfferedInterface
from cellc.compiler.cell.members import members
from cellc.compiler.cell.site import Host, NetworkCard, Safety
from cellc.compiler.graph.cell_graph import build_graph
from cellc.compiler.rules.safety.stop import dependent_stop
from cellc.contract.diagnostics import Span
from cellc.contract.entities import Kpis
from cellc.contract.stated import Stop, Versions
from cellc.contract.vocabulary import Distro, InterfaceKind
from cellc.robot.description.model import Description
from tests.cells import COMPLETE, CORPUS, linked, spec_of

CELL, HOSTS, STOP = (Span("cell.yaml", line, 1, line, 5) for line in (1, 4, 9))
PLACES = Places(
    "folder/cell.yaml",
    {("cell",): CELL, ("hosts",): HOSTS, ("hosts", "pc"): HOSTS, ("safety",): STOP, ("safety", "stop"): STOP},
    {("cell",): "demo"},
)
PC = Host(name="pc", path=("hosts", "pc"), span=HOSTS, nics={"robot": NetworkCard(address="192.168.56.10/24")})
DEMO = Cell(
    name="demo",
    places=PLACES,
    distro=Distro.JAZZY,
    versions=Versions(ros="jazzy", rmw="rmw_zenoh_cpp 0.2.3"),
    hosts={"pc": PC},
    safety=Safety(stop=Stop(authority="safety_plc", path="hardwired")),
)


CAMERA = Device(
    name="camera",
    path=("devices", "camera"),
    span=CELL,
    model="demo",
    vendor="demo",
    kind="camera",
    body=Body(root_link="camera_base", description=Description(name="demo", links=(), joints=())),
)


def test_rule_reports_a_cell_that_was_built_by_hand() -> None:
    (finding,) = dependent_stop.check(build_graph(DEMO))
    assert (finding.span, finding.path) == (STOP, ("safety", "stop", "independent_of"))


def test_graph_reads_the_cards_of_hosts() -> None:
    (card,) = build_graph(DEMO).network.nics
    assert str(card.interface) == "192.168.56.10/24"


@pytest.mark.parametrize(
    ("path", "place"),
    [
        (("hosts", "pc", "clock", "max_offset"), HOSTS),  # the nearest thing that is written
        (("network", "domain_id"), CELL),  # a section that nobody wrote
    ],
)
def test_place_of_what_nobody_wrote_is_that_of_the_nearest_written(path: tuple[str, ...], place: Span) -> None:
    assert DEMO.locate(*path) == place
    assert not DEMO.states(*path)


def test_texts_are_as_written_and_empty_where_nothing_is() -> None:
    assert (DEMO.text("cell"), DEMO.text("summary"), PLACES.file_name) == ("demo", "", "cell.yaml")


def test_figures_without_a_target_are_named_by_their_keys() -> None:
    assert Kpis(cancel_s=0.2, recovery_time_s=120.0).without_target() == (
        "plan_to_execute",
        "missed_cycles",
        "stale_state_rejection",
        "protective_stops",
        "wrong_owner_events",
    )


def test_no_two_parts_of_a_device_have_a_field_of_one_name() -> None:
    names = [member.name for member in members(CAMERA)]
    parts = [field.name for field in fields(CAMERA) if isinstance(getattr(CAMERA, field.name), Part)]
    assert len(names) == len(set(names)) > 50
    assert not {*parts} & {*names}


def test_topics_of_a_device_are_those_of_its_driver_and_of_its_streams() -> None:
    stream = CameraStream(
        topic="/image", type="sensor_msgs/msg/Image", info_topic="/info", frame="optical", rate_hz=30.0
    )
    offered = OfferedInterface(kind=InterfaceKind.TOPIC, name="/state", type="std_msgs/msg/Bool", node="/driver")
    served = OfferedInterface(kind=InterfaceKind.SERVICE, name="/reset", type="std_srvs/srv/Trigger", node="/driver")
    camera = replace(
        CAMERA, sensing=Sensing(camera=Camera(streams=(stream,))), control=DeviceControl(offers=(offered, served))
    )
    assert camera.topics == {
        "/state": "std_msgs/msg/Bool",
        "/image": "sensor_msgs/msg/Image",
        "/info": "sensor_msgs/msg/CameraInfo",
    }


def test_what_is_simulated_of_one_joint_comes_before_what_is_of_all() -> None:
    every = SimulatedJoint(name=EVERY_JOINT, path=(), span=CELL, joints=("a", "b"), lag_s=0.1)
    one = SimulatedJoint(name="b", path=(), span=CELL, joints=("b",), lag_s=0.2)
    arm = replace(CAMERA, mock=DeviceMock(simulated_joints=(every, one)))
    assert (arm.simulated("a"), arm.simulated("b"), arm.simulated("c")) == ((every,), (one, every), ())


def test_linking_fills_every_section_that_some_spec_states() -> None:
    empty = Cell(name="", places=Places(""), distro=Distro.HUMBLE, versions=Versions.model_construct(ros=""))
    unfilled = {field.name for field in fields(Cell)}
    for path in (
        COMPLETE,
        spec_of("ur5e_pick"),
        spec_of("dual_ur"),
        CORPUS / "valid" / "every_target.yaml",
        CORPUS / "valid" / "direct_sdk_arm.yaml",
        CORPUS / "valid" / "more_fields.yaml",
        CORPUS / "valid" / "servo_and_octomap.yaml",
    ):
        cell = linked(path)
        unfilled = {name for name in unfilled if getattr(cell, name) == getattr(empty, name)}
    assert unfilled == set()


def test_joint_of_a_device_is_the_one_of_that_name() -> None:
    arm = linked(COMPLETE).device("arm")
    assert [arm.joint(joint.name) for joint in arm.joints] == list(arm.joints)
    assert {joint.name for joint in arm.actuated_joints} >= {"arm_joint_1", "arm_joint_6"}
    with pytest.raises(KeyError):
        arm.joint("joint_1")
