"""An entered robot that cannot be the one that was measured, its numbers in other units; said before any simulation."""

from collections.abc import Mapping

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.measurement.campaign import States
from cdpr_struct.measurement.unit_scale import cable_vectors, chords, frame_reach
from cdpr_struct.robot.plausibility import lengths_in_mm
from cdpr_struct.robot.robot import Robot

_STRAIN = 0.3  # beyond this no cable stretches under the tensions measured
_TIMES_TENSION = 3.0  # beyond this no cable weighs, in tensions measured
_TIMES_WEIGHT = 30.0  # beyond this tensions together do not carry, in weights of the platform
_GIVE = 0.1  # of the frame's size, beyond which no mast gives way


def check_robot_scale(source: str, robot: Robot, states: States, files: Mapping[str, str]) -> None:
    """Hold platform, cables and masts against the frame's size and the tensions measured.

    files : of each case, that which gave its tensions

    Raises
    ------
    InputError : a number of the robot that cannot be in m, kg and N.
    """
    _check_body(source, robot)
    if np.isfinite(states.tension).any():
        _check_cables(source, robot, states)
        _check_readings(robot, states, files)
        _check_weight(source, robot, states)
        _check_masts(source, robot, states)


def _check_body(source: str, robot: Robot) -> None:
    """Mass lies within the frame."""
    body, (_, reach) = robot.platform, frame_reach(robot)
    if np.linalg.norm(body.center_of_mass) > reach:
        expected = "m: it lies outside the frame, whose anchors are within "
        expected += f"{reach:.3g} m of their middle (is it in mm?)"
        raise InputError(source, "center_of_mass", body.center_of_mass.tolist(), expected)
    gyration = float(np.sqrt(np.linalg.eigvalsh(body.inertia)[-1] / body.mass))
    if gyration > reach:
        expected = f"kg m^2: with a mass of {body.mass:.4g} kg the radius of gyration is {gyration:.3g} m, and the "
        expected += f"frame's anchors are within {reach:.3g} m of their middle (is it in kg mm^2, or the mass in t?)"
        raise InputError(source, "platform inertia", body.inertia.tolist(), expected)


def _check_cables(source: str, robot: Robot, states: States) -> None:
    """Cables that would tear or hang like chains under the tensions measured are not entered in N and kg/m."""
    strain = float(np.nanmedian(states.tension / robot.axial_stiffness))
    if strain > _STRAIN:
        expected = "EA in N: under the tensions measured such cables would stretch by "
        expected += f"{100.0 * strain:.3g} % in the median (is it in kN, or are the tensions not in N?)"
        raise InputError(source, "axial_stiffness", float(np.median(robot.axial_stiffness)), expected)
    weight = robot.linear_density * robot.gravity * chords(robot, states.position, states.angles)
    with np.errstate(over="ignore"):  # a tension of 1e-310 N: what is not finite does not count
        ratio = weight / states.tension
    times = float(np.median(ratio[np.isfinite(ratio)])) if np.isfinite(ratio).any() else 0.0
    if times > _TIMES_TENSION:
        weigh = f"such cables would weigh {times:.3g} times the tensions measured, in the median"
        if whole := lengths_in_mm(robot):
            raise InputError(source, "frame_anchor", robot.frame_anchors[0].tolist(), f"m: {weigh}. {whole}")
        expected = f"kg/m: {weigh} (is it in g/m, or are the tensions not in N?)"
        raise InputError(source, "linear_density", float(np.median(robot.linear_density)), expected)


def _check_readings(robot: Robot, states: States, files: Mapping[str, str]) -> None:
    """One tension that would tear its cable has lost its decimal point."""
    strain = np.nan_to_num(states.tension / robot.axial_stiffness)
    i, cable = np.unravel_index(int(strain.argmax()), strain.shape)
    if strain[i, cable] > _STRAIN:
        name, stiffness = states.names[i], robot.axial_stiffness[cable]
        expected = f"a tension in N: with EA = {stiffness:g} N it would stretch the cable to "
        expected += f"{1.0 + strain[i, cable]:.2g} times its length (is a decimal point missing?)"
        place = f"case {name}, cable {cable + 1}: tension_N"
        raise InputError(files[name], place, float(states.tension[i, cable]), expected)


def _check_weight(source: str, robot: Robot, states: States) -> None:
    """Tensions together do not carry many times what the platform weighs, also without the one that pulls most."""
    posed = np.isfinite(states.position + states.angles).all(axis=1)
    whole = np.isfinite(states.tension).all(axis=1) & posed
    if not whole.any():
        return
    vectors = cable_vectors(robot, states.position[whole], states.angles[whole])
    upward = states.tension[whole] * vectors[..., 2] / np.linalg.norm(vectors, axis=-1)
    most = np.take_along_axis(upward, np.abs(upward).argmax(axis=1)[:, None], axis=1)[:, 0]
    together = upward.sum(axis=1)
    carried = float(np.median(np.minimum(np.abs(together), np.abs(together - most))))
    weight = float(np.median(robot.platform.mass + states.payload[whole])) * robot.gravity
    if carried > _TIMES_WEIGHT * weight:
        expected = f"a platform's mass in kg: it weighs {weight:.3g} N with its load, and the tensions measured carry "
        expected += f"more than {carried:.3g} N (is it in t, or are the tensions not in N?)"
        raise InputError(source, "platform mass", robot.platform.mass, expected)


def _check_masts(source: str, robot: Robot, states: States) -> None:
    """Masts stand where their cables pull."""
    for name in ("frame_compliance", "mast_bending"):
        compliance: np.ndarray = getattr(robot.extensions, name)
        give = float(np.nanmedian(states.tension * compliance))
        if give > _GIVE * frame_reach(robot)[1]:
            expected = "m/N: under the tensions measured masts would give way by "
            expected += f"{give:.3g} m, in the median (is it in mm/N?)"
            raise InputError(source, name, float(np.median(compliance)), expected)
