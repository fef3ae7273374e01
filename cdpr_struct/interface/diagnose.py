"""What the simulation gets wrong, why, and what a better model gains."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.diagnosis.diagnosing import diagnosed
from cdpr_struct.diagnosis.diagnosis import Diagnosis
from cdpr_struct.diagnosis.later_lengths import later_lengths, require_same_robot
from cdpr_struct.diagnosis.predicted_frames import PredictedFrames, predicted_frames
from cdpr_struct.errors import InputError
from cdpr_struct.hypotheses.budget import BUDGETS
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import one_of
from cdpr_struct.interface.campaigns import read_campaign, with_dropped
from cdpr_struct.interface.given import CampaignLike, Progress
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.planning.recommendations import recommendations
from cdpr_struct.reports.diagnose.recordings import later_json
from cdpr_struct.reports.diagnose.residual_table import residual_columns
from cdpr_struct.reports.diagnose.result import result_json
from cdpr_struct.reports.diagnose.text import diagnosis_sentences, result_text
from cdpr_struct.reports.diagnose.virtual_table import virtual_columns, virtual_json
from cdpr_struct.reports.extension_notes import with_extensions
from cdpr_struct.robot.robot import Robot

if TYPE_CHECKING:
    import pandas as pd

    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class DiagnoseResult(Result):
    """What a campaign says of the simulation.

    diagnosis : decision, candidates, residuals, sizes of the causes, and all else that was found
    virtual_sensors : predictions of every sensor in every state, None unless asked for
    """

    diagnosis: Diagnosis
    virtual_sensors: PredictedFrames | None = None

    @property
    def extended(self) -> Robot | None:
        """The robot with the causes that are named, for every other function; None where none is."""
        return self.diagnosis.extended

    @property
    def title(self) -> str:
        """Whose simulation."""
        return f"{self.diagnosis.campaign.robot.name}: what the simulation gets wrong"

    def text(self) -> str:
        """The verdict first, then errors, candidates and the gain."""
        return result_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """The verdict, and how far it can be relied on."""
        return diagnosis_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of residuals.csv."""
        return residual_columns(self.diagnosis)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """How probable each answer is."""
        from cdpr_struct.reports.figures import diagnose as figures

        return lambda figure: figures.draw_probabilities(figure, self.answer), figures.PROBABILITY_SIZE

    def files(self) -> Files:
        """Table, figures, extended robot and page."""
        from cdpr_struct.reports.diagnose.page import result_files

        return result_files(self.diagnosis, self.answer, self.virtual_sensors)

    def virtual_frame(self) -> "pd.DataFrame":
        """Columns of virtual_sensors.csv as a table.

        Raises
        ------
        InputError : they were not asked for.
        """
        import pandas as pd

        if self.virtual_sensors is None:
            raise InputError("virtual_sensors", "", False, "diagnose(..., virtual_sensors=True)")
        return pd.DataFrame(virtual_columns(self.virtual_sensors.own))


@answered
def diagnose(
    campaign: CampaignLike,
    *,
    budget: str = "small",
    lower_bound: float | None = None,
    upper_bound: float | None = None,
    later: CampaignLike | None = None,
    virtual_sensors: bool = False,
    progress: Progress = silent,
) -> DiagnoseResult:
    """Name the cause of differences between a simulation and measured data.

    Parameters
    ----------
    campaign : Campaign, or path of a campaign file
    budget : small or full search
    lower_bound, upper_bound : of the cable forces [N], with a path only; default: those of the robot file
    later : campaign of the same robot, not fitted, whose cable lengths are predicted at its measured poses
    virtual_sensors : predict every tension, pose and length of every state, with a band, also where nothing was read
    progress : called with the name of each step

    Raises
    ------
    InputError : an unusable argument, file, or a campaign that holds nothing that can be diagnosed.
    """
    one_of(budget, "budget", BUDGETS)
    measured = read_campaign(campaign, lower_bound, upper_bound)
    other = None if later is None else read_campaign(later, None, None)
    if other is not None:
        require_same_robot(measured, other)
    found = diagnosed(measured, budget, progress)
    progress("simulating the next measurement")
    told = with_dropped(result_json(found, recommendations(found)), measured)
    told["later_lengths"] = None if other is None else later_json(other.source, later_lengths(found, other))
    predicted = predicted_frames(found, measured, other) if virtual_sensors else None
    told["virtual_sensors"] = virtual_json(predicted)
    return DiagnoseResult(with_extensions(told, measured.robot, "diagnose"), found, predicted)
