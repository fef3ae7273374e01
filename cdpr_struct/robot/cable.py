"""What a cable is made of, and the pulley it may run over."""

from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.robot.arrays import frozen_array, require_positive


@dataclass(frozen=True, slots=True)
class Cable:
    """Uniform elastic cable.

    axial_stiffness : EA [N]
    linear_density  : mu [kg/m], per unstrained length
    damping_ratio   : xi [-], viscous, referred to the cable's first natural frequency
    """

    axial_stiffness: float
    linear_density: float
    damping_ratio: float = 0.0

    def __post_init__(self) -> None:
        require_positive(self, "axial_stiffness", "linear_density")
        if not 0.0 <= self.damping_ratio < 1.0:
            raise ValueError(f"Cable.damping_ratio must be in [0, 1), got {self.damping_ratio!r}")


@dataclass(frozen=True, slots=True, eq=False)
class Pulley:
    """Swivelling pulley at the frame end of a cable.

    radius : R [m]
    axis   : (3,) swivel axis, world frame; normalised at birth. It passes through the frame anchor, where the
             cable enters the pulley along it.
    """

    radius: float
    axis: np.ndarray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))

    def __post_init__(self) -> None:
        require_positive(self, "radius")
        axis = frozen_array(self.axis, (3,), "Pulley.axis")
        norm = float(np.linalg.norm(axis))
        if norm == 0.0:
            raise ValueError("Pulley.axis must not be the zero vector")
        object.__setattr__(self, "axis", frozen_array(axis / norm, (3,), "Pulley.axis"))
