"""Figs 2.5, 3.8 and 3.9: vibration of the example cable and of the robot of Table 3.1."""

import numpy as np

from cdpr_struct.crosscheck.determinant_minima import scan_determinant
from cdpr_struct.crosscheck.single_cable import describe_cable
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.generated import cable_compliance, cable_dsm
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.thesis import cable_tables
from cdpr_struct.thesis.reproduction import Cell, Reproduction, Statement
from cdpr_struct.workspace.grid import Grid
from cdpr_struct.workspace.vibration import first_frequencies

DAMPING = 0.01
FORCE = 100.0
REACH, HEIGHT, POSES = 3.0, 0.5, 9


def fig_2_5() -> Reproduction:
    """Trace of the dynamic and the static stiffness of the example cable under the third load."""
    found = describe_cable(
        FORCE, -FORCE, cable_tables.LENGTH, cable_tables.AXIAL_STIFFNESS, cable_tables.DENSITY, cable_tables.GRAVITY
    )
    hertz = np.arange(0.005, 8.0, 0.005)
    dynamic = _trace(found, hertz)
    k_xx, _, k_zz = cable_compliance.stiffness(
        FORCE,
        -FORCE,
        cable_tables.LENGTH,
        cable_tables.AXIAL_STIFFNESS,
        cable_tables.DENSITY * cable_tables.GRAVITY,
    )
    static = np.full_like(hertz, float(k_xx + k_zz) + found["tau_N"] / found["chord_m"])
    first = found["frequencies_hz"]["out_of_plane"][0]
    peak = hertz[1:-1][(dynamic[1:-1] > dynamic[:-2]) & (dynamic[1:-1] > dynamic[2:])][0]
    statement = Statement(
        "the first peak is the first out-of-plane mode",
        f"first peak at {peak:.3f} Hz, first out-of-plane frequency {first:.3f} Hz (the printed formula lacks a factor "
        "of frequency; omega = (pi / l_c) sqrt(tau / rho))",
        abs(peak - first) < 0.01,
    )
    columns = {"frequency_Hz": hertz, "dynamic_trace_N_m": dynamic, "static_trace_N_m": static}
    return Reproduction(
        "fig-2.5", "Trace of the cable's dynamic and static stiffness", (), "Damping ratio 0.01.", (statement,), columns
    )


def _trace(found: dict, hertz: np.ndarray) -> np.ndarray:
    chord, tau = found["chord_m"], found["tau_N"]
    weight = cable_tables.DENSITY * cable_tables.GRAVITY * abs(found["x_m"]) / chord
    effective = cable_dsm.effective_length_integral(chord, found["epsilon"])
    first = np.pi / chord * np.sqrt(tau / cable_tables.DENSITY)
    squared = cable_dsm.damped_omega_squared(2.0 * np.pi * hertz, DAMPING, first)
    k_xx, _, k_yy, k_zz = cable_dsm.dynamic_stiffness(
        squared, chord, tau, cable_tables.AXIAL_STIFFNESS, effective, cable_tables.DENSITY, weight
    )
    return np.abs(k_xx + k_yy + k_zz)


def fig_3_8() -> Reproduction:
    """Determinants with dynamic and static stiffness at (0, 0, 0.5), and the first frequency stated as 2.4 Hz."""
    robot = load_robot("thesis-3-1")
    pose = robot.home
    assert pose is not None
    point = OperatingPoint(robot, pose.position, pose.rotation, inverse(robot, pose.position, pose.rotation).cables)
    scan = scan_determinant(point, 0.01, 20.0, 0.01)
    modes = certified_modes(point, "exact", 24)
    hertz, kinds = modes.frequencies.hertz, modes.shapes.kinds()
    platform = hertz[kinds.index("platform")]
    tension = point.cables.tension_at_platform
    cell = Cell("fundamental frequency", "Hz", "2.4", float(hertz[0]))
    note = (
        f"With 60 kg the minimum-norm tensions are {tension.min():.0f}-{tension.max():.0f} N; the first, "
        f"{hertz[0]:.3f} Hz, is a mode of the cables, the first of sixteen up to {hertz[15]:.3f} Hz; the platform's "
        f"first is {platform:.3f} Hz. 2.4 Hz would need tensions {100 * (1 - (2.4 / hertz[0]) ** 2):.0f} % lower; "
        "read off a plot it means 2.35 to 2.45 or more."
    )
    columns = {
        "frequency_Hz": scan.hertz,
        "log10_dynamic": scan.log_dynamic,
        "log10_static": scan.log_static,
    }
    return Reproduction("fig-3.8", "Determinants at the centre pose", (cell,), note, (), columns)


def fig_3_9() -> Reproduction:
    """First frequency of the platform and of the eight cables over the sub-workspace."""
    robot = load_robot("thesis-3-1")
    axis = np.linspace(-REACH, REACH, POSES)
    grid = Grid(axis, axis, np.array([HEIGHT]), np.zeros(3))
    columns = first_frequencies(robot, grid.positions, grid.rotation)
    first, massless = (columns[name].reshape(POSES, POSES) for name in ("first_Hz", "platform_massless_Hz"))
    middle = POSES // 2
    statement = Statement(
        "the first natural frequency of the end-effector is highest at the centre and falls towards the edge",
        f"so does the first frequency of the robot, {first[middle, middle]:.2f} Hz at the centre, {first.min():.2f} Hz "
        "at the corners; but that is a mode of the cables. The platform's own first, on massless cables, is "
        f"{massless[middle, middle]:.2f} Hz at the centre, {massless.min():.2f} to {massless.max():.2f} Hz in all",
        bool(first[middle, middle] >= first.max() and first.min() == first[[0, 0, -1, -1], [0, -1, 0, -1]].min()),
    )
    data = {"x_m": grid.positions[:, 0], "y_m": grid.positions[:, 1], **columns}
    data["held"] = data["held"].astype(float)
    return Reproduction(
        "fig-3.9",
        "First natural frequencies over the sub-workspace",
        (),
        "Exact catenary dynamics at minimum-norm tensions; the platform's is the mode most like its first on massless "
        "cables.",
        (statement,),
        data,
    )
