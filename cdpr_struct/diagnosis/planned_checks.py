"""What could be measured beside the robot's states: a weighing, a caliper, a thermometer.

Such a check reads parameters of the world directly, so it narrows tolerances and sizes of causes alike; or it reads the
parameters of one cause, where the world does not keep causes apart.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.diagnosis.world import World
from cdpr_struct.statics.masts import of_each_mast

Reads = Callable[[World], np.ndarray]


@dataclass(frozen=True, slots=True, eq=False)
class Check:
    """A direct reading.

    text  : what to do, with its accuracy
    sigma : one sigma of each reading
    reads : (..., k) readings of a world;  cause : or the name of the cause whose parameters are read
    """

    text: str
    sigma: float
    reads: Reads | None = None
    cause: str = ""

    def __post_init__(self) -> None:
        if not self.sigma > 0.0:
            raise ValueError(f"Check.sigma must be positive, got {self.sigma!r}")
        if (self.reads is None) == (not self.cause):
            raise ValueError(f"Check {self.text!r} needs either reads or cause")


def _flat(value: np.ndarray) -> np.ndarray:
    return value.reshape((*value.shape[:-2], -1))


def _weighed_cells(world: World) -> np.ndarray:
    """What the cells show under 100 N and 500 N."""
    light, heavy = (world.cell_gain * weight + world.cell_bias for weight in (100.0, 500.0))
    return np.concatenate(np.broadcast_arrays(light, heavy), axis=-1)


CHECKS = (
    Check("weigh the platform (+-0.1 kg)", 0.1, lambda w: w.mass[..., None]),
    Check("weigh the joints (+-0.01 kg)", 0.01, lambda w: w.joint_mass),
    Check("weigh sensors and shaker (+-0.05 kg)", 0.05, lambda w: w.sensor_mass[..., None]),
    Check("weigh 5 m of cable (+-0.5 %)", 0.005, lambda w: np.log(w.linear_density)),
    Check("tensile test of 2 m of cable (+-1 %)", 0.01, lambda w: np.log(w.axial_stiffness)),
    Check("balance the platform on an edge (+-2 mm)", 2e-3, lambda w: w.center_of_mass),
    Check(
        "swing the platform as a bifilar pendulum (+-2 %)",
        0.02,
        lambda w: np.log(np.diagonal(w.inertia, axis1=-2, axis2=-1)),
    ),
    Check("spirit level on the frame (+-0.5 mrad)", 5e-4, lambda w: w.tilt),
    Check("caliper on the platform anchors (+-0.2 mm)", 2e-4, lambda w: _flat(w.platform_anchors)),
    Check("laser tracker on the frame anchors (+-0.5 mm)", 5e-4, lambda w: _flat(w.frame_anchors)),
    Check("two known weights on each load cell (+-1 N)", 1.0, _weighed_cells),
    Check("homing all winches again (+-0.5 mm)", 5e-4, lambda w: w.length_offset),
    Check("common points on the frame (+-0.2 mm, mrad)", 2e-4, lambda w: w.tracker),
    Check("caliper on the pulleys (+-0.1 mm)", 1e-4, lambda w: w.pulley_radius),
    Check("spring balance on hoses and wires (+-1 N/m)", 1.0, lambda w: w.hose[..., None]),
    Check("spring balance on the free platform (+-1 N)", 1.0, lambda w: w.force),
    Check("dial gauge on every mast (+-0.1 um/N)", 1e-7, lambda w: of_each_mast(w.masts, w.frame_compliance)),
    Check("dial gauge across the joints (+-0.1 um/N)", 1e-7, cause="joint_compliance"),
    Check("thermometer (+-1 K)", 1.0, cause="temperature"),
    Check("encoder count over a measured metre (+-0.2 mm)", 2e-4, cause="drum_scale"),
)
