"""Point masses that hang on cables: read from a robot file, checked, written."""

from dataclasses import dataclass
from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from cdpr_struct.robot.extensions import Extensions

_LARGEST = 1e12  # of any number, as elsewhere in a robot file
_Positive = Annotated[float, Field(strict=True, gt=0.0, le=_LARGEST)]


@dataclass(frozen=True, slots=True)
class Lump:
    """A point mass clamped to a cable.

    cable : number of the cable, from 1
    from_platform : unstrained length between the platform anchor and the mass [m]
    mass : [kg]
    """

    cable: int
    from_platform: float
    mass: float

    def __post_init__(self) -> None:
        for name in ("from_platform", "mass"):
            if not 0.0 < getattr(self, name) <= _LARGEST:
                raise ValueError(f"Lump.{name} must be positive and finite, got {getattr(self, name)!r}")


class LumpTable(BaseModel):
    """An entry of `[[lumps]]`."""

    model_config = ConfigDict(extra="forbid", strict=False, allow_inf_nan=False)

    cable: Annotated[int, Field(strict=True, ge=1)]
    from_platform: _Positive
    mass: _Positive

    @property
    def lump(self) -> Lump:
        """The entry as a value."""
        return Lump(self.cable, self.from_platform, self.mass)


def lump_lines(lump: Lump) -> list[str]:
    """Lines of an entry."""
    return [
        "[[lumps]]",
        f"cable = {lump.cable}",
        f"from_platform = {float(lump.from_platform)!r}",
        f"mass = {float(lump.mass)!r}",
    ]


def lump_arrays(lumps: tuple[Lump, ...], cables: int) -> dict[str, np.ndarray]:
    """`lump_place` [m] and `lump_mass` [kg] (m, k) of RobotArrays: each cable's own from the platform on, k as many as
    the cable with most has, at least one; the others have masses of zero at the platform."""
    own = [sorted((lump.from_platform, lump.mass) for lump in lumps if lump.cable == i + 1) for i in range(cables)]
    most = max(1, *(len(each) for each in own))
    padded = np.array([[(0.0, 0.0)] * (most - len(each)) + each for each in own])
    return {"lump_place": padded[..., 0], "lump_mass": padded[..., 1]}


def lumps_fault(lumps: tuple[Lump, ...], cables: int, more: Extensions, gravity: float) -> str:
    """What is wrong with the lumps of a robot, "" if nothing."""
    for lump in lumps:
        if not 1 <= lump.cable <= cables:
            return f"there is no cable {lump.cable}: cables are numbered from 1 to {cables}"
    places = {(lump.cable, lump.from_platform) for lump in lumps}
    if len(places) < len(lumps):
        return "two lumps sit at one place: give one with the mass of both"
    if lumps and (more.bending_stiffness.any() or more.added_mass.any()):
        return "lumps do not go with extensions.bending_stiffness and added_mass: give a lump for an added_mass"
    if lumps and more.drag_width.any():
        return "lumps do not go with extensions.drag_width: a lump leaves the plane in which wind holds its cable"
    return "" if gravity > 0.0 or not lumps else "lumps need gravity above 0: without it their cables have no shape"
