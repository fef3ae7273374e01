"""Tables 4.5, 4.6 and the modes read from fig. 4.9: vibration of CoGiRo at two poses."""

import dataclasses
from functools import cache

import numpy as np
from scipy.optimize import least_squares

from cdpr_struct.crosscheck.determinant_minima import scan_determinant
from cdpr_struct.dynamics.cable_dynamics import cable_dynamics, damped
from cdpr_struct.dynamics.natural_frequencies import static_frequencies
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.cable_state import cable_stiffness
from cdpr_struct.statics.inverse_kinematics import inverse
from cdpr_struct.thesis.reproduction import Cell, Reproduction, Statement, printed_table

CENTRE = np.array([0.012, 0.0697, 1.219])
EDGE = np.array([4.012, 0.0697, 1.219])
CABLE = 5
_LISTED = {"centre": "334 N (simulated) and 307 N (measured)", "edge": "394 N (simulated) and 383 N (measured)"}
STATED_MODES = np.array([5.1, 5.5, 7.2, 8.5, 12.8])


def table_4_5() -> Reproduction:
    """Frequencies of cable 5 at the centre."""
    return _cable_table("table-4.5", "table_4_5", "centre", CENTRE)


def table_4_6() -> Reproduction:
    """Frequencies of cable 5 at the edge."""
    return _cable_table("table-4.6", "table_4_6", "edge", EDGE)


def _cable_table(item: str, table: str, where: str, position: np.ndarray) -> Reproduction:
    point = _at(load_robot("cogiro"), position)
    i = CABLE - 1
    chord, tau = float(point.cables.chord[i]), float(point.cables.tension[i])
    density = float(point.entered.linear_density[i])
    first = np.sqrt(tau / density) / (2.0 * chord)
    rows = printed_table(table)
    cells, implied = [], {}
    for column in ("dsm_Hz", "experiment_Hz"):
        printed = np.array([float(row[column]) for row in rows])
        modes = np.array([int(row["mode"]) for row in rows])
        implied[column] = density * float(np.mean(2.0 * chord * printed / modes)) ** 2
        cells += [Cell(f"mode {n}", column, row[column], float(n * first)) for n, row in zip(modes, rows, strict=True)]
    note = (
        f"Ours: a taut string between the anchors ({chord:.3f} m) at the tension of 118.5 kg, {tau:.0f} N. The printed "
        f"simulation needs {implied['dsm_Hz']:.0f} N, the experiment {implied['experiment_Hz']:.0f} N; Table 4.4 lists "
        f"{_LISTED[where]} without the shaker, whose mass hung on the platform in the vibration tests."
    )
    return Reproduction(item, f"Natural frequencies of cable 5 at the {where}", tuple(cells), note)


def fig_4_7() -> Reproduction:
    """Trace of cable 5's dynamic stiffness at the centre."""
    return _trace_figure("fig-4.7", "centre", CENTRE, table_4_5())


def fig_4_8() -> Reproduction:
    """Trace of cable 5's dynamic stiffness at the edge."""
    return _trace_figure("fig-4.8", "edge", EDGE, table_4_6())


def _trace_figure(item: str, where: str, position: np.ndarray, table: Reproduction) -> Reproduction:
    point = _at(load_robot("cogiro"), position)
    cables = cable_dynamics(point, "dsm")
    hertz = np.arange(0.01, 20.0, 0.01)
    squared = damped(cables, point.entered.damping_ratio, 2.0 * np.pi * hertz[:, None])
    trace = np.abs(np.trace(cables.stiffness(squared)[:, CABLE - 1], axis1=-2, axis2=-1))
    static = float(np.trace(cable_stiffness(point.cables)[CABLE - 1]))
    columns = {
        "frequency_Hz": hertz,
        "dynamic_trace_N_m": trace,
        "static_trace_N_m": np.full_like(hertz, static),
    }
    title = f"Trace of the dynamic stiffness of cable 5 at the {where}"
    cells = tuple(cell for cell in table.cells if cell.column == "dsm_Hz")
    return Reproduction(item, title, cells, table.note, (), columns)


def fig_4_10() -> Reproduction:
    """Determinants at the edge."""
    point = _at(load_robot("cogiro"), EDGE)
    scan = scan_determinant(point, 0.01, 20.0, 0.01)
    columns = {"frequency_Hz": scan.hertz, "log10_dynamic": scan.log_dynamic, "log10_static": scan.log_static}
    note = "With the assumed inertia of the built-in robot; the print gives none, see fig-4.9."
    return Reproduction("fig-4.10", "Determinants of CoGiRo at the edge", (), note, (), columns)


