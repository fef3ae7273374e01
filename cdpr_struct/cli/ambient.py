"""`cdpr-struct ambient`: natural frequencies and damping ratios in records of vibration under unknown forces."""

from typing import Annotated

import typer

import cdpr_struct as cs
from cdpr_struct.cli.options import require_file
from cdpr_struct.cli.output import Output

NAME = "ambient"
EXAMPLES = (
    "cdpr-struct ambient examples/ambient/campaign.toml --out results/ambient",
    "cdpr-struct ambient examples/ambient/campaign.toml --json",
)


def run(
    campaign: Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", help="Path to a campaign file.")],
    *,
    output: Output,
) -> int:
    """Natural frequencies and damping ratios in ambient records, with sigmas (extra `ambient`)."""
    require_file(campaign)
    output.give(cs.ambient(campaign))
    return 0
