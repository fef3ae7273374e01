"""What accelerometers do to the size of a vibration."""

import numpy as np

from cdpr_struct.diagnosis.causes.cause import Cause, Parameter
from cdpr_struct.diagnosis.modal_constants import DIRECTIONS
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.diagnosis.world import World

_GAIN = 0.05  # of the logarithm


def _gain(world: World, theta: np.ndarray) -> World:
    """One gain of all directions, then one of each."""
    return world.times(accelerometer_gain=np.exp(theta[..., :1] + theta[..., 1:]))


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
)
