"""A simple body that cables must keep away from: a box, a cylinder or a sphere on the platform or on the frame."""

from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.robot.arrays import frozen_array

SHAPES = ("box", "cylinder", "sphere")
CARRIERS = ("platform", "frame")


@dataclass(frozen=True, slots=True, eq=False)
class Body:
    """A convex body, fixed to the platform or the frame.

    name     : what messages call it
    fixed_to : "platform" or "frame"
    shape    : "box" (edges along its own axes), "cylinder" (axis along its own z) or "sphere"
    size     : (3,) [m] edges of a box; of the others diameter, diameter, length (of a sphere its diameter)
    center   : (3,) [m], platform or world frame;  rotation : (3, 3) from its own axes to that frame
    """

    name: str
    fixed_to: str
    shape: str
    size: np.ndarray
    center: np.ndarray
    rotation: np.ndarray = field(default_factory=lambda: np.eye(3))

    def __post_init__(self) -> None:
        for name, known in (("fixed_to", CARRIERS), ("shape", SHAPES)):
            if getattr(self, name) not in known:
                raise ValueError(f"Body.{name} must be one of {', '.join(known)}, got {getattr(self, name)!r}")
        for name, shape in (("size", (3,)), ("center", (3,)), ("rotation", (3, 3))):
            object.__setattr__(self, name, frozen_array(getattr(self, name), shape, f"Body.{name}"))
        if not (self.size > 0.0).all():
            raise ValueError(f"Body.size must be positive, got {self.size.tolist()}")

    def distance(self, point: np.ndarray) -> np.ndarray:
        """(...) [m] from points (..., 3), in the frame that carries the body; 0 inside."""
        own = (point - self.center) @ self.rotation
        half = 0.5 * self.size
        if self.shape == "sphere":
            return np.asarray(np.maximum(np.linalg.norm(own, axis=-1) - half[0], 0.0))
        if self.shape == "box":
            beyond = np.maximum(np.abs(own) - half, 0.0)
            return np.asarray(np.linalg.norm(beyond, axis=-1))
        around = np.maximum(np.hypot(own[..., 0], own[..., 1]) - half[0], 0.0)
        return np.asarray(np.hypot(around, np.maximum(np.abs(own[..., 2]) - half[2], 0.0)))
