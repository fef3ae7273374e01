"""Before measuring, what a campaign could find and what it would confuse."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.campaigns import read_campaign, with_dropped
from cdpr_struct.interface.given import CampaignLike, Progress
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.planning.campaign_plan import Plan, planned
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.reports.plan.result import detectable_columns, plan_json
from cdpr_struct.reports.plan.text import plan_sentences, plan_text

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class PlanResult(Result):
    """A campaign's promise.

    campaign : as planned;  promise : detectable sizes, confusions, and measurements that would help
    """

    campaign: Campaign
    promise: Plan

    @property
    def title(self) -> str:
        """Whose plan."""
        return f"{self.campaign.robot.name}: what the campaign can find"

    def text(self) -> str:
        """Smallest sizes, confusions, and next measurements."""
        return plan_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """What would be found and confused, and what to measure next."""
        return plan_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of detectable.csv."""
        return detectable_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """What one more measurement would be worth.

        Raises
        ------
        InputError : no measurement would help, so there is nothing to draw.
        """
        from cdpr_struct.reports.figures import plan as figures

        if not self.answer["next"]:
            raise InputError("campaign", "", self.campaign.source, "no measurement would help: nothing to draw")
        return lambda figure: figures.draw_gains(figure, self.answer), figures.gain_size(self.answer)

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.plan.page import plan_files

        return plan_files(self.answer)


@answered
def plan(
    campaign: CampaignLike,
    *,
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    progress: Progress = silent,
) -> PlanResult:
    """Tell before measuring which causes a campaign can find, which it confuses, and what to measure next.

    Parameters
    ----------
    campaign : Campaign, or path of a campaign file; a template that is not filled stands for what it predicts
    lower_bound, upper_bound : of the cable forces [N], with a path only; default: those of the robot file
    progress : called with the name of each step

    Raises
    ------
    InputError : an unusable argument, file, or a campaign that holds nothing that can be diagnosed.
    """
    entered = read_campaign(campaign, lower_bound, upper_bound, planned=True)
    found = planned(entered, progress)
    told = with_dropped(plan_json(found) | {"warnings": list(entered.notes)}, entered)
    return PlanResult(with_extensions(told, entered.robot, "plan"), entered, found)
