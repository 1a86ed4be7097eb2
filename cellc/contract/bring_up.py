"""``config/bring_up.json``: the steps from processes that started to a cell that may move, and the proof of each.

Read by ``lib/<package>/bring_up`` on the robot's computers and by the mock, so that what is rehearsed is what is done.
"""

from collections.abc import Iterator, Mapping
from itertools import chain
from typing import Annotated, Literal, get_args

from pydantic import Field, model_validator

from cellc.contract.base import ContractModel
from cellc.contract.entities import HardwareState, LaunchTarget
from cellc.contract.grading import Graded, Rule
from cellc.contract.vocabulary import BringUpPhase, Need, ReviewArea

CLAIM_WATCH = "/claim_watch"
"""The node that takes the claims of a robot that no longer follows, and keeps them until a person acknowledges."""
WATCH_WITHIN_S = 0.1
"""From a message that a robot no longer follows to its claims given up: what the node promises and prints where it is
later, what the mock plays, and what bounds are certified with. A trial on the robot at gate G7 shows it."""

ManagedState = Literal["inactive", "active"]


class NodeProof(ContractModel):
    """A node is seen in the ROS graph."""

    kind: Literal["node"]
    node: str = Field(description="Full name of the node.")


class LifecycleProof(ContractModel):
    """A managed node says that it is in a state, or in one that comes after it."""

    kind: Literal["lifecycle"]
    node: str = Field(description="Full name of the node.")
    state: ManagedState = Field(description="State that it must say.")


class ControllerProof(ContractModel):
    """A controller manager lists a controller in a state, or in one that comes after it."""

    kind: Literal["controller"]
    manager: str = Field(description="Full name of the controller manager.")
    controller: str = Field(description="Name of the controller.")
    state: ManagedState = Field(description="State that it must be in.")


class HardwareProof(ContractModel):
    """A controller manager lists a hardware component in a state."""

    kind: Literal["hardware"]
    manager: str = Field(description="Full name of the controller manager.")
    component: str = Field(description="Name of the hardware component.")
    state: HardwareState = Field(description="State that it must be in.")


class TopicProof(ContractModel):
    """A message arrives; where ``field`` is given, it must be one of ``values``, or ``above``, in the newest one."""

    kind: Literal["topic"]
    topic: str = Field(description="Full name of the topic.")
    type: str = Field(description="Type of the message.")
    field: str | None = Field(None, description="Field of the message that is looked at.")
    values: tuple[bool | int, ...] = Field((), description="What it may hold.")
    above: float | None = Field(None, description="What it must exceed.")
    unsaid: bool | None = Field(
        None, description="Whether it holds too where a publisher has said nothing, because it speaks of changes alone."
    )


class ActionProof(ContractModel):
    """An action has a server."""

    kind: Literal["action"]
    action: str = Field(description="Full name of the action.")


class TransformProof(ContractModel):
    """The transforms that arrive connect two frames."""

    kind: Literal["transform"]
    parent: str = Field(description="Frame that the other one is found in.")
    child: str = Field(description="Frame that is found.")


class MockProof(ContractModel):
    """The description that a node holds names no hardware plugin but those of the mock, or of the simulator."""

    kind: Literal["mock"]
    node: str = Field(description="Full name of the node with the parameter `robot_description`.")
    plugins: tuple[str, ...] = Field(description="Plugins that touch no hardware.")


class AloneProof(ContractModel):
    """No second cell answers in this domain: the mock and the real one have the same names, and both would hear."""

    kind: Literal["alone"]
    nodes: tuple[str, ...] = Field(description="Full names of nodes, none of which may be there twice.")


SingleProof = (
    NodeProof
    | LifecycleProof
    | ControllerProof
    | HardwareProof
    | TopicProof
    | ActionProof
    | TransformProof
    | MockProof
    | AloneProof
)


class SharedProof(ContractModel):
    """Every proof of a list holds: several steps of a target wait for them."""

    kind: Literal["shared"]
    list: str = Field(description="Name of the list in `shared` of the target.")


Proof = SingleProof | SharedProof


class Transition(ContractModel):
    """Ask a managed node for a transition."""

    kind: Literal["transition"]
    node: str = Field(description="Full name of the node.")
    transition: Literal["configure", "activate"] = Field(description="Transition of lifecycle_msgs/msg/Transition.")


class Activation(ContractModel):
    """Ask a controller manager to activate controllers: all of them or none."""

    kind: Literal["controllers"]
    manager: str = Field(description="Full name of the controller manager.")
    controllers: tuple[str, ...] = Field(description="Controllers to activate, strict.")


class Restart(ContractModel):
    """Ask a controller manager to deactivate and activate controllers, so that they read interfaces that are new."""

    kind: Literal["restart"]
    manager: str = Field(description="Full name of the controller manager.")
    controllers: tuple[str, ...] = Field(description="Controllers to restart, strict.")


class HardwareActivation(ContractModel):
    """Ask a controller manager to take a hardware component to active; it configures it first where it must."""

    kind: Literal["hardware"]
    manager: str = Field(description="Full name of the controller manager.")
    component: str = Field(description="Name of the hardware component.")


