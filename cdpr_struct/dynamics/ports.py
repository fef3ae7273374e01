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
             per unit force at the port
    direct : (f, n, n) displacement per unit force with the platform held [m/N]
    """

    twist: np.ndarray
    direct: np.ndarray


def port_response(
    point: OperatingPoint, cables: CableDynamics, law: DampingLaw, ports: tuple[Port, ...], omega: np.ndarray
) -> PortResponse:
    """Participation of n ports at f frequencies (f,) [rad/s].

    Cable points follow from the modal expansion: with z = inertia / elasticity of the damped cable, static shapes
    plus modes times z / (omega_j^2 - z).
    """
    count = len(ports)
    on_cables = [i for i, port in enumerate(ports) if isinstance(port, CablePort)]
    kind = complex if on_cables else float
    twist = np.zeros((len(omega) if on_cables else 1, count, 6), dtype=kind)
    direct = np.zeros((len(twist), count, count), dtype=kind)
    for i, port in enumerate(ports):
        if isinstance(port, PlatformPort):
            twist[:, i] = port.twist
    if on_cables:
        _add_cable_ports(point, cables, law, ports, omega, twist, direct)
    return PortResponse(twist, direct)


def _add_cable_ports(
    point: OperatingPoint,
    cables: CableDynamics,
    law: DampingLaw,
    ports: tuple[Port, ...],
    omega: np.ndarray,
    twist: np.ndarray,
    direct: np.ndarray,
) -> None:
    expansion = cables.expansion(MODES_OF_A_POINT * float(omega[-1]))
    to_cable = np.swapaxes(expansion.frame, -1, -2) @ attachment(point)
    inertia = law.inertia(omega[:, None], cables.first_frequency) + np.zeros_like(expansion.omega_squared[:, 0])
    elasticity = law.elasticity(omega[:, None], cables.first_frequency)
    shapes: dict[int, np.ndarray] = {}
    for i, port in enumerate(ports):
        if isinstance(port, PlatformPort):
            continue
        c = port.cable
        static, modes = expansion.shapes(np.array([port.station]))
        local = expansion.frame[c].T @ port.direction
        shapes[i] = modes[c, :, 0] @ local
        gap = _gap(elasticity[:, [c]] * expansion.omega_squared[c], inertia[:, [c]])
        end = static[c, 0].T @ local + (inertia[:, [c]] / gap * shapes[i]) @ expansion.coupling[c]
        twist[:, i] = end @ to_cable[c]
        for j, other in enumerate(ports[: i + 1]):
            if isinstance(other, CablePort) and other.cable == c:
                direct[:, i, j] = direct[:, j, i] = (shapes[i] * shapes[j] / gap).sum(axis=1)


def _gap(elastic: np.ndarray, inertia: np.ndarray) -> np.ndarray:
    gap = elastic - inertia
    return np.where(gap == 0.0, np.finfo(float).eps * np.abs(elastic), gap)
