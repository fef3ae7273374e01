"""What a workspace requires of each pose: `slack-margin>=50`, `cable-distance>=0.02`, `wrench-feasible`."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np

from cdpr_struct.robot.robot import Robot
from cdpr_struct.statics.inverse_kinematics import InverseSolution, inverse
from cdpr_struct.workspace.margins import NO_WRENCH, ZONE, distances, margins, stable_where_held
from cdpr_struct.workspace.quantities import pose_errors, quantity_of
from cdpr_struct.workspace.rest_columns import rest_columns
from cdpr_struct.workspace.work_list import Columns

FEASIBLE = "wrench-feasible"
HELD, STABLE = "held", "stable"
"""What every pose must be, before any requirement."""
_FORM = re.compile(r"\s*([a-z0-9-]+)\s*(>=|<=)\s*([-+0-9.eE]+)\s*")


@dataclass(frozen=True, slots=True)
class Requirement:
    """A quantity of `quantities.py` and the limit [its unit] that it must not pass.

    at_least : the limit is the smallest value that is allowed, else the largest
    """

    quantity: str
    at_least: bool
    limit: float

    @classmethod
    def read(cls, text: str) -> "Requirement":
        """Of a text like `slack-margin>=50`; `wrench-feasible` alone asks for every wrench of the set.

        Raises
        ------
        ValueError : not of this form, or a quantity that is unknown or needs the whole map; says what would be right.
        """
        if text.strip() == FEASIBLE:
            return cls(FEASIBLE, True, 1.0)
        found = _FORM.fullmatch(text)
        try:
            name, relation, limit = found.groups() if found else ("", "", "")
            value = float(limit)
        except ValueError:
            raise ValueError("give NAME>=VALUE or NAME<=VALUE, like slack-margin>=50") from None
        try:
            quantity = quantity_of(name)
        except KeyError as error:
            raise ValueError(f"a quantity of map, {error.args[0]}") from None
        if quantity.most_poses is not None:
            raise ValueError(f"{name} is followed from pose to pose; a requirement is judged at each pose alone")
        return cls(name, relation == ">=", value)

    @property
    def text(self) -> str:
        """As it is typed."""
        if self.quantity == FEASIBLE and self.limit == 1.0:
            return FEASIBLE
        return f"{self.quantity}{'>=' if self.at_least else '<='}{self.limit:g}"

    def met(self, columns: Columns) -> np.ndarray:
        """(n,) bool; not where there is no value."""
        value = columns[quantity_of(self.quantity).column]
        with np.errstate(invalid="ignore"):
            return np.asarray(value >= self.limit if self.at_least else value <= self.limit)


@dataclass(frozen=True, slots=True)
class ManyQuantities:
    """What computes several quantities at poses, from one solution of the tensions; another process may run it.

    names : of quantities;  wrenches : (w) of six numbers each, beside the load;  zone : as in `distances`
    """

    names: tuple[str, ...]
    wrenches: tuple[tuple[float, ...], ...] = NO_WRENCH
    zone: float = ZONE

    def __call__(
        self, robot: Robot, positions: np.ndarray, rotation: np.ndarray, found: InverseSolution | None = None
    ) -> Columns:
        """Their columns; `held` under the robot's load, `stable` at locked lengths."""
        solution = inverse(robot, positions, rotation, allow_unheld=True) if found is None else found
        more: dict[object, dict[str, Any]] = {
            margins: {"wrenches": self.wrenches},
            distances: {"zone": self.zone},
        }
        columns: Columns = {}
        for compute in dict.fromkeys(quantity_of(name).evaluate for name in self.names):
            takes = compute is not pose_errors
            given = (solution,) if takes else ()
            made = compute(robot, positions, rotation, *given, **more.get(compute, {}))
            good = made.pop("held") & made.pop("stable", True)
            columns |= made if takes else {name: np.where(good, value, np.nan) for name, value in made.items()}
        columns |= rest_columns(solution)
        stable = stable_where_held(robot, positions, rotation, solution)
        return {**columns, "stable": stable}


def reasons(requirements: tuple[Requirement, ...]) -> list[str]:
    """What may reject a pose, in the order in which it is asked."""
    return [HELD, STABLE, *(one.text for one in requirements)]


def failing(requirements: tuple[Requirement, ...], columns: Columns) -> np.ndarray:
    """(n, 2 + r) bool: what rejects each pose, in the order of `reasons`; a pose that is not held fails in nothing
    else, and one that is held but not stable in no requirement."""
    held, stable = columns["held"], columns["stable"]
    parts = [~held, held & ~stable, *(held & stable & ~one.met(columns) for one in requirements)]
    return np.stack(parts, axis=1)
