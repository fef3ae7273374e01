"""What does a frequency response of 10 000 frequencies cost, against solving as many complex 6 x 6 systems?

    python -m benchmarks frf

The measure is NumPy's batched `solve` of 10 000 dense complex 6 x 6 systems with one right-hand side: the least that a
frequency response of a platform needs. Target: at most twice that, statics and cable model prepared beforehand;
their preparation is shown apart. One thread; medians of nine runs, alternating.
"""

import numpy as np

from benchmarks.markdown_page import table
from benchmarks.question import Answer, Question, paragraphs
from benchmarks.timing import medians, milliseconds
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


def answer(quick: bool) -> Answer:
    """Each model and law beside the bare solution."""
    rows, ratios = [], []
    models, damping = FrequencyResponse.params
    for model in models:
        for law in damping[:1] if quick else damping:
            case = FrequencyResponse()
            case.setup(model, law)
            given = model, law
            tasks = {
                "solve": lambda c=case, g=given: c.time_solve(*g),
                "response": lambda c=case, g=given: c.time_response(*g),
                "model": lambda c=case, g=given: c.time_model(*g),
            }
            seconds = medians(tasks, 1 if quick else RUNS)
            ratios.append(seconds["response"] / seconds["solve"])
            rows.append([model, law, *map(milliseconds, seconds.values()), f"{ratios[-1]:.2f}"])
    head = [
        "model",
        "damping",
        "bare solution [ms]",
        "response [ms]",
        "preparing the model [ms]",
        "response / solution",
    ]
    said = f"{FREQUENCIES} frequencies up to {FrequencyResponse.top:g} Hz; the largest ratio is {max(ratios):.2f}."
    return Answer(paragraphs(table(head, rows), said))


QUESTION = Question("frf", "A frequency response at 10 000 frequencies, beside solving as many 6 x 6 systems", answer)
