"""What the sensors of a robot read when its winches are locked at given encoder lengths: the diagnosis's forward model.

The pose and tensions at which nothing is left of balance and lengths (`observation.rest`) are found by Newton's method;
frequencies are those of the exact catenary there.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableModel, cable_dynamics
from cdpr_struct.dynamics.damping import DampingLaw, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.dynamics.robot_dynamic_stiffness import Assembly
from cdpr_struct.observation.cable_modes import CableRows, cable_modes_at
from cdpr_struct.observation.circumstances import Circumstances
from cdpr_struct.observation.dependence import Dependence
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import rest, static_residuals
from cdpr_struct.observation.robot_modes import VibratingModes, modes_at
from cdpr_struct.observation.vibrating import vibrating
from cdpr_struct.robot.robot_arrays import RobotArrays

RADIUS = 0.3  # m, of the platform: moments over it are forces
_STEPS = np.repeat([1e-5, 1e-5, 1e-2], [3, 3, 8])  # m, rad, N
_RIGHT = 1e-9  # N and m: Newton has converged
_FINER = 3  # times the sampling of the band: curves are drawn smooth


@dataclass(frozen=True, slots=True, eq=False)
class Answer:
    """Impulse response and FRF of the platform's height: hertz (f,), response (f,) complex [(m/s^2)/N]."""

    hertz: np.ndarray
    response: np.ndarray

    @property
    def decay(self) -> tuple[np.ndarray, np.ndarray]:
        """Time (n,) [s] and acceleration (n,) [m/s^2 per N s] after a blow: the response, transformed back."""
        step = self.hertz[1] - self.hertz[0]
        whole = np.concatenate([[0.0], self.response])
        window = 0.5 + 0.5 * np.cos(np.pi * np.arange(len(whole)) / len(whole))  # no ringing of the cut band
        count = _FINER * (2 * len(whole) - 2)
        return np.arange(count) / (step * count), np.fft.irfft(whole * window, count) * step * count


def locked(arrays: RobotArrays, start: Readings, known: Circumstances) -> Readings:
    """Readings of pose and tensions at the encoder lengths of `start`, from there on; one state."""
    y = np.zeros(14)
    for _ in range(8):
        residual = static_residuals(arrays, _moved(start, y[None]), known, RADIUS)[0]
        if np.abs(residual).max() < _RIGHT:
            return _moved(start, y[None])
        there = static_residuals(arrays, _moved(start, (y + np.diag(_STEPS))[:, None]), known, RADIUS)[:, 0]
        y = y - np.linalg.solve(((there - residual) / _STEPS[:, None]).T, residual)
    raise ArithmeticError(f"no rest at these lengths: {np.abs(residual).max():.1e} is left")


def _moved(start: Readings, y: np.ndarray) -> Readings:
    """Readings plus (..., 14) of pose and tensions."""
    return start.less(-y[..., :6], -y[..., 6:], np.zeros(y.shape[-1] - 6))


def at_rest(arrays: RobotArrays, readings: Readings, known: Circumstances) -> OperatingPoint:
    """The robot as it stands while vibration is measured, one state."""
    return vibrating(rest(arrays, readings, known), known)


def cable_hertz(point: OperatingPoint, modes: int = 3) -> np.ndarray:
    """(m, modes) natural frequencies of the cables in their planes [Hz]."""
    m = point.arrays.cable_count
    cable, mode = (a.ravel() for a in np.meshgrid(np.arange(m), np.arange(1, modes + 1), indexing="ij"))
    rows = CableRows(np.zeros(m * modes, dtype=int), cable, mode, np.ones(m * modes, dtype=bool))
    return np.exp(cable_modes_at(point, rows).log_hertz).reshape(m, modes)


def platform_modes(point: OperatingPoint, top: float, model: CableModel, assembly: Assembly) -> VibratingModes:
    """Modes below `top` [Hz], and how they change."""
    return modes_at(point, np.array([2.0 * np.pi * top]), assembly, model)


def changed(modes: VibratingModes, point: OperatingPoint) -> np.ndarray:
    """(M,) change of ln f towards a nearby state, to first order."""
    change = Dependence.of(point, modes.assembly).vector - modes.dependence
    return (change[:, None, :] @ modes.gradient)[0, 0]


def answer(point: OperatingPoint, top: float, law: DampingLaw | None, model: CableModel, assembly: Assembly) -> Answer:
    """Answer of the platform's height to a vertical force."""
    one = _single(point)
    law = law or Viscous(np.broadcast_to(one.arrays.damping_ratio, one.cables.length.shape))
    hertz = 0.05 * np.arange(1, round(top / 0.05))
    port = platform_port("z", np.array([0.0, 0.0, 1.0]), False, np.zeros(3))
    cables = cable_dynamics(one, model, 2.0 * np.pi * top)
    found = frequency_response(one, cables, law, port, (port,), hertz, "acceleration", assembly)
    return Answer(hertz, found.response[:, 0])


def _single(point: OperatingPoint) -> OperatingPoint:
    """The only state without its axis."""
    from dataclasses import fields, replace

    from cdpr_struct.robot.parameters import PARAMETERS

    a = point.arrays
    flat = {n: getattr(a, n)[0] for n, rule in PARAMETERS.items() if getattr(a, n).ndim > rule.axes}
    cables = type(point.cables)(**{f.name: getattr(point.cables, f.name)[0] for f in fields(point.cables)})
    return OperatingPoint(replace(a, **flat), point.position[0], point.rotation[0], cables)
