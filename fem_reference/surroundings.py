"""What a robot stands and leans on: masts that bend, a tether on the platform, gravity that is not the cables'."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from fem_reference.arrays import fixed_array


@dataclass(frozen=True, eq=False)
class SurroundingsData:
    """By default everything stands still.

    masts            : for each mast, the numbers (from 0) of the cables it carries
    mast_compliance  : [m/N], one of each mast, the same in all directions, or one of all; a mast has no mass
    tether_stiffness : [N/m] of a spring on the platform's reference point, relaxed at tether_point (3,) [m], world
    platform_gravity : (3,) [m/s^2], world, that acts on the platform; None for that of the cables
    """

    masts: tuple[tuple[int, ...], ...] = ()
    mast_compliance: float | tuple[float, ...] = 0.0
    tether_stiffness: float = 0.0
    tether_point: np.ndarray = field(default_factory=lambda: np.zeros(3))
    platform_gravity: np.ndarray | None = None

    def __post_init__(self) -> None:
        if np.shape(self.mast_compliance) not in ((), (len(self.masts),)):
            raise ValueError(f"SurroundingsData.mast_compliance: {len(self.masts)} masts, got {self.mast_compliance!r}")
        for name in ("mast_compliance", "tether_stiffness"):
            if not all(0.0 <= value < np.inf for value in np.ravel(getattr(self, name))):
                raise ValueError(f"SurroundingsData.{name} must be zero or more, got {getattr(self, name)!r}")
        carried = [cable for mast in self.masts for cable in mast]
        if len(set(carried)) != len(carried):
            raise ValueError(f"SurroundingsData.masts must name no cable twice, got {self.masts!r}")
        object.__setattr__(self, "tether_point", fixed_array("tether_point", self.tether_point, (3,)))
        if self.platform_gravity is not None:
            gravity = fixed_array("platform_gravity", self.platform_gravity, (3,))
            object.__setattr__(self, "platform_gravity", gravity)

    @property
    def bending(self) -> tuple[tuple[int, ...], ...]:
        """Cables of the masts that give way."""
        return tuple(mast for mast, give in zip(self.masts, self._compliances, strict=True) if give > 0.0)

    @property
    def bending_compliance(self) -> tuple[float, ...]:
        """[m/N] of the masts that give way."""
        return tuple(give for give in self._compliances if give > 0.0)

    @property
    def _compliances(self) -> tuple[float, ...]:
        return tuple(np.broadcast_to(self.mast_compliance, (len(self.masts),)).tolist())

    @property
    def still(self) -> bool:
        """Whether nothing is elastic around the robot, and gravity is one."""
        return not self.bending and self.tether_stiffness == 0.0 and self.platform_gravity is None
