"""What accelerometers do: their mass to the vibration, their gain to its size."""

import numpy as np

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter
from cdpr_struct.diagnosis.modal_constants import DIRECTIONS
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World

ACCELEROMETERS = ("frf", "free_decay")
"""Kinds of data that somebody measured with an accelerometer; a list of peaks does not say with what."""
_GAIN = 0.05  # of the logarithm


def _mass(world: World, theta: np.ndarray) -> World:
    return world.plus(sensor_mass=theta[..., 0])


def _gain(world: World, theta: np.ndarray) -> World:
    """One gain of all directions, then one of each."""
    return world.times(accelerometer_gain=np.exp(theta[..., :1] + theta[..., 1:]))


def _moving_and_at_rest(setting: Setting) -> str:
    campaign = setting.campaign
    used = {i.record.kind for i in campaign.identified if i.used.any()}
    if not used & set(ACCELEROMETERS) or not campaign.robot_frequencies.hertz.size:
        return "needs robot frequencies from FRFs or free decays"
    at_rest = (campaign.states.static | campaign.states.loaded).any()
    return "" if at_rest else "needs static states or loaded poses, which the sensor's mass leaves alone"


def _constants(setting: Setting) -> str:
    return "" if len(setting.constants) else "needs FRFs of the platform, along its axes, with well separated modes"


CAUSES = (
    Cause(
        "accelerometer_gain",
        "gain of the accelerometers, or of the force cell of the excitation",
        tuple(Parameter(name, "ratio", _GAIN, True) for name in ("gain", *(f"gain_{d}" for d in DIRECTIONS))),
        _gain,
        seen_in=("FA",),
        sentence="the accelerometers read {percent} of the acceleration",
        needs=_constants,
        separated_by="a shaker of known acceleration; weighing the platform",
        extension="accelerometer_gain",
        shapes=(
            ("all alike", slice(0, 1), 0.5),
            ("each its own", slice(1, None), 0.2),
            *((f"{d} alone", slice(i, i + 1), 0.05) for i, d in enumerate(DIRECTIONS, start=1)),
        ),
    ),
    Cause(
        "accelerometer_mass",
        "mass of accelerometers that are on the platform only while vibration is measured",
        (Parameter("sensor_mass", "kg", 0.3, positive=True),),
        _mass,
        seen_in=("RF", "FA"),
        sentence="accelerometers add {value} kg to the platform while vibration is measured",
        needs=_moving_and_at_rest,
        separated_by="weighing the accelerometers; frequencies with a second sensor of the same mass",
        extension="sensor_mass",
    ),
)
