"""`cdpr-struct plan`: before measuring, what a campaign could find and what it would confuse."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.options import LowerBound, UpperBound, read_bounds, require_file
from cdpr_struct.cli.output import Files, Output

NAME = "plan"
EXAMPLES = (
    "cdpr-struct plan examples/table-4-4/campaign.toml --out results/plan",
    "cdpr-struct plan examples/table-4-4/level.toml --json",
)


def run(
    campaign: Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", help="Path to a campaign file.")],
    lower_bound: LowerBound = None,
    upper_bound: UpperBound = None,
    *,
    output: Output,
) -> int:
    """Smallest detectable size of each cause, which causes look alike, and which measurement would separate them."""
    require_file(campaign)
    from cdpr_struct.measurement.campaign_file import load_campaign
    from cdpr_struct.planning.campaign_plan import STEPS, planned
    from cdpr_struct.reports.plan.result import plan_json
    from cdpr_struct.reports.plan.text import plan_text

    entered = load_campaign(campaign, *read_bounds(lower_bound, upper_bound))
    with output.steps(STEPS) as progress:
        found = planned(entered, progress)
    result = with_extensions(plan_json(found) | {"warnings": list(entered.notes)}, entered.robot, NAME)

    def files() -> Files:
        from cdpr_struct.reports.plan.page import plan_files

        return plan_files(result)

    output.deliver(result, lambda: plan_text(result), files)
    return 0
