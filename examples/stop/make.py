"""SIMULATED measurement: accelerations of the platform of thesis-3-1 after an emergency stop.

    python examples/stop/make.py [DIR]

Writes acceleration.csv (time_s, ax, ay, az) to its own folder, or DIR. The motion is that of the finite-element model
of `fem_reference`, 40 bars a cable, 1 % damping in the cables, seen by an accelerometer with white noise.
"""

import sys
from pathlib import Path

import numpy as np
import pandas as pd

import cdpr_struct.fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

STOPPED = np.array([0.3, 0.1, 0.05, 0.0, 0.0, 0.0])  # m/s, rad/s just before
SECONDS, RATE, STEPS = 5.0, 100.0, 5  # s, Hz, steps of the integration a sample
NOISE = 0.02  # m/s^2, one sigma of the sensor
DAMPING, ELEMENTS, SEED = 0.01, 40, 11


def main(directory: Path) -> None:
    """Write the file."""
    robot = load_robot("thesis-3-1")
    held = inverse(robot, robot.home.position, robot.home.rotation)
    point = OperatingPoint(robot, robot.home.position, robot.home.rotation, held.cables)
    motion = fem.integrate(solve_in_fem(point, ELEMENTS), SECONDS, 1.0 / (RATE * STEPS), STOPPED, DAMPING)
    place = motion.platform[:, :3]
    acceleration = np.gradient(np.gradient(place, 1.0 / (RATE * STEPS), axis=0), 1.0 / (RATE * STEPS), axis=0)
    samples = acceleration[2 * STEPS :: STEPS]
    samples = samples + np.random.default_rng(SEED).normal(0.0, NOISE, samples.shape)
    table = pd.DataFrame(samples.round(4), columns=["ax", "ay", "az"])
    table.insert(0, "time_s", (np.arange(len(table)) / RATE).round(4))
    table.to_csv(directory / "acceleration.csv", index=False)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else Path(__file__).parent)
