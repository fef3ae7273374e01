"""How do taut cables close to their end points, and how do they change with their tension?

Arrays are (cable, pose). Unknowns of a cable are its chord tension tau, with H = tau span / chord, the vertical pull V
at mid-cable and its unstrained length L. With the end tensions T0, T1 at V -+ w L / 2, S = T0 + T1 and q = w L / S the
end-point equations (2.11)-(2.12) read

    x / H = L / EA + (2 L / S) artanh(q) / q,      z = V (L / EA + 2 L / S),

which lose no digits from taut to slack.
"""

from dataclasses import dataclass, replace

import numpy as np

from cdpr_struct.statics.cable_state import STEEPEST


@dataclass(frozen=True, slots=True, eq=False)
class TautGeometry:
    """A batch, cables first: span, rise, chord, stiff (EA), weight (m, n).

    offset (3, m, n) from the start of the free cable to its platform end, world; heading (2, m, n) horizontal
    arm (3, m, n) in units of `unit` (n,); load (6, n) moments in these units
    low, high (m, n) bounds on the tension at the platform
    """

    offset: np.ndarray
    span: np.ndarray
    rise: np.ndarray
    chord: np.ndarray
    stiff: np.ndarray
    weight: np.ndarray
    heading: np.ndarray
    arm: np.ndarray
    load: np.ndarray
    low: np.ndarray
    high: np.ndarray

    def placed(self, offset: np.ndarray) -> "TautGeometry":
        """The same cables with another offset (3, m, n)."""
        x, y, rise = offset
        span = np.hypot(x, y)
        chord, level = np.hypot(span, rise), span > 0.0
        safe = np.where(level, span, 1.0)
        heading = np.stack([np.where(level, x / safe, 1.0), y / safe])
        return replace(
            self, offset=offset, span=np.maximum(span, STEEPEST * chord), rise=rise, chord=chord, heading=heading
        )

    def pulls(self, along: np.ndarray, across: np.ndarray | None, up: np.ndarray) -> np.ndarray:
        """(3, m, n), world, of parts (m, n) along the headings, across them to the left (None for none), and up."""
        x, y = self.heading
        if across is None:
            return np.stack([along * x, along * y, up])
        return np.stack([along * x - across * y, along * y + across * x, up])

    def in_own_axes(self, vectors: np.ndarray) -> np.ndarray:
        """(3, m, n) along the headings, across them and up, of world vectors (3, m, n)."""
        (x, y), (along, across, up) = self.heading, vectors
        return np.stack([x * along + y * across, x * across - y * along, up])

    def columns(self, pulls: np.ndarray) -> np.ndarray:
        """Wrenches (6, m, n) on the platform of pulls (3, m, n) on the cables' platform ends."""
        a, b, c = self.arm
        found = np.empty((6, *pulls.shape[1:]))
        x, y, z = np.negative(pulls, out=found[:3])
        found[3], found[4], found[5] = b * z - c * y, c * x - a * z, a * y - b * x
        return found


@dataclass(frozen=True, slots=True, eq=False)
class ClosingStep:
    """Cables at (tau, V, L), all (m, n): steps of V and L that close the end point, and their rates with tau.

    matrix : derivatives of the errors in x / H and z, by V and L each, and their determinant
    of_pull : derivatives of these errors by H
    """

    vertical: np.ndarray
    length: np.ndarray
    vertical_rate: np.ndarray
    length_rate: np.ndarray
    matrix: tuple[np.ndarray, ...]
    of_pull: tuple[np.ndarray, np.ndarray]

    def carried(self, pose: TautGeometry, tau: np.ndarray, moved: np.ndarray) -> tuple[np.ndarray, ...]:
        """Changes of H, V and L (m, n) with a motion of the platform end at the same chord tension.

        moved : (3, m, n) along the heading, across it and up [m]
        """
        cos, sin = pose.span / pose.chord, pose.rise / pose.chord
        x, _, z = moved
        pull = tau / pose.chord * sin * (sin * x - cos * z)
        error_x = self.of_pull[0] * pull - (cos * x + sin * z) / tau
        error_z = self.of_pull[1] * pull - z
        x_v, x_l, z_v, z_l, determinant = self.matrix
        return pull, (x_l * error_z - z_l * error_x) / determinant, (z_v * error_x - x_v * error_z) / determinant


@dataclass(frozen=True, slots=True, eq=False)
class Rates:
    """What changes with the chord tension: the pull at the platform along the heading, across it to the left and up,
    V and L, all (m, n). None across where the pull stays in the cable's plane."""

    along: np.ndarray
    across: np.ndarray | None
    up: np.ndarray
    vertical: np.ndarray
    length: np.ndarray

    @classmethod
    def from_fixed(cls, pose: TautGeometry, step: ClosingStep) -> "Rates":
        """Of cables that start at fixed points."""
        up = step.vertical_rate + 0.5 * pose.weight * step.length_rate
        return cls(pose.span / pose.chord, None, up, step.vertical_rate, step.length_rate)


def closing_step(pose: TautGeometry, tau: np.ndarray, vertical: np.ndarray, length: np.ndarray) -> ClosingStep:
    """One Newton step of the end-point equations, and the rates with tau, at (tau, V, L)."""
    cos = pose.span / pose.chord
    h, half = tau * cos, 0.5 * pose.weight * length
    v0, v1 = vertical - half, vertical + half
    t0, t1 = np.sqrt(h * h + v0 * v0), np.sqrt(h * h + v1 * v1)
    total = t0 + t1
    q = 2.0 * half / total
    share0, share1 = v0 / t0, v1 / t1
    slope = share0 + share1
    total_l = 0.5 * pose.weight * (share1 - share0)
    reach = 2.0 * length / total
    spread = reach / (1.0 - q * q)
    error_x = length / pose.stiff + reach * np.arctanh(q) / q - pose.chord / tau
    give = length / pose.stiff + reach
    error_z = vertical * give - pose.rise
    x_v, x_l = -spread * slope / total, 1.0 / pose.stiff + spread * (1.0 / length - total_l / total)
    give_v, give_l = -reach * slope / total, 1.0 / pose.stiff + 2.0 / total - reach * total_l / total
    z_v, z_l = give + vertical * give_v, vertical * give_l
    rising = h * (1.0 / t0 + 1.0 / t1) / total
    x_h, z_h = -spread * rising, -vertical * reach * rising
    x_t, z_t = pose.chord / tau**2 + x_h * cos, z_h * cos
    determinant = x_v * z_l - x_l * z_v
    return ClosingStep(
        (x_l * error_z - z_l * error_x) / determinant, (z_v * error_x - x_v * error_z) / determinant,
        (x_l * z_t - z_l * x_t) / determinant, (z_v * x_t - x_v * z_t) / determinant,
        (x_v, x_l, z_v, z_l, determinant), (x_h, z_h),
    )  # fmt: skip
