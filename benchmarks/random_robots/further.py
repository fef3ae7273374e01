"""Further questions about a pose that is held: its static pose error, and the best tensions along a small motion."""

from collections.abc import Iterator
from typing import Any

import numpy as np

import cdpr_struct as cs
from benchmarks.random_robots.case import Case
from benchmarks.random_robots.judging import rest_balance_faults
from benchmarks.random_robots.own_mechanics import own_rest
from cdpr_struct.statics.forward_kinematics import ForwardSolution
from cdpr_struct.statics.pose_error import PoseError, pose_error
from cdpr_struct.statics.trajectory import Trajectory, straight_line
from cdpr_struct.workspace.grid import Grid

_SAME = 1e-9  # of the frame's size [mm]: the answer's errors are those of the poses that are judged
_AS_GOOD = 1e-6  # relative: by so much the norm of tensions may lie above one that is known
_ROUNDED = 1e-13  # of EA: forces of lengths that are rounded
_MOVED = 1e-3  # of the frame's size
_TAUT = 1.2  # times the weight of a cable
_SECONDS = 10.0
_INSTANTS = 3


def error_at(case: Case, pose: cs.Pose) -> Any:
    """Answer of `pose_error` at one pose."""
    x, y, z = (np.array([value]) for value in pose.position)
    return cs.pose_error(case.robot, Grid(x, y, z, pose.angles))


def pose_error_faults(case: Case, pose: cs.Pose, answer: Any) -> Iterator[str]:
    """What is wrong with a pose error: the poses it lies between balance at the lengths that winches are told."""
    columns, found = answer.errors.columns, pose_error(case.robot, pose.position, pose.rotation)
    told = np.array([columns[f"global_{axis}_mm"][0] for axis in "xyz"])
    apart = float(np.abs(told - 1e3 * found.global_error).max())
    if apart > 1e3 * _SAME * float(np.abs(case.robot.frame_anchors).max()):
        yield f"error: {apart:.1e} mm from that of the pose it is taken of"
    if not (columns["held"][0] and columns["stable"][0]):
        yield "counts: a single pose is answered that does not count"
    yield from _ends_faults(case, pose, found)


def _ends_faults(case: Case, pose: cs.Pose, found: PoseError) -> Iterator[str]:
    end, pull = found.sagging, found.sagging.cables.force_on_platform
    own = own_rest(case.robot, (end.position, end.rotation), end.cables.total_length, pull)
    yield from (f"sagging: {fault}" for fault in rest_balance_faults(own, pull))
    if not any(case.robot.pulleys):
        off = _spring_forces(case, found.spring) - found.spring.cables.force_on_platform
        if np.abs(off).max() > 1e-7 * np.abs(pull).max() + _ROUNDED * float(case.robot.axial_stiffness.max()):
            yield f"spring: forces are off by {np.abs(off).max():.1e} N"
    if not (any(case.robot.pulleys) or (case.robot.force_min > 0.0).any()):
        straight = np.linalg.norm(
            pose.position + case.robot.platform_anchors @ pose.rotation.T - case.robot.frame_anchors, axis=1
        )
        off = np.abs(found.sagging.cables.total_length / straight - 1.0).max()
        if off > 1e-12:
            yield f"lengths: {off:.1e} from those of straight cables"


def _spring_forces(case: Case, end: ForwardSolution) -> np.ndarray:
    """(m, 3) of straight elastic cables that cannot push, on the platform [N]."""
    lengths = end.cables.total_length
    offset = case.robot.frame_anchors - end.position - case.robot.platform_anchors @ end.rotation.T
    chord = np.linalg.norm(offset, axis=1)
    pull = case.robot.axial_stiffness * np.maximum(chord / lengths - 1.0, 0.0)
    return np.asarray((pull / chord)[:, None] * offset)


def small_motion(case: Case) -> Trajectory:
    """From the pose a little towards the middle of the frame, at rest at both ends."""
    middle = case.robot.frame_anchors.mean(axis=0)
    way = _MOVED * (middle - case.pose.position)
    if case.robot.guided:
        way = way * [1.0, 0.0, 1.0]
    return straight_line(case.pose, cs.Pose(case.pose.position + way, case.pose.angles), _SECONDS, _INSTANTS)


def distributed(case: Case) -> Any:
    """Answer of `distribute` along a small motion, cables as slack as they may be."""
    return cs.distribute(case.robot, small_motion(case), bound="fixed", b=1e-6)


def taut(case: Case, held: Any) -> bool:
    """Whether the cables of a rest are so taut that `distribute`, which knows no slack ones, could choose them."""
    cables = held.solution.cables
    span, chord = np.linalg.norm(cables.offset[:, :2], axis=1), np.linalg.norm(cables.offset, axis=1)
    level = np.linalg.norm(cables.force_on_platform[:, :2], axis=1)
    straight = level * chord / np.maximum(span, 1e-12 * chord)
    upright = np.where(span > 1e-6 * chord, straight, held.solution.tensions)
    return bool((upright > _TAUT * case.robot.weight_per_length * cables.length).all() and (upright > 0.0).all())


def distribution_faults(case: Case, held: Any, answer: Any) -> Iterator[str]:
    """What is wrong with tensions along a small motion, whose first instant is the pose that is `held`."""
    found, path = answer.found[0].distribution, small_motion(case)
    for i in (0, _INSTANTS - 1):  # at rest
        forces = found.cables.force_on_platform[i]
        own = own_rest(case.robot, (path.position[i], path.rotation[i]), found.lengths[i], forces)
        yield from (f"instant {i + 1}: {fault}" for fault in rest_balance_faults(own, forces))
        margin = 1e-7 * (own.scale + found.tensions[i])
        outside = (found.tensions[i] < found.lower[i] - margin) | (found.tensions[i] > found.upper[i] + margin)
        if outside.any():
            yield f"bounds: tensions outside of them at instant {i + 1}"
    before = held.solution.tensions
    within = taut(case, held) and (before >= found.lower[0]).all() and (before <= found.upper[0]).all()
    best, known = np.linalg.norm(found.tensions[0]), np.linalg.norm(before)
    if within and best > known * (1.0 + _AS_GOOD):
        yield f"norm: {best / known - 1.0:.1e} above that of tensions that hold the pose"
