"""What hangs on the cables."""

from dataclasses import replace

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.platform import least_moved_mass, moved_mass
from cdpr_struct.robot.robot_arrays import RobotArrays

_XYZ = ("x", "y", "z")
_NOTHING = 1e-10  # of the platform's mass: mode frequencies keep ten digits
_PENDULA = (0.5, 1.0)  # Hz: cords of 1 m and 0.25 m
_HOOK = 0.1  # m, an axis: a payload hangs near the middle of a platform
_BELOW = (-0.2,)  # m: hooks are under a platform more often than above it
_MOST = 0.8  # of what the platform moves at a place: so much of it may sit on a mount or hang


def _mass(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, mass=np.exp(theta[..., 0]))


def _joint(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return arrays.with_point_masses(theta, arrays.platform_anchors)


def _center(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, center_of_mass=theta)


def _inertia(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    half = np.exp(0.5 * theta)
    return times(arrays, inertia=half[..., :, None] * half[..., None, :])


def _force(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, force=theta)


def _hose(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """Stiffness about the campaign's mean position, and the force there: nobody knows where a hose is at rest."""
    return plus(arrays, hose=theta[..., 0], force=theta[..., 1:])


def _flexible(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """Roots of the internal mass along x, y and z, and the frequency of its mount."""
    root = theta[..., :3]
    length = np.linalg.norm(root, axis=-1)
    there = length > 0.0
    direction = np.where(there[..., None], root / np.where(there, length, 1.0)[..., None], arrays.internal_direction)
    most = _MOST * moved_mass(arrays.mass, arrays.center_of_mass, arrays.inertia, direction)
    return replace(
        arrays, internal_mass=np.minimum(length**2, most), internal_frequency=np.maximum(theta[..., 3], 0.0),
        internal_direction=direction,
    )  # fmt: skip


def _swinging(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """Root of the mass that swings, its frequency, and where it hangs."""
    place = theta[..., 2:]
    most = _MOST * least_moved_mass(arrays.mass, arrays.center_of_mass, arrays.inertia, place)
    return replace(
        arrays, swinging_mass=np.minimum(theta[..., 0] ** 2, most), swinging_frequency=np.maximum(theta[..., 1], 0.0),
        swinging_place=place,
    )  # fmt: skip


def _line(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """A part on a mount that weighs nothing: its frequency is the same in every state, and no other mode feels it."""
    hertz = np.maximum(theta[..., 0], 0.0)
    return replace(arrays, internal_mass=np.where(hertz > 0.0, _NOTHING * arrays.mass, 0.0), internal_frequency=hertz)


def _flexes(seen: Seen) -> str:
    return "the robot file has an internal mass already" if seen.internal else ""


def _swings(seen: Seen) -> str:
    return "the robot file has a swinging mass already" if seen.swinging else ""


CAUSES = (
    Cause(
        "platform_mass",
        "mass of the platform",
        (Parameter("platform_mass", "ratio", 0.05, True),),
        _mass,
        seen_in=("EQ", "RF"),
        sentence="the platform mass is {percent} of the entered value",
        separated_by="weighing it; a payload series",
        extension="mass",
    ),
    Cause(
        "joint_mass",
        "mass of joints, rings and shackles at the platform anchors",
        (Parameter("joint_mass", "kg", 0.2, positive=True),),
        _joint,
        carrier="cable",
        seen_in=("EQ", "RF"),
        sentence="joints at the platform anchors weigh {value} kg each",
        separated_by="weighing a joint; rotational frequencies",
        extension="joint_mass",
    ),
    Cause(
        "center_of_mass",
        "centre of mass of the platform",
        tuple(Parameter(f"center_of_mass_{a}", "m", 0.015) for a in _XYZ),
        _center,
        seen_in=("EQ", "RF"),
        sentence="the centre of mass of the platform is off by {norm} m",
        separated_by="tilted poses",
        extension="center_of_mass",
    ),
    Cause(
        "platform_inertia",
        "inertia of the platform",
        (Parameter("inertia", "ratio", 0.2, True),),
        _inertia,
        carrier="axis",
        seen_in=("RF",),
        sentence="the platform inertia is {percent} of the entered value",
        separated_by="rotational frequencies; a bifilar pendulum",
        extension="inertia",
    ),
    Cause(
        "external_force",
        "a constant force on the platform",
        tuple(Parameter(f"force_{a}", "N", 10.0) for a in _XYZ),
        _force,
        seen_in=("EQ",),
        sentence="a constant force of {norm} N acts on the platform",
        separated_by="a payload series; removing hoses and wires",
        extension="force",
    ),
    Cause(
        "hose_stiffness",
        "stiffness of a hose or energy chain on the platform",
        (
            Parameter("hose_stiffness", "N/m", 20.0, positive=True),
            *(Parameter(f"hose_force_{a}", "N", 10.0) for a in _XYZ),
        ),
        _hose,
        seen_in=("EQ", "RF"),
        sentence="a hose or energy chain acts on the platform with a stiffness of {value} N/m",
        separated_by="removing the hose; poses farther apart",
        extension="hose",
        becomes=("external_force",),
    ),
    Cause(
        "flexible_platform",
        "a mode inside the platform: a part of it, such as a gripper or a tool, on an elastic mount",
        (
            *(Parameter(f"internal_mass_{a}", "kg", 1.0, squared=True, positive=True) for a in _XYZ),
            Parameter("internal_frequency", "Hz", 1.0, positive=True, in_band=True),
        ),
        _flexible,
        shapes=(
            *((f"along {a} of the platform", [i, 3], 0.2) for i, a in enumerate(_XYZ)),
            ("in some direction", [0, 1, 2, 3], 0.4),
        ),
        seen_in=("RF",),
        needs=_flexes,
        sentence="a part of the platform moves on an elastic mount, {parts} with the platform held",
        separated_by="shaking with accelerometers on the platform and on the part; clamping the part",
        extension="internal_mass",
        becomes=("steady_disturbance",),
    ),
    Cause(
        "swinging_payload",
        "a part of the platform's mass that swings below it, or a liquid that sloshes in it",
        (
            Parameter("swinging_mass", "kg", 1.0, squared=True, positive=True),
            Parameter("swinging_frequency", "Hz", 1.0, positive=True, in_band=True, tried=_PENDULA),
            *(Parameter(f"hook_{a}", "m", _HOOK, tried=_BELOW if a == "z" else ()) for a in _XYZ),
        ),
        _swinging,
        shapes=(("at the platform origin", [0, 1], 0.5), ("at a point of the platform", [0, 1, 2, 3, 4], 0.5)),
        seen_in=("RF",),
        needs=_swings,
        sentence="a part of the platform's mass swings, {parts} with the platform held",
        separated_by="fixing the payload, or a cord of another length; shaking far below the robot's first mode",
        extension="swinging_mass",
        becomes=("steady_disturbance",),
    ),
    Cause(
        "steady_disturbance",
        "a disturbance of constant frequency, such as the mains, a fan or a pump, among the robot's peaks",
        (Parameter("disturbance_frequency", "Hz", 1.0, positive=True, in_band=True),),
        _line,
        seen_in=("RF",),
        needs=_flexes,
        sentence="a disturbance of {value} Hz at all poses, which is no mode of the robot, is among its peaks",
        separated_by="recording without excitation, and with fans, pumps and drives switched off",
        outside=True,
    ),
)
