"""Campaigns of the FEM in which something hangs on the platform while vibration is measured, and only then.

Tensions, poses and lengths are read at rest without it. For cable and robot frequencies the FEM finds its equilibrium
again at the same unstrained lengths with the mass on the platform origin; nothing of the DSM is in them.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.sparse import csc_array
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.fem_reference.eigen_solver import frequencies_hz, lowest_eigenpairs
from cdpr_struct.fem_reference.rigid_platform import platform_mass_matrix
from cdpr_struct.fem_reference.robot_modes import robot_matrices
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

ELEMENTS, CABLE_MODES, ROBOT_MODES, SHIFT = 24, 2, 48, -0.4
SEEN = 0.3  # share of the kinetic energy in the platform: what an accelerometer shows as a clear peak
CAMPAIGN = """robot = "{name}"
model = "dsm"
[[measurement]]
kind = "static_state"
file = "states.csv"
sigma = {{ tension_N = {tension}, position_m = {position}, rotation_deg = {rotation}, length_m = {length} }}
[[measurement]]
kind = "cable_frequency"
file = "cables.csv"
[[measurement]]
kind = "robot_frequency"
file = "peaks.csv"
"""


@dataclass(frozen=True)
class Noise:
    """One sigma of each reading; of frequencies relative ones."""

    tension: float = 2.0
    position: float = 5e-4
    rotation: float = 0.02
    length: float = 5e-4
    cable: float = 3e-3
    robot: float = 1e-3


@dataclass(frozen=True, eq=False)
class Vibration:
    """In-plane frequencies (m, 2) of the cables, and all of the robot (k,) with their share of energy (k,) [Hz, -]."""

    cables: np.ndarray
    robot: np.ndarray
    share: np.ndarray

    @property
    def peaks(self) -> np.ndarray:
        """Frequencies of the robot that are seen on the platform [Hz]."""
        return self.robot[self.share > SEEN]


def equilibria(name: str, place: np.ndarray, mass: float) -> tuple[fem.RobotEquilibrium, fem.RobotEquilibrium]:
    """The robot at rest at lengths that hold it at a place, and at the same lengths with a mass on its platform."""
    robot = load_robot(name)
    held = inverse(robot, place, np.eye(3))
    return tuple(  # type: ignore[return-value]
        solve_in_fem(OperatingPoint(robot.with_load(load), place, np.eye(3), held.cables), ELEMENTS)
        for load in (0.0, mass)
    )


def vibration(equilibrium: fem.RobotEquilibrium) -> Vibration:
    """Natural frequencies by the mean of lumped and consistent mass, which is right to fourth order."""
    stiffness, lumped = robot_matrices(equilibrium, "lumped")
    mass = csc_array(0.5 * (lumped + robot_matrices(equilibrium, "consistent")[1]))
    values, vectors = lowest_eigenpairs(stiffness, mass, ROBOT_MODES, SHIFT)
    body, moved = platform_mass_matrix(equilibrium.robot.platform, equilibrium.rotation), vectors[-6:]
    share = np.einsum("ak,ab,bk->k", moved, body, moved)
    return Vibration(np.array([_in_plane(cable) for cable in equilibrium.cables]), frequencies_hz(values), share)


def _in_plane(cable: fem.CableEquilibrium) -> np.ndarray:
    both = []
    for kind in ("lumped", "consistent"):
        found = fem.cable_modes(cable, 2 * CABLE_MODES + 2, kind)
        both.append(found.frequencies_hz[found.in_plane_share > 0.5][:CABLE_MODES])
    return np.sqrt(2.0 / (1.0 / both[0] ** 2 + 1.0 / both[1] ** 2))


def tensions(equilibrium: fem.RobotEquilibrium) -> np.ndarray:
    """(m,) at the platform [N]."""
    return np.array([np.linalg.norm(cable.end_force) for cable in equilibrium.cables])


def sensors_campaign(
    folder: Path, name: str, places: np.ndarray, mass: float, noise: Noise = Noise(), seed: int | None = 1
) -> Campaign:
    """Static states at places (S, 3) [m], and frequencies there with a mass [kg] on; without noise if seed is None."""
    generator = np.random.default_rng(seed)
    size = 0.0 if seed is None else 1.0
    tables: dict[str, list[dict[str, float | str]]] = {"states": [], "cables": [], "peaks": []}
    for number, place in enumerate(places):
        rest, shaken = equilibria(name, place, mass)
        state = _reading(rest, f"p{number}", noise, size, generator)
        tables["states"] += state
        found, case = vibration(shaken), {"case": f"p{number}"} | {k: state[0][k] for k in _POSE}
        for cable, row in enumerate(found.cables):
            for mode, hertz in enumerate(row, start=1):
                read = hertz * (1.0 + size * noise.cable * generator.normal())
                line = case | {"cable": cable + 1, "mode": mode, "frequency_hz": read, "sigma": noise.cable * hertz}
                tables["cables"].append(line)
        for hertz in found.peaks:
            read = hertz * (1.0 + size * noise.robot * generator.normal())
            tables["peaks"].append(case | {"frequency_hz": read, "sigma": noise.robot * hertz})
    for file, rows in tables.items():
        pd.DataFrame(rows).to_csv(folder / f"{file}.csv", index=False)
    (folder / "campaign.toml").write_text(CAMPAIGN.format(name=name, **vars(noise)))
    return load_campaign(folder / "campaign.toml")


_POSE = ("x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg")


def _reading(
    rest: fem.RobotEquilibrium, case: str, noise: Noise, size: float, generator: np.random.Generator
) -> list[dict[str, float | str]]:
    """One row a cable of a state at rest."""
    position = rest.position + size * noise.position * generator.normal(size=3)
    turn = Rotation.from_rotvec(size * np.radians(noise.rotation) * generator.normal(size=3))
    angles = (turn * Rotation.from_matrix(rest.rotation)).as_euler("ZYX", degrees=True)[::-1]
    tension = tensions(rest) + size * noise.tension * generator.normal(size=len(rest.cables))
    length = np.array([cable.unstrained_length for cable in rest.robot.cables])
    length = length + size * noise.length * generator.normal(size=len(length))
    place = {"case": case} | dict(zip(_POSE, (*position, *angles), strict=True))
    return [
        place | {"cable": i, "tension_N": t, "length_m": n}
        for i, (t, n) in enumerate(zip(tension, length, strict=True), start=1)
    ]
