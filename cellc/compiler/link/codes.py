"""What linking reports: references that nothing has, and choices that the catalog does not offer."""

from __future__ import annotations

from cellc.compiler.link.code_examples import EXAMPLES
from cellc.contract.diagnostics import Severity
from cellc.contract.diagnostics.diagnostic import CodePage


def _page(code: str, title: str, why: str, fix: str) -> CodePage:
    return CodePage(code, Severity.ERROR, title, why, fix, EXAMPLES.get(code, ""))


def _unknown(code: str, thing: str, where: str, otherwise: str) -> CodePage:
    return _page(
        code,
        f"a reference names {'an' if thing[0] in 'aeiou' else 'a'} {thing} that does not exist",
        f"Names are references: {where}. A misspelled one is found here, with the "
        f"nearest names that exist. {otherwise}.",
        f"name an existing {thing}, or declare it",
    )


CODES: tuple[CodePage, ...] = (
    _unknown(
        "unknown-calibration",
        "calibration",
        "a measured transform names an entry of `calibrations`",
        "Otherwise the transform would rest on a measurement without date, residual and owner",
    ),
    _unknown(
        "unknown-clock",
        "clock",
        "a clock is a host, a device that states one, or the domain of either",
        "Otherwise the fault would turn no clock, and the rehearsal prove nothing",
    ),
    _unknown(
        "unknown-controller",
        "controller",
        "switches and faults name controllers of the cell",
        "The controller manager would refuse the switch when it is first needed, and a fault would hit nothing",
    ),
    _unknown(
        "unknown-device",
        "device",
        "controllers, steps and faults name entries of `devices`",
        "Otherwise a controller would have no joints, and a step or a fault nothing to act on",
    ),
    _unknown(
        "unknown-frame",
        "frame",
        "a frame is `world`, an entry of `frames` or `scene`, or `device/link`",
        "tf2 would answer each lookup of it with an exception, while the cell runs",
    ),
    _unknown(
        "unknown-goal",
        "pose or goal",
        "a `move` step names an entry of `motion.poses` or `motion.goals`",
        "Otherwise the step would have nowhere to go",
    ),
    _unknown(
        "unknown-group",
        "planning group",
        "poses and goals belong to an entry of `motion.groups`, and a goal says to which unless there is only one",
        "MoveIt would drop the pose with a line in its log, and refuse each request for the group",
    ),
    _unknown(
        "unknown-host",
        "host",
        "nodes, managers and connections name entries of `hosts`",
        "Otherwise the program would be started on no computer, and the device be reached from none",
    ),
    _unknown(
        "unknown-interface",
        "interface",
        "a fault names a topic, service or action under its full name",
        "Otherwise the fault would hit nothing, and the rehearsal prove nothing",
    ),
    _unknown(
        "unknown-joint",
        "joint",
        "a joint is `device/joint`, with the joint's name in its description",
        "The controller manager would refuse a controller whose interfaces no hardware offers",
    ),
    _unknown(
        "unknown-model",
        "model",
        "a device names an entry of the catalog, or a folder with a device.yaml",
        "Otherwise neither its links and joints nor its driver would be known",
    ),
    _unknown(
        "unknown-nic",
        "network card",
        "a connection names a card of its host",
        "Otherwise it would be unknown which card reaches the device, and which other traffic that card carries",
    ),
    _unknown(
        "unknown-node",
        "node",
        "interfaces, frames and clients name nodes, devices or controllers",
        "ROS itself does not report it: a subscriber waits forever for a publisher that does not exist",
    ),
    _unknown(
        "unknown-planner",
        "planner",
        "a planning group names its IK solver and its planner of OMPL, `motion` its planning pipelines",
        "Otherwise MoveIt would start without a solver, or answer every request with a failure",
    ),
    _unknown(
        "unknown-rehearsal",
        "rehearsal",
        "`use` names another entry of `rehearsals`",
        "Otherwise the steps that it shares would be left out",
    ),
    _unknown(
        "unknown-signal",
        "signal",
        "an output or sensor of a switched device is one of its `device.yaml`, wired to an interface of a gpio, as "
        "`device/gpio/interface`",
        "Otherwise nothing would switch the device, or nothing tell where it is",
    ),
    _unknown(
        "unknown-state",
        "state",
        "the states of a switched device stand in its `device.yaml`; a step that senses one needs wired sensors that "
        "tell it from the others",
        "Otherwise the step would set nothing, or wait forever",
    ),
    _page(
        "ambiguous-node",
        "a reference fits several controllers",
        "Two controller managers may have controllers of one name, each in its namespace. Only the full name "
        "then says which of them publishes or serves.",
        "write the full name, with the namespace of its manager",
    ),
    _page(
        "controller-not-in-distro",
        "the pinned distribution has no plugin for this kind of controller",
        "Controllers come and go between distributions: the generic gripper controller is gone from Kilted, parallel "
        "grippers are new in Jazzy. The controller manager would refuse to load an unknown type.",
        "choose a kind that the pinned distribution has",
    ),
    _page(
        "controller-without-device",
        "a controller that drives joints names no device",
        "Joints and claims follow from the device. Without one the controller would have an empty list of joints, "
        "which the controller manager refuses.",
        "add `device:` to the controller",
    ),
    _page(
        "hand-eye-differs",
        "a transform of the spec is not the one that its calibration's file has",
        "A new file and an old number, or a slip in either: two poses of one camera, of which the arm "
        "follows one. What a spec rounds off, 0.1 mm and 0.05 deg, is no difference.",
        "write neither `xyz` nor `rpy`, so that the file counts",
    ),
    _page(
        "hand-eye-of-other-frames",
        "a hand-eye calibration tells of other frames than those that rest on it",
        "The tool writes the pose of a camera in the hand, or in the base for one beside the robot. Taken "
        "the other way round, or for a frame that a joint parts from it, every goal is wrong by as much as the arm "
        "is turned. Names of a tool may be TF's or `device/link`; others are stated as `parent` and `child`.",
        "name the file of this camera, or state `parent` and `child` of the calibration",
    ),
    _page(
        "invalid-hand-eye",
        "a hand-eye calibration is not what a tool writes",
        "Read are the files of easy_handeye2, launch files of MoveIt's calibration, and a mapping in YAML or JSON "
        "with a 4x4 `matrix`, or `xyz` in meters with a quaternion as `xyzw`, `wxyz` or `rotation: {x, y, z, w}`. A "
        "list that does not say which of its four is w, millimeters, or a matrix that mirrors would place the camera "
        "somewhere else.",
        "export the calibration again, or write what is missing",
    ),
    _page(
        "invalid-kinematics",
        "a calibration of a robot's kinematics is not what its vendor's tool writes",
        "A robot differs from its type by up to centimeters at the tool. The file that the vendor's tool reads off it "
        "gives each joint's place in m and rad, and a hash that the driver compares; a figure that is missing, or "
        "written by hand, would put the tool somewhere else.",
        "read it off the robot again, and name the file as it was written",
    ),
    _page(
        "event-never-comes",
        "a fault waits for a step that is not there, or that sends no goal",
        "A fault may begin when a step is started, when its goal is accepted or when a joint first moves. Only moves "
        "and grips send goals; a fault that waits for anything else never comes, and the rehearsal proves nothing.",
        "name a step of the rehearsal, with an event that it has",
    ),
    _page(
        "not-a-chain",
        "the tip of a planning group is not below its base",
        "A group is the chain of joints between two links. Where the tip is not below the base there is no chain, and "
        "MoveIt would drop the group with a line in its log.",
        "name a tip whose parents lead to the base link",
    ),
    _page(
        "not-an-executable",
        "`run` is not a package and an executable",
        "The launch file needs both to start a node.",
        "write `package/executable`",
    ),
    _page(
        "planner-not-in-distro",
        "the pinned distribution does not release a solver or planning pipeline",
        "Its plugin is looked up by name when move_group starts. Without the package the group has no solver, or the "
        "pipeline no planner, and every goal fails.",
        "choose one that the pinned distribution has",
    ),
    _page(
        "rehearsal-cycle",
        "rehearsals use each other's steps in a circle",
        "Following `use` would never reach a list of steps.",
        "give one of them its own `steps`",
    ),
    _page(
        "confidence-of-nothing",
        "a rehearsal states a confidence, and asks for no verdict",
        "A sweep gives a verdict on `success`. Without it a confidence changes nothing, and the verdict "
        "that its author expects is never given.",
        "write `success` beside it, or delete it",
    ),
    _page(
        "repeatability-of-nothing",
        "a repeatability is stated of a device that no group moves",
        "A sweep draws the arrival position of a group's tip. For a camera or a gripper nothing is drawn, "
        "and the figure would have no effect.",
        "name a device whose joints a group moves, or delete it",
    ),
    _page(
        "unknown-controller-kind",
        "a controller is of a kind that neither the catalog nor its device has",
        "The plugin, the claims and the action follow from the kind.",
        "use a kind that the catalog or the device lists",
    ),
    _page(
        "unknown-distro",
        "the version tuple names a ROS 2 distribution that cellc does not know",
        "Plugins, parameters and their defaults differ between distributions; without one nothing can be generated.",
        "pin humble, jazzy, kilted or lyrical",
    ),
)
