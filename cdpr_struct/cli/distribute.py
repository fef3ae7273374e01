"""`cdpr-struct distribute`: cable forces along a trajectory."""

import math
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cdpr_struct.cli.executors import Scheduler, Where, Workers, check_workers
from cdpr_struct.cli.many_inputs import ManyInputs, answer_all, require_different, worst_code
from cdpr_struct.cli.options import (
    Band,
    Free,
    LowerBound,
    Mass,
    Payload,
    RobotName,
    Samples,
    Temperature,
    UpperBound,
    Wrench,
    number,
    whole_number,
)
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.sweeping import clear_checkpoint
from cdpr_struct.errors import InputError
from cdpr_struct.interface.trajectory import FORMS

if TYPE_CHECKING:
    from cdpr_struct.interface.distribute import DistributeQuestion

NAME = "distribute"
EXAMPLES = (
    "cdpr-struct distribute thesis-5 --trajectory helix --instants 301 --bound frequency --out results/forces",
    "cdpr-struct distribute thesis-5 --trajectory line:0,0,2:1,0,2.5:4 --instants 101 --compare fixed",
)
BOUNDS = ("fixed", "pose-dependent", "frequency")
COSTS = ("norm", "p-norm", "middle", "centre")
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
    wrench: Wrench = None,
    temperature: Temperature = None,
    free: Free = None,
    band: Band = None,
    samples: Samples = None,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    *,
    output: Output,
) -> int:
    """Cable forces of least cost along a trajectory, above a lower bound; several trajectories give a table, too."""
    check_workers(workers, scheduler)
    from cdpr_struct.interface.distribute import distribute_question

    asked = distribute_question(
        robot, bound=bound, b=b, cost=cost, weights=weights, power=power, lower_bound=lower_bound,
        upper_bound=upper_bound, longest=longest, model=model, max_speed=max_speed,
        max_acceleration=max_acceleration, instants=instants, compare=compare or (), payload=payload, mass=mass,
        wrench=wrench, temperature=temperature, free=free, band=band, samples=samples,
    )  # fmt: skip
    paths = trajectories_of(trajectory)
    if len(paths) > 1:
        return _many(asked, trajectory, paths, f"{cost} {weights} {power}", (workers, scheduler), output)
    with output.steps(len(asked.rules)) as progress:
        found = asked.along(paths[0], progress)
    output.give(found)
    return 0


def answer(text: str, asked: "DistributeQuestion") -> tuple[Mapping[str, Any], Files]:
    """Result and files of one trajectory of several."""
    found = asked.along(text)
    return found.answer, found.files()


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


def _many(
    asked: "DistributeQuestion", typed: Sequence[str], paths: tuple[str, ...], cost: str, where: Where, output: Output
) -> int:
    """All trajectories, each with files of its own, and a table of what their forces are."""
    require_different(paths, "--trajectory")
    if asked.instants is not None and any(Path(path).is_file() for path in paths):
        raise InputError(
            "--instants", "", asked.instants, "trajectory files have their own instants; leave the option out"
        )
    from cdpr_struct.reports import distribution_many as report
    from cdpr_struct.robot.fingerprint import fingerprint

    told = (asked.rules, asked.b, asked.longest, cost, asked.model, asked.max_speed, asked.max_acceleration)
    shared = fingerprint(f"{NAME} {told} {asked.instants} {asked.free} {asked.asked}", asked.robot)
    digests = tuple(fingerprint(path, Path(path).read_bytes() if Path(path).is_file() else b"") for path in paths)
    work = ManyInputs("trajectories", paths, tuple(typed), "--trajectory", digests, shared, answer, (asked,))
    rows = answer_all(work, where, output, report.trajectory_row)
    result = {"robot": asked.robot.name, "bound": asked.rules[0], "trajectories": rows}
    output.deliver(result, lambda: report.trajectories_text(result), lambda: report.trajectories_files(result))
    clear_checkpoint(work, output.directory)
    return worst_code(rows)
