"""The swivelling pulley at the frame end of a cable, and how a bar behaves that comes round it.

Picture, with the axis pointing up. The cable comes from a winch below, runs up along the swivel axis and
touches the pulley at the entry point b. There it is on the inner side of the groove; the pulley's centre is at
b + R e, with e horizontal and towards the platform. The cable goes up and over the top, turns by the wrap
angle theta and leaves along a tangent:

    exit point   p = b + R (1 - cos theta) e + R sin theta a      (a: unit axis, along the incoming cable)
    tangent      t = cos theta a + sin theta e

theta = 0 goes straight on, 90 degrees leaves level, near 180 degrees hangs down at distance 2R from the axis.
The pulley is massless, swivels without friction about the line through b along a, so that its plane
follows the cable, and turns without friction, so that the tension is the same all round.

Mechanics. The only unknown is the first free node x, since the tangent from x to the pulley gives swivel, exit
and wrap angle. The potential of wrap and first bar, with W half the weight of that bar, is

    strain energy of the wrap + strain energy of the bar - weight of the bar . ((x + p) / 2 - reference),

minimised over the unstrained length s on the wrap; the bar weighs in proportion to what s leaves it, and the
reference point, the exit, makes the tension of the wrap T + W . t, that of the cable at the exit. The path length
wrap + bar changes by t . dx, the wrap angle by n . dx / l and the swivel by o . dx / rho, with (t, n, o) the tangent,
its normals in and out of the pulley's plane, l the bar's length and rho the distance of x from the axis. The gradient
is the pull T t and, where the axis leans, the force -(W . o) R (1 - cos theta) / rho o by which the swivelling
exit hands its weight on. The weight and the inertia of the cable on the pulley are neglected, its stretch counts.

Stiffness. As the cable turns by n . dx / l, the exit moves on by R n . dx / l along t, and it swings along o. The
reference follows it. That changes s, and so the force at x, but it is no work: cable that weighs nothing on the pulley
gains weight where it rolls off. So the force has no potential, and its derivative is not symmetric.
`bar_stiffness` is the symmetric part of that derivative. One effect of it is an artefact that grows as bars shrink;
`_not_softened` takes it back.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cdpr_struct.fem_reference.arrays import fixed_array
from cdpr_struct.fem_reference.errors import UndefinedSwivelError
from cdpr_struct.fem_reference.sliding_bar import SlidingBar

PARALLEL = 1e-9  # sine of the angle between cable and axis below which the pulley has no plane


@dataclass(frozen=True, eq=False)
class PulleyData:
    """Massless swivelling pulley; the frame anchor of its cable is the entry point.

    radius : R [m] of the cable's centre line in the groove
    axis   : (3,) swivel axis through the entry point, world, in the direction the incoming cable travels
    """

    radius: float
    axis: np.ndarray

    def __post_init__(self) -> None:
        if not 0.0 < self.radius < np.inf:
            raise ValueError(f"PulleyData.radius must be positive and finite, got {self.radius!r}")
        axis = fixed_array("PulleyData.axis", self.axis, (3,))
        size = float(np.linalg.norm(axis))
        if abs(size - 1.0) > 1e-9:
            raise ValueError(f"PulleyData.axis must be a unit vector, got {axis.tolist()!r} of length {size:.6g}")
        object.__setattr__(self, "axis", axis)


@dataclass(frozen=True, eq=False)
class Wrap:
    """Where a cable lies on its pulley.

    pulley, entry     : the pulley and the point b (3,) [m], world
    outward           : (3,) unit vector e from b to the pulley's centre
    angle             : theta [rad] at which the first bar leaves
    tension           : [N] of the cable on the pulley
    unstrained_length : [m] of the cable on the pulley and on the path behind it
    half_weight       : (3,) [N], half the weight of the first bar, which rides on the exit
    behind            : P [m], length of a straight path behind the entry point, see `sliding_bar.py`
    """

    pulley: PulleyData
    entry: np.ndarray
    outward: np.ndarray
    angle: float
    tension: float
    unstrained_length: float
    half_weight: np.ndarray
    behind: float = 0.0

    @property
    def arc(self) -> float:
        """Present length [m] of the cable on the pulley."""
        return self.pulley.radius * self.angle

    @property
    def center(self) -> np.ndarray:
        """Centre (3,) [m] of the pulley, world."""
        return self.entry + self.pulley.radius * self.outward

    @property
    def exit_point(self) -> np.ndarray:
        """Point (3,) [m] where the first bar leaves the pulley, world."""
        radius, angle = self.pulley.radius, self.angle
        rise = radius * np.sin(angle) * self.pulley.axis
        return np.asarray(self.entry + 2.0 * radius * np.sin(0.5 * angle) ** 2 * self.outward + rise)

    def directions(self) -> np.ndarray:
        """Rows (3, 3): tangent t at the exit, normal to it in the pulley's plane, normal of that plane."""
        axis, cosine, sine = self.pulley.axis, np.cos(self.angle), np.sin(self.angle)
        tangent = cosine * axis + sine * self.outward
        inward = cosine * self.outward - sine * axis
        return np.array([tangent, inward, np.cross(axis, self.outward)])

    def _swivel_reach(self) -> float:
        """R tan(theta / 2) [m]: how much longer the first bar seems to a swing about the axis."""
        return float(self.pulley.radius * np.tan(0.5 * self.angle))

    def swivel_share(self, bar: float) -> float:
        """How far the exit swings out of the pulley's plane per motion of the node at the bar's end; bar: l [m]."""
        return self._swivel_reach() / (bar + self._swivel_reach())

    def handed_on(self, bar: float) -> np.ndarray:
        """Force (3,) [N] that the weight riding on the exit adds at the end of a first bar of length [m]."""
        across = self.directions()[2]
        return np.asarray(self.swivel_share(bar) * (self.half_weight @ across) * across)

    def bar_stiffness(self, tension: float, free_length: float, axial_stiffness: float) -> np.ndarray:
        """Stiffness (3, 3) [N/m] felt by the first free node, entry held.

        tension [N] and unstrained length [m] of the bar alone, axial_stiffness: EA [N].
        """
        first = SlidingBar(
            tension, self.tension, free_length, self.unstrained_length, axial_stiffness, self.half_weight
        )
        bar, directions = first.bar, self.directions()
        along = first.axial_stiffness_matrix(directions[0], self.pulley.radius / bar * directions[1])
        rates = np.array([0.0, tension / bar, tension / (bar + self._swivel_reach())])
        return np.asarray(along + directions.T @ (rates[:, None] * directions) + self._riding_weight_stiffness(bar))

    def first_bar_stiffness(self, tension: float, free_length: float, axial_stiffness: float) -> np.ndarray:
        """The same for both nodes of the first bar (6, 6); the start is the held entry point."""
        matrix = np.zeros((6, 6))
        block = self.bar_stiffness(tension, free_length, axial_stiffness)
        matrix[3:, 3:] = block + self._not_softened(block)
        return matrix

    def first_bar_mass(
        self, mass: np.ndarray, tension: float, free_length: float, axial_stiffness: float
    ) -> np.ndarray:
        """Mass (6, 6) [kg] of the first bar from that of a bar with free ends: the exit moves as its end demands."""
        motion = np.vstack([self.exit_motion(tension, free_length, axial_stiffness), np.eye(3)])
        matrix = np.zeros((6, 6))
        matrix[3:, 3:] = motion.T @ mass @ motion
        return matrix

    def _not_softened(self, block: np.ndarray) -> np.ndarray:
        """Stiffness (3, 3) [N/m] that takes back a softening which only the symmetric part has.

        A motion u of the bar's end along the normal rolls off R u / l of cable, and its weight w per length adds the
        force w R u / l across the normal, along the cable and out of the plane. Motion across has no such effect on the
        force along the normal. In these two, the derivative of the force is

            [[T / l, 0], [w R / l, k]],    inverse    [[l / T, 0], [-(1 / k) w R / T, 1 / k]]:

        across the normal, a short bar gives way by 1 / k. The symmetric part has c = w R / 2 l on both sides. Without
        u, k - c c^T l / T is left, which is softer without bound as bars shrink. With c c^T l / T added, it is k again,
        and the inverse is the symmetric part of the one above, but for squares of w R / 2 T. For T / l stands what the
        block has there, which the curvature changes by half of R / radius of curvature: with T / l itself that share of
        the softening would remain. An upright pulley couples u with motion along the cable only, which shows where
        the cable is soft or something elastic is in line.
        """
        _, normal, _ = self.directions()
        turning = float(normal @ block @ normal)
        coupling = block @ normal - turning * normal
        return np.asarray(np.outer(coupling, coupling) / turning)

    def _riding_weight_stiffness(self, bar: float) -> np.ndarray:
        """Part (3, 3) [N/m] of the weight on the moving exit, together with the tension step W . t there."""
        _, normal, across = self.directions()
        radius, sine = self.pulley.radius, np.sin(self.angle)
        offset = 2.0 * radius * np.sin(0.5 * self.angle) ** 2
        distance = max(offset + bar * sine, 1e-300)
        rolled, swung = normal / bar, across / distance
        down, aside, outward = (float(self.half_weight @ way) for way in (normal, across, self.outward))
        mixed = np.outer(rolled, swung) * radius * sine - np.outer(self.outward, swung) * offset / distance
        plain = outward * offset * np.outer(swung, swung) - down * radius * np.outer(rolled, rolled)
        return np.asarray(plain - aside * (mixed + mixed.T))

    def exit_motion(self, tension: float, free_length: float, axial_stiffness: float) -> np.ndarray:
        """Motion (3, 3) of the cable at the exit per motion of the first free node.

        Across, the cable on the pulley moves with the swivel only; along, it slides as the wrap stretches.
        """
        strain = 1.0 + tension / axial_stiffness
        before = self.arc + self.behind
        slid = before / (before + free_length * strain)
        directions, swung = self.directions(), self.swivel_share(free_length * strain)
        return np.asarray(directions.T @ (np.array([slid, 0.0, swung])[:, None] * directions))


