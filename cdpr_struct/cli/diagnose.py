"""`cdpr-struct diagnose`: what the simulation gets wrong, why, and what a better model gains."""

from collections.abc import Mapping
from typing import Annotated, Any

import typer

import cdpr_struct as cs
from cdpr_struct.cli.executors import Scheduler, Where, Workers, check_workers
from cdpr_struct.cli.many_inputs import ManyInputs, answer_all, require_different, worst_code
from cdpr_struct.cli.options import LowerBound, UpperBound, read_bounds, require_file
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.sweeping import clear_checkpoint
from cdpr_struct.errors import InputError

NAME = "diagnose"
EXAMPLES = (
    "cdpr-struct diagnose examples/table-4-4/campaign.toml --out results/table-4-4",
    "cdpr-struct diagnose examples/table-4-4/level.toml --json",
)
BUDGET_HELP = "small (10 s, half a minute where much is wrong, minutes with signals) or full."
LATER_HELP = "Campaign of the same robot, not fitted: how far its cable lengths are off, before and after."
VIRTUAL_HELP = "Predict every tension, pose and length of every state, with a 90 % band, also where nothing was read."
Bounds = tuple[float | None, float | None]


def run(
    campaigns: Annotated[list[str], typer.Argument(metavar="CAMPAIGN.toml...", help="Campaign files, one or more.")],
    budget: Annotated[str, typer.Option("--budget", help=BUDGET_HELP)] = "small",
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    later: Annotated[str | None, typer.Option("--later", metavar="CAMPAIGN.toml", help=LATER_HELP)] = None,
    virtual_sensors: Annotated[bool, typer.Option("--virtual-sensors", help=VIRTUAL_HELP)] = False,
    workers: Workers = 1,
    scheduler: Scheduler = None,
    *,
    output: Output,
) -> int:
    """Name the cause of differences between a simulation and measured data; several campaigns give a table, too."""
    if budget not in ("small", "full"):
        raise InputError("--budget", "", budget, "small or full")
    check_workers(workers, scheduler)
    for campaign in campaigns:
        require_file(campaign)
    if later is not None:
        require_file(later)
        if len(campaigns) > 1:
            raise InputError("--later", "", later, "a single campaign to diagnose")
    if virtual_sensors and len(campaigns) > 1:
        raise InputError("--virtual-sensors", "", f"{len(campaigns)} campaigns", "a single campaign to diagnose")
    bounds = read_bounds(lower_bound, upper_bound)
    if len(campaigns) > 1:
        return _many(tuple(campaigns), budget, bounds, (workers, scheduler), output)
    with output.steps(5) as progress:
        found = cs.diagnose(
            campaigns[0], budget=budget, lower_bound=bounds[0], upper_bound=bounds[1], later=later,
            virtual_sensors=virtual_sensors, progress=progress,
        )  # fmt: skip
    output.give(found)
    return 0


def answer(campaign: str, budget: str, bounds: Bounds) -> tuple[Mapping[str, Any], Files]:
    """Result and files of one campaign."""
    found = cs.diagnose(campaign, budget=budget, lower_bound=bounds[0], upper_bound=bounds[1])
    return found.answer, found.files()


def _many(campaigns: tuple[str, ...], budget: str, bounds: Bounds, where: Where, output: Output) -> int:
    """All campaigns, each with files of its own, and a table of their verdicts."""
    require_different(campaigns, "CAMPAIGN.toml")
    from cdpr_struct.measurement.campaign_sources import campaign_bytes
    from cdpr_struct.reports.diagnose import many as report
    from cdpr_struct.robot.fingerprint import fingerprint

    digests = tuple(fingerprint(campaign, campaign_bytes(campaign)) for campaign in campaigns)
    shared = fingerprint(f"{NAME} {budget} {bounds}")
    work = ManyInputs("campaigns", campaigns, campaigns, "", digests, shared, answer, (budget, bounds))
    rows = answer_all(work, where, output, report.campaign_row)
    result = {"campaigns": rows}
    output.deliver(result, lambda: report.campaigns_text(rows), lambda: report.campaigns_files(rows))
    clear_checkpoint(work, output.directory)
    return worst_code(rows)
