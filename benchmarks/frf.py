"""What does a frequency response of 10 000 frequencies cost, against solving as many complex 6 x 6 systems?

    python -m benchmarks.frf [--top HZ]

The measure is NumPy's batched `solve` of 10 000 dense complex 6 x 6 systems with one right-hand side: the least that a
frequency response of a platform needs. Target: less than five times that, statics and cable model prepared beforehand;
their preparation is shown apart. One thread; medians of nine runs, alternating.
"""

import argparse
import os
import time
from collections.abc import Callable

os.environ.setdefault("OMP_NUM_THREADS", "1")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from cdpr_struct.dynamics.cable_dynamics import CABLE_MODELS, CableModel, cable_dynamics
from cdpr_struct.dynamics.damping import DampingLaw, Hysteretic, PowerLaw, Rayleigh, Viscous
from cdpr_struct.dynamics.frequency_response import frequency_response
from cdpr_struct.dynamics.operating_point import OperatingPoint
from cdpr_struct.dynamics.ports import platform_port
from cdpr_struct.dynamics.swept_stiffness import dynamic_stiffness
from cdpr_struct.robot.robot_file import load_robot
from cdpr_struct.statics.inverse_kinematics import inverse

FREQUENCIES = 10_000
RUNS = 9


class FrequencyResponse:
    """asv-shaped: each model and law on the 8-cable robot of Table 3.1, off centre so that no two cables are alike."""

    params = (list(CABLE_MODELS), ["viscous", "hysteretic", "rayleigh", "frequency-dependent"])
    param_names = ("model", "law")
    top = 20.0

    def setup(self, model: CableModel, law: str) -> None:
        robot = load_robot("thesis-3-1")
        position, rotation = np.array([1.3, -0.8, 0.9]), np.eye(3)
        self.point = OperatingPoint(robot, position, rotation, inverse(robot, position, rotation).cables)
        self.hertz = np.linspace(self.top / FREQUENCIES, self.top, FREQUENCIES)
        self.law = laws(robot.damping_ratio)[law]
        self.port = platform_port("z", np.array([0.0, 0.0, 1.0]), False, np.zeros(3))
        self.model = model
        self.cables = cable_dynamics(self.point, model, 2.0 * np.pi * self.top)
        random = np.random.default_rng(0)
        self.matrices = random.normal(size=(FREQUENCIES, 6, 6)) + 1j * random.normal(size=(FREQUENCIES, 6, 6))
        self.sides = np.ones((FREQUENCIES, 6, 1), dtype=complex)

    def time_solve(self, model: CableModel, law: str) -> None:
        np.linalg.solve(self.matrices, self.sides)

    def time_response(self, model: CableModel, law: str) -> None:
        frequency_response(self.point, self.cables, self.law, self.port, (self.port,), self.hertz)

    def time_model(self, model: CableModel, law: str) -> None:
        cable_dynamics(self.point, self.model, 2.0 * np.pi * self.top)

    def time_every_frequency_in_full(self, model: CableModel, law: str) -> None:
        dynamic_stiffness(self.point, self.cables, self.law, 2.0 * np.pi * self.hertz)


def laws(ratio: np.ndarray) -> dict[str, DampingLaw]:
    """One of each law."""
    return {
        "viscous": Viscous(ratio),
        "hysteretic": Hysteretic(0.02),
        "rayleigh": Rayleigh(0.2, 1e-4),
        "frequency-dependent": PowerLaw(0.02, 0.5, 15.0),
    }


def milliseconds(calls: list[Callable[..., None]], arguments: tuple[str, str]) -> list[float]:
    """Median time of each call, runs alternating so that all see the same machine."""
    times = np.empty((RUNS, len(calls)))
    for run in range(RUNS):
        for column, call in enumerate(calls):
            start = time.perf_counter()
            call(*arguments)
            times[run, column] = time.perf_counter() - start
    return (1000.0 * np.median(times, axis=0)).tolist()


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--top", type=float, default=FrequencyResponse.top, help="top of the band [Hz]")
    FrequencyResponse.top = parser.parse_args().top
    print(f"{FREQUENCIES} frequencies up to {FrequencyResponse.top:g} Hz, 8 cables; times in ms")
    print(f"{'model':<8}{'law':<22}{'solve':>8}{'response':>10}{'ratio':>7}{'model':>8}{'K in full':>11}")
    for model in FrequencyResponse.params[0]:
        for law in FrequencyResponse.params[1]:
            case = FrequencyResponse()
            case.setup(model, law)  # type: ignore[arg-type]
            solve, response = milliseconds([case.time_solve, case.time_response], (model, law))
            start = time.perf_counter()
            case.time_every_frequency_in_full(model, law)  # type: ignore[arg-type]
            full = 1000.0 * (time.perf_counter() - start)
            (prepare,) = milliseconds([case.time_model], (model, law))
            print(f"{model:<8}{law:<22}{solve:8.1f}{response:10.1f}{response / solve:7.2f}{prepare:8.1f}{full:11.1f}")


if __name__ == "__main__":
    main()
