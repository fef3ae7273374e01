"""The robot as arrays, any of which may carry batch axes: what batched statics computes with."""

from dataclasses import dataclass, fields, replace

import numpy as np

from cdpr_struct.robot.robot import Robot


@dataclass(frozen=True, slots=True, eq=False)
class RobotArrays:
    """Robot with m cables; leading axes (...) of any field are batch axes, for parameter studies and Monte Carlo.

    platform_anchors, frame_anchors : (..., m, 3) platform frame, world frame [m]
    axial_stiffness : (..., m) EA [N]
    weight          : (..., m) w = mu g [N/m]
    pulley_radius   : (..., m) [m], 0 where the cable starts at a fixed point
    pulley_axis     : (..., m, 3) unit, world; the cable passes the frame anchor travelling along +axis
    mass            : (...) [kg]
    center_of_mass  : (..., 3) platform frame [m]
    gravity         : (...) g [m/s^2]
    """

    platform_anchors: np.ndarray
    frame_anchors: np.ndarray
    axial_stiffness: np.ndarray
    weight: np.ndarray
    pulley_radius: np.ndarray
    pulley_axis: np.ndarray
    mass: np.ndarray
    center_of_mass: np.ndarray
    gravity: np.ndarray

    @classmethod
    def of(cls, robot: "Robot | RobotArrays", mass: np.ndarray | float | None = None) -> "RobotArrays":
        """Arrays of a robot; `mass` (...) [kg] replaces the platform's."""
        if isinstance(robot, RobotArrays):
            return robot if mass is None else replace(robot, mass=np.asarray(mass, dtype=float))
        vertical = np.array([0.0, 0.0, 1.0])
        return cls(
            platform_anchors=robot.platform_anchors,
            frame_anchors=robot.frame_anchors,
            axial_stiffness=robot.axial_stiffness,
            weight=robot.weight_per_length,
            pulley_radius=np.array([0.0 if p is None else p.radius for p in robot.pulleys]),
            pulley_axis=np.array([vertical if p is None else p.axis for p in robot.pulleys]),
            mass=np.asarray(robot.platform.mass if mass is None else mass, dtype=float),
            center_of_mass=robot.platform.center_of_mass,
            gravity=np.asarray(robot.gravity, dtype=float),
        )

    @property
    def cable_count(self) -> int:
        """m."""
        return int(self.platform_anchors.shape[-2])

    @property
    def has_pulleys(self) -> bool:
        """Whether any cable runs over a pulley."""
        return bool((self.pulley_radius > 0.0).any())

    @property
    def batch_shape(self) -> tuple[int, ...]:
        """Broadcast batch axes of all fields."""
        return np.broadcast_shapes(*(_batch(self, f.name) for f in fields(self)))

    def flattened(self, shape: tuple[int, ...]) -> "RobotArrays":
        """The batch axes broadcast to `shape` and flattened to one; fields without batch axes keep none."""
        return replace(self, **{f.name: self._flat(f.name, shape) for f in fields(self)})

    def take(self, index: np.ndarray) -> "RobotArrays":
        """Items of a flattened batch."""
        batched = {f.name: getattr(self, f.name)[index] for f in fields(self) if _batch(self, f.name)}
        return replace(self, **batched) if batched else self

    def _flat(self, name: str, shape: tuple[int, ...]) -> np.ndarray:
        value: np.ndarray = getattr(self, name)
        batch = _batch(self, name)
        if not batch:
            return value
        core = value.shape[len(batch) :]
        return np.broadcast_to(value, shape + core).reshape((-1, *core))


_CORE_AXES = {
    "platform_anchors": 2,
    "frame_anchors": 2,
    "axial_stiffness": 1,
    "weight": 1,
    "pulley_radius": 1,
    "pulley_axis": 2,
    "mass": 0,
    "center_of_mass": 1,
    "gravity": 0,
}


def _batch(arrays: RobotArrays, name: str) -> tuple[int, ...]:
    shape: tuple[int, ...] = getattr(arrays, name).shape
    return shape[: len(shape) - _CORE_AXES[name]]
