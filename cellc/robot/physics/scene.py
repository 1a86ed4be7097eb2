"""The one door to MuJoCo: a scene that was read, and bodies that move in it.

All states are copies, so that a motion can be made again from any of them, bit for bit: a state holds where everything
is, how fast, the set points of the drives, and what the solver begins with.
https://mujoco.readthedocs.io/en/3.3.0/computation/index.html (The State)
"""

from __future__ import annotations

import copy
from collections.abc import Container, Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cellc.contract.errors import CellcError
from cellc.contract.extras import PHYSICS, gate
from cellc.contract.frozen import dataclass
from cellc.contract.printing import overheard
from cellc.contract.transforms import Pose, Vector3

Array = NDArray[np.float64]
Rows = NDArray[np.intp]
_FREE, _SLIDE, _HINGE = 0, 2, 3
"""Types of joints."""
_EQUAL_JOINTS = 2
"""Type of an equality between two joints."""

_ELLIPTIC = 1
"""Friction cone."""
_NO_ROWS: Rows = np.empty((0, 2), dtype=np.intp)
_NO_FORCES: Array = np.empty(0)
_THINNEST = 1e-4
"""m: half of what is left of a part that is to be narrower than nothing."""
_SMOOTHEST = 1e-5
"""The least friction that MuJoCo computes with."""


class SceneError(CellcError):
    """A scene cannot be read, or does not stay in one piece; the text says why."""


@dataclass(frozen=True, slots=True)
class Touch:
    """Two bodies that press on each other, by their names, with a force in N along the normal of the contact."""

    one: str
    other: str
    force_n: float
    normal: Vector3

    def is_between(self, body: str, others: Container[str]) -> bool:
        """Tell whether a body touches one of others."""
        return (self.one == body and self.other in others) or (self.other == body and self.one in others)


@dataclass(frozen=True, slots=True)
class Weight:
    """How a body differs from the scene: factors of its mass, and of the force with which a controller holds it."""

    mass: float = 1.0
    held: float = 1.0


