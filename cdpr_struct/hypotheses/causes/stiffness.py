"""What gives way more than entered."""

from dataclasses import replace

import numpy as np

from cdpr_struct.hypotheses.causes.cause import A_MINUTE, Cause, Parameter, Seen, by_carrier
from cdpr_struct.robot.changed_arrays import plus, times
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.masts import carriers

_POWER = 0.15  # exponent: a modulus that rises by a fifth where the tension grows by a factor of three
_STEEPEST = 0.8  # exponent: at 1 a cable of no strain would hold any tension


def _axial(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, axial_stiffness=np.exp(theta))


def _joint(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, series_compliance=theta)


def _dead(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, series_compliance=theta / arrays.axial_stiffness)


def _frame(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    carried, give = carriers(arrays.masts).T, by_carrier(theta, 2)
    return plus(arrays, frame_compliance=give[..., 0] @ carried, mast_bending=give[..., 1] @ carried)


def _nonlinear(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """k of a straight line; exponents of a power law of EA that small motion shares, and of one that is elastic, whose
    tangent is 1 / (1 - n) of the secant; EA at the reference tension, of the tangent where there is one."""
    k, shared, elastic, level = np.moveaxis(theta, -1, 0)
    shared, elastic = np.clip(shared, -_STEEPEST, _STEEPEST), np.clip(elastic, -_STEEPEST, _STEEPEST)
    stiffer = times(arrays, axial_stiffness=(np.exp(level) * (1.0 - elastic))[..., None])
    stiffer = times(stiffer, incremental_ratio=1.0 / (1.0 - elastic))
    exponent = np.clip(arrays.stiffening_exponent + shared + elastic, -_STEEPEST, _STEEPEST)
    return plus(replace(stiffer, stiffening_exponent=exponent), nonlinearity=k)


def _creep(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return plus(arrays, creep=theta[..., 0])


def _tensions(seen: Seen) -> str:
    """Along a motion balance does not tell tensions, since inertia is not in the model."""
    return "" if seen.tensions or not seen.moving else "needs tensions along a motion"


def _times(seen: Seen) -> str:
    return "" if seen.hours > A_MINUTE else "needs time_s over some minutes"


CAUSES = (
    Cause(
        "axial_stiffness",
        "axial stiffness EA of the cables",
        (Parameter("axial_stiffness", "ratio", 0.15, True),),
        _axial,
        carrier="cable",
        seen_in=("CO", "RF"),
        sentence="the axial stiffness of the cables is {percent} of the entered value",
        separated_by="poses at other heights: EA acts in proportion to the free length; a tensile test of 2 m of cable",
        extension="axial_stiffness",
    ),
    Cause(
        "joint_compliance",
        "compliance of joints, load cells or winches in series with the cables",
        (Parameter("compliance", "m/N", 4e-6, positive=True),),
        _joint,
        carrier="cable",
        seen_in=("CO", "RF"),
        sentence="each cable has a compliance of {value} m/N in series",
        separated_by="a dial gauge across the joint; clamping the cable at the pulley",
        extension="series_compliance",
    ),
    Cause(
        "dead_length",
        "elastic cable between pulley and winch",
        (Parameter("dead_length", "m", 3.0, positive=True),),
        _dead,
        carrier="cable",
        seen_in=("CO", "RF"),
        sentence="{value} m of elastic cable lie between pulley and winch",
        separated_by="clamping the cable at the pulley; an amplitude sweep",
        extension="series_compliance",
    ),
    Cause(
        "frame_compliance",
        "compliance of the masts",
        (
            Parameter("compliance", "m/N", 2e-6, positive=True),
            Parameter("bending_compliance", "m/N", 2e-6, positive=True),
        ),
        _frame,
        carrier="mast",
        laws=(("", [0], 0.5), ("bending sideways", [1], 0.5)),
        seen_in=("CO", "RF"),
        sentence="the masts have a compliance of {value} m/N",
        separated_by="a dial gauge on a mast; pulling one cable and watching its neighbour",
        extension="frame_compliance",
    ),
    Cause(
        "nonlinear_elasticity",
        "cables stiffen with tension",
        (
            Parameter("k", "1", 0.15),
            Parameter("exponent", "1", _POWER),
            Parameter("exponent_elastic", "1", _POWER),
            Parameter("level", "ratio", 0.15, True),
        ),
        _nonlinear,
        shapes=(
            ("a straight line", [0], 0.4),
            ("a power of the secant", [1], 0.15),
            ("a power of the tangent", [2], 0.15),
            ("a power of the secant, at another level", [1, 3], 0.15),
            ("a power of the tangent, at another level", [2, 3], 0.15),
        ),
        fitted=5,
        seen_in=("CO", "RF"),
        needs=_tensions,
        sentence="the stiffness of the cables changes with tension: {named}",
        separated_by="two preloads; a payload series",
        extension="nonlinearity",
    ),
    Cause(
        "creep",
        "cables creep",
        (Parameter("creep_per_decade", "1", 0.1, positive=True),),
        _creep,
        seen_in=("CO",),
        needs=_times,
        sentence="the cables creep by {value} of the elastic strain per decade of time",
        separated_by="a load held for 30 minutes",
    ),
)
