"""The first bar of a cable that slides through its start, and what stretches in line behind it.

Behind the start, an exit that lets the cable slide, the cable goes on along a path of fixed length P: a dead piece to
a winch, and the piece on a pulley. The same tension prevails there. The only unknown beside the first free node is
the unstrained length s behind the start, over which the strain energy of both pieces, less the work of the bar's
weight, is minimised; the bar weighs in proportion to what s leaves it, as `pulley.py` says. A spring of compliance c
in line is such a path of the length c EA: under T both let c T of cable pass, strained as T strains it.

A held point keeps its height, and what slides out there weighs w . t per length: the start gives way along the bar by
c / (1 - c w . t). On a pulley the exit moves along the cable as that rolls on, and with it the place to which the bar's
weight refers. That acts on s, but nothing acts back: the symmetric part of it is taken.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cdpr_struct.fem_reference.arrays import fixed_array


@dataclass(frozen=True, eq=False)
class SlidingBar:
    """A first bar at rest.

    tension, tension_behind      : [N] of the bar and of what lies behind its start
    free_length, behind          : unstrained lengths [m] of both
    axial_stiffness, half_weight : EA [N]; half the weight of the bar (3,) [N]
    """

    tension: float
    tension_behind: float
    free_length: float
    behind: float
    axial_stiffness: float
    half_weight: np.ndarray

    @property
    def strain(self) -> float:
        """1 + T / EA of the bar."""
        return 1.0 + self.tension / self.axial_stiffness

    @property
    def bar(self) -> float:
        """Present length [m] of the bar."""
        return self.free_length * self.strain

    def axial_stiffness_matrix(self, tangent: np.ndarray, wound: np.ndarray) -> np.ndarray:
        """Stiffness (3, 3) [N/m] at the end of the bar against stretching it and what lies behind, weight included.

        tangent : (3,) along the bar;  wound : (3,) rate at which the path behind grows as that end moves
        """
        strain, on = self.strain, 1.0 + self.tension_behind / self.axial_stiffness
        lengthened = tangent - wound
        soft = strain**2 * self.behind + on**2 * self.free_length
        path = on * lengthened + strain * wound
        sliding = (strain * self.behind * lengthened - on * self.free_length * wound) / soft
        down = float(self.half_weight @ tangent)
        weight = (self.half_weight + down * wound) / self.free_length
        gained = np.outer(weight, sliding) + np.outer(sliding, weight)
        gained -= down / self.free_length * (np.outer(sliding, wound) + np.outer(wound, sliding))
        gained += np.outer(weight, weight) * self.behind * self.free_length / (self.axial_stiffness * soft)
        return np.asarray(self.axial_stiffness / soft * np.outer(path, path) - gained)


@dataclass(frozen=True, eq=False)
class Eyelet:
    """A held point through which a cable slides, with a straight path behind it; it may ride on a mast.

    exit_point        : (3,) [m], world
    behind            : P [m], length of the path behind it
    tension           : [N] of the cable there
    unstrained_length : [m] of the cable there
    direction         : (3,) unit vector along the first bar
    half_weight       : (3,) [N], half the weight of the first bar
    """

    exit_point: np.ndarray
    behind: float
    tension: float
    unstrained_length: float
    direction: np.ndarray
    half_weight: np.ndarray

    @classmethod
    def at(
        cls,
        point: np.ndarray,
        behind: float,
        first_bar: np.ndarray,
        tension: float,
        half_weight: np.ndarray,
        axial_stiffness: float,
    ) -> Eyelet:
        """With a first bar along the vector `first_bar` (3,), of any length, of that tension [N] and EA [N]."""
        along = fixed_array("first_bar", first_bar / np.linalg.norm(first_bar), (3,))
        there = tension + float(half_weight @ along)
        return cls(point, behind, there, behind / (1.0 + there / axial_stiffness), along, half_weight)

    def handed_on(self, bar: float) -> np.ndarray:
        """Nothing: the bar's weight rides on a point that only slides along it."""
        del bar
        return np.zeros(3)

    def first_bar_stiffness(self, tension: float, free_length: float, axial_stiffness: float) -> np.ndarray:
        """Stiffness (6, 6) [N/m] of the first bar between the eyelet and the first free node."""
        bar = SlidingBar(tension, self.tension, free_length, self.unstrained_length, axial_stiffness, self.half_weight)
        across = np.eye(3) - np.outer(self.direction, self.direction)
        block = bar.axial_stiffness_matrix(self.direction, np.zeros(3)) + tension / bar.bar * across
        return np.block([[block, -block], [-block, block]])

    def first_bar_mass(
        self, mass: np.ndarray, tension: float, free_length: float, axial_stiffness: float
    ) -> np.ndarray:
        """Mass (6, 6) [kg] of the first bar from that of a bar with held ends: its start slides through the eyelet."""
        bar = free_length * (1.0 + tension / axial_stiffness)
        return sliding_mass(mass, self.direction, self.behind / (self.behind + bar))


def sliding_mass(mass: np.ndarray, direction: np.ndarray, share: float) -> np.ndarray:
    """Mass (6, 6) [kg] of a bar from that with held ends, if its start slides by a share of its end's motion along it.

    direction : (3,) unit vector along the bar
    """
    slid = share * np.outer(direction, direction)
    motion = np.block([[np.eye(3) - slid, slid], [np.zeros((3, 3)), np.eye(3)]])
    return np.asarray(motion.T @ mass @ motion)
