"""The tables [tolerances] of robot files and campaigns, [posterior] and [remainder] of robots that a diagnosis left."""

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from cdpr_struct.errors import InputError
from cdpr_struct.robot.tolerances import FINDABLE, VARIED, Spread, Varied, change_count

_Rms = Annotated[float, Field(strict=True, ge=0.0, le=1e12)]
_Size = _Rms | None


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


class RemainderTable(BaseModel):
    """Rms of errors that a robot has anew at every rest, as `Remainder` says."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    force_N: tuple[_Rms, _Rms, _Rms] = (0.0, 0.0, 0.0)
    moment_Nm: tuple[_Rms, _Rms, _Rms] = (0.0, 0.0, 0.0)
    length_m: _Rms = 0.0
    common_length_m: _Rms = 0.0
    frequency: _Rms = 0.0


class PosteriorTable(BaseModel):
    """Mean and root of the covariance of changes, in the order of `VARIED` and of fields that were found to be off."""

    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)

    found: list[str] = []
    mean: list[_Number]
    root: list[list[_Number]]

    def spread(self, cables: int, source: str) -> Spread:
        """As arrays, of a robot with so many cables.

        Raises
        ------
        InputError : fields that no robot has, rows or numbers that are too many or too few; the file is called
            `source`.
        """
        for name in self.found:
            if name not in FINDABLE or self.found.count(name) > 1:
                raise InputError(source, "posterior.found", name, f"each once, and one of: {', '.join(FINDABLE)}")
        found = tuple(Varied.found(name) for name in self.found)
        count = change_count(cables, (*VARIED, *found))
        if len(self.mean) != count:
            raise InputError(source, "posterior.mean", f"{len(self.mean)} numbers", f"{count} for {cables} cables")
        lengths = {len(row) for row in self.root}
        if len(self.root) != count or len(lengths) != 1:
            given = f"{len(self.root)} rows of {' or '.join(map(str, sorted(lengths)))} numbers"
            raise InputError(source, "posterior.root", given, f"{count} rows of equal length")
        return Spread(np.array(self.root).reshape(count, -1), np.array(self.mean), found)
