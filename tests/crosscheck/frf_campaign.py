"""Campaigns of static states and FRFs whose readings are the FEM's, with noise; nothing of the DSM is in them.

The FRFs are given by their modes (frequency, damping, residues), as a fit would find them; that the fit finds
frequencies and damping is shown in tests/laws/test_signal_modes.py.
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd
from scipy.spatial.transform import Rotation

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.measurement.campaign import Campaign, RobotFrequencies
from cdpr_struct.measurement.campaign_file import load_campaign
from cdpr_struct.measurement.identified import Identified
from cdpr_struct.measurement.modal_estimate import Modes
from cdpr_struct.measurement.peak_kinds import MODE
from cdpr_struct.measurement.signal_records import SignalRecord
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

POSES = np.array(
    [[0.2, 0.1, 0.5], [1.3, -0.8, 0.9], [-1.5, 0.7, 0.3], [0.6, 1.2, 1.2], [-0.8, -1.1, 0.8], [1.8, 0.4, 0.2]]
)
SHAKEN = (0, 1, 2, 3)  # poses with an FRF
ELEMENTS, MODES = 24, 60
HIGHEST, SHARE = 9.0, 0.15  # Hz; of the kinetic energy in the platform: modes that a fit finds and the campaign takes
DAMPING = 0.004
NOISE = {"hertz": 1e-3, "damping": 0.02, "constant": 0.05}  # relative
RESPOND, EXCITE = ("x", "y", "z"), ("fx", "fz")
ROBOT = "thesis-3-1"
CAMPAIGN = """robot = "{robot}"
model = "dsm"
[[measurement]]
kind = "static_state"
file = "states.csv"
sigma = {{ tension_N = 2.0, position_m = 5e-4, rotation_deg = 0.02, length_m = 5e-4 }}
"""


@dataclass(frozen=True)
class Shaken:
    """What the FRFs hold: gain of the sensors along x, y, z."""

    gain: tuple[float, float, float] = (1.0, 1.0, 1.0)


def equilibrium(robot: Robot, position: np.ndarray) -> fem.RobotEquilibrium:
    """The robot in the FEM at the lengths that hold a pose."""
    held = inverse(robot, position, np.eye(3))
    return solve_in_fem(OperatingPoint(robot, position, np.eye(3), held.cables), ELEMENTS)


def states_table(robot: Robot, seed: int) -> pd.DataFrame:
    """Pose, tensions and lengths at rest, with noise; no sensor hangs on the platform."""
    generator, rows = np.random.default_rng(seed), []
    for number, place in enumerate(POSES):
        rest = equilibrium(robot, place)
        position = rest.position + 5e-4 * generator.normal(size=3)
        turn = Rotation.from_rotvec(np.radians(0.02) * generator.normal(size=3)) * Rotation.from_matrix(rest.rotation)
        angles = turn.as_euler("ZYX", degrees=True)[::-1]
        for i, cable in enumerate(rest.cables):
            tension = float(np.linalg.norm(cable.end_force)) + 2.0 * generator.normal()
            length = rest.robot.cables[i].unstrained_length + 5e-4 * generator.normal()
            rows.append([f"p{number}", i + 1, *position, *angles, tension, length])
    pose = ["x_m", "y_m", "z_m", "rx_deg", "ry_deg", "rz_deg"]
    return pd.DataFrame(rows, columns=["case", "cable", *pose, "tension_N", "length_m"])


def identified(robot: Robot, number: int, made: Shaken, generator: np.random.Generator) -> Identified:
    """Modes of one FRF at a pose, x, y, z over forces along x and z."""
    found = fem.robot_modes(equilibrium(robot, POSES[number]), MODES)
    keep = (found.platform_energy > SHARE) & (found.frequencies_hz < HIGHEST)
    hertz, shapes = found.frequencies_hz[keep], found.platform_shapes[keep]
    constant = shapes[:, :3, None] * np.array(made.gain)[:, None] * shapes[:, None, [0, 2]]
    constant = constant.reshape((len(hertz), 6)) * (1.0 + NOISE["constant"] * generator.normal(size=(len(hertz), 6)))
    hertz = hertz * (1.0 + NOISE["hertz"] * generator.normal(size=len(hertz)))
    damping = DAMPING * (1.0 + NOISE["damping"] * generator.normal(size=len(hertz)))
    omega = 2.0 * np.pi * hertz
    pole = omega * (-damping + 1j * np.sqrt(1.0 - damping**2))
    residue = constant * (pole**2 / (2j * pole.imag))[:, None]
    strength, noise = np.full(len(hertz), 100.0), np.full(6, 1e-3)
    modes = Modes(
        hertz, NOISE["hertz"] * hertz, damping, NOISE["damping"] * damping, residue, strength, noise
    )  # fmt: skip
    channels = tuple(f"{respond}/{excite}" for respond in RESPOND for excite in EXCITE)
    blank, none = np.zeros(0), np.full(3, np.nan)
    record = SignalRecord("frf", f"p{number}", "frf.csv", blank, blank, channels, none, none, 0.0, np.full(8, np.nan))
    count, own = len(hertz), np.ones(len(hertz), dtype=bool)
    return Identified(
        record, modes, None, modes.hertz_sigma, (MODE,) * count, np.arange(count), own, ("",) * count, "", None
    )


def fem_campaign(folder: Path, made: Shaken, seed: int = 1) -> Campaign:
    """Static states of the thesis's robot, and FRFs with what is hidden in them."""
    robot = load_robot(ROBOT)
    states_table(robot, seed).to_csv(folder / "states.csv", index=False)
    (folder / "campaign.toml").write_text(CAMPAIGN.format(robot=ROBOT))
    campaign, generator = load_campaign(folder / "campaign.toml"), np.random.default_rng(seed + 1000)
    found = tuple(identified(robot, number, made, generator) for number in SHAKEN)
    hertz = np.concatenate([item.modes.hertz for item in found])
    sigma = np.concatenate([item.sigma for item in found])
    state = np.concatenate([np.full(len(item.modes), n) for n, item in zip(SHAKEN, found, strict=True)])
    origin = np.concatenate([[(k, i) for i in range(len(item.modes))] for k, item in enumerate(found)])
    shape = np.full((len(hertz), 6), np.nan, dtype=complex)
    rows = RobotFrequencies(state, hertz, sigma, shape, origin)
    return replace(campaign, identified=found, robot_frequencies=rows)