class Comparison(ContractModel):
    """Compare what is installed on this computer with the version tuple of ``manifest.json``; a difference stops."""

    kind: Literal["versions"]
    parts: tuple[str, ...] = Field(
        description="Parts of the tuple that this computer must show, as `arm.driver=package:NAME`."
    )


class Acknowledgment(ContractModel):
    """Tell the watch of a robot that a person authorizes its claims; it refuses while a proof of it is missing."""

    kind: Literal["acknowledge"]
    service: str = Field(description="Full name of the service, of type std_srvs/srv/Trigger.")


Request = Transition | Activation | Restart | HardwareActivation | Comparison | Acknowledgment


class BringUpStep(ContractModel):
    """One step: what must show before it, what is asked for, and what must show after it."""

    name: str = Field(description="Name of the step.")
    phase: Annotated[
        BringUpPhase,
        Graded(
            ReviewArea.START_ORDER, "launch phase on hardware", Rule.DANGEROUS, why="it is released at another phase"
        ),
    ] = Field(description="Phase that a person or the launch file releases.")
    host: Annotated[str, Graded(ReviewArea.START_ORDER)] = Field(
        description="Computer that takes it; empty where the cell names none."
    )
    release: str = Field("", description="Device that a person releases by it, alone; empty where its phase has one.")
    proof: Annotated[tuple[Proof, ...], Graded(ReviewArea.START_ORDER, "precondition", Rule.LOST, ordered=False)] = (
        Field(description="What must show before it.")
    )
    request: Request | None = Field(None, description="What is asked for; null where only the proof counts.")
    effect: Annotated[
        tuple[SingleProof, ...], Graded(ReviewArea.START_ORDER, "expected effect", Rule.LOST, ordered=False)
    ] = Field((), description="What must show after it; checked when the proof holds, too.")
    deadline_s: Annotated[float, Graded(ReviewArea.START_ORDER)] = Field(
        description="Time until the proof, and again until the effect.", gt=0.0
    )

    def waits_for(self) -> Iterator[str]:
        """Yield the names of the lists of proofs that it waits for."""
        return (proof.list for proof in self.proof if isinstance(proof, SharedProof))

    def with_lists(self, lists: Mapping[str, tuple[SingleProof, ...]]) -> "BringUpStep":
        """Return it with the proofs of these lists in the place of their names."""
        listed = (lists.get(proof.list) if isinstance(proof, SharedProof) else None for proof in self.proof)
        proofs = ((proof,) if found is None else found for proof, found in zip(self.proof, listed, strict=True))
        return self.model_copy(update={"proof": tuple(chain(*proofs))})


class Watch(ContractModel):
    """What ends when a robot no longer follows set points, and stays ended until a person acknowledges."""

    device: str = Field(description="Name of the robot.")
    host: str = Field(description="Computer that watches it; empty where the cell names none.")
    manager: str = Field(description="Full name of the controller manager.")
    controllers: tuple[str, ...] = Field(description="Controllers that are deactivated.")
    actions: tuple[str, ...] = Field((), description="Actions whose goals are canceled.")
    nodes: tuple[str, ...] = Field((), description="Managed nodes that ask for motion; they are deactivated.")
    while_hold: dict[Need, TopicProof] = Field(description="What a claim needs, with the proof that it has it.")
    acknowledge: str = Field(description="Service, of type std_srvs/srv/Trigger, that lets claims be made again.")
    within_s: float = Field(description="Time from the message that proves otherwise to claims given up.", gt=0.0)


class BringUp(ContractModel):
    """The whole plan."""

    format: Literal[2] = Field(description="Format of this file.")
    cell: str = Field(description="Name of the cell.")
    enclave: str = Field(description="SROS2 enclave of what asks.")
    shared: dict[LaunchTarget, dict[str, tuple[SingleProof, ...]]] = Field(
        description="Proofs that several steps of a target wait for, by the name of their list."
    )
    mock: tuple[BringUpStep, ...] = Field(description="Steps on the mock, in order.")
    sim: tuple[BringUpStep, ...] = Field((), description="Steps on the simulator, where the spec asks for it.")
    real: tuple[BringUpStep, ...] = Field(description="Steps on the real target, in order.")
    watches: tuple[Watch, ...] = Field((), description="What the stopper watches on the real target.")

    @model_validator(mode="after")
    def _every_list_is_there(self) -> "BringUp":
        for target in get_args(LaunchTarget):
            for step in self.steps(target):
                if absent := [name for name in step.waits_for() if name not in self.shared.get(target, {})]:
                    raise ValueError(f"step {step.name} must wait for lists of `shared.{target}`, got {absent[0]}")
        return self

    def steps(self, target: LaunchTarget) -> tuple[BringUpStep, ...]:
        """Return the steps on a target; what several of them wait for is named."""
        return {"mock": self.mock, "sim": self.sim, "real": self.real}[target]

    def proven_steps(self, target: LaunchTarget) -> tuple[BringUpStep, ...]:
        """Return the steps on a target, each with every proof that it waits for."""
        return tuple(step.with_lists(self.shared.get(target, {})) for step in self.steps(target))