class Scene:
    """What no run changes of a scene.

    Attributes:
        joints: that turn or slide, with the place of each position and velocity.
        sliding: those that slide.
        drives: joint → number of its set point.
        limits: what each drive gives at most, N m or N; infinite without a bound.
        parts: free body → place of its pose.
        bodies: by their numbers.
        fixed: those that never move.
        step_ns: of one step of the solver.
        size: how many numbers a state has.
        computed_by: library and version; another one may give other bits.
    """

    def __reduce__(self) -> tuple[type[Scene], tuple[str, Mapping[str, bytes]]]:
        """Return what another process reads it from again."""
        return type(self), self._read

    def __init__(self, text: str, meshes: Mapping[str, bytes]) -> None:
        """Read a scene; ``meshes`` has the content of each file that it names.

        Raises:
            MissingExtraError: MuJoCo is not installed.
            SceneError: it refuses the scene.
        """
        with gate(PHYSICS):
            import mujoco
        self.library: Any = mujoco
        self._read = (text, meshes)
        self.computed_by = f"mujoco {mujoco.__version__}"
        mujoco.set_mju_user_warning(_silent)
        try:
            with overheard():
                self.model: Any = mujoco.MjModel.from_xml_string(text, dict(meshes))
        except ValueError as error:
            raise SceneError(f"MuJoCo refuses it: {' '.join(str(error).split())}") from None
        model, kinds = self.model, mujoco.mjtState
        moves = kinds.mjSTATE_TIME | kinds.mjSTATE_QPOS | kinds.mjSTATE_QVEL | kinds.mjSTATE_ACT
        self.spec = int(moves | kinds.mjSTATE_WARMSTART | kinds.mjSTATE_CTRL)
        self.size = int(mujoco.mj_stateSize(model, self.spec))
        self.step_ns = round(float(model.opt.timestep) * 1e9)
        moving = [index for index in range(model.njnt) if model.jnt_type[index] in (_SLIDE, _HINGE)]
        self.joints = {
            str(model.joint(index).name): (int(model.jnt_qposadr[index]), int(model.jnt_dofadr[index]))
            for index in moving
        }
        self.drives = {str(model.actuator(index).name): index for index in range(model.nu)}
        self.parts = {
            str(model.body(model.jnt_bodyid[index]).name): int(model.jnt_qposadr[index])
            for index in range(model.njnt)
            if model.jnt_type[index] == _FREE
        }
        self.sliding = frozenset(str(model.joint(at).name) for at in moving if model.jnt_type[at] == _SLIDE)
        bounded = model.actuator_forcelimited.astype(bool)
        self.limits: Array = np.where(bounded, model.actuator_forcerange[:, 1], np.inf)
        self.bodies = tuple(str(model.body(index).name) for index in range(model.nbody))
        self.fixed = tuple(name for name, weld in zip(self.bodies, model.body_weldid, strict=True) if weld == 0)

    def aims(self, state: Array) -> Array:
        """Return the set points of all drives in one state, by their numbers."""
        return state[self.size - len(self.drives) :]

    def positions(self, states: Array, joints: Sequence[str]) -> Array:
        """Return the positions of joints in some states, rad or m."""
        places: Rows = np.array([1 + self.joints[joint][0] for joint in joints], dtype=np.intp)
        return states[..., places]

    def efforts(self, states: Array) -> Array:
        """Return what each drive gives in some states, N m or N: of its set point, position and velocity, bounded."""
        model, joints = self.model, list(self.drives)
        aims = states[..., self.size - len(self.drives) :]
        asked = model.actuator_gainprm[:, 0] * aims + model.actuator_biasprm[:, 1] * self.positions(states, joints)
        asked = asked + model.actuator_biasprm[:, 2] * self.velocities(states, joints)
        bounded: Array = np.clip(asked, -self.limits, self.limits)
        return bounded

    def velocities(self, states: Array, joints: Sequence[str]) -> Array:
        """Return the velocities of joints in some states, rad/s or m/s."""
        begin = 1 + int(self.model.nq)
        places: Rows = np.array([begin + self.joints[joint][1] for joint in joints], dtype=np.intp)
        return states[..., places]

    def pose(self, state: Array, part: str) -> Pose:
        """Return where a free body is in one state, in the root frame."""
        at = 1 + self.parts[part]
        x, y, z, w, i, j, k = state[at : at + 7].tolist()
        return Pose((x, y, z), (i, j, k, w))

    def followers(self) -> Iterator[tuple[str, str, float, float]]:
        """Yield each joint that follows another: its name, that of the other, offset and factor."""
        model = self.model
        for index in range(model.neq):
            if model.eq_type[index] == _EQUAL_JOINTS:
                offset, factor = (float(value) for value in model.eq_data[index][:2])
                one, other = (str(model.joint(ids[index]).name) for ids in (model.eq_obj1id, model.eq_obj2id))
                yield one, other, offset, factor

    def below(self, body: str) -> Iterator[str]:
        """Yield a body and all that it carries, of a body that is there."""
        carried = {self.bodies.index(body)} if body in self.bodies else set[int]()
        for index, parent in enumerate(self.model.body_parentid.tolist()):  # a parent has the smaller number
            if parent in carried:
                carried.add(index)
        yield from (self.bodies[index] for index in sorted(carried))

    def mass_kg(self, bodies: Iterable[str]) -> float:
        """Return what some bodies weigh together."""
        return sum(float(self.model.body(body).mass[0]) for body in bodies)

    def watched(self, planned: frozenset[frozenset[str]]) -> NDArray[np.bool_]:
        """Return for each two shapes whether a contact of theirs is not planned."""
        names = [self.bodies[body] for body in self.model.geom_bodyid]
        rows = [[frozenset((first, second)) not in planned for second in names] for first in names]
        return np.array(rows, dtype=bool).reshape(len(names), len(names))


def _shapes_of(model: Any, part: str) -> range:
    body = model.body(part)
    return range(int(body.geomadr[0]), int(body.geomadr[0]) + int(body.geomnum[0]))


def _silent(_: str) -> None:
    """Keep MuJoCo from writing a file of its own; what it warns of is counted in the data."""


