"""What a campaign's data hold, for causes to say whether they can show there."""

import numpy as np

from cdpr_struct.hypotheses.causes.cause import Seen
from cdpr_struct.observation.motion import moving
from cdpr_struct.residuals.recorded import Recorded
from cdpr_struct.robot.extensions import masts_of
from cdpr_struct.statics.masts import carriers

_AXES = ("x", "y", "z")


def seen_in(data: Recorded) -> Seen:
    """Of the static readings and frequencies of a campaign."""
    campaign, m = data.campaign, data.cables
    states = campaign.states
    kinds = {"EQ"} | ({"CO"} if data.read[:, 6 + m :].any() else set())
    kinds |= {"CF"} if campaign.cable_frequencies.hertz.size else set()
    kinds |= {"RF"} if campaign.robot_frequencies.hertz.size else set()
    kinds |= {"FA"} if data.vibrations is not None and len(data.vibrations.sizes) else set()
    return Seen(
        kinds=frozenset(kinds),
        tensions=bool(np.isfinite(states.tension).any()),
        lengths=bool(data.read[:, 6 + m :].any()),
        approach=bool(np.any(data.known.approach)),
        hours=float(np.ptp(data.known.hours)),
        cable_modes=len(set(campaign.cable_frequencies.mode.tolist())),
        states=states.names,
        highest=float(campaign.robot_frequencies.hertz.max(initial=0.0)),
        internal=data.arrays.has_internal_mass,
        swinging=data.arrays.has_swinging_mass,
        relative=campaign.relative_lengths,
        poses=bool(data.read[:, :6].any()),
        moving=bool(moving(data.known.rate).any()),
        pulling=bool(data.known.pull.any()),
        wheels=data.arrays.has_pulleys,
        bare=bool((data.arrays.pulley_radius == 0.0).any()),
        groups={
            "cable": {str(i): f"cable {i}" for i in range(1, m + 1)},
            "mast": _masts(campaign.robot.frame_anchors),
            "axis": {axis: f"axis {axis}" for axis in _AXES},
            "state": {str(i): f"case {name}" for i, name in enumerate(states.names, start=1)},
        },
    )


def _masts(frame_anchors: np.ndarray) -> dict[str, str]:
    """Names of the masts, by the cables that they carry."""
    carried = carriers(masts_of(frame_anchors))
    cables = [[str(i + 1) for i in np.flatnonzero(column)] for column in carried.T]
    return {"_".join(["mast_of", *own]): f"mast of cable{'s' * (len(own) > 1)} {', '.join(own)}" for own in cables}
