"""What a cable is besides stiff."""

from dataclasses import replace

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Cause, Parameter, Seen, by_carrier
from cdpr_struct.robot.added_masses import PLACES
from cdpr_struct.robot.changed_arrays import times
from cdpr_struct.robot.robot_arrays import RobotArrays


def _density(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    return times(arrays, linear_density=np.exp(theta))


def _bending(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """The root of EI with clamped ends, which raise frequencies with it, and EI with pinned ones; ends between have
    both."""
    root, pinned = np.moveaxis(by_carrier(theta, 2), -1, 0)
    own = np.stack([root * np.abs(root), pinned], axis=-1)
    whole, clamped = arrays.bending_stiffness + own.sum(axis=-1), own[..., 0]
    held = arrays.bending_fixity * arrays.bending_stiffness + clamped
    fixity = np.where(whole > 0.0, held / np.where(whole > 0.0, whole, 1.0), arrays.bending_fixity)
    return replace(arrays, bending_stiffness=whole, bending_fixity=np.clip(fixity, 0.0, 1.0))


def _added(arrays: RobotArrays, theta: np.ndarray) -> RobotArrays:
    """Masses near each of `PLACES`, and how far from it; those that are there already count in the place."""
    own = by_carrier(theta, 2 * len(PLACES))
    mass, place = own[..., : len(PLACES)], PLACES + own[..., len(PLACES) :]
    whole = arrays.added_mass + mass.sum(axis=-1)
    moment = arrays.added_mass * arrays.added_mass_place + (mass * place).sum(axis=-1)
    found = np.where(whole != 0.0, moment / np.where(whole != 0.0, whole, 1.0), arrays.added_mass_place)
    return replace(arrays, added_mass=whole, added_mass_place=np.clip(found, 0.0, 1.0))


_NAMES = [*(f"_at_{place:g}" for place in PLACES[:-1]), ""]
"""Of parameters: those of mid-cable, the last, have the plain name."""


def _several_modes(seen: Seen) -> str:
    return "" if seen.cable_modes >= 2 else "needs two or more modes of the same cable"


CAUSES = (
    Cause(
        "cable_linear_density",
        "linear density of the cables",
        (Parameter("linear_density", "ratio", 0.08, True),),
        _density,
        carrier="cable",
        seen_in=("EQ", "CO", "CF", "RF"),
        sentence="the linear density of the cables is {percent} of the entered value",
        separated_by="weighing 5 m of cable",
        extension="linear_density",
    ),
    Cause(
        "bending_stiffness",
        "bending stiffness of the cables",
        (
            Parameter("bending_stiffness", "N m^2", 0.3, squared=True, positive=True),
            Parameter("bending_stiffness_pinned", "N m^2", 0.3, positive=True),
        ),
        _bending,
        carrier="cable",
        laws=(("clamped ends", [0], 0.5), ("pinned ends", [1], 0.35), ("ends between", [0, 1], 0.15)),
        seen_in=("CF",),
        sentence="the bending stiffness of the cables is {value} N m^2",
        needs=_several_modes,
        separated_by="four or more modes of a short cable",
        extension="bending_stiffness",
    ),
    Cause(
        "cable_added_mass",
        "a sensor or marker on the cables",
        (
            *(Parameter(f"added_mass{place}", "kg", 0.02, positive=True) for place in _NAMES),
            *(Parameter(f"added_mass_beyond{place}", "1", 0.04) for place in _NAMES),
        ),
        _added,
        carrier="cable",
        laws=tuple(
            (f"near {place:g} of the length", [k, k + len(PLACES)], 1.0 / len(PLACES))
            for k, place in enumerate(PLACES.tolist())
        ),
        seen_in=("CF",),
        sentence="masses of {value} kg are attached to the cables",
        needs=_several_modes,
        separated_by="moving or removing the sensor",
        extension="added_mass",
    ),
)
