"""`cdpr-struct diagnose`: what the simulation gets wrong, why, and what a better model gains."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Annotated, Any

import typer

from cdpr_struct.cli.executors import Scheduler, Where, Workers, check_workers
from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.many_inputs import ManyInputs, answer_all, forget, require_different, worst_code
from cdpr_struct.cli.options import LowerBound, UpperBound, read_bounds, require_file
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.cli.progress import Begin, silent
from cdpr_struct.errors import InputError

if TYPE_CHECKING:
    from cdpr_struct.diagnosis.diagnosis import Diagnosis

NAME = "diagnose"
EXAMPLES = (
    "cdpr-struct diagnose examples/table-4-4/campaign.toml --out results/table-4-4",
    "cdpr-struct diagnose examples/table-4-4/level.toml --json",
)
BUDGET_HELP = "small (10 s, half a minute where much is wrong, minutes with signals) or full."
Bounds = tuple[float | None, float | None]


def run(
    campaigns: Annotated[list[str], typer.Argument(metavar="CAMPAIGN.toml...", help="Campaign files, one or more.")],
    budget: Annotated[str, typer.Option("--budget", help=BUDGET_HELP)] = "small",
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
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
    bounds = read_bounds(lower_bound, upper_bound)
    if len(campaigns) > 1:
        return _many(tuple(campaigns), budget, bounds, (workers, scheduler), output)
    from cdpr_struct.reports.diagnose.text import result_text

    with output.steps(5) as progress:
        found, result = _diagnosed(campaigns[0], budget, bounds, progress)

    def files() -> Files:
        from cdpr_struct.reports.diagnose.page import result_files

        return result_files(found, result)

    output.deliver(result, lambda: result_text(result), files)
    return 0


def answer(campaign: str, budget: str, bounds: Bounds) -> tuple[Mapping[str, Any], Files]:
    """Result and files of one campaign."""
    from cdpr_struct.reports.diagnose.page import result_files

    found, result = _diagnosed(campaign, budget, bounds, silent)
    return result, result_files(found, result)


def _diagnosed(campaign: str, budget: str, bounds: Bounds, progress: Begin) -> "tuple[Diagnosis, dict[str, Any]]":
    from cdpr_struct.diagnosis.diagnosing import diagnosed
    from cdpr_struct.measurement.campaign_file import load_campaign
    from cdpr_struct.planning.recommendations import recommendations
    from cdpr_struct.reports.diagnose.result import result_json

    measured = load_campaign(campaign, *bounds)
    found = diagnosed(measured, budget, progress)
    progress("simulating the next measurement")
    simulated = recommendations(found)
    return found, with_extensions(result_json(found, simulated), measured.robot, NAME)


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
    forget(work, output)
    return worst_code(rows)
