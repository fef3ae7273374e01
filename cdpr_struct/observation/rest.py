"""The robot at rest as its readings mean it: what does not balance, and which lengths do not fit.

Pose and tensions are put into the model; what is left over is the wrench that does not balance and the difference
between the length paid out and that of the cable with this tension between these points. Both are nearly linear in
every cause, while tensions computed from lengths are not.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.readings import Readings, paid_out, true_pose, true_tension
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.cable_models import cable_model
from cdpr_struct.statics.cable_state import CableStates
from cdpr_struct.statics.equilibrium import PlatformArms, cable_wrench, load_wrench
from cdpr_struct.statics.guides import free_part
from cdpr_struct.statics.tensioned_cables import tensioned

_FIRST_MINUTE = 60.0  # minutes in an hour: creep counts decades of time after the first minute


@dataclass(frozen=True, slots=True, eq=False)
class Rest:
    """States that readings mean; leading axes (..., S) are batch and states.

    arrays : the robot as it is in each state, payload and creep included
    position (..., S, 3) [m], rotation (..., S, 3, 3), arms, cables : CableStates (..., S, m)
    """

    arrays: RobotArrays
    position: np.ndarray
    rotation: np.ndarray
    arms: PlatformArms
    cables: CableStates


def at_states(arrays: RobotArrays, known: Circumstances) -> RobotArrays:
    """The robot in each state: its cables crept, the payload on its platform, its laws referred to the campaign."""
    if arrays.creep.any():
        lag = 1.0 + arrays.creep[..., None] * np.log10(1.0 + _FIRST_MINUTE * known.hours[:, None])
        arrays = replace(arrays, axial_stiffness=arrays.axial_stiffness / lag)
    arrays = arrays.with_point_masses(known.payload[:, None], np.zeros(3))
    return replace(arrays, hose_center=known.center, reference_tension=np.asarray(known.mean_tension))


def rest(arrays: RobotArrays, readings: Readings, known: Circumstances) -> Rest:
    """What readings mean for a robot; batch axes of arrays (..., S or 1) and readings (..., S) broadcast."""
    there = at_states(arrays, known)
    position, rotation = true_pose(there, readings)
    arms = PlatformArms.at(there, position, rotation)
    cables = tensioned(cable_model(known.model), there, arms.points, true_tension(there, readings, known))
    return Rest(there, position, rotation, arms, cables)


def unbalanced(state: Rest, known: Circumstances) -> np.ndarray:
    """(..., S, 6) wrench of cables, load and inertia about the platform origin [N, N m]; zero if all were right.

    What a guide holds is zero: it takes whatever there is.
    """
    load = load_wrench(state.arrays, state.arms) + inertia_wrench(state.arrays, state.arms, state.rotation, known)
    return free_part(cable_wrench(state.cables, state.arms) + load, state.arrays)


def inertia_wrench(arrays: RobotArrays, arms: PlatformArms, rotation: np.ndarray, known: Circumstances) -> np.ndarray:
    """(..., S, 6) d'Alembert wrench of the accelerated platform about its origin, world axes [N, N m].

    What goes with the square of its angular velocity is left out. Cables are light.
    """
    if not known.inertial.any():
        return np.zeros(6)
    moved, turned = known.inertial[:, :3], known.inertial[:, 3:]
    force = -arrays.mass[..., None] * (moved + np.cross(turned, arms.center))
    rate = (rotation @ (arrays.inertia @ (np.swapaxes(rotation, -1, -2) @ turned[..., None])))[..., 0]
    return np.concatenate([force, np.cross(arms.center, force) - rate], axis=-1)


def unfitting(state: Rest, readings: Readings, known: Circumstances) -> np.ndarray:
    """(..., S, m) length paid out, as the encoders mean it, less that of the cables [m]; zero if all were right."""
    return paid_out(state.arrays, readings, known) - state.cables.total_length


def static_residuals(arrays: RobotArrays, readings: Readings, known: Circumstances, radius: float) -> np.ndarray:
    """(..., S, 6 + m): wrench, moments over the platform's radius [N], then lengths [m]."""
    state = rest(arrays, readings, known)
    wrench, length = unbalanced(state, known), unfitting(state, readings, known)
    rows = [wrench[..., :3], wrench[..., 3:] / radius, length]
    lead = np.broadcast_shapes(*(part.shape[:-1] for part in rows))
    return np.concatenate([np.broadcast_to(part, (*lead, part.shape[-1])) for part in rows], axis=-1)
