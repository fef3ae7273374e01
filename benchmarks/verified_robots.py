"""Does the FEM confirm the models, for robots of every kind?

    python -m benchmarks verified-robots

`verify` as it is typed, for the built-in robots, the example with pulleys, six random robots, a facade, and models of
CASPR if they are there (`CDPR_EXTERNAL_DATA` names the folder that holds `caspr/`; they are not part of this project).
"""

import os
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

import cdpr_struct as cs
from benchmarks.markdown_page import table
from benchmarks.question import Answer, Question, paragraphs
from cdpr_struct.errors import CdprError
from cdpr_struct.interface.verify import VerifyResult
from cdpr_struct.reports.verification_verdict import EFFECT_WORDS, percent, worst
from cdpr_struct.robot.cable import Cable, Pulley
from cdpr_struct.robot.caspr_import import Choices, import_caspr
from cdpr_struct.robot.platform import Platform
from cdpr_struct.robot.pose import Pose
from cdpr_struct.robot.robot import Robot
from cdpr_struct.robot.robot_file import load_robot, robot_of_text
from tests.random_robots import random_robot

BUILT_IN = ("thesis-3-1", "thesis-3-1-8mm", "six-cable-4mm", "six-cable-8mm", "cogiro", "thesis-5")
RANDOM = 6
CASPR_FORCE = (
    20.0  # N: of a robot with cables from above and below, minimum norm with a bound of zero leaves some slack
)
_ROOT = Path(__file__).parents[1]


@dataclass(frozen=True)
class Case:
    """A robot, and the least cable force [N] with which it is held if that is not the file's."""

    name: str
    robot: Robot | str
    lower_bound: float | None = None

    def verified(self, modes: int = 60) -> VerifyResult:
        """What `verify` says."""
        return cs.verify(self.robot, lower_bound=self.lower_bound, modes=modes)


def cases() -> Iterator[Case]:
    """All robots."""
    yield from (Case(name, name) for name in BUILT_IN)
    yield Case("thesis-5, minimum norm: lower cables hang", "thesis-5", 0.0)
    yield Case("box-robot, with pulleys", load_robot(_ROOT / "examples" / "box-robot" / "robot.toml"))
    cogiro, drawn = load_robot("cogiro"), random_robot(np.random.default_rng(3))
    yield Case("cogiro, pulleys of 60 mm with level axes", with_pulleys(cogiro, 0.06, [1.0, 0.0, 0.0]))
    yield Case("random robot 3, pulleys of 50 mm with leaning axes", with_pulleys(drawn, 0.05, [0.6, 0.0, 0.8]))
    yield from random_cases()
    yield Case("facade, taut", facade(), 2000.0)
    yield Case("facade, minimum norm: lower cables hang", facade())
    yield from caspr_cases()


def with_pulleys(robot: Robot, radius: float, axis: list[float]) -> Robot:
    """The robot with a swivelling pulley at every frame anchor."""
    return replace(robot, pulleys=tuple(Pulley(radius, np.array(axis)) for _ in robot.cables))


def random_cases() -> Iterator[Case]:
    """The first random robots that their cables can hold level at their home pose, stable."""
    found, seed = 0, 0
    while found < RANDOM:
        case = Case(f"random robot {seed}", random_robot(np.random.default_rng(seed)))
        try:
            stable = cs.inverse(case.robot).answer["stable"]
        except CdprError:
            stable = False
        found, seed = found + bool(stable), seed + 1
        if stable:
            yield replace(case, name=f"{case.name}, {len(random_robot(np.random.default_rng(seed - 1)).cables)} cables")


def facade() -> Robot:
    """500 kg on eight steel ropes of 12 mm before a facade 30 m wide and 40 m high."""
    signs = np.array([[x, y, z] for z in (1.0, -1.0) for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    return Robot(
        name="facade",
        platform=Platform(500.0, np.zeros(3), np.diag([250.0, 420.0, 420.0])),
        cables=(Cable(7e6, 0.6),) * 8,
        platform_anchors=signs * [1.5, 0.5, -0.75],
        frame_anchors=signs * [15.0, 2.0, 20.0] + [0.0, 0.0, 20.0],
        home=Pose(np.array([0.0, 0.0, 20.0]), np.zeros(3)),
    )


def caspr_cases() -> Iterator[Case]:
    """CASPR's models of CoGiRo and IPAnema, where they are."""
    folder = Path(os.environ.get("CDPR_EXTERNAL_DATA", _ROOT.parents[1] / "shared" / "external")) / "caspr"
    for name, bound in (("CoGiRo", None), ("IPAnema_1", CASPR_FORCE)):
        paths = [folder / f"{name}_{part}.xml" for part in ("bodies", "cables")]
        if all(path.exists() for path in paths):
            texts = [path.read_text("utf-8") for path in paths]
            made = import_caspr(*texts, *(path.name for path in paths), Choices())
            yield Case(f"{name}, from CASPR", robot_of_text(made.text, name), bound)


HEAD = [
    "robot", "force bound [N]", "exact model", "largest deviation", "FEM certain to", "elements per cable",
    "closed-form DSM", "largest deviation", "cause",
]  # fmt: skip


def row(case: Case, modes: int = 60) -> list[str]:
    """One line of the table."""
    trial = case.verified(modes).trial
    exact, closed = trial.agreement("exact"), trial.agreement("dsm")
    bounds = sorted({f"{cable.force_min:g}" for cable in trial.point.entered.cables})
    causes = " + ".join(EFFECT_WORDS[cause.effect] for cause in trial.causes.get("dsm", ()))
    return [
        case.name, " to ".join(bounds), exact.status, percent(worst(exact)), percent(trial.fem_uncertainty),
        str(trial.elements[-1]), closed.status, percent(worst(closed)), causes or "-",
    ]  # fmt: skip


def answer(quick: bool) -> Answer:
    """Verdicts on all robots; quick: on two, and few modes."""
    asked = list(cases())
    rows = [row(case, 8) for case in asked[:2]] if quick else [row(case) for case in asked]
    said = (
        f"{8 if quick else 60} eigenfrequencies each, at the home pose. The exact model must meet the FEM within "
        "0.01 %, "
        "the closed form within 1 %. The bound is that of the cable forces; without one, cables of minimum norm may "
        "hang. Elements: where the FEM stopped to refine itself."
    )
    absent = [] if any("CASPR" in case.name for case in asked) else ["CASPR's models are not there: two rows less."]
    return Answer(paragraphs(said, table(HEAD, rows), *absent))


QUESTION = Question("verified-robots", "Does the FEM confirm the models, for robots of every kind?", answer)
