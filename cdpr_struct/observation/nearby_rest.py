"""States at rest near known ones, to first order: residuals of many slightly different robots without any catenary.

A cable that carries a given tension depends on where its ends are, its tension, stiffness, weight and what is in line
with it: seven numbers. Their slopes are taken once; what a robot or a reading changes of them is geometry. So is a
pulley of another radius or axis: with the cable's direction held, its exit moves as if the frame anchor did, and the
cable on it is longer. What the exit does as the cable turns after that, the slopes know.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import Readings, paid_out, true_pose, true_tension
from cdpr_struct.observation.rest import Rest, at_states, inertia_wrench, rest
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, load_wrench
from cdpr_struct.statics.guides import free_part
from cdpr_struct.statics.masts import MastShapes
from cdpr_struct.statics.pulley import pulley_exit
from cdpr_struct.statics.swivel_angle import swivel_angle, within_turn
from cdpr_struct.statics.tensioned_cables import tensioned

_ANCHOR, _SHARE, _COMPLIANCE = 1e-5, 1e-5, 1e-10  # steps: m, of the value, m/N
_PULLS = 3  # rounds of masts that are pulled by what they move: each is a thousandth of the one before


@dataclass(frozen=True, slots=True, eq=False)
class NearbyRest:
    """Known states, and slopes of the cables there.

    inputs (S, m, 7) : frame to platform anchor with rigid masts (3) [m], tension, EA, weight, compliance
    outputs (S, m, 7) : force on the platform, pull at the frame (3 each) [N], length from the frame anchor on [m]
    slopes (S, m, 7, 7)
    wound (S or 1, m or 1, 4) : exit less frame anchor (3) [m], unstrained length on the pulley [m], at these pulls
    stretch (S, m) : strained over unstrained length where cables leave the pulleys
    """

    known: Circumstances
    radius: float
    inputs: np.ndarray
    outputs: np.ndarray
    slopes: np.ndarray
    wound: np.ndarray
    stretch: np.ndarray

    @classmethod
    def about(cls, arrays: RobotArrays, readings: Readings, known: Circumstances, radius: float) -> "NearbyRest":
        """Slopes at the states (S) that readings mean for a robot."""
        state = rest(arrays, readings, known)
        tension = true_tension(state.arrays, readings, known)
        rigid = _rigid(state, tension)
        base = _outputs(state.cables)
        moved, pulled, steps = _steps(rigid, tension)
        found = _outputs(tensioned(cable_model(known.model), moved, state.arms.points, pulled))
        inputs = _inputs(state.arrays, state.arms, tension, _mast_shift(state.arrays, base))
        slopes = np.moveaxis((found - base) / steps[..., None], 0, -1)
        stretch = 1.0 + np.linalg.norm(base[..., 3:6], axis=-1) / state.cables.axial_stiffness
        return cls(known, radius, inputs, base, slopes, _wound(state.arrays, base, stretch), stretch)

    def residuals(self, arrays: RobotArrays, readings: Readings) -> np.ndarray:
        """(..., S, 6 + m) as `static_residuals`, to first order in the change of the cables."""
        there = at_states(arrays, self.known)
        position, rotation = true_pose(there, readings)
        arms = PlatformArms.at(there, position, rotation)
        found = self._cables(there, arms, true_tension(there, readings, self.known))
        force, length = found[..., :3], found[..., 6]
        moment = np.cross(arms.arms, force).sum(axis=-2)
        load = load_wrench(there, arms) + inertia_wrench(there, arms, rotation, self.known)
        gap = paid_out(there, readings, self.known) - length
        wrench = free_part(np.concatenate([force.sum(axis=-2), moment], axis=-1) + load, there)
        rows = [wrench[..., :3], wrench[..., 3:] / self.radius, gap]
        lead = np.broadcast_shapes(*(part.shape[:-1] for part in rows))
        return np.concatenate([np.broadcast_to(part, (*lead, part.shape[-1])) for part in rows], axis=-1)

    def swivels(self, arrays: RobotArrays, readings: Readings, reference: np.ndarray) -> np.ndarray:
        """(..., S, m) what encoders on the swivel axes say [rad], within a turn; zero directions `reference` (m, 3)."""
        there = at_states(arrays, self.known)
        arms = PlatformArms.at(there, *true_pose(there, readings))
        found = self._cables(there, arms, true_tension(there, readings, self.known))
        return within_turn(swivel_angle(found[..., 3:6], there.pulley_axis, reference) + there.swivel_zero)

    def _cables(self, there: RobotArrays, arms: PlatformArms, tension: np.ndarray) -> np.ndarray:
        """(..., S, m, 7) outputs."""
        found, wound = self.outputs, _wound(there, self.outputs, self.stretch) - self.wound
        for _ in range(_PULLS if there.has_masts else 1):
            change = _inputs(there, arms, tension, _mast_shift(there, found) + wound[..., :3]) - self.inputs
            found = self.outputs + np.einsum("smoi,...smi->...smo", self.slopes, change)
        return np.concatenate([found[..., :6], found[..., 6:] + wound[..., 3:]], axis=-1) if wound.any() else found


def _rigid(state: Rest, tension: np.ndarray) -> RobotArrays:
    """The robot of a state with masts rigid where they stand, and the stiffness that its cables have."""
    moved = state.arrays.frame_anchors + _mast_shift(state.arrays, _outputs(state.cables))
    stiff = state.arrays.stiffness_at(tension)
    return replace(
        state.arrays,
        frame_anchors=moved,
        axial_stiffness=stiff,
        frame_compliance=np.zeros(1),
        mast_bending=np.zeros(1),
        nonlinearity=np.zeros(()),
        stiffening_exponent=np.zeros(()),
    )


def _outputs(cables: CableStates) -> np.ndarray:
    """(..., m, 7)."""
    parts = [cables.force_on_platform, cables.force_at_frame, cables.total_length[..., None]]
    return np.concatenate(parts, axis=-1)


def _mast_shift(arrays: RobotArrays, outputs: np.ndarray) -> np.ndarray:
    """(..., m, 3) by which the pull on the masts moves their exits."""
    if not arrays.has_masts:
        return np.zeros(3)
    return MastShapes.soft(arrays).shift(outputs[..., 3:6])


def _wound(arrays: RobotArrays, outputs: np.ndarray, stretch: np.ndarray) -> np.ndarray:
    """(..., m, 4) exit less frame anchor (3) and unstrained length on the pulley [m], of cables with these pulls."""
    if not arrays.has_pulleys:
        return np.zeros((1, 1, 4))
    pull = outputs[..., 3:6]
    there = pulley_exit(pull / np.linalg.norm(pull, axis=-1, keepdims=True), arrays.pulley_axis, arrays.pulley_radius)
    length = arrays.pulley_radius * there.wrap_angle / stretch
    return np.concatenate([there.point, length[..., None]], axis=-1)


def _inputs(arrays: RobotArrays, arms: PlatformArms, tension: np.ndarray, shift: np.ndarray) -> np.ndarray:
    """(..., m, 7)."""
    offset = arms.points - arrays.frame_anchors - shift
    single = [tension, arrays.stiffness_at(tension), arrays.weight, arrays.series_compliance]
    lead = np.broadcast_shapes(offset.shape[:-1], *(value.shape for value in single))
    parts = [np.broadcast_to(offset, (*lead, 3)), *(np.broadcast_to(value, lead)[..., None] for value in single)]
    return np.concatenate(parts, axis=-1)


def _steps(rigid: RobotArrays, tension: np.ndarray) -> tuple[RobotArrays, np.ndarray, np.ndarray]:
    """The robot and its tensions with one input at a time changed along a new first axis (7), by (7, S, m)."""
    shift, pull, stiff, heavy, soft = np.split(np.eye(7)[:, :, None, None], [3, 4, 5, 6], axis=1)
    pull, stiff, heavy, soft = (part[:, 0] for part in (pull, stiff, heavy, soft))
    moved = replace(
        rigid,
        frame_anchors=rigid.frame_anchors - _ANCHOR * np.moveaxis(shift, 1, -1),
        axial_stiffness=rigid.axial_stiffness * (1.0 + _SHARE * stiff),
        linear_density=rigid.linear_density * (1.0 + _SHARE * heavy),
        series_compliance=rigid.series_compliance + _COMPLIANCE * soft,
    )
    shares = pull * tension + stiff * rigid.axial_stiffness + heavy * rigid.weight
    sizes = _ANCHOR * shift.sum(axis=1) + _SHARE * shares + _COMPLIANCE * soft
    return moved, tension * (1.0 + _SHARE * pull), sizes
