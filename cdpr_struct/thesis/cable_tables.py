"""Tables 2.2-2.4: the example cable of section 2.3 under three end forces.

The print gives f_Cz = +10, +40, +100 N; its end points need -10, -40, -100 N in eqs (2.11)-(2.12). It gives
rho = 0.067 kg/m; its numbers need a weight of 0.6512 N/m, 0.9 % less, with which 45 of the 48 cells round to the print.
"""

import math
from typing import Any

from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.thesis.reproduction import Cell, Reproduction, printed_table

AXIAL_STIFFNESS = 20e9 * math.pi / 4.0 * 0.004**2
LENGTH, DENSITY, GRAVITY = 20.0, 0.067, 9.81
IMPLIED_WEIGHT = 0.6512
""" [N/m] with which the printed numbers of the three tables were evidently computed."""

_WEIGHT_NOTE = (
    "Computed with the stated rho = 0.067 kg/m, and with f_Cz = -10, -40, -100 N, which the printed end points need. "
    "The deviations have one cause: the print was computed with a cable weight of 0.6512 N/m instead of "
    "0.067 x 9.81 = 0.6573 N/m (0.9 % less); with it 45 of the 48 cells of Tables 2.2-2.4 round to the print."
)


def table_2_2() -> Reproduction:
    """Static cable parameters."""
    columns = {
        "xC_m": "x_m",
        "zC_m": "z_m",
        "alpha_deg": "inclination_deg",
        "lc_m": "chord_m",
        "dl_m": "elongation_m",
        "d_m": "sag_m",
    }
    return _reproduce("table-2.2", "Static cable parameters", "table_2_2", columns, _WEIGHT_NOTE)


def table_2_3() -> Reproduction:
    """Compliance and stiffness matrices."""
    cells = []
    for row, result in _rows("table_2_3"):
        sag, stiffness = result["compliance_sag"], result["stiffness"]
        ours = {
            "Caxial_xx_1e-4m_N": 1e4 * result["compliance_axial"][0][0],
            "Csag_xx_m_N": sag[0][0],
            "Csag_xz_m_N": sag[0][1],
            "Csag_zz_m_N": sag[1][1],
            "Kxx_N_m": stiffness[0][0],
            "Kxz_N_m": stiffness[0][1],
            "Kzz_N_m": stiffness[1][1],
        }
        cells += [Cell(_name(row), column, row[column], value) for column, value in ours.items()]
    return Reproduction("table-2.3", "Static compliance and stiffness", tuple(cells), _WEIGHT_NOTE)


def table_2_4() -> Reproduction:
    """Dynamic cable parameters."""
    columns = {"lambda2": "lambda2", "alpha_deg": "inclination_deg", "epsilon": "epsilon"}
    return _reproduce("table-2.4", "Dynamic cable parameters", "table_2_4", columns, _WEIGHT_NOTE)


def _reproduce(item: str, title: str, table: str, columns: dict[str, str], note: str) -> Reproduction:
    cells = [
        Cell(_name(row), printed, row[printed], result[ours])
        for row, result in _rows(table)
        for printed, ours in columns.items()
    ]
    return Reproduction(item, title, tuple(cells), note)


def _rows(table: str) -> list[tuple[dict[str, str], dict[str, Any]]]:
    return [
        (row, describe_cable(float(row["fCx_N"]), -float(row["fCz_N"]), LENGTH, AXIAL_STIFFNESS, DENSITY, GRAVITY))
        for row in printed_table(table)
    ]


def _name(row: dict[str, str]) -> str:
    return f"[{row['fCx_N']} {row['fCz_N']}] N"
