"""Where a robot is shaken and where its answer is measured: points of the platform and of the cables."""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CableDynamics
from cdpr_struct.dynamics.damping import DampingLaw
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.robot_dynamic_stiffness import attachment


@dataclass(frozen=True, slots=True, eq=False)
class PlatformPort:
    """One degree of freedom of a point of the platform.

    name  : as the user wrote it
    twist : (6,) its displacement per platform motion, and the wrench of a unit force (or moment) there; world axes,
            moments about the platform origin
    turns : a rotation or a moment instead of a displacement or a force
    """

    name: str
    twist: np.ndarray
    turns: bool = False


@dataclass(frozen=True, slots=True, eq=False)
class CablePort:
    """One direction at a point of a cable.

    cable     : number from 0
    station   : fraction of the cable from the frame, between 0 and 1
    direction : (3,) unit vector, world
    """

    name: str
    cable: int
    station: float
    direction: np.ndarray
    turns: bool = False


Port = PlatformPort | CablePort
MODES_OF_A_POINT = 8.0  # times the top of the band: so far the modes of a cable are summed at one of its points


def platform_port(name: str, axis: np.ndarray, turns: bool, arm: np.ndarray) -> PlatformPort:
    """Port along (or about) `axis` (3,) at the point `arm` (3,) [m] from the platform origin, both in world axes."""
    if turns:
        return PlatformPort(name, np.concatenate([np.zeros(3), axis]), True)
    return PlatformPort(name, np.concatenate([axis, np.cross(arm, axis)]))


@dataclass(frozen=True, slots=True, eq=False)
class PortResponse:
    """How ports take part in the platform's vibration.

    twist  : (f, n, 6) displacement of each port per platform motion; by reciprocity also the wrench on the platform
             per unit force at the port; f is 1 where no port is on a cable
    direct : (f, n, n) displacement per unit force with the platform held [m/N]
    """

    twist: np.ndarray
    direct: np.ndarray

    def responses(self, motion: np.ndarray) -> np.ndarray:
        """(f, n - 1) displacement of all ports but the first in motions (6, f) of the platform."""
        if len(self.twist) == 1:
            return np.asarray((self.twist[0, 1:] @ motion).T)
        return np.einsum("fnk,kf->fn", self.twist[:, 1:], motion)


@dataclass(frozen=True, slots=True, eq=False)
class _CablePoint:
    """A direction at a point of a cable with p modes in use: its motion per unit of each coordinate.

    static : (6,) per platform motion, in static shape;  own : (p,) per modal coordinate
    driven : (p, 6) mass coupling of the modes with the platform motion
    """

    cable: int
    static: np.ndarray
    own: np.ndarray
    driven: np.ndarray
    omega_squared: np.ndarray


@dataclass(frozen=True, slots=True, eq=False)
class ReadyPorts:
    """n ports of a robot, ready for any number of frequencies; made by `ready_ports`.

    free : (6,) 1 where the platform moves, 0 where a guide holds it
    """

    ports: tuple[Port, ...]
    law: DampingLaw
    first_frequency: np.ndarray
    points: dict[int, _CablePoint]
    free: np.ndarray

    def at(self, omega: np.ndarray) -> PortResponse:
        """Participation at f frequencies (f,) [rad/s].

        Cable points follow from the modal expansion: with z = inertia / elasticity of the damped cable, static shapes
        plus modes times z / (omega_j^2 - z).
        """
        kind = complex if self.points else float
        twist = np.zeros((len(omega) if self.points else 1, len(self.ports), 6), dtype=kind)
        direct = np.zeros((len(twist), len(self.ports), len(self.ports)), dtype=kind)
        for i, port in enumerate(self.ports):
            if isinstance(port, PlatformPort):
                twist[:, i] = port.twist * self.free
        if not self.points:
            return PortResponse(twist, direct)
        inertia = self.law.inertia(omega[:, None], self.first_frequency)
        elasticity = self.law.elasticity(omega[:, None], self.first_frequency)
        for i, here in self.points.items():
            column = [here.cable]
            gap = _gap(elasticity[:, column] * here.omega_squared, inertia[:, column])
            twist[:, i] = here.static + (inertia[:, column] / gap * here.own) @ here.driven
            for j, other in self.points.items():
                if j <= i and other.cable == here.cable:
                    direct[:, i, j] = direct[:, j, i] = (here.own * other.own / gap).sum(axis=1)
        return PortResponse(twist, direct)


def ready_ports(
    point: OperatingPoint, cables: CableDynamics, law: DampingLaw, ports: tuple[Port, ...], highest: float
) -> ReadyPorts:
    """Ports for frequencies up to `highest` [rad/s]; modes up to `MODES_OF_A_POINT` times that stand for a cable."""
    points: dict[int, _CablePoint] = {}
    on_cables = {i: port for i, port in enumerate(ports) if isinstance(port, CablePort)}
    if on_cables:
        expansion = cables.expansion(MODES_OF_A_POINT * highest)
        to_cable = np.swapaxes(expansion.frame, -1, -2) @ attachment(point)
        for i, port in on_cables.items():
            c = port.cable
            static, modes = expansion.shapes(np.array([port.station]))
            local = expansion.frame[c].T @ port.direction
            driven = expansion.coupling[c] @ to_cable[c]
            points[i] = _CablePoint(
                c, local @ static[c, 0] @ to_cable[c], modes[c, :, 0] @ local, driven, expansion.omega_squared[c]
            )
    return ReadyPorts(ports, law, cables.first_frequency, points, point.arrays.free)


def _gap(elastic: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    gap = elastic - inertia
    return np.where(gap == 0.0, np.finfo(float).eps * np.abs(elastic), gap)
