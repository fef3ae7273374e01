"""What a robot stands and leans on: masts that bend, a tether on the platform, gravity that is not the cables'."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.masts import Mast, rigid, with_bracket, with_upright


@dataclass(frozen=True, eq=False)
class SurroundingsData:
    """By default everything stands still.

    masts            : for each mast, the numbers (from 0) of the cables it carries
    mast_compliance  : [m/N], one of each mast, the same in all directions, or one of all
    mast_bending     : [m/N], of each mast or of all, as an upright that bends sideways, at its highest exit
    mast_foot        : [m], height z at which uprights are clamped
    exit_mass        : [kg], of each cable, a point mass at its exit that moves with the mast; () for none. No weight
    tether_stiffness : [N/m] of a spring on the platform's reference point, relaxed at tether_point (3,) [m], world
    platform_gravity : (3,) [m/s^2], world, that acts on the platform; None for that of the cables
    beams            : further parts of the frame that bend, each with its own motion and flexibility; they carry other
                       cables than `masts`
    """

    masts: tuple[tuple[int, ...], ...] = ()
    mast_compliance: float | tuple[float, ...] = 0.0
    mast_bending: float | tuple[float, ...] = 0.0
    mast_foot: float = 0.0
    exit_mass: tuple[float, ...] = ()
    tether_stiffness: float = 0.0
    tether_point: np.ndarray = field(default_factory=lambda: np.zeros(3))
    platform_gravity: np.ndarray | None = None
    beams: tuple[Mast, ...] = ()

    def __post_init__(self) -> None:
        for name in ("mast_compliance", "mast_bending"):
            if np.shape(getattr(self, name)) not in ((), (len(self.masts),)):
                raise ValueError(f"SurroundingsData.{name}: {len(self.masts)} masts, got {getattr(self, name)!r}")
        for name in ("mast_compliance", "mast_bending", "exit_mass", "tether_stiffness"):
            if not all(0.0 <= value < np.inf for value in np.ravel(getattr(self, name))):
                raise ValueError(f"SurroundingsData.{name} must be zero or more, got {getattr(self, name)!r}")
        carried = [cable for mast in (*self.masts, *(beam.cables for beam in self.beams)) for cable in mast]
        if len(set(carried)) != len(carried):
            raise ValueError(f"SurroundingsData.masts and beams must name no cable twice, got {carried!r}")
        object.__setattr__(self, "tether_point", fixed_array("tether_point", self.tether_point, (3,)))
        if self.platform_gravity is not None:
            gravity = fixed_array("platform_gravity", self.platform_gravity, (3,))
            object.__setattr__(self, "platform_gravity", gravity)

    @property
    def bending(self) -> bool:
        """Whether any mast or beam gives way."""
        return bool(np.any(self.mast_compliance)) or bool(np.any(self.mast_bending)) or bool(self.beams)

    def soft_masts(self, frame_anchors: np.ndarray) -> tuple[Mast, ...]:
        """The masts and beams that give way, of a robot with exits at frame_anchors (m, 3) [m]."""
        heads = np.array(self.exit_mass) if self.exit_mass else np.zeros(len(frame_anchors))
        gives = (np.broadcast_to(v, (len(self.masts),)).tolist() for v in (self.mast_compliance, self.mast_bending))
        found = []
        for cables, bracket, upright in zip(self.masts, *gives, strict=True):
            mast, heights = rigid(cables, heads[list(cables)]), frame_anchors[list(cables), 2] - self.mast_foot
            mast = with_bracket(mast, bracket) if bracket > 0.0 else mast
            mast = with_upright(mast, upright, heights) if upright > 0.0 else mast
            found += [mast] if mast.flexibility.size else []
        return (*found, *self.beams)

    @property
    def still(self) -> bool:
        """Whether nothing is elastic around the robot, and gravity is one."""
        return not self.bending and self.tether_stiffness == 0.0 and self.platform_gravity is None
