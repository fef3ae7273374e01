"""Table 3.2 and figs 3.4-3.7: static pose error of the robot of Table 3.1 over -3..3 m x -3..3 m at z = 0.5 m.

The averages of Table 3.2 are those over 7 x 7 poses, edges included: with them all twelve cells are met. The average
over the area itself, by Gauss quadrature, is another number; it stands beside ours. The thesis's "external load" is the
whole hanging mass.
"""

from functools import cache

import numpy as np

from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.pose_error import pose_error
from cdpr_struct.thesis.reproduction import Cell, Reproduction, Statement, printed_table
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.pose_error_map import PARTS, PoseErrorMap
from cdpr_struct.workspace.quantities import pose_errors

ROBOTS = {"4": "thesis-3-1", "8": "thesis-3-1-8mm"}
REACH, HEIGHT = 3.0, 0.5  # m, half width of the sub-workspace, and its height
POSES, FINE = 7, 31  # along each axis: of the thesis's averages, and of our figures
GAUSS = 8  # nodes along each axis: more change the average by less than 1e-5 mm
TOLERANCE = 0.07  # mm: half a printed digit, and the size of an unstated digit of EA and rho

_FIGURES = {"fig-3.4": ("4", "30"), "fig-3.5": ("4", "60"), "fig-3.6": ("8", "30"), "fig-3.7": ("8", "60")}


def table_3_2() -> Reproduction:
    """Average pose errors, printed, ours on the same poses, and ours over the area."""
    cells = []
    for row in printed_table("table_3_2"):
        diameter, load = row["cable_diameter_mm"], row["load_kg"]
        cells += _averages(error_map(diameter, load, POSES), diameter, load, row)
    note = (
        f"Averages over {POSES} x {POSES} poses, edges included, as in the print; the whole hanging mass is the "
        "printed load, E = 20 GPa, rho = 0.067 and 0.251 kg/m. `converged` is the average over the area (Gauss "
        "quadrature): a mean over 7 x 7 poses gives the corners, where sag is largest, too much weight, so those "
        "averages overstate what sag adds by up to 28 %. The spring equilibrium is the one continuous with the "
        "reference pose."
    )
    return Reproduction("table-3.2", "Average pose error in the sub-workspace [mm]", tuple(cells), note)


def fig_3_4() -> Reproduction:
    """4 mm cables, 30 kg."""
    return _figure("fig-3.4")


def fig_3_5() -> Reproduction:
    """4 mm cables, 60 kg."""
    return _figure("fig-3.5")


def fig_3_6() -> Reproduction:
    """8 mm cables, 30 kg."""
    return _figure("fig-3.6")


def fig_3_7() -> Reproduction:
    """8 mm cables, 60 kg."""
    return _figure("fig-3.7")


@cache
def error_map(diameter: str, load: str, count: int) -> PoseErrorMap:
    """Pose errors on count x count poses of the sub-workspace, for a cable diameter [mm] and a load [kg] as printed."""
    robot = load_robot(ROBOTS[diameter]).with_load(mass=float(load))
    axis = np.linspace(-REACH, REACH, count)
    grid = Grid(axis, axis, np.array([HEIGHT]), np.zeros(3))
    columns = pose_errors(robot, grid.positions, grid.rotation)
    return PoseErrorMap(robot.name, robot.platform.mass, grid, columns).require_some()


@cache
def area_average(diameter: str, load: str) -> dict[str, float]:
    """Average over the area of the sub-workspace [mm], by part."""
    node, weight = np.polynomial.legendre.leggauss(GAUSS)
    x, y = (axis.ravel() for axis in np.meshgrid(REACH * node, REACH * node, indexing="ij"))
    positions = np.stack([x, y, np.full_like(x, HEIGHT)], axis=-1)
    robot = load_robot(ROBOTS[diameter])
    error = pose_error(robot, positions, np.eye(3), mass=float(load))
    share = np.outer(weight, weight).ravel() / 4.0
    return {part: float(1e3 * share @ getattr(error, f"{part}_error")[:, 2]) for part in PARTS}


def _averages(errors: PoseErrorMap, diameter: str, load: str, row: dict[str, str]) -> list[Cell]:
    area = area_average(diameter, load)
    label = f"{diameter} mm, {load} kg"
    return [Cell(label, part, row[f"{part}_mm"], errors.mean(part), TOLERANCE, area[part]) for part in PARTS]


def _figure(item: str) -> Reproduction:
    diameter, load = _FIGURES[item]
    (row,) = (r for r in printed_table("table_3_2") if (r["cable_diameter_mm"], r["load_kg"]) == (diameter, load))
    errors = error_map(diameter, load, FINE)
    place = errors.grid.positions
    columns = {"x_m": place[:, 0], "y_m": place[:, 1]} | {f"{p}_mm": errors.vertical(p) for p in PARTS}
    columns["more_stable_pose"] = errors.more_stable.astype(int)
    return Reproduction(
        item,
        f"Static pose error along z, {diameter} mm cables, {load} kg",
        tuple(_averages(error_map(diameter, load, POSES), diameter, load, row)),
        f"The figure has {FINE} x {FINE} poses; the averages are over {POSES} x {POSES}, as in Table 3.2, whose row "
        "the cells repeat. The figures of the thesis have no other printed numbers.",
        _statements(errors),
        columns,
    )


def _statements(errors: PoseErrorMap) -> tuple[Statement, ...]:
    """What section 3.4.2 says of these figures."""
    axial, sag, size = errors.vertical("axial"), errors.vertical("sag"), np.abs(errors.vertical("global"))
    place = errors.grid.positions[:, :2]
    small, large = place[np.argmin(size)], place[np.argmax(size)]
    return (
        Statement(
            "the axial-elasticity-introduced pose errors are all negative",
            f"{axial.min():.2f} to {axial.max():.2f} mm",
            bool((axial < 0.0).all()),
        ),
        Statement(
            "the sag-introduced pose errors are all positive",
            f"{sag.min():.2f} to {sag.max():.2f} mm",
            bool((sag > 0.0).all()),
        ),
        Statement(
            "in general, the pose error is smallest near the centre and becomes bigger near the edge",
            f"global error {size.min():.2f} mm at ({small[0]:g}, {small[1]:g}) m, {size.max():.2f} mm at "
            f"({large[0]:g}, {large[1]:g}) m",
            bool(np.hypot(*small) < np.hypot(*large)),
        ),
    )
