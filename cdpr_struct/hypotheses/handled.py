"""Which corrections of the data are worth judging? Those that leave least of what every state says against itself.

Each state's residual is held against its readings and the tolerances; a state that is wrong for another reason costs
only so much, as it does under Student's distribution of as many degrees of freedom as stated sigmas are worth.
"""

from collections.abc import Sequence
from dataclasses import fields, replace

import numpy as np

from cdpr_struct.association.detection import SHARE_INVISIBLE
from cdpr_struct.errors import CdprError
from cdpr_struct.generated.platform import rotation as rotation_from_angles
from cdpr_struct.hypotheses.correction import Correction
from cdpr_struct.inference.scale_mixture import TAU_DEGREES
from cdpr_struct.measurement.campaign import Campaign
from cdpr_struct.observation.readings import Readings
from cdpr_struct.observation.rest import static_residuals
from cdpr_struct.residuals.assembled import FLOOR
from cdpr_struct.residuals.doubt_of_sizes import doubt_of_sizes
from cdpr_struct.residuals.linearised import Local, Point
from cdpr_struct.residuals.recorded import Recorded, recorded
from cdpr_struct.residuals.swivels import swivels
from cdpr_struct.residuals.vibrations import Vibrating

_MOST = 4  # corrections that are judged
_NOT_POSSIBLE = 1e6  # N, m: of readings that mean no robot at all
_FAR = 1.0  # of ln f: a mode that no sensor on the platform sees
_FELT = 3.0  # times what the others tell of a reading: so unsure must it be without its sensor to contradict them


def promising(data: Recorded, found: Sequence[Correction], felt: np.ndarray) -> list[Correction]:
    """The likeliest corrections, of those that are likelier than the data as they are; felt: see `readings_felt`."""
    local = Local.about(data, Point.entered(data))
    covariance = _covariance(data, local)
    now = _costs(data, covariance, [data.campaign])[0]
    prices = np.array([-one.log_prior - one.log_stretch(felt) for one in found])
    costs = _costs(data, covariance, [one.campaign for one in found]) + prices
    costs += np.array([_of_frequencies(local, one.campaign) for one in found])
    costs += np.array([_of_swivels(local, covariance, one.campaign) for one in found])
    order = np.argsort(costs, kind="stable")[:_MOST]
    return [found[i] for i in order if costs[i] + _of_sizes(local, found[i].campaign) < now]


def readings_felt(data: Recorded) -> np.ndarray:
    """(S, 6 + 2 m) bool, readings that would be missed: unread, they could contradict what else was read.

    The orientation of a point mass, say, changes nothing else.
    """
    local = Local.about(data, Point.entered(data))
    root = np.linalg.inv(np.linalg.cholesky(_covariance(data, local)))
    seen = np.linalg.norm(root @ local.by_noise.static, axis=1)
    return np.asarray(data.read & (seen * data.unread > _FELT * data.sigma))


def _covariance(data: Recorded, local: Local) -> np.ndarray:
    """(S, 6 + m, 6 + m) of each state's residual by readings and tolerances."""
    size = np.where(data.read, 1.0, data.unread / data.sigma)
    noise = local.by_noise.static * size[:, None, :]
    tolerance = local.own_columns.static
    floor = np.diag(np.repeat(np.square(FLOOR[:2]), (6, data.cables)))  # moments of a point mass are no question
    return np.asarray(noise @ np.swapaxes(noise, 1, 2) + tolerance @ np.swapaxes(tolerance, 1, 2) + floor)


def _costs(data: Recorded, covariance: np.ndarray, campaigns: Sequence[Campaign]) -> np.ndarray:
    """(B,) minus ln of the density of all states, each Student's; estimates of what nobody read stay."""
    readings = [_readings(data, campaign) for campaign in campaigns]
    r = _residuals_of(data, readings)
    for i, campaign in enumerate(campaigns):
        if campaign.states.payload is not data.campaign.states.payload:
            known = replace(data.known, payload=campaign.states.payload)
            r[i] = static_residuals(data.arrays, readings[i], known, data.radius)
    root = np.linalg.inv(np.linalg.cholesky(covariance))
    square = ((root @ r[..., None]) ** 2).sum(axis=(-2, -1))
    return np.asarray(0.5 * (TAU_DEGREES + r.shape[-1]) * np.log1p(square / TAU_DEGREES).sum(axis=-1))


def _residuals_of(data: Recorded, readings: Sequence[Readings]) -> np.ndarray:
    """(B, S, 6 + m); infinite of readings that mean no robot at all, as forces that would break its masts."""
    whole = Readings(*(np.stack([getattr(one, f.name) for one in readings]) for f in fields(Readings)))
    try:
        return np.array(static_residuals(data.arrays, whole, data.known, data.radius))
    except CdprError:
        return np.array([_residuals_or_none(data, one) for one in readings])


def _residuals_or_none(data: Recorded, readings: Readings) -> np.ndarray:
    try:
        return static_residuals(data.arrays, readings, data.known, data.radius)
    except CdprError:
        return np.full((data.states, 6 + data.cables), _NOT_POSSIBLE)


