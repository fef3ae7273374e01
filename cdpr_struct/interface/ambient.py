"""Modes of the ambient records of a campaign."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.errors import InputError
from cdpr_struct.interface.answering import answered
from cdpr_struct.interface.campaigns import read_campaign
from cdpr_struct.interface.given import CampaignLike
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.measurement.ambient_records import AmbientRecord
from cdpr_struct.reports.ambient_result import ambient_json, ambient_sentences, ambient_text, mode_columns

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class AmbientResult(Result):
    """Modes of ambient records, and the diagrams that they were chosen from."""

    records: tuple[AmbientRecord, ...]

    @property
    def title(self) -> str:
        """Whose modes."""
        return f"{self.answer['robot']}: modes in ambient records"

    def text(self) -> str:
        """Frequencies and damping ratios with their sigmas."""
        return ambient_text(self.answer)

    def sentences(self) -> Sequence[str]:
        """One sentence a record."""
        return ambient_sentences(self.answer)

    def columns(self) -> Mapping[str, Any]:
        """Columns of modes.csv."""
        return mode_columns(self.answer)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Stabilisation diagram of the first record."""
        from cdpr_struct.reports.figures import ambient as figures

        return lambda figure: figures.draw_stabilisation(figure, self.records[0]), figures.SIZE

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.ambient_page import ambient_files

        return ambient_files(self.answer, self.records)


@answered
def ambient(campaign: CampaignLike) -> AmbientResult:
    """Identify natural frequencies and damping ratios in a campaign's records of vibration under unknown forces.

    Parameters
    ----------
    campaign : Campaign, or path of a campaign file, with a measurement of the kind ambient

    Raises
    ------
    InputError : an unusable argument or file, a campaign without an ambient record, or pyOMA-2 is not installed.
    """
    entered = read_campaign(campaign, None, None)
    if not entered.ambient:
        expected = 'at least one [[measurement]] of kind = "ambient"'
        raise InputError(entered.source, "measurement", "no ambient record", expected)
    return AmbientResult(ambient_json(entered), entered.ambient)
