"""`cdpr-struct distribute`: cable forces along a trajectory."""

import math
from typing import TYPE_CHECKING, Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
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
from cdpr_struct.cli.trajectory_input import FORMS, read_trajectory
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.dynamics.trajectory_distribution import BoundRule
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


def run(
    robot: RobotName,
    trajectory: Annotated[str, typer.Option("--trajectory", metavar="T", help=FORMS)],
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
    *,
    output: Output,
) -> int:
    """Cable forces of least cost along a trajectory, above a lower bound."""
    rules = _rules(bound, compare)
    _require_positive(b, longest, max_speed, max_acceleration)
    if model not in MODELS:
        raise InputError("--model", "", model, f"one of: {', '.join(MODELS)}")
    machine = read_robot(robot, payload, mass, lower_bound, upper_bound)
    price = _cost(cost, weights, power, machine)
    path, assumed = read_trajectory(trajectory, instants)
    path.require_within(max_speed, max_acceleration)
    from cdpr_struct.dynamics.trajectory_distribution import distribute_along
    from cdpr_struct.reports.distribution_result import distribution_json
    from cdpr_struct.reports.distribution_text import distribution_text

    found = []
    with output.steps(len(rules)) as progress:
        for rule in rules:
            progress(f"{rule} bound")
            found.append(distribute_along(machine, path, rule, b, longest=longest, cost=price, model=model))
    told = distribution_json(found[0], found[1:]) | {"warnings": assumed}
    result = with_extensions(told, machine, NAME, model)

    def files() -> Files:
        from cdpr_struct.reports.distribution_page import distribution_files

        return distribution_files(found)

    output.deliver(result, lambda: distribution_text(found), files)
    return 0


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
