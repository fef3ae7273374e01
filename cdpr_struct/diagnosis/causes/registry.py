"""All causes by name."""

import math
from dataclasses import replace

from cdpr_struct.diagnosis.causes import accelerometers, cables, geometry, internal_mode, platform, sensors, stiffness
from cdpr_struct.diagnosis.causes.cause import Cause
from cdpr_struct.diagnosis.residuals import Setting
from cdpr_struct.errors import InputError, known_names
from cdpr_struct.measurement.campaign import Campaign

FAMILIES = (stiffness, geometry, platform, cables, sensors, accelerometers)
LIBRARY: dict[str, Cause] = {cause.name: cause for family in FAMILIES for cause in family.CAUSES}
HANDLING = ("unit_error", "sign_error", "swapped_channels")
SHORTCUTS = ("cable_sag", "cable_dynamics", "attachment_geometric_stiffness")
NEEDS_SIGNALS = {
    "viscous_damping": "needs free decays or FRFs",
    "hysteretic_damping": "needs decays at several amplitudes",
    "coulomb_damping": "needs decays at several amplitudes",
}


def require_known(campaign: Campaign) -> None:
    """Raises `InputError` if [checked] names what is no cause."""
    known = sorted({*LIBRARY, "internal_force"})
    for name, sigma in campaign.checked.items():
        if name not in known:
            expected = f"no such cause; {known_names(name.lower(), known)}"
            raise InputError(campaign.source, f"checked.{name}", sigma, expected)


def _as_checked(campaign: Campaign, causes: list[Cause]) -> list[Cause]:
    """The causes with priors no wider than what a check beside the robot has left of them."""
    require_known(campaign)
    return [_bounded(cause, campaign.checked.get(cause.name, math.inf)) for cause in causes]


def _bounded(cause: Cause, sigma: float) -> Cause:
    """sigma : of each parameter, in its unit."""
    parameters = [replace(p, prior=min(p.prior, math.sqrt(sigma) if p.squared else sigma)) for p in cause.parameters]
    return replace(cause, parameters=tuple(parameters))


def causes_for(setting: Setting) -> tuple[list[Cause], dict[str, str]]:
    """Causes that the campaign's data can show in principle, and why not the others."""
    testable, not_testable = [], {}
    for cause in _as_checked(setting.campaign, [*LIBRARY.values(), sensors.internal_force(setting)]):
        reason = cause.needs(setting)
        if not reason and not set(cause.seen_in) & set(setting.labels.block.tolist()):
            reason = "not seen in these kinds of data"
        if reason:
            not_testable[cause.name] = reason
        else:
            testable.append(cause)
    not_testable |= NEEDS_SIGNALS
    campaign = setting.campaign
    if reason := internal_mode.needs(campaign):
        not_testable[internal_mode.NAME] = reason
    if campaign.model != "spring":
        not_testable["cable_sag"] = "the simulation under test has sagging cables"
    if campaign.model != "static" or not campaign.robot_frequencies.hertz.size:
        not_testable["cable_dynamics"] = (
            "the simulation under test has cable dynamics, or no robot frequency was measured"
        )
    if campaign.assembly == "consistent" or not campaign.robot_frequencies.hertz.size:
        not_testable["attachment_geometric_stiffness"] = "the simulation under test has this term"
    return testable, not_testable