def fig_4_9() -> Reproduction:
    """Which mass, stiffness and inertia the stated platform modes 5.1, 5.5, 7.2, 8.5, 12.8 Hz allow."""
    stated_stiffness = _fit(118.5, free_stiffness=False)
    free = {mass: _fit(mass, free_stiffness=True) for mass in (91.0, 118.5)}
    cells = tuple(
        Cell(f"mode {i + 1}", "Hz", f"{printed:g}", float(ours))
        for i, (printed, ours) in enumerate(zip(STATED_MODES, stated_stiffness.nearest, strict=True))
    )
    text = "; ".join(
        f"{mass:g} kg: EA x {fit.factor:.2f}, inertia {', '.join(f'{v:.0f}' for v in fit.inertia)} kg m^2, "
        f"all five within {fit.rms:.2f} Hz rms and a sixth at {fit.hertz[0]:.1f} Hz"
        for mass, fit in free.items()
    )
    statement = Statement(
        "the stated modes are the rigid-body modes of the platform on cables of E = 20 GPa",
        f"with EA as stated no inertia brings them within {stated_stiffness.rms:.1f} Hz rms; what they fix is EA per "
        f"mass, twice the stated: {text}",
        stated_stiffness.rms < 0.2,
    )
    note = (
        "The inertia of CoGiRo is not printed. Massless cables, centre of mass at the platform origin, principal axes "
        "along the platform's; fitted are three moments of inertia that obey the triangle inequality, and in the "
        "second fit a common factor on EA. The curves are those of the built-in robot with its "
        "assumed inertia. Five numbers cannot fix mass, EA, inertia and centre of mass at once."
    )
    scan = scan_determinant(_at(load_robot("cogiro"), CENTRE), 0.01, 20.0, 0.01)
    columns = {"frequency_Hz": scan.hertz, "log10_dynamic": scan.log_dynamic, "log10_static": scan.log_static}
    return Reproduction("fig-4.9", "Platform modes of CoGiRo at the centre", cells, note, (statement,), columns)


@dataclasses.dataclass(frozen=True, slots=True, eq=False)
class InertiaFit:
    """A platform that comes nearest to the stated modes: inertia (3,) [kg m^2], factor on EA, its modes (6,) [Hz]."""

    inertia: np.ndarray
    factor: float
    hertz: np.ndarray
    left_out: int

    @property
    def nearest(self) -> np.ndarray:
        """(5,) the modes that stand for the stated ones [Hz]."""
        return np.delete(self.hertz, self.left_out)

    @property
    def rms(self) -> float:
        """Root mean square deviation [Hz]."""
        return float(np.sqrt(np.mean((self.nearest - STATED_MODES) ** 2)))


@cache
def _fit(mass: float, free_stiffness: bool) -> InertiaFit:
    """Best of the six ways to leave one mode unseen."""
    fits = []
    for left_out in range(6):
        start = np.array([0.2, 0.1, 0.0, 0.4][: 3 + free_stiffness])
        found = least_squares(_misses, start, bounds=(-2.0, 2.0), args=(mass, left_out)).x
        factor = float(np.exp(found[3])) if free_stiffness else 1.0
        fits.append(InertiaFit(_inertia(mass, found), factor, _modes(mass, found), left_out))
    return min(fits, key=lambda fit: fit.rms)


def _misses(x: np.ndarray, mass: float, left_out: int) -> np.ndarray:
    return np.delete(_modes(mass, x), left_out) - STATED_MODES


def _inertia(mass: float, x: np.ndarray) -> np.ndarray:
    """(3,) principal moments [kg m^2] from logarithms x of three radii of gyration [1/e m].

    Moments are sums of two of three positive second moments of mass, so that the triangle inequality holds.
    """
    second = mass * np.exp(2.0 * (x[:3] - 1.0))
    return second.sum() - second


def _modes(mass: float, x: np.ndarray) -> np.ndarray:
    """Six modes [Hz] on massless cables; x[:3] gives the inertia, x[3], if there, the logarithm of a factor on EA."""
    factor = float(np.exp(x[3])) if len(x) > 3 else 1.0
    point = _stiffened(mass, factor)
    robot = point.entered
    platform = dataclasses.replace(robot.platform, inertia=np.diag(_inertia(mass, x)))
    return static_frequencies(dataclasses.replace(point, robot=dataclasses.replace(robot, platform=platform)))


@cache
def _stiffened(mass: float, factor: float) -> OperatingPoint:
    """CoGiRo at the centre with another platform mass [kg] and EA times a factor; neither depends on the inertia."""
    robot = load_robot("cogiro")
    cables = tuple(dataclasses.replace(c, axial_stiffness=c.axial_stiffness * factor) for c in robot.cables)
    return _at(dataclasses.replace(robot, platform=robot.platform.with_mass(mass), cables=cables), CENTRE)


def _at(robot: Robot, position: np.ndarray) -> OperatingPoint:
    return OperatingPoint(robot, position, np.eye(3), inverse(robot, position, np.eye(3)).cables)
