"""What do 60 certified eigenfrequencies with mode shapes cost, against the FEM at equal accuracy?

    python -m benchmarks.modes

From a pose to certified modes, statics included, on the 8-cable robot of Table 3.1; the FEM with as many elements as
its 60th frequency needs for a relative error of 1e-4 (measured against the exact model, printed). One thread; the runs
alternate, smallest and median of nine.
"""

import os
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import fem_reference as fem
from cdpr_struct.crosscheck.fem_robot import solve_in_fem
from cdpr_struct.dynamics.cable_dynamics import CableModel
from cdpr_struct.dynamics.certified_modes import certified_modes
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

COUNT, RUNS, ELEMENTS = 60, 9, 256


class CertifiedModes:
    """asv-shaped."""

    params = (["dsm", "exact"],)
    param_names = ("model",)

    def setup(self, model: CableModel) -> None:
        self.robot = load_robot("thesis-3-1")
        self.position, self.rotation = np.array([0.0, 0.0, 0.5]), np.eye(3)

    def rest(self) -> OperatingPoint:
        cables = inverse(self.robot, self.position, self.rotation).cables
        return OperatingPoint(self.robot, self.position, self.rotation, cables)

    def time_model(self, model: CableModel) -> None:
        certified_modes(self.rest(), model, COUNT)

    def time_fem(self, model: CableModel) -> None:
        fem.robot_modes(solve_in_fem(self.rest(), ELEMENTS), COUNT)


def main() -> None:
    """Print times and ratios, and the error of the FEM that they belong to."""
    bench = CertifiedModes()
    bench.setup("exact")
    exact = certified_modes(bench.rest(), "exact", COUNT).frequencies.hertz
    mesh = fem.robot_modes(solve_in_fem(bench.rest(), ELEMENTS), COUNT).frequencies_hz
    error = np.abs(mesh / exact - 1.0).max()
    print(f"FEM with 8 x {ELEMENTS} elements: largest error of {COUNT} frequencies {error:.1e}")
    tasks = {
        "inverse kinematics alone": bench.rest,
        "dsm": lambda: bench.time_model("dsm"),
        "exact": lambda: bench.time_model("exact"),
        "fem": lambda: bench.time_fem("exact"),
    }
    seconds: dict[str, list[float]] = {name: [] for name in tasks}
    for _ in range(RUNS):
        for name, task in tasks.items():
            start = time.perf_counter()
            task()
            seconds[name].append(time.perf_counter() - start)
    fem_median = float(np.median(seconds["fem"]))
    for name, values in seconds.items():
        median = float(np.median(values))
        ratio = fem_median / median
        print(f"{name:<26} {1e3 * min(values):8.1f} ms  median {1e3 * median:8.1f} ms  FEM / this {ratio:6.1f}")


if __name__ == "__main__":
    main()
