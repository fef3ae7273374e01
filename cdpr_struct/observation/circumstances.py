"""What is known of every state of a campaign without error: load, approach, time, and where things refer to."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.measurement.campaign import Campaign, States
from cdpr_struct.observation.motion import accelerations, length_rates
from cdpr_struct.robot.robot import Robot

_SECONDS = 3600.0  # of an hour


@dataclass(frozen=True, slots=True, eq=False)
class Circumstances:
    """Of S states of a robot with m cables.

    payload (S,) [kg];  hours (S,) since the first reading with a time, 0 without
    rate (S, m, 2) : derivatives of the encoders' lengths [m/s, m/s^2], acceleration (S,) : of the platform [m/s^2]; 0
    in states that are no frames of a motion
    approach (S, m) : +1 if the winch last wound in, -1 if it paid out, 0 unknown
    wrap (S, m) : right angles by which a cable that comes up from a winch below turns at its exit
    center (3,) : what a hose refers to [m];  mean_tension : what nonlinear elasticity refers to [N]
    sagging : whether cables have weight in the simulation under test
    """

    payload: np.ndarray
    hours: np.ndarray
    rate: np.ndarray
    acceleration: np.ndarray
    approach: np.ndarray
    wrap: np.ndarray
    center: np.ndarray
    mean_tension: float
    sagging: bool = True

    @classmethod
    def of(cls, campaign: Campaign, rotation: np.ndarray, position: np.ndarray) -> "Circumstances":
        """At poses (S, 3), (S, 3, 3) near the measured ones."""
        states, more, frames = campaign.states, campaign.robot.extensions, campaign.frames
        return cls(
            payload=states.payload,
            hours=_hours(states),
            rate=length_rates(states) if frames is None else frames.rate,
            acceleration=accelerations(states) if frames is None else frames.acceleration,
            approach=np.where(np.isfinite(states.approach), states.approach, 0.0),
            wrap=exit_turns(campaign.robot, position, rotation),
            center=more.hose_center if more.hose else position.mean(axis=0),
            mean_tension=more.reference_tension
            if more.nonlinearity or more.stiffening_exponent
            else _mean_tension(campaign),
            sagging=campaign.model != "spring",
        )

    @property
    def model(self) -> str:
        """Name of the cable model of the simulation under test."""
        return "sagging" if self.sagging else "spring"

    def at(self, some: np.ndarray) -> "Circumstances":
        """Those of some states."""
        names = ("payload", "hours", "rate", "acceleration", "approach", "wrap")
        return replace(self, **{name: getattr(self, name)[some] for name in names})


def _hours(states: States) -> np.ndarray:
    known = np.isfinite(states.time)
    if not known.any():
        return np.zeros(len(states.time))
    return np.where(known, (states.time - np.nanmin(states.time)) / _SECONDS, 0.0)


def _mean_tension(campaign: Campaign) -> float:
    """[N] of the readings, or of equal shares of the weight where none was read."""
    tension = campaign.states.tension[np.isfinite(campaign.states.tension)]
    weight = campaign.robot.platform.mass * campaign.robot.gravity
    return float(tension.mean()) if tension.size else weight / len(campaign.robot.cables)


def exit_turns(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(..., m) right angles by which a cable that comes up from a winch below turns at its exit, cables straight."""
    away = position[..., None, :] + robot.platform_anchors @ np.swapaxes(rotation, -1, -2) - robot.frame_anchors
    upward = away[..., 2] / np.linalg.norm(away, axis=-1)
    return np.asarray(np.arccos(upward) / (0.5 * np.pi))
