"""What could be measured beside the robot's states: a weighing, a caliper, a thermometer.

Such a check reads parameters of the robot directly, so it bounds tolerances and sizes of causes alike; or it reads the
parameters of one cause, where the robot's do not keep causes apart.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from cdpr_struct.planning.information import Numbers
from cdpr_struct.residuals.linearised import Term
from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.robot.tolerances import Tolerances, tolerated
from cdpr_struct.statics.masts import of_each_mast

_STEP = 0.05  # of a prior sigma, of differences
_JOINTS_OFF = ("joint_mass",)
Reads = Callable[[RobotArrays], np.ndarray]


@dataclass(frozen=True, slots=True, eq=False)
class Check:
    """A direct reading.

    name  : what is read;  sigma : one sigma of each reading
    reads : (..., k) readings of a robot;  apart : causes that are not there while it is read
    cause : or the name of the cause whose parameters are read
    """

    name: str
    sigma: float
    reads: Reads | None = None
    apart: tuple[str, ...] = ()
    cause: str = ""

    def __post_init__(self) -> None:
        if not self.sigma > 0.0:
            raise ValueError(f"Check.sigma must be positive, got {self.sigma!r}")
        if (self.reads is None) == (not self.cause):
            raise ValueError(f"Check {self.name!r} needs either reads or cause")


def _flat(value: np.ndarray) -> np.ndarray:
    return value.reshape((*value.shape[:-2], -1))


def _weighed_cells(robot: RobotArrays) -> np.ndarray:
    """What the cells show under 100 N and 500 N."""
    light, heavy = (robot.cell_gain * weight + robot.cell_bias for weight in (100.0, 500.0))
    return np.concatenate(np.broadcast_arrays(light, heavy), axis=-1)


def _turning(robot: RobotArrays) -> np.ndarray:
    return np.log(np.diagonal(robot.inertia, axis1=-2, axis2=-1))


CHECKS = (
    Check("platform_mass", 0.1, lambda r: r.mass[..., None], _JOINTS_OFF),  # kg, a platform scale
    Check("joint_mass", 0.01, cause="joint_mass"),  # kg, a kitchen scale
    Check("sensor_mass", 0.05, lambda r: r.sensor_mass[..., None]),  # kg
    Check("linear_density", 0.005, lambda r: np.log(r.linear_density)),  # relative, weight of 5 m
    Check("axial_stiffness", 0.01, lambda r: np.log(r.axial_stiffness)),  # relative, tensile test of 2 m
    Check("center_of_mass", 2e-3, lambda r: r.center_of_mass, _JOINTS_OFF),  # m, on an edge
    Check("inertia", 0.02, _turning, _JOINTS_OFF),  # relative, bifilar pendulum
    Check("tilt", 5e-4, lambda r: r.tilt),  # rad, spirit level
    Check("platform_anchors", 2e-4, lambda r: _flat(r.platform_anchors)),  # m, caliper
    Check("frame_anchors", 5e-4, lambda r: _flat(r.frame_anchors)),  # m, laser tracker
    Check("load_cells", 1.0, _weighed_cells),  # N, two known weights
    Check("length_offset", 5e-4, lambda r: r.length_offset),  # m, homing again
    Check("tracker", 2e-4, lambda r: r.tracker),  # m, rad, common points
    Check("pulley_radius", 1e-4, lambda r: r.pulley_radius),  # m, caliper
    Check("hose", 1.0, lambda r: r.hose[..., None]),  # N/m, spring balance
    Check("force", 1.0, lambda r: r.force),  # N, spring balance
    Check("masts", 1e-7, lambda r: of_each_mast(r.masts, r.frame_compliance + r.mast_bending)),  # m/N, dial gauge
    Check("joint_compliance", 1e-7, cause="joint_compliance"),  # m/N, dial gauge
    Check("temperature", 1.0, cause="temperature"),  # K, thermometer
    Check("drum_scale", 2e-4, cause="drum_scale"),  # relative: 0.2 mm over a measured metre
)
"""The catalogue; sigmas are those of the tool that a laboratory has, in the unit of the reading."""


def check_rows(robot: RobotArrays, tolerances: Tolerances, numbers: Numbers, check: Check) -> np.ndarray:
    """(k, t + c) change of the readings of a check, in their sigmas, by each number."""
    start, whole = numbers.tolerances, numbers.tolerances + numbers.count
    if check.reads is None:
        if check.cause not in numbers.causes:
            return np.zeros((0, whole))
        sigma, own = numbers.sigma[check.cause], numbers.place[check.cause]
        found = np.zeros((len(sigma), whole))
        found[:, start + own.start : start + own.stop] = np.diag(sigma) / check.sigma
        return found
    reads, plain = check.reads, check.reads(robot)

    def slope(term: Term) -> np.ndarray:
        moved = reads(term.applied(robot, _STEP * np.eye(len(term.sigma))[:, None, :]))
        moved = moved[:, 0] if moved.ndim > plain.ndim else moved
        return np.broadcast_to((moved - plain) / (_STEP * check.sigma), (len(term.sigma), len(plain))).T

    found = np.zeros((len(plain), whole))
    found[:, :start] = slope(Term(lambda arrays, u: tolerated(arrays, tolerances, u), np.eye(start), np.ones(start)))
    for name, cause in numbers.causes.items():
        if name not in check.apart and cause.carrier != "state":
            own = numbers.place[name]
            found[:, start + own.start : start + own.stop] = slope(numbers.term(name))
    return found
