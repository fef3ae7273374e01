"""`cdpr-struct diagnose`: what the simulation gets wrong, why, and what a better model gains."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.options import LowerBound, UpperBound, read_bounds, require_file
from cdpr_struct.cli.output import Files, Output
from cdpr_struct.errors import InputError

NAME = "diagnose"
EXAMPLES = (
    "cdpr-struct diagnose examples/table-4-4/campaign.toml --out results/table-4-4",
    "cdpr-struct diagnose examples/table-4-4/level.toml --json",
)
BUDGET_HELP = "small (10 s, half a minute where much is wrong, minutes with signals) or full."


def run(
    campaign: Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", help="Path to a campaign file.")],
    budget: Annotated[str, typer.Option("--budget", help=BUDGET_HELP)] = "small",
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    *,
    output: Output,
) -> int:
    """Name the cause of differences between a simulation and measured data."""
    if budget not in ("small", "full"):
        raise InputError("--budget", "", budget, "small or full")
    require_file(campaign)
    from cdpr_struct.diagnosis.diagnosing import diagnosed
    from cdpr_struct.measurement.campaign_file import load_campaign
    from cdpr_struct.planning.recommendations import recommendations
    from cdpr_struct.reports.diagnose.result import result_json
    from cdpr_struct.reports.diagnose.text import result_text

    measured = load_campaign(campaign, *read_bounds(lower_bound, upper_bound))
    with output.steps(5) as progress:
        found = diagnosed(measured, budget, progress)
        progress("simulating the next measurement")
        simulated = recommendations(found)
    result = with_extensions(result_json(found, simulated), measured.robot, NAME)

    def files() -> Files:
        from cdpr_struct.reports.diagnose.page import result_files

        return result_files(found, result)

    output.deliver(result, lambda: result_text(result), files)
    return 0
