"""Where do taut cables leave their pulleys, at thousands of poses at once, and what does that do to their pull?

Arrays are (cable, pose). With f the tension vector at the exit E, t and T0 its direction and size, and the notation of
`pulley.py`, a change of f moves the exit by

    dE = R t dphi + R (1 - cos phi) / sin phi e' dpsi,   dphi = n . df / T0,   dpsi = e' . df / T0,

n = cos(phi) e - sin(phi) a in the wheel's plane and e' = a x e across it. At a chord tension tau, f changes with a
motion of the exit by -K dE, so that df = f' dtau - K dE with f' its rate from a fixed point: two equations for dphi and
dpsi.
"""

from dataclasses import dataclass

import numpy as np

from cdpr_struct.robot.robot_arrays import RobotArrays
from cdpr_struct.statics.closed_cables import ClosingStep, Rates, TautGeometry
from cdpr_struct.statics.pulley import pulley_exit, straight_exit


@dataclass(frozen=True, slots=True, eq=False)
class PulleyExits:
    """Pulleys of a batch.

    offset : (3, m, n) of the platform ends from the frame anchors, world [m]
    axis   : (3, m, n), world
    radius : (m, n) [m]
    """

    offset: np.ndarray
    axis: np.ndarray
    radius: np.ndarray

    @classmethod
    def of(cls, arrays: RobotArrays, pose: TautGeometry) -> "PulleyExits | None":
        """Of cables that start at the frame anchors as yet; None where no cable runs over a pulley."""
        if not arrays.has_pulleys:
            return None
        axis = np.broadcast_to(arrays.pulley_axis, (*pose.span.T.shape, 3))
        radius = np.broadcast_to(arrays.pulley_radius, pose.span.T.shape)
        return cls(pose.offset, np.ascontiguousarray(axis.T), np.ascontiguousarray(radius.T))

    def straight(self, pose: TautGeometry) -> TautGeometry:
        """Straight cables."""
        return pose.placed(self.offset - self._exit(straight_exit(self.offset.T, self.axis.T, self.radius.T).T)[0])

    def leaving(self, pull: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Offset (3, m, n) of the platform ends from the exits, and strained length on the wheel (m, n) [m], of cables
        with tension vectors `pull` (3, m, n) at the frame, world."""
        point, angle = self._exit(pull / np.sqrt((pull**2).sum(axis=0)))
        return self.offset - point, self.radius * angle

    def _exit(self, direction: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """E less B (3, m, n) [m] and phi (m, n)."""
        exit_ = pulley_exit(direction.T, self.axis.T, self.radius.T)
        return np.ascontiguousarray(exit_.point.T), exit_.wrap_angle.T


@dataclass(frozen=True, slots=True, eq=False)
class MovingExits:
    """How exits and pulls of cables at (tau, V, L) change together.

    Vectors are (3, m, n), along the heading, across it and up.
    pull                  : tension vectors at the exits [N]
    turning, swivelling   : n / T0 and e' / T0 [1/N]
    rolled, swung         : motions of the exit [m] per dphi and dpsi
    """

    exits: PulleyExits
    pose: TautGeometry
    step: ClosingStep
    tau: np.ndarray
    pull: np.ndarray
    turning: np.ndarray
    swivelling: np.ndarray
    rolled: np.ndarray
    swung: np.ndarray

    @classmethod
    def at(
        cls, exits: PulleyExits, pose: TautGeometry, step: ClosingStep, cable: tuple[np.ndarray, np.ndarray, np.ndarray]
    ) -> "MovingExits":
        tau, vertical, length = cable
        level = tau * (pose.span / pose.chord)
        pull = np.stack([level, np.zeros_like(level), vertical - 0.5 * pose.weight * length])
        tension = np.sqrt((pull**2).sum(axis=0))
        t, axis = pull / tension, pose.in_own_axes(exits.axis)
        cos = _dot(axis, t)
        outward = t - cos * axis
        sin = np.sqrt((outward**2).sum(axis=0))
        outward = outward / sin
        aside = np.cross(axis, outward, axis=0)
        turning = (cos * outward - sin * axis) / tension
        swung = (exits.radius * (1.0 - cos) / sin) * aside
        return cls(exits, pose, step, tau, pull, turning, aside / tension, exits.radius * t, swung)

    @property
    def rates(self) -> Rates:
        """With the chord tension."""
        pose, step = self.pose, self.step
        cos, half = pose.span / pose.chord, 0.5 * pose.weight
        given = np.stack([cos, np.zeros_like(cos), step.vertical_rate - half * step.length_rate])
        moved = self._moved(given)
        pull, vertical, length = step.carried(pose, self.tau, moved)
        vertical, length = step.vertical_rate - vertical, step.length_rate - length
        return Rates(cos - pull, -self.tau / pose.chord * moved[1], vertical + half * length, vertical, length)

    def placed(self, rates: Rates, step: np.ndarray, moving: np.ndarray) -> tuple[TautGeometry, np.ndarray]:
        """Geometry after a step (m, n) of the chord tension where poses are `moving` (n,), and by how much of the chord
        that moves an exit, the most of any cable (n,)."""
        pose, half = self.pose, 0.5 * self.pose.weight
        across = np.zeros_like(step) if rates.across is None else rates.across
        change = np.stack([rates.along * step, across * step, (rates.vertical - half * rates.length) * step])
        offset, _ = self.exits.leaving(pose.pulls(*(self.pull + change)))
        missed = pose.in_own_axes(pose.offset - offset) - self._by(change)
        offset = offset - pose.pulls(*self._moved(-self._pulled(missed)))
        offset = np.where(moving, offset, pose.offset)
        moved = np.abs(offset - pose.offset).max(axis=0) / pose.chord
        return pose.placed(offset), moved.max(axis=0)

    def _by(self, change: np.ndarray) -> np.ndarray:
        """Motion of the exits with a change of the pulls."""
        return np.asarray(self.rolled * _dot(self.turning, change) + self.swung * _dot(self.swivelling, change))

    def _moved(self, given: np.ndarray) -> np.ndarray:
        """Motion of the exits by changes `given` of the pulls and what they themselves do to the pulls."""
        of_rolled, of_swung = self._pulled(self.rolled), self._pulled(self.swung)
        a, b = 1.0 + _dot(self.turning, of_rolled), _dot(self.turning, of_swung)
        c, d = _dot(self.swivelling, of_rolled), 1.0 + _dot(self.swivelling, of_swung)
        turn, swivel = _dot(self.turning, given), _dot(self.swivelling, given)
        return np.asarray(
            (self.rolled * (d * turn - b * swivel) + self.swung * (a * swivel - c * turn)) / (a * d - b * c)
        )

    def _pulled(self, moved: np.ndarray) -> np.ndarray:
        """K times a motion."""
        pull, vertical, length = self.step.carried(self.pose, self.tau, moved)
        return np.stack([pull, self.tau / self.pose.chord * moved[1], vertical - 0.5 * self.pose.weight * length])


def _dot(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return np.asarray(a[0] * b[0] + a[1] * b[1] + a[2] * b[2])
