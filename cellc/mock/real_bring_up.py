"""The bring-up of the real target as the mock can take it: in its order, with the proofs that the mock can give."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from cellc.contract.bring_up import (
    CLAIM_WATCH,
    Activation,
    BringUpStep,
    ControllerProof,
    NodeProof,
    Proof,
    Restart,
    TopicProof,
)
from cellc.contract.contract import Contract
from cellc.contract.vocabulary import BringUpPhase


def played(real: Sequence[BringUpStep], mock: Sequence[BringUpStep], contract: Contract) -> tuple[BringUpStep, ...]:
    """Return the steps of the real target that the mock can execute.

    ``Effects.bring_up`` acts as the operator where the robot would report a state in a topic. The stopper is no node
    here. Claims that only the mock has, of a device that its own driver moves on the real target, are last, with the
    proofs required before a motion.
    """
    keys = {
        (f"{manager.namespace}/controller_manager", controller.full_name.rpartition("/")[2])
        for manager in contract.managers.values()
        for controller in manager.controllers.values()
        if "mock" in controller.targets
    }
    claimed = {
        (step.request.manager, name)
        for step in real
        if isinstance(step.request, Activation)
        for name in step.request.controllers
    }
    steps = [_step(step, keys) for step in real if step.phase is not BringUpPhase.MOVE]
    steps += _left_over(mock, claimed)
    return (*steps, *(step for step in mock if step.phase is BringUpPhase.MOVE))


_Key = tuple[str, str]


def _step(step: BringUpStep, keys: set[_Key]) -> BringUpStep:
    """Return a step of the real target with the controllers that the mock has."""
    asked = step.request
    if isinstance(asked, Activation | Restart):
        present = tuple(name for name in asked.controllers if (asked.manager, name) in keys)
        asked = asked.model_copy(update={"controllers": present}) if present else None
    shown = {"proof": _proofs(step.proof, keys), "effect": _proofs(step.effect, keys), "request": asked}
    return step.model_copy(update=shown)


def _proofs(proofs: Sequence[Proof], keys: set[_Key]) -> tuple[Proof, ...]:
    return tuple(
        proof
        for proof in proofs
        if not (isinstance(proof, ControllerProof) and (proof.manager, proof.controller) not in keys)
        and not (isinstance(proof, TopicProof) and proof.field is not None)
        and not (isinstance(proof, NodeProof) and proof.node == CLAIM_WATCH)
    )


def _left_over(mock: Sequence[BringUpStep], claimed: set[_Key]) -> Iterator[BringUpStep]:
    """Yield the claims of the mock that no step of the real target has."""
    for step in mock:
        asked = step.request
        if step.phase is BringUpPhase.CLAIM and isinstance(asked, Activation):
            rest = tuple(name for name in asked.controllers if (asked.manager, name) not in claimed)
            if rest:
                request = asked.model_copy(update={"controllers": rest})
                yield step.model_copy(update={"request": request, "proof": (), "effect": ()})
