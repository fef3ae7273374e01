"""A campaign about the robot as entered, linearised once: the information in all of its states, or in some."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.association.detection import robot_detection
from cdpr_struct.inference.linear_model import LinearModel
from cdpr_struct.inference.scale_mixture import NoiseState
from cdpr_struct.inference.screening import Screen
from cdpr_struct.inference.soft_rows import SoftExpectation
from cdpr_struct.planning.information import Numbers
from cdpr_struct.residuals.assembled import Lists, linear_model, stacked
from cdpr_struct.residuals.layout import layout
from cdpr_struct.residuals.linearised import Local, Point, Rows, Term
from cdpr_struct.residuals.recorded import Recorded


@dataclass(frozen=True, slots=True, eq=False)
class PlannedRows:
    """Readings that are planned: rows about the robot as entered, and what every number does to them."""

    data: Recorded
    local: Local
    causes: Rows

    @classmethod
    def of(cls, data: Recorded, numbers: Numbers, instead: Mapping[str, tuple[Term, np.ndarray]]) -> "PlannedRows":
        """Of a campaign.

        Parameters
        ----------
        instead : by cause, what it does in some states (indices) in place of what it does elsewhere.

        A cause with parameters of its own in each state does nothing in new ones.
        """
        local = Local.about(data, Point.entered(data))
        parts = []
        for name, cause in numbers.causes.items():
            own = len(numbers.sigma[name])
            per_state = cause.carrier == "state" and own != len(cause.parameters) * data.states
            found = local.r.only_static(np.zeros((*local.r.static.shape, own)))
            found = found if per_state else local.columns(numbers.term(name))
            if name in instead:
                term, where = instead[name]
                found.static[where] = local.columns(term).static[where]
            parts.append(found)
        return cls(data, _with_expected_peaks(local), Rows.joined(parts))

    def information(self, states: Sequence[int] | None = None) -> np.ndarray:
        """(t + c, t + c) in all states, or in some that share no reading with others."""
        blocks = self.data.blocks
        if states is not None:
            blocks = tuple(block for block in blocks if np.isin(block, states).all())
        where = layout(replace(self.data, blocks=blocks))
        model, tolerances = linear_model(self.local, where), self.local.own_columns
        lists = Lists.of(self.local, where) if any(shelf.vibrating.size for shelf in where.shelves) else None
        count = tolerances.static.shape[-1]
        soft = None if lists is None else lists.at_point(np.zeros((count, count)))
        columns = stacked(where, Rows.joined([tolerances, self.causes]))
        return information_of(model, NoiseState.stated(model.groups), soft, columns)


def information_of(
    model: LinearModel, noise: NoiseState, soft: SoftExpectation | None, columns: Sequence[np.ndarray]
) -> np.ndarray:
    """(d, d) in a campaign's rows on the numbers whose columns (K, n, d) a stack are given, and on no others."""
    bare = LinearModel(tuple(replace(stack, X=stack.X[..., :0]) for stack in model.stacks), model.groups)
    return Screen.of(bare, noise, soft).screened(columns).gram


def _with_expected_peaks(local: Local) -> Local:
    """Lists of as many peaks as planned, at the frequencies of the modes that are most likely to be seen."""
    vibrating = local.vibrating
    if vibrating is None or vibrating.robot is None or vibrating.measured.peaks is None:
        return local
    peaks, robot = vibrating.measured.peaks, vibrating.robot
    inside = robot.mask & (robot.log_hertz > peaks.band[:, :1]) & (robot.log_hertz < peaks.band[:, 1:])
    chance = np.where(inside, robot_detection(robot.share), 0.0)
    place, present = np.zeros_like(peaks.ln_frequency), np.zeros_like(peaks.present)
    for k, count in enumerate(peaks.count):
        likely = np.argsort(-chance[k], kind="stable")[:count]
        seen = np.sort(robot.log_hertz[k, likely[chance[k, likely] > 0.0]])
        place[k, : len(seen)], present[k, : len(seen)] = seen, True
    expected = replace(peaks, ln_frequency=place, present=present)
    return replace(local, vibrating=replace(vibrating, measured=replace(vibrating.measured, peaks=expected)))
