"""What a cable is made of, and the pulley it may run over."""

import math
from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.robot.arrays import frozen_array, require_positive

STEEL = 1.2e-5  # [1/K]
LARGEST_EXPANSION = 1e-3  # [1/K], far beyond that of any rope: a cable keeps a length at all temperatures


@dataclass(frozen=True, slots=True)
class Cable:
    """Uniform elastic cable.

    axial_stiffness : EA [N]
    linear_density  : mu [kg/m], per unstrained length
    damping_ratio   : xi [-], viscous, referred to the cable's first natural frequency
    force_min, force_max : smallest and largest tension at the platform that the robot may ask for [N]; inf for no
                           upper limit
    thermal_expansion : alpha [1/K] of its unstrained length, negative for fibres that shrink; default: steel
    winch_tension : tension at the frame anchor [N] that the winch holds, whatever length that takes; 0 where it holds
                    the length
    winch : name of the winch that winds this cable together with others of the same name; "": its own
    winch_ratio : length of this cable per what that winch winds of a cable of ratio 1; negative if it winds against
        the others
    home_length : unstrained length [m] when that winch is at home; 0: what holds the robot's home pose
    """

    axial_stiffness: float
    linear_density: float
    damping_ratio: float = 0.0
    force_min: float = 0.0
    force_max: float = math.inf
    thermal_expansion: float = STEEL
    winch_tension: float = 0.0
    winch: str = ""
    winch_ratio: float = 1.0
    home_length: float = 0.0

    def __post_init__(self) -> None:
        require_positive(self, "axial_stiffness", "linear_density")
        if not 0.0 <= self.damping_ratio < 1.0:
            raise ValueError(f"Cable.damping_ratio must be in [0, 1), got {self.damping_ratio!r}")
        if not abs(self.thermal_expansion) <= LARGEST_EXPANSION:
            expected = f"from -{LARGEST_EXPANSION:g} to {LARGEST_EXPANSION:g} 1/K"
            raise ValueError(f"Cable.thermal_expansion must be {expected}, got {self.thermal_expansion!r}")
        if not 0.0 <= self.winch_tension < math.inf:
            raise ValueError(f"Cable.winch_tension must be finite and >= 0 N, got {self.winch_tension!r}")
        if not 1e-3 <= abs(self.winch_ratio) <= 1e3:
            raise ValueError(f"Cable.winch_ratio must be from 0.001 to 1000 in size, got {self.winch_ratio!r}")
        if not 0.0 <= self.home_length < math.inf:
            raise ValueError(f"Cable.home_length must be finite and >= 0 m, got {self.home_length!r}")
        if not 0.0 <= self.force_min < math.inf:
            raise ValueError(f"Cable.force_min must be finite and >= 0 N, got {self.force_min!r}")
        if not self.force_max > self.force_min:
            raise ValueError(
                f"Cable.force_max must be above force_min = {self.force_min:g} N, got {float(self.force_max)!r}"
            )


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
