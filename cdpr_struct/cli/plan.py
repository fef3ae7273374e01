"""`cdpr-struct plan`: before measuring, what a campaign could find and what it would confuse."""

from typing import Annotated

import typer

from cdpr_struct.cli.extension_notes import with_extensions
from cdpr_struct.cli.options import Json, Out
from cdpr_struct.cli.output import emit, result_json, write_files

NAME = "plan"


def run(
    campaign: Annotated[str, typer.Argument(metavar="CAMPAIGN.toml", help="Path to a campaign file.")],
    out: Out = None,
    json: Json = False,
) -> int:
    """Smallest detectable size of each cause, and which causes would be taken for each other."""
    from cdpr_struct.diagnosis.diagnose import BUDGETS, prepare
    from cdpr_struct.measurement.campaign_file import load_campaign
    from cdpr_struct.reports.diagnosis_plan import plan_json, plan_text

    planned = load_campaign(campaign)
    prepared = prepare(planned, BUDGETS["small"])
    result = with_extensions(plan_json(prepared.ground, prepared.not_testable), planned.robot, NAME)
    emit(result, json, lambda: print(plan_text(result)))
    if out is not None:
        write_files(out, {"result.json": result_json(result)})
    return 0
