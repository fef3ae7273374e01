"""Fig. 2.4: profiles of the example cable of section 2.3 under three end forces."""

from itertools import pairwise

import numpy as np

from cdpr_struct.generated import catenary
from cdpr_struct.thesis import cable_tables
from cdpr_struct.thesis.reproduction import Reproduction, Statement, printed_table

_POINTS = 101


def fig_2_4() -> Reproduction:
    """Cable and chord; the end points are the first column of Table 2.2."""
    forces = [float(row["fCx_N"]) for row in printed_table("table_2_2")]
    share = np.linspace(0.0, 1.0, _POINTS)
    curves = [profile(force, share * cable_tables.LENGTH) for force in forces]
    columns = {
        "force_N": np.repeat(forces, _POINTS),
        "arc_m": np.tile(share * cable_tables.LENGTH, len(forces)),
        "x_m": np.concatenate([x for x, _ in curves]),
        "z_m": np.concatenate([z for _, z in curves]),
    }
    kept = ("xC_m", "zC_m", "lc_m", "d_m")
    table = cable_tables.table_2_2()
    cells = tuple(cell for cell in table.cells if cell.column in kept)
    return Reproduction(
        "fig-2.4", "Profiles of the example cable", cells, table.note, _statements(curves, forces), columns
    )


def profile(force: float, arc: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """x, z [m] at unstrained arc lengths from the fixed end, pulled with (force, -force) [N] at the free end."""
    weight = cable_tables.DENSITY * cable_tables.GRAVITY
    x, z = catenary.profile(arc, force, -force, cable_tables.LENGTH, cable_tables.AXIAL_STIFFNESS, weight)
    return np.asarray(x), np.asarray(z)


def _statements(curves: list[tuple[np.ndarray, np.ndarray]], forces: list[float]) -> tuple[Statement, ...]:
    chord = [float(np.hypot(x[-1], z[-1])) for x, z in curves]
    angle = [float(np.degrees(np.arctan2(-z[-1], x[-1]))) for x, z in curves]
    listed = ", ".join(f"{a:.1f}° at {f:g} N" for a, f in zip(angle, forces, strict=True))
    return (
        Statement(
            "the inclined angle decreases with the external forces and tends to 45°",
            listed,
            all(a > b > 45.0 for a, b in pairwise(angle)),
        ),
        Statement(
            "under 100 N the chord is longer than the unstrained cable",
            f"chord {chord[-1]:.3f} m, cable {cable_tables.LENGTH:g} m",
            chord[-1] > cable_tables.LENGTH,
        ),
    )