def _of_frequencies(local: Local, campaign: Campaign) -> float:
    """Change of minus ln of the density of frequencies, each Student's about its mode; a peak's is the nearest."""
    own = local.data.campaign
    if local.vibrating is None or (
        campaign.cable_frequencies is own.cable_frequencies and campaign.robot_frequencies is own.robot_frequencies
    ):
        return 0.0
    return _apart(local, local.vibrating, campaign) - _apart(local, local.vibrating, own)


def _apart(local: Local, vibrating: Vibrating, campaign: Campaign) -> float:
    """Minus ln of the density, modes being as sure as the tolerances let them be."""
    rows, peaks, robot = campaign.cable_frequencies, campaign.robot_frequencies, vibrating.robot
    variance = (rows.sigma / rows.hertz) ** 2 + (local.own_columns.cables**2).sum(axis=1)
    costs = [_student((np.log(rows.hertz) - vibrating.cables.log_hertz) ** 2, variance)]
    if robot is not None:
        state = np.searchsorted(vibrating.measured.states, peaks.state)
        visible = (robot.mask & (robot.share > SHARE_INVISIBLE))[state]
        square = np.where(visible, (np.log(peaks.hertz)[:, None] - robot.log_hertz[state]) ** 2, _FAR**2)
        spread = (local.own_columns.robot**2).sum(axis=-1)[state]
        costs.append(_student(square, (peaks.sigma / peaks.hertz)[:, None] ** 2 + spread).min(axis=1))
    return float(np.concatenate(costs).sum())


def _of_sizes(local: Local, campaign: Campaign) -> float:
    """Change of minus ln of the density of modal constants, each Student's about what the model has in its place."""
    if not len(local.r.sizes) or campaign.robot_frequencies is local.data.campaign.robot_frequencies:
        return 0.0
    data = recorded(campaign)
    costs = []
    for there in (Local.about(data, Point.entered(data)), local):
        assert there.vibrating is not None
        sizes = there.vibrating.measured.sizes
        own = sizes.sigma**2 + sizes.common**2 + doubt_of_sizes(there) ** 2 + (there.own_columns.sizes**2).sum(axis=1)
        costs.append(float(_student(there.r.sizes**2, own).sum()))
    return costs[0] - costs[1]


def _student(square: np.ndarray, variance: np.ndarray) -> np.ndarray:
    """Minus ln of Student's density, but for a constant."""
    freedom = TAU_DEGREES
    return np.asarray(0.5 * (freedom + 1.0) * np.log1p(square / (freedom * variance)) + 0.5 * np.log(variance))


def _of_swivels(local: Local, covariance: np.ndarray, campaign: Campaign) -> float:
    """Change of minus ln of the density of swivel angles, each Student's about what all else says of it."""
    data = local.data
    if campaign.states.swivel is data.campaign.states.swivel:
        return 0.0
    there = local.nearby.swivels(data.arrays, data.readings, data.swivels.reference)
    shift, variance = _swivels_expected(local, covariance)
    costs = []
    for own in (swivels(campaign, data.arrays, data.known, data.readings), data.swivels):
        square = (own.missed(there) - shift) ** 2 / (own.sigma**2 + variance)
        costs.append(0.5 * (TAU_DEGREES + 1.0) * float(np.log1p(square / TAU_DEGREES).sum()))
    return costs[0] - costs[1]


def _swivels_expected(local: Local, covariance: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(w,) by how much swivel angles should be missed, and the variance of that, given the residuals of their states.

    covariance (S, 6 + m, 6 + m) of these
    """
    data, at = local.data, local.data.swivels.state
    size = np.where(data.read, 1.0, data.unread / data.sigma)[at]
    own = np.hstack([local.by_noise.swivels * size, local.own_columns.swivels[:, : -data.cables]])  # zeros are gone
    static = [local.by_noise.static[at] * size[:, None], local.own_columns.static[at][..., : -data.cables]]
    cross = np.einsum("wrd,wd->wr", np.concatenate(static, axis=-1), own)
    gain = np.linalg.solve(covariance[at], cross[..., None])[..., 0]
    variance = (own**2).sum(axis=1) - (gain * cross).sum(axis=1)
    return (gain * local.r.static[at]).sum(axis=1), np.maximum(variance, 0.0)


def _readings(data: Recorded, campaign: Campaign) -> Readings:
    """The readings of a corrected campaign, filled as those recorded."""
    states, own = campaign.states, data.readings
    turn = own.rotation
    if states.angles is not data.campaign.states.angles:
        read = np.isfinite(states.angles).all(axis=1)[:, None, None]
        turned = np.array([rotation_from_angles(*angles) for angles in np.nan_to_num(states.angles)])
        turn = np.where(read, turned, own.rotation)
    position, tension, length = (
        np.where(np.isfinite(new), new, old)
        for new, old in ((states.position, own.position), (states.tension, own.tension), (states.length, own.length))
    )
    return Readings(position, turn, tension, length)
