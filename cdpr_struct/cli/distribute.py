"""`cdpr-struct distribute`: cable forces along a trajectory."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cdpr_struct.cli.executors import Scheduler, Where, Workers, check_workers
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.many_inputs import ManyInputs, answer_all, forget, require_different, worst_code
from cdpr_struct.cli.options import (
    LowerBound,
    Mass,
    Payload,
    RobotName,
    UpperBound,
    number,
    read_numbers,
    read_robot,
    whole_number,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.progress import Begin, silent
from cdpr_struct.cli.trajectory_input import FORMS, read_trajectory
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.trajectory_distribution import BoundRule, TrajectoryDistribution
    from cdpr_struct.robot.robot import Robot
    from cdpr_struct.statics.tension_cost import TensionCost

NAME = "distribute"
EXAMPLES = (
    "cdpr-struct distribute thesis-5 --trajectory helix --instants 301 --bound frequency --out results/forces",
    "cdpr-struct distribute thesis-5 --trajectory line:0,0,2:1,0,2.5:4 --instants 101 --compare fixed",
)
BOUNDS = ("fixed", "pose-dependent", "frequency")
COSTS = ("norm", "p-norm", "middle", "centre")
_POSITIVE = ("--b", "--longest", "--max-speed", "--max-acceleration")
MODELS = ("sagging", "spring", "ideal")
_TRAJECTORY = f"{FORMS}; or a directory of such files. May be given several times."


def run(
    robot: RobotName,
    trajectory: Annotated[list[str], typer.Option("--trajectory", metavar="T", help=_TRAJECTORY)],
    bound: Annotated[str, typer.Option("--bound", help=f"lower bound: {', '.join(BOUNDS)}")] = "pose-dependent",
    b: Annotated[
        float, typer.Option("--b", parser=number, metavar="RAD_S", help="Lowest cable frequency wanted [rad/s].")
    ] = 4.0 * math.pi,
    cost: Annotated[str, typer.Option("--cost", help=f"what is made least: {', '.join(COSTS)}")] = "norm",
    weights: Annotated[
        str | None, typer.Option("--weights", metavar="W1,..,Wm", help="Weight of each cable's square in the norm.")
    ] = None,
    power: Annotated[float, typer.Option("--power", parser=number, help="p of the p-norm, 1.1 to 6.")] = 4.0,
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    longest: Annotated[
        float, typer.Option("--longest", parser=number, metavar="M", help="Largest unstrained cable length [m].")
    ] = math.inf,
    model: Annotated[str, typer.Option("--model", help=", ".join(MODELS))] = "sagging",
    max_speed: Annotated[
        float, typer.Option("--max-speed", parser=number, metavar="M_S", help="Speed limit to check [m/s].")
    ] = math.inf,
    max_acceleration: Annotated[
        float, typer.Option("--max-acceleration", parser=number, metavar="M_S2", help="Limit to check [m/s^2].")
    ] = math.inf,
    instants: Annotated[
        int | None, typer.Option("--instants", parser=whole_number, help="Instants of a built-in trajectory or line.")
    ] = None,
    compare: Annotated[
        str | None, typer.Option("--compare", metavar="BOUND,..", help="Other lower bounds to show beside.")
    ] = None,
    payload: Payload = 0.0,
    mass: Mass = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    *,
    output: Output,
) -> int:
    """Cable forces of least cost along a trajectory, above a lower bound; several trajectories give a table, too."""
    rules = _rules(bound, compare)
    _require_positive(b, longest, max_speed, max_acceleration)
    if model not in MODELS:
        raise InputError("--model", "", model, f"one of: {', '.join(MODELS)}")
    check_workers(workers, scheduler)
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    price = _cost(cost, weights, power, machine)
    asked = Asked(machine, tuple(rules), b, longest, price, model, max_speed, max_acceleration, instants)
    paths = trajectories_of(trajectory)
    if len(paths) > 1:
        return _many(asked, trajectory, paths, f"{cost} {weights} {power}", (workers, scheduler), output)
    from cdpr_struct.reports.distribution_text import distribution_text

    with output.steps(len(rules)) as progress:
        found, result = asked.along(paths[0], progress)

    def files() -> Files:
        from cdpr_struct.reports.distribution_page import distribution_files

        return distribution_files(found)

    output.deliver(result, lambda: distribution_text(found), files)
    return 0


@dataclass(frozen=True, slots=True, eq=False)
class Asked:
    """What the options ask of every trajectory."""

    robot: "Robot"
    rules: "tuple[BoundRule, ...]"
    b: float
    longest: float
    cost: "TensionCost"
    model: str
    max_speed: float
    max_acceleration: float
    instants: int | None

    def along(self, text: str, progress: Begin) -> "tuple[list[TrajectoryDistribution], dict[str, Any]]":
        """Distributions for all lower bounds, and result.json."""
        from cdpr_struct.dynamics.trajectory_distribution import distribute_along
        from cdpr_struct.reports.distribution_result import distribution_json

        path, assumed = read_trajectory(text, self.instants)
        path.require_within(self.max_speed, self.max_acceleration)
        found = []
        for rule in self.rules:
            progress(f"{rule} bound")
            found.append(
                distribute_along(self.robot, path, rule, self.b, longest=self.longest, cost=self.cost, model=self.model)
            )
        told = distribution_json(found[0], found[1:]) | {"warnings": assumed}
        return found, with_extensions(told, self.robot, NAME, self.model)


def answer(text: str, asked: Asked) -> tuple[Mapping[str, Any], Files]:
    """Result and files of one trajectory of several."""
    from cdpr_struct.reports.distribution_page import distribution_files

    found, result = asked.along(text, silent)
    return result, distribution_files(found)


def trajectories_of(texts: Sequence[str]) -> tuple[str, ...]:
    """Every --trajectory as it is, of a directory all its CSV files.

    Raises
    ------
    InputError : a directory without CSV files.
    """
    found: list[str] = []
    for text in texts:
        files = sorted(map(str, Path(text).glob("*.csv"))) if Path(text).is_dir() else [text]
        if not files:
            raise InputError("--trajectory", "", text, "a directory with CSV files of trajectories")
        found += files
    return tuple(found)


def _many(asked: Asked, typed: Sequence[str], paths: tuple[str, ...], cost: str, where: Where, output: Output) -> int:
    """All trajectories, each with files of its own, and a table of what their forces are."""
    require_different(paths, "--trajectory")
    if asked.instants is not None and any(Path(path).is_file() for path in paths):
        raise InputError(
            "--instants", "", asked.instants, "trajectory files have their own instants; leave the option out"
        )
    from cdpr_struct.reports import distribution_many as report
    from cdpr_struct.robot.fingerprint import fingerprint

    told = (asked.rules, asked.b, asked.longest, cost, asked.model, asked.max_speed, asked.max_acceleration)
    shared = fingerprint(f"{NAME} {told} {asked.instants}", asked.robot)
    digests = tuple(fingerprint(path, Path(path).read_bytes() if Path(path).is_file() else b"") for path in paths)
    work = ManyInputs("trajectories", paths, tuple(typed), "--trajectory", digests, shared, answer, (asked,))
    rows = answer_all(work, where, output, report.trajectory_row)
    result = {"robot": asked.robot.name, "bound": asked.rules[0], "trajectories": rows}
    output.deliver(result, lambda: report.trajectories_text(result), lambda: report.trajectories_files(result))
    forget(work, output)
    return worst_code(rows)


def _require_positive(*values: float) -> None:
    for option, value in zip(_POSITIVE, values, strict=True):
        if not value > 0.0 or (option == "--b" and not value < math.inf):
            raise InputError(option, "", value, "give a number above zero")


def _rules(bound: str, compare: str | None) -> "list[BoundRule]":
    from cdpr_struct.dynamics.trajectory_distribution import BOUND_RULES

    rules: list[BoundRule] = []
    given = [("--bound", bound), *(("--compare", name) for name in (compare.split(",") if compare else ()))]
    for option, name in given:
        found = [rule for rule in BOUND_RULES if rule == name]
        if not found:
            raise InputError(option, "", name, f"one of: {', '.join(BOUNDS)}")
        rules += [rule for rule in found if rule not in rules]
    return rules


def _cost(name: str, weights: str | None, power: float, robot: "Robot") -> "TensionCost":
    from cdpr_struct.statics.tension_cost import Centre, EuclideanNorm, Middle, PowerNorm

    if name not in COSTS:
        raise InputError("--cost", "", name, f"one of: {', '.join(COSTS)}")
    if weights is not None and name != "norm":
        raise InputError("--weights", "", weights, "weights belong to --cost norm")
    if name in ("middle", "centre") and not (robot.force_max < math.inf).all():
        hint = f"--cost {name} needs a finite upper bound, here or as force_max in the robot file"
        raise InputError("--upper-bound", "", "nothing", hint)
    if name == "p-norm":
        if not 1.1 <= power <= 6.0:
            raise InputError("--power", "", power, "give a number from 1.1 to 6")
        return PowerNorm(power)
    if name != "norm":
        return Middle() if name == "middle" else Centre()
    if weights is None:
        return EuclideanNorm()
    import numpy as np

    values = np.array(read_numbers(weights, "--weights", (len(robot.cables),), "weights, one per cable"))
    if not (values > 0.0).all():
        raise InputError("--weights", "", weights, "weights must be above zero")
    return EuclideanNorm(values)
