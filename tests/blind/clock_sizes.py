"""How late must a sensor be to be seen along a motion? By straight cables, for somebody who has all frames.

Two differences scatter about zero if nothing is wrong: length read less length at the pose read, and the wrench of the
tensions read less the platform's weight. A delay adds the rate of what is late; an effect of the catalogue changes what
it changes. Sizes are those of `detectability`: found beside tolerances and noise with power 0.8 at a false-alarm rate
of 0.001. Where tensions are not read, internal forces are unknown to their own size.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from tests.blind.controller import exit_points
from tests.blind.detectability import sigmas_to_find
from tests.blind.deviations import TOLERANCES
from tests.blind.entered_robot import FREEDOMS, EnteredRobot
from tests.blind.motion import Motion

TINY = 1e-4  # s, of differences in time


@dataclass(frozen=True, eq=False)
class Seen:
    """Differences of F frames as rows (F, 6 + m): wrench [N], moments over the radius, lengths [m].

    along (F, m, 3) : unit vectors from platform to frame;  arms (F, m, 3) [m]
    rates (F, m) of lengths [m/s], pulls (F, m) of tensions [N/s]
    """

    robot: EnteredRobot
    motion: Motion
    time: np.ndarray
    sigma: Mapping[str, float]
    with_tensions: bool
    along: np.ndarray
    arms: np.ndarray

    @classmethod
    def of(
        cls, robot: EnteredRobot, motion: Motion, time: np.ndarray, sigma: Mapping[str, float], with_tensions: bool
    ) -> Seen:
        """At the frames of a campaign."""
        turned = Rotation.from_rotvec(motion.at("turns", time)).as_matrix()
        arms = robot.platform_anchors @ np.swapaxes(turned, 1, 2)
        points = motion.at("position", time)[:, None] + arms
        chords = np.array([exit_points(robot, own) - own for own in points])
        along = chords / np.linalg.norm(chords, axis=-1, keepdims=True)
        return cls(robot, motion, time, sigma, with_tensions, along, arms)

    @property
    def wrenches(self) -> np.ndarray:
        """(F, 6, m) of unit tensions, moments over the radius."""
        moment = np.cross(self.arms, self.along) / self.radius
        return np.swapaxes(np.concatenate([self.along, moment], axis=-1), 1, 2)

    @property
    def radius(self) -> float:
        """[m] of the platform."""
        return float(np.linalg.norm(self.robot.platform_anchors, axis=1).mean())

    def rate(self, name: str) -> np.ndarray:
        """(F, m) derivative by time."""
        later, before = (self.motion.at(name, self.time + step) for step in (TINY, -TINY))
        return np.asarray((later - before) / (2.0 * TINY))

    def rows(self, tensions: np.ndarray, lengths: np.ndarray) -> np.ndarray:
        """(F, 6 + m) of changes of what tensions and lengths (F, m) are read."""
        wrench = np.einsum("fwm,fm->fw", self.wrenches, tensions)
        return np.concatenate([wrench if self.with_tensions else 0.0 * wrench, lengths], axis=1)

    def noise(self) -> np.ndarray:
        """(F, 6 + m, 6 + m) covariance of the rows of a frame; one where tensions are not read."""
        m = self.robot.cables
        pose = np.concatenate([self.along, np.cross(self.arms, self.along)], axis=-1)
        size = np.repeat([self.sigma["position_m"], np.radians(self.sigma["rotation_deg"])], 3)
        found = np.zeros((len(self.time), 6 + m, 6 + m))
        found[:, 6:, 6:] = (pose * size**2) @ np.swapaxes(pose, 1, 2) + self.sigma["length_m"] ** 2 * np.eye(m)
        if not self.with_tensions:
            found[:, 6:, 6:] += self._unknown_preload()
        force = self.sigma["tension_N"] ** 2 * self.wrenches @ np.swapaxes(self.wrenches, 1, 2)
        found[:, :6, :6] = force + 1e-6 * np.eye(6) if self.with_tensions else np.eye(6)
        return found

    def _unknown_preload(self) -> np.ndarray:
        """(F, m, m) covariance of lengths that are stretched by internal forces nobody read."""
        m = self.robot.cables
        if m <= FREEDOMS:
            return np.zeros((m, m))
        null = np.linalg.svd(self.wrenches)[2][:, FREEDOMS:]
        tensions, lengths = (self.motion.at(name, self.time) for name in ("tensions", "lengths"))
        stretched = null * (tensions.mean() * lengths / self.robot.axial_stiffness)[:, None]
        return np.asarray(np.swapaxes(stretched, 1, 2) @ stretched)

    def tolerances(self) -> list[np.ndarray]:
        """Rows of one sigma of each tolerance."""
        m, none = self.robot.cables, np.zeros((len(self.time), self.robot.cables))
        tensions, found = self.motion.at("tensions", self.time), []
        for i in range(m):
            own = np.zeros(m)
            own[i] = 1.0
            for axis in range(3):
                found.append(self.rows(none, np.sqrt(2.0) * TOLERANCES["anchor_m"] * self.along[..., axis] * own))
            found.append(self.rows(none, TOLERANCES["length_m"] * own + none))
            found.append(TOLERANCES["axial_stiffness"] * self.stretched() * np.append(np.zeros(6), own))
            found.append(self.rows(TOLERANCES["load_cell_gain"] * tensions * own, none))
            found.append(self.rows(TOLERANCES["load_cell_bias_N"] * own + none, none))
        return found + (self._of_the_platform() if self.with_tensions else [])

    def _of_the_platform(self) -> list[np.ndarray]:
        """Of its mass, and of its centre of mass to the sides."""
        weight, m = self.robot.gravity, self.robot.cables
        mass, mass_off = self.robot.mass, TOLERANCES["platform_mass_kg"]
        aside = mass * weight * TOLERANCES["center_of_mass_m"] / self.radius
        places = ((2, mass_off * weight), (3, aside), (4, aside))
        return [np.tile(size * (np.arange(6 + m) == row), (len(self.time), 1)) for row, size in places]

    def stretched(self) -> np.ndarray:
        """(F, 6 + m) rows of the elastic part of the lengths, by which stiffness changes them."""
        elastic = self.motion.at("tensions", self.time) / self.robot.axial_stiffness
        return self.rows(np.zeros_like(elastic), elastic * self.motion.at("lengths", self.time))

    def size(self, columns: list[np.ndarray], pattern: np.ndarray, nuisance: list[np.ndarray]) -> float:
        """Smallest detectable multiple of a pattern (d,) of changes (F, 6 + m) each, beside nuisances of one sigma."""
        sigmas = self.sigmas(np.tensordot(pattern, np.array(columns), axes=1), nuisance)
        return float(sigmas_to_find(int(np.count_nonzero(pattern))) / sigmas)

    def sigmas(self, change: np.ndarray, nuisance: list[np.ndarray]) -> float:
        """By how many sigmas a change (F, 6 + m) stands out of noise, tolerances and nuisances."""
        root = np.linalg.cholesky(self.noise())
        white = np.linalg.solve(root, np.stack([change, *self.tolerances(), *nuisance], axis=-1))
        signal, spread = white[..., 0].ravel(), white[..., 1:].reshape((change.size, -1))
        across = spread.T @ signal
        inner = np.eye(spread.shape[1]) + spread.T @ spread
        return float(np.sqrt(signal @ signal - across @ np.linalg.solve(inner, across)))
