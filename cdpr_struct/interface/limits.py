"""The printed validity limits themselves on trial."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from cdpr_struct.crosscheck.limits_trial import FULL_EXTENT, SMALL_EXTENT, Extent, LimitsTrial, try_limits
from cdpr_struct.interface.answering import answered, silent
from cdpr_struct.interface.arguments import real
from cdpr_struct.interface.given import Progress
from cdpr_struct.interface.result import Files, Result
from cdpr_struct.reports.audit_limits_result import cable_columns, limits_trial_json
from cdpr_struct.reports.audit_limits_text import limits_trial_text, verdict
from cdpr_struct.reports.trust_without_robot import limits_trust, with_trust

if TYPE_CHECKING:
    from cdpr_struct.reports.figures.shown import Draw


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class LimitsResult(Result):
    """The printed limits of the closed form on trial, on single cables of every kind.

    trial : errors of every cable tried, and the limits that are missing
    """

    trial: LimitsTrial

    @property
    def holds(self) -> bool:
        """Whether the printed limits keep the error within the tolerance."""
        return bool(self.trial.holds)

    @property
    def title(self) -> str:
        """What is tried."""
        return "The validity limits of the closed form, on trial"

    def text(self) -> str:
        """Tables and verdict."""
        return limits_trial_text(self.trial)

    def sentences(self) -> Sequence[str]:
        """The verdict."""
        return verdict(self.trial)

    def columns(self) -> Mapping[str, Any]:
        """Columns of cables.csv."""
        return cable_columns(self.trial)

    def figure(self) -> "tuple[Draw, tuple[float, float]]":
        """Error of the clamped frequencies over the domain."""
        from cdpr_struct.reports.figures import audit_error_map

        draw, quantity = audit_error_map.draw_error_map, "in_plane_frequency"
        return lambda figure: draw(figure, self.trial, quantity), audit_error_map.SIZE

    def files(self) -> Files:
        """Tables, figures and page."""
        from cdpr_struct.reports.audit_limits_page import limits_trial_files

        return limits_trial_files(self.trial)


@answered
def limits(
    *, small: bool = False, tolerance: float = 0.01, executor: Executor | None = None, progress: Progress = silent
) -> LimitsResult:
    """Try the printed validity limits themselves against the catenary and the FEM (`audit --limits`).

    Parameters
    ----------
    small : a coarse grid, some seconds instead of minutes
    tolerance : error that counts as a failure [-]
    executor : of `concurrent.futures` that shares the work; default: this process
    progress : called with the name of each step

    Raises
    ------
    InputError : an unusable argument.
    """
    real(tolerance, "tolerance", "give a ratio between 0 and 1, like 0.01", 0.0, 1.0)
    trial = try_limits(extent(small), tolerance, executor, progress)
    return LimitsResult(with_trust(limits_trial_json(trial), limits_trust(trial)), trial)


def extent(small: bool) -> Extent:
    """How much is tried."""
    return SMALL_EXTENT if small else FULL_EXTENT
