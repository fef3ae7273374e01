"""Every parameter that could be other than entered, as arrays any of which may carry a batch axis."""

from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.robot import parameters
from cdpr_struct.robot.extensions import masts_of
from cdpr_struct.robot.platform import is_inertia
from cdpr_struct.robot.robot import Robot

_CORE = {
    "platform_anchors": 2, "frame_anchors": 2, "axial_stiffness": 1, "linear_density": 1, "pulley_radius": 1,
    "pulley_axis": 2, "mass": 0, "center_of_mass": 1, "inertia": 2, "gravity": 0, "length_offset": 1,
    "length_scale": 1, "series_compliance": 1, "frame_compliance": 1, "joint_mass": 1, "cell_gain": 1,
    "cell_bias": 1, "friction": 1, "force": 1, "hose": 0, "tracker": 1, "tilt": 1, "bending_stiffness": 1,
    "added_mass": 1, "nonlinearity": 0, "creep": 0, "slip": 1, "internal": 1, "internal_force": 1,
    "pose_offset": 1, "masts": 2, "accelerometer_gain": 1, "sensor_mass": 0,
}  # fmt: skip

EXTENSIONS = tuple(name for name in parameters.EXTENSIONS if name in _CORE)
"""Fields that a robot file holds as extensions."""


@dataclass(frozen=True, slots=True, eq=False)
class World:
    """A robot with m cables, its sensors and its surroundings; leading axes (...) are the batch. SI units.

    platform_anchors, frame_anchors (..., m, 3); axial_stiffness, linear_density, pulley_radius (..., m);
    pulley_axis (..., m, 3); mass, gravity (...); center_of_mass (..., 3); inertia (..., 3, 3)
    length_offset, length_scale (..., m) : paid out = reading * scale + offset
    series_compliance (..., m) : of what is in line with a cable, joint or cable behind the pulley [m/N]
    frame_compliance (..., m) : of each cable's mast, alike in all directions [m/N]
    masts (m, m) : 1 where cables share a mast
    joint_mass (..., m) : at the platform anchors [kg]
    cell_gain, cell_bias (..., m) : reading = gain * tension + bias
    friction (..., m) : reading = tension * exp(friction * sign of the last motion * right angles at the exit)
    force (..., 3) : on the platform origin, world;  hose (...) : stiffness to the campaign's mean position [N/m]
    tracker (..., 6) : true pose = shifted and turned reading [m, rad];  tilt (..., 2) : of gravity [rad]
    bending_stiffness (..., m) [N m^2];  added_mass (..., m) : at mid-cable [kg]
    nonlinearity (...) : k in E = E0 (1 + k (T / T0 - 1)), T0 the campaign's mean tension
    creep (...) : strain per T / EA and decade of time after 1 min;  slip (..., m) : of the winch [m/h]
    internal (..., q) : commanded lengths along the null space, states without encoder [m]
    internal_force (..., q) : along the null space, the same in all those states [N a cable]
    pose_offset (..., S * 6) : of each state's pose reading [m, rad]
    accelerometer_gain (..., 6) : reading = gain * acceleration, along x, y, z and about them
    sensor_mass (...) : on the platform origin while vibration is measured, and only then [kg]
    """

    platform_anchors: np.ndarray
    frame_anchors: np.ndarray
    axial_stiffness: np.ndarray
    linear_density: np.ndarray
    pulley_radius: np.ndarray
    pulley_axis: np.ndarray
    mass: np.ndarray
    center_of_mass: np.ndarray
    inertia: np.ndarray
    gravity: np.ndarray
    length_offset: np.ndarray
    length_scale: np.ndarray
    series_compliance: np.ndarray
    frame_compliance: np.ndarray
    joint_mass: np.ndarray
    cell_gain: np.ndarray
    cell_bias: np.ndarray
    friction: np.ndarray
    force: np.ndarray
    hose: np.ndarray
    tracker: np.ndarray
    tilt: np.ndarray
    bending_stiffness: np.ndarray
    added_mass: np.ndarray
    nonlinearity: np.ndarray
    creep: np.ndarray
    slip: np.ndarray
    internal: np.ndarray
    internal_force: np.ndarray
    pose_offset: np.ndarray
    masts: np.ndarray
    accelerometer_gain: np.ndarray
    sensor_mass: np.ndarray

    @classmethod
    def of(cls, robot: Robot, states: int = 0) -> "World":
        """The robot as entered, with the extensions of its file; without any, sensors are perfect."""
        m, more = len(robot.cables), robot.extensions
        up = np.array([0.0, 0.0, 1.0])
        return cls(
            platform_anchors=robot.platform_anchors, frame_anchors=robot.frame_anchors,
            axial_stiffness=robot.axial_stiffness, linear_density=robot.linear_density,
            pulley_radius=np.array([0.0 if p is None else p.radius for p in robot.pulleys]),
            pulley_axis=np.array([up if p is None else p.axis for p in robot.pulleys]),
            mass=np.asarray(robot.platform.mass), center_of_mass=robot.platform.center_of_mass,
            inertia=robot.platform.inertia, gravity=np.asarray(robot.gravity),
            joint_mass=np.zeros(m), **{name: np.asarray(getattr(more, name)) for name in EXTENSIONS},
            internal=np.zeros(states * max(m - 6, 0)), internal_force=np.zeros(max(m - 6, 0)),
            pose_offset=np.zeros(states * 6), masts=masts_of(robot.frame_anchors),
        )  # fmt: skip

    @property
    def cables(self) -> int:
        """m."""
        return int(self.axial_stiffness.shape[-1])

    def plus(self, **changes: np.ndarray) -> "World":
        """World with changes added to the named fields; batch axes broadcast."""
        return replace(self, **{name: getattr(self, name) + change for name, change in changes.items()})

    def times(self, **factors: np.ndarray) -> "World":
        """World with the named fields multiplied; batch axes broadcast."""
        return replace(self, **{name: getattr(self, name) * factor for name, factor in factors.items()})

    def per_state(self) -> "World":
        """Batched fields with an axis for the states inserted before their own axes."""
        return replace(self, **{f.name: self._spread(f.name) for f in fields(self)})

    def _spread(self, name: str) -> np.ndarray:
        value: np.ndarray = getattr(self, name)
        batch = value.ndim - _CORE[name]
        return np.expand_dims(value, batch) if batch else value

    def take(self, index: int) -> "World":
        """One item of a batch with one axis."""
        picked = {f.name: getattr(self, f.name)[index] for f in fields(self) if self.is_batched(f.name)}
        return replace(self, **picked) if picked else self

    def bodies_exist(self) -> np.ndarray:
        """(...) whether there is a rigid body with this inertia."""
        return is_inertia(np.linalg.eigvalsh(self.inertia))

    def is_batched(self, name: str) -> bool:
        """Whether the named field carries a batch axis."""
        return bool(getattr(self, name).ndim > _CORE[name])
