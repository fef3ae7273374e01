"""The tables [tolerances] of robot files and campaigns, and [posterior] of robots that a diagnosis extended."""

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from cdpr_struct.errors import InputError
from cdpr_struct.robot.tolerances import Spread, change_count

_Size = Annotated[float, Field(strict=True, ge=0.0, le=1e12)] | None


class TolerancesTable(BaseModel):
    """One sigma of each, as `Tolerances` says; None where the file says nothing."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    anchor_m: _Size = None
    length_m: _Size = None
    axial_stiffness: _Size = None
    linear_density: _Size = None
    platform_mass_kg: _Size = None
    center_of_mass_m: _Size = None
    platform_inertia: _Size = None
    load_cell_gain: _Size = None
    load_cell_bias_N: _Size = None
    damping: _Size = None
    pulley_radius_m: _Size = None
    swivel_deg: _Size = None

    def stated(self) -> dict[str, float]:
        """Those that the file gives."""
        return {name: value for name, value in self.model_dump().items() if value is not None}


_Number = Annotated[float, Field(strict=True, ge=-1e12, le=1e12)]


class PosteriorTable(BaseModel):
    """Mean and root of the covariance of changes, in the order of `VARIED`."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    mean: list[_Number]
    root: list[list[_Number]]

    def spread(self, cables: int, source: str) -> Spread:
        """As arrays, of a robot with so many cables.

        Raises
        ------
        InputError : rows or numbers that are too many or too few; the file is called `source`.
        """
        count = change_count(cables)
        if len(self.mean) != count:
            raise InputError(source, "posterior.mean", f"{len(self.mean)} numbers", f"{count} for {cables} cables")
        lengths = {len(row) for row in self.root}
        if len(self.root) != count or len(lengths) != 1:
            given = f"{len(self.root)} rows of {' or '.join(map(str, sorted(lengths)))} numbers"
            raise InputError(source, "posterior.root", given, f"{count} rows of equal length")
        return Spread(np.array(self.root).reshape(count, -1), np.array(self.mean))
