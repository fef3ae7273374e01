"""Readings that are many times what the robot allows are in another unit; that is said before any simulation."""

import numpy as np

from cdpr_struct.errors import InputError
from cdpr_struct.generated.platform import rotation
from cdpr_struct.measurement.campaign import States
from cdpr_struct.robot.plausibility import lengths_in_mm
from cdpr_struct.robot.robot import Robot

_TIMES = 30.0  # beyond this no robot or reading is: mm instead of m is a thousand times, kN instead of N as well
_TIMES_PLATFORM = 100.0  # the same of a payload
_TIMES_LOCKED = 1.5  # the same of all lengths together where the pose must be found from them


def check_scale(source: str, robot: Robot, states: States) -> None:
    """Hold poses, lengths, payloads and tensions against the size and weight of the robot.

    Raises
    ------
    InputError : a state whose pose, lengths, payload or tensions cannot be in m, kg and N.
    """
    for i, name in enumerate(states.names):
        locked = not states.has_tension[i]
        check_pose_scale(source, name, robot, states.position[i], states.angles[i], states.length[i], locked)
        _check_payload(source, name, robot, float(states.payload[i]))
        _check_tensions(source, name, states.tension[i], robot, float(states.payload[i]))
    _check_files(source, robot, states)


def check_pose_scale(
    source: str,
    name: str,
    robot: Robot,
    position: np.ndarray,
    angles: np.ndarray,
    length: np.ndarray,
    locked: bool = True,
) -> None:
    """Hold one pose (3,) [m], (3,) [rad], and its lengths (m,) [m], against the size of the robot.

    locked : whether the pose must be found from the lengths, which many times too long takes minutes and finds nothing

    Raises
    ------
    InputError : a pose or lengths that cannot be in m.
    """
    _check_position(source, name, robot, position)
    _check_lengths(source, name, robot, length, chords(robot, position[None], angles[None])[0], locked)


def _check_position(source: str, name: str, robot: Robot, position: np.ndarray) -> None:
    middle, reach = frame_reach(robot)
    if np.linalg.norm(position - middle) > _TIMES * reach:
        expected = f"a position in m: the frame anchors lie within {reach:.3g} m of their middle (is it in mm?)"
        raise InputError(source, f"case {name}: x_m, y_m, z_m", position.tolist(), expected)


def _robot_or_lengths(robot: Robot) -> str:
    """Which file is in another unit, where all lengths are far shorter than the robot: its masses decide."""
    if whole := lengths_in_mm(robot):
        return f"the robot's lengths are in mm? {whole.rpartition(' (')[0]}"
    return "are the anchors or this pose in mm, or is the length in km?"


def _check_lengths(source: str, name: str, robot: Robot, length: np.ndarray, chord: np.ndarray, locked: bool) -> None:
    known = np.isfinite(length) & np.isfinite(chord)
    if not known.any():
        return
    chord = np.where(known, chord, 1.0)
    ratio = np.where(known, length, chord) / chord
    off, unit = np.flatnonzero(~((ratio > 1.0 / _TIMES) & (ratio < _TIMES))), "mm"
    if locked and known.all() and not off.size and _all_beyond(ratio, _TIMES_LOCKED):
        off, unit = np.arange(len(ratio)), "ft"
    if off.size:
        i = int(off[0])
        which = "every cable" if off.size == known.sum() else f"cable {i + 1}"
        all_short = unit == "mm" and off.size == known.sum() and _all_beyond(ratio, _TIMES) and ratio[i] < 1.0
        doubt = _robot_or_lengths(robot) if all_short else f"is it in {unit}?"
        expected = f"a length in m: at this pose its anchors are {chord[i]:.3g} m apart ({doubt})"
        raise InputError(source, f"case {name}, {which}: length_m", float(length[i]), expected)


def _all_beyond(ratio: np.ndarray, times: float) -> bool:
    """Whether all are too large, or all too small; with a wrong pose some are and others are not."""
    return bool((ratio > times).all() or (ratio < 1.0 / times).all())


def _check_payload(source: str, name: str, robot: Robot, payload: float) -> None:
    if payload > _TIMES_PLATFORM * robot.platform.mass:
        expected = f"a payload in kg: the platform itself has {robot.platform.mass:.4g} kg (is it in g, or that in t?)"
        raise InputError(source, f"case {name}: payload_kg", payload, expected)


def _check_tensions(source: str, name: str, tension: np.ndarray, robot: Robot, payload: float) -> None:
    """All tensions together pull at least as much as the platform weighs."""
    weight = (robot.platform.mass + payload) * robot.gravity
    if np.isfinite(tension).all() and tension.sum() * _TIMES < weight:
        expected = f"tensions in N: all together hold at least the weight of {weight:.3g} N (are they in kN"
        expected += f", or is the robot's mass of {robot.platform.mass:.4g} kg in g?)"
        raise InputError(source, f"case {name}: tension_N", float(tension.sum()), expected)


def _check_files(source: str, robot: Robot, states: States) -> None:
    """Lengths of static states and locked ones are in one unit."""
    known = np.isfinite(states.length).all(axis=1) & np.isfinite(states.position + states.angles).all(axis=1)
    held, locked = (np.flatnonzero(known & own) for own in (states.has_tension, ~states.has_tension))
    if not (held.size and locked.size):
        return
    ratio = states.length / chords(robot, states.position, states.angles)
    times = float(np.median(ratio[held]) / np.median(ratio[locked]))
    if not 1.0 / _TIMES_LOCKED < times < _TIMES_LOCKED:
        i = int(held[0])
        expected = f"lengths of all files in m: those of the static states are {times:.3g} times as long, beside the "
        expected += "distance of their anchors, as those of the locked ones (are they in ft?)"
        raise InputError(source, f"case {states.names[i]}: length_m", float(states.length[i, 0]), expected)


def frame_reach(robot: Robot) -> tuple[np.ndarray, float]:
    """Middle (3,) of the frame anchors and how far the farthest is from it [m]."""
    middle = robot.frame_anchors.mean(axis=0)
    return middle, float(np.linalg.norm(robot.frame_anchors - middle, axis=1).max())


def chords(robot: Robot, position: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """(S, m) distances of the anchors at poses (S, 3) [m], (S, 3) [rad]."""
    distances: np.ndarray = np.linalg.norm(cable_vectors(robot, position, angles), axis=-1)
    return distances


def cable_vectors(robot: Robot, position: np.ndarray, angles: np.ndarray) -> np.ndarray:
    """(S, m, 3) from platform to frame anchors at poses (S, 3) [m], (S, 3) [rad]."""
    turned = np.array([robot.platform_anchors @ rotation(*own).T for own in angles])
    vectors: np.ndarray = robot.frame_anchors - position[:, None] - turned
    return vectors
