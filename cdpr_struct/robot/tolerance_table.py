"""The table [tolerances] of robot files and campaigns."""

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

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

    def stated(self) -> dict[str, float]:
        """Those that the file gives."""
        return {name: value for name, value in self.model_dump().items() if value is not None}
