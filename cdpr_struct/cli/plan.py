"""`cdpr-struct plan`: before measuring, what a campaign could find and what it would confuse."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import LowerBound, UpperBound, require_file
from cdpr_struct.cli.output import Output

NAME = "plan"
_STEPS = 3
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
    with output.steps(_STEPS) as progress:
        found = cs.plan(campaign, lower_bound=lower_bound, upper_bound=upper_bound, progress=progress)
    output.give(found)
    return 0