class Bodies:
    """Everything in a scene as it moves."""

    def __init__(self, scene: Scene) -> None:
        """Begin with the zero of every joint, and with each free body where the scene has it."""
        self.scene = scene
        self._library = scene.library
        self.model = scene.model
        self._data = scene.library.MjData(scene.model)
        self._one = np.zeros(6)

    def _own_model(self) -> Any:
        """Return a model of this run alone, whose masses, sizes and frictions may be changed."""
        if self.model is self.scene.model:
            self.model = copy.copy(self.scene.model)
        return self.model

    def state(self, out: Array | None = None) -> Array:
        """Return the present state, written into ``out`` where that is given."""
        taken: Array = np.empty(self.scene.size) if out is None else out
        self._library.mj_getState(self.model, self._data, taken, self.scene.spec)
        return taken

    def restore(self, state: Array) -> None:
        """Begin again from a state."""
        self._library.mj_setState(self.model, self._data, state, self.scene.spec)

    def place(self, positions: Mapping[str, float]) -> None:
        """Put joints where they are to be, at rest, with their set points and what follows them."""
        found = dict(positions)
        for one, other, offset, factor in self.scene.followers():
            if other in positions:
                found[one] = offset + factor * positions[other]
        for joint, value in found.items():
            position, velocity = self.scene.joints[joint]
            self._data.qpos[position], self._data.qvel[velocity] = value, 0.0
            if joint in self.scene.drives:
                self._data.ctrl[self.scene.drives[joint]] = value

    def put(self, part: str, pose: Pose) -> None:
        """Put a free body somewhere in the root frame, at rest."""
        at = self.scene.parts[part]
        i, j, k, w = pose.quaternion
        self._data.qpos[at : at + 7] = (*pose.position, w, i, j, k)
        first = int(self.model.body(part).dofadr[0])
        self._data.qvel[first : first + 6] = 0.0

    def shift(self, part: str, by: Vector3) -> None:
        """Move a free body in the root frame, whatever its speed is."""
        at = self.scene.parts[part]
        self._data.qpos[at : at + 3] += by

    def shape(self, part: str, wider_m: float, friction: float | None) -> None:
        """Give a free body other edges across, and another friction, than the scene has.

        Args:
            wider_m: by which both edges across are longer.
            friction: of its contacts; None for that of the scene.
        """
        model = self._own_model()
        for geom in _shapes_of(self.scene.model, part):
            size = self.scene.model.geom_size[geom].copy()
            size[:2] = np.maximum(size[:2] + wider_m / 2.0, _THINNEST)
            model.geom_size[geom] = model.geom_aabb[geom][3:] = size
            model.geom_rbound[geom] = float(np.linalg.norm(size))
            slides = self.scene.model.geom_friction[geom][0] if friction is None else friction
            model.geom_friction[geom][0] = max(slides, _SMOOTHEST)

    def weigh(self, weights: Mapping[str, Weight]) -> None:
        """Give bodies other masses, and another share of their weight that a controller takes, than the scene has."""
        model, stated = self._own_model(), self.scene.model
        for name, weight in weights.items():
            body = self.scene.bodies.index(name)
            model.body_mass[body] = stated.body_mass[body] * weight.mass
            model.body_inertia[body] = stated.body_inertia[body] * weight.mass
            model.body_gravcomp[body] = stated.body_gravcomp[body] * weight.held / weight.mass
        self._library.mj_setConst(model, self._library.MjData(model))

    def run(self, steps: int, aims: Array) -> None:
        """Let time pass while the drives have their set points.

        Raises:
            SceneError: positions or speeds are beyond what a computer can hold.
        """
        self._data.ctrl[:] = aims
        if steps > 0:
            self._library.mj_step(self.model, self._data, steps)

    def refuse_unstable(self) -> None:
        """Raise SceneError where MuJoCo has met a value that is not a number."""
        kinds = self._library.mjtWarning
        bad = (kinds.mjWARN_BADQPOS, kinds.mjWARN_BADQVEL, kinds.mjWARN_BADQACC, kinds.mjWARN_BADCTRL)
        if any(self._data.warning[int(kind)].number for kind in bad):
            raise SceneError(f"what moves in it does not stay in one piece, {self._data.time:.3f} s after its begin")

    def weight_n(self, part: str) -> float:
        """Return what a free body weighs."""
        return float(self.model.body(part).mass[0]) * float(np.linalg.norm(self.model.opt.gravity))

    def friction(self, part: str) -> float:
        """Return the friction of a free body's contacts."""
        return float(self.model.geom_friction[_shapes_of(self.model, part)[0]][0])

    def touches(self, watched: NDArray[np.bool_] | None = None) -> Iterator[Touch]:
        """Yield what presses on what; ``watched`` says of which two shapes."""
        data, model = self._data, self.model
        if not data.ncon:
            return
        pairs = data.contact.geom
        chosen = np.arange(len(pairs)) if watched is None else np.flatnonzero(watched[pairs[:, 0], pairs[:, 1]])
        for index in chosen.tolist():
            self._library.mj_contactForce(model, data, index, self._one)
            if self._one[0] > 0.0:
                one, other = (self.scene.bodies[model.geom_bodyid[geom]] for geom in pairs[index])
                x, y, z = data.contact.frame[index][:3].tolist()
                yield Touch(one, other, float(self._one[0]), (x, y, z))

    def pressing(self) -> tuple[Rows, Array]:
        """Return the numbers of each two bodies that press on each other, a row for each contact, and the forces, N."""
        data, model = self._data, self.model
        if not data.ncon:
            return _NO_ROWS, _NO_FORCES
        pairs: Rows = np.sort(model.geom_bodyid[data.contact.geom], axis=1)
        if model.opt.cone == _ELLIPTIC:  # the first row of a contact is its normal
            first = data.contact.efc_address
            return pairs[first >= 0], data.efc_force[first[first >= 0]]
        forces = np.zeros(len(pairs))
        for index in range(len(pairs)):
            self._library.mj_contactForce(model, data, index, self._one)
            forces[index] = self._one[0]
        return pairs, forces

    def look(self) -> None:
        """Compute what presses on what in a state that was just restored."""
        self._library.mj_forward(self.model, self._data)
