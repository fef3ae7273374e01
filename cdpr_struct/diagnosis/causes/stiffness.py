"""What gives way more than entered."""

import numpy as np

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World
from cdpr_struct.robot.extensions import masts_of
from cdpr_struct.statics.masts import carriers


def _axial(world: World, theta: np.ndarray) -> World:
    return world.times(axial_stiffness=np.exp(theta))


def _joint(world: World, theta: np.ndarray) -> World:
    return world.plus(series_compliance=theta)


def _dead(world: World, theta: np.ndarray) -> World:
    return world.plus(series_compliance=theta / world.axial_stiffness)


def _frame(world: World, theta: np.ndarray) -> World:
    return world.plus(frame_compliance=theta @ carriers(world.masts).T)


def _nonlinear(world: World, theta: np.ndarray) -> World:
    return world.plus(nonlinearity=theta[..., 0])


def _creep(world: World, theta: np.ndarray) -> World:
    return world.plus(creep=theta[..., 0])


def _masts(setting: Setting) -> dict[str, str]:
    """Names of the masts, by the cables that they carry."""
    carried = carriers(masts_of(setting.campaign.robot.frame_anchors))
    cables = [[str(i + 1) for i in np.flatnonzero(column)] for column in carried.T]
    return {"_".join(["mast_of", *own]): f"mast of cable{'s' * (len(own) > 1)} {', '.join(own)}" for own in cables}


def _times(setting: Setting) -> str:
    hours = setting.known.hours
    return "" if np.ptp(hours) > 0.05 else "needs time_s over some minutes"


CAUSES = (
    Cause(
        "axial_stiffness",
        "axial stiffness EA of the cables",
        (Parameter("axial_stiffness", "ratio", 0.15, True),),
        _axial,
        True,
        seen_in=("CO", "LP", "RF"),
        sentence="the cables' axial stiffness is {percent} of what was entered",
        separated_by="poses at other heights: EA acts in proportion to the free length; a tensile test of 2 m of cable",
        extension="axial_stiffness",
    ),
    Cause(
        "joint_compliance",
        "joints, load cells or winches in line with the cables give way",
        (Parameter("compliance", "m/N", 4e-6, positive=True),),
        _joint,
        True,
        seen_in=("CO", "LP", "RF"),
        sentence="each cable has an elastic element in line with it, {value} m/N",
        separated_by="a dial gauge across the joint; clamping the cable at the pulley",
        extension="series_compliance",
    ),
    Cause(
        "dead_length",
        "elastic cable between pulley and winch",
        (Parameter("dead_length", "m", 3.0, positive=True),),
        _dead,
        True,
        seen_in=("CO", "LP", "RF"),
        sentence="{value} m of elastic cable lie between pulley and winch",
        separated_by="clamping the cable at the pulley; an amplitude sweep",
        extension="series_compliance",
    ),
    Cause(
        "frame_compliance",
        "the masts bend",
        (Parameter("compliance", "m/N", 2e-6, positive=True),),
        _frame,
        True,
        groups=_masts,
        carrier="mast, named by its cables as in `compliance_mast_of_1_2`",
        seen_in=("CO", "LP", "RF"),
        sentence="the masts give way by {value} m/N",
        separated_by="a dial gauge on a mast; pulling one cable and watching its neighbour",
        extension="frame_compliance",
    ),
    Cause(
        "nonlinear_elasticity",
        "cables stiffen with tension",
        (Parameter("k", "1", 0.15),),
        _nonlinear,
        seen_in=("CO", "LP", "RF"),
        sentence="the cables' stiffness changes with tension, k = {value}",
        separated_by="two preloads; a payload series",
        extension="nonlinearity",
    ),
    Cause(
        "creep",
        "cables creep",
        (Parameter("creep_per_decade", "1", 0.1, positive=True),),
        _creep,
        seen_in=("CO", "LP"),
        needs=_times,
        sentence="the cables creep, {value} of the elastic strain per decade of time",
        separated_by="a load held for 30 minutes",
    ),
)