def wrapped(
    pulley: PulleyData,
    entry: np.ndarray,
    first_bar: np.ndarray,
    tension: float,
    half_weight: np.ndarray,
    axial_stiffness: float,
    behind: float = 0.0,
) -> Wrap:
    """The wrap that lets a first bar leave along the vector `first_bar` (3,), of any length.

    tension : T [N] of the first bar; half_weight : (3,) [N], half its weight; axial_stiffness : EA [N]. The
    tension at the exit prevails all along the wrap and the path of length `behind` P [m] before it, and
    (R theta + P) / (1 + T / EA) is their unstrained length.

    Raises
    ------
    UndefinedSwivelError : the cable comes straight back along the axis.
    """
    axial = float(first_bar @ pulley.axis)
    aside = first_bar - axial * pulley.axis
    reach = float(np.linalg.norm(aside))
    if reach <= PARALLEL * abs(axial):
        if axial < 0.0:
            raise UndefinedSwivelError(entry, pulley.axis)
        aside = np.cross(pulley.axis, np.eye(3)[int(np.argmin(np.abs(pulley.axis)))])
    outward = aside / np.linalg.norm(aside)
    angle = float(np.arctan2(reach, axial))
    at_exit = tension + float(half_weight @ first_bar) / float(np.linalg.norm(first_bar))
    length = (pulley.radius * angle + behind) / (1.0 + at_exit / axial_stiffness)
    return Wrap(pulley, entry, outward, angle, at_exit, length, half_weight, behind)
