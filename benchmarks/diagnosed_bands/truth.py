"""What the finite elements say of the true robot of a blind campaign at poses that were not measured."""

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.band_coverage.fem_rest import FemRest
from cdpr_struct.fem_reference import RobotEquilibrium
from cdpr_struct.robot.pose import angles_from_rotation
from tests.blind.deviations import Deviations
from tests.blind.entered_robot import EnteredRobot, entered_robot
from tests.blind.measuring_plan import PlanSize, drawn_plan
from tests.blind.true_robot import Command, at_rest
from tests.blind.vibrations import robot_frequencies

POSES = 3
FREQUENCIES = 3
_ELEMENTS = 40  # bars a cable; frequencies are the limit of these and half as many
_SIZE = PlanSize(static_states=POSES, locks=0, frequency_states=0)


@dataclass(frozen=True, slots=True, eq=False)
class TrueRobot:
    """entered : what the owner believes;  deviations : by how much it is off;  about : the sealed record."""

    entered: EnteredRobot
    deviations: Deviations
    about: dict[str, Any]

    @classmethod
    def opened(cls, sealed: Path) -> "TrueRobot":
        """From the sealed file of a case that has been answered."""
        about = json.loads(sealed.read_text("utf-8"))["truth"]
        entered = entered_robot(about["robot"])
        none = Deviations.none(entered.cables)
        off = {name: np.asarray(value) for name, value in about["deviations"].items()}
        return cls(entered, Deviations({**none.fields, **off}), about)

    def commands(self, rng: np.random.Generator) -> tuple[Command, ...]:
        """States drawn anew."""
        return drawn_plan(self.entered, rng, self.deviations, _SIZE).statics

    def at(self, command: Command) -> FemRest:
        """Where it comes to rest there.

        Raises
        ------
        FemError : it does not.
        """
        fine, coarse = (at_rest(self.entered, self.deviations, command, n) for n in (_ELEMENTS, _ELEMENTS // 2))
        hertz = (4.0 * self._hertz(fine) - self._hertz(coarse)) / 3.0
        pull = np.array([np.linalg.norm(cable.end_force) for cable in fine.cables])
        pose = np.concatenate([fine.position, np.degrees(angles_from_rotation(fine.rotation))])
        return FemRest(pose, pull, hertz)

    def _hertz(self, rest: RobotEquilibrium) -> np.ndarray:
        return np.asarray(robot_frequencies(self.entered, self.deviations, rest)[0][:FREQUENCIES])
