"""What is known of every state of a campaign without error: load, approach, time, and where things refer to."""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.measurement.campaign import Campaign, States
from cdpr_struct.observation.motion import inertial, length_rates, tension_rates
from cdpr_struct.robot.robot import Robot

_SECONDS = 3600.0  # of an hour


@dataclass(frozen=True, slots=True, eq=False)
class Circumstances:
    """Of S states of a robot with m cables.

    payload (S,) [kg];  hours (S,) since the first reading with a time, 0 without
    clock (S,) : since the clocks of poses and of other readings agree [s]: since the first reading unless entered
    rate, pull (S, m, 2) : derivatives of lengths [m/s, m/s^2] and of tensions [N/s, N/s^2] as they were read
    inertial (S, 6) : acceleration of the platform's origin [m/s^2], angular acceleration [rad/s^2], world axes
    acceleration (S,) : of it what is not known [m/s^2];  all four 0 in states that are no frames of a motion
    approach (S, m) : +1 if the winch last wound in, -1 if it paid out, 0 unknown
    wrap (S, m) : right angles by which a cable that comes up from a winch below turns at its exit
    center (3,) : what a hose refers to [m];  mean_tension : what nonlinear elasticity refers to [N]
    sagging : whether cables have weight in the simulation under test
    """

    payload: np.ndarray
    hours: np.ndarray
    clock: np.ndarray
    rate: np.ndarray
    pull: np.ndarray
    inertial: np.ndarray
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
        moved, unknown = inertial(states) if frames is None else (frames.inertial, frames.acceleration)
        return cls(
            payload=states.payload,
            hours=_hours(states),
            clock=_since(states, more.clock_start if more.clock_drift else first_time(states)),
            rate=length_rates(states) if frames is None else frames.rate,
            pull=tension_rates(states) if frames is None else frames.pull,
            inertial=moved,
            acceleration=unknown,
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
        names = ("payload", "hours", "clock", "rate", "pull", "inertial", "acceleration", "approach", "wrap")
        return replace(self, **{name: getattr(self, name)[some] for name in names})


def _hours(states: States) -> np.ndarray:
    return _since(states, first_time(states)) / _SECONDS


def first_time(states: States) -> float:
    """[s] of the first reading with a time, 0 without."""
    known = states.time[np.isfinite(states.time)]
    return float(known.min()) if known.size else 0.0


def _since(states: States, start: float) -> np.ndarray:
    """(S,) [s] since a time, 0 of readings without one."""
    return np.where(np.isfinite(states.time), states.time - start, 0.0)


def _mean_tension(campaign: Campaign) -> float:
    """[N] of the readings; where none was read, of equal shares of the weight, or of what cables carry at least."""
    tension = campaign.states.tension[np.isfinite(campaign.states.tension)]
    if tension.size:
        return float(tension.mean())
    least = np.array([cable.force_min for cable in campaign.robot.cables])
    weight = campaign.robot.platform.mass * campaign.robot.gravity
    return float(np.maximum(least, weight / len(least)).mean())


def exit_turns(robot: Robot, position: np.ndarray, rotation: np.ndarray) -> np.ndarray:
    """(..., m) right angles by which a cable that comes up from a winch below turns at its exit, cables straight."""
    away = position[..., None, :] + robot.platform_anchors @ np.swapaxes(rotation, -1, -2) - robot.frame_anchors
    upward = away[..., 2] / np.linalg.norm(away, axis=-1)
    return np.asarray(np.arccos(upward) / (0.5 * np.pi))
