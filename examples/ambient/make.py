"""SIMULATED measurement: two minutes of wind on a robot of six cables, seen by two accelerometers on its platform.

    python examples/ambient/make.py [DIR] [MINUTES]

Writes states.csv and ambient.csv to its own folder, or DIR. The motion is that of the finite-element model under white
random forces on the platform, 0.5 % damping in every mode. The platform in the finite-element model has 25 % more
inertia than that of six-cable-4mm, whose inertia is assumed; statics does not depend on it.
"""

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pandas as pd

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

POSITION = np.array([0.4, 0.3, 0.6])  # m
CORNER = np.array([0.12, 0.09, 0.1])  # m, of the second sensor, upright
MINUTES, RATE = 2.0, 25.0  # of the record, Hz
FORCE, MOMENT, NOISE = 1.0, 0.1, 2e-3  # N, N m, m/s^2: one sigma of the wind, and of the sensors
INERTIA, DAMPING, ELEMENTS, MODES, SEED = 1.25, 0.005, 20, 90, 4
SIGMA_TENSION, SIGMA_LENGTH = 1.0, 5e-4  # N, m


def main(directory: Path, minutes: float = MINUTES) -> None:
    """Write the files."""
    entered = load_robot("six-cable-4mm")
    robot = replace(entered, platform=replace(entered.platform, inertia=INERTIA * entered.platform.inertia))
    held = inverse(robot, POSITION, robot.home.rotation)
    mesh = solve_in_fem(OperatingPoint(robot, POSITION, robot.home.rotation, held.cables), ELEMENTS)
    generator = np.random.default_rng(SEED)
    states = pd.DataFrame({"case": "calm", "cable": np.arange(1, 7)})
    states[["x_m", "y_m", "z_m"]] = POSITION
    states["tension_N"] = (held.tensions + generator.normal(0.0, SIGMA_TENSION, 6)).round(2)
    states["length_m"] = (held.cables.total_length + generator.normal(0.0, SIGMA_LENGTH, 6)).round(5)
    states.to_csv(directory / "states.csv", index=False)
    force, count = np.repeat([FORCE, MOMENT], 3), round(60.0 * minutes * RATE)
    seen = fem.ambient_record(
        fem.robot_modes(mesh, MODES), DAMPING, force, sensors(), RATE, count, generator
    )  # fmt: skip
    seen = seen + generator.normal(0.0, NOISE, seen.shape)
    table = pd.DataFrame(seen.round(4), columns=["ax", "ay", "az", "az_corner"])
    table.insert(0, "time_s", (np.arange(count) / RATE).round(4))
    table.insert(0, "case", "calm")
    table.to_csv(directory / "ambient.csv", index=False)


def sensors() -> np.ndarray:
    """(4, 6) what the accelerometers read of the platform's motion: three axes at its origin, one at its corner."""
    return np.vstack([np.eye(3, 6), [*np.eye(3)[2], *np.cross(CORNER, np.eye(3)[2])]])


if __name__ == "__main__":
    main(
        Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent,
        float(sys.argv[2]) if len(sys.argv) > 2 else MINUTES,
    )
